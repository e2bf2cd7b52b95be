#!/usr/bin/env python3
"""One run of the real thing: gfpd with the synthetic driver, real ipc sockets, a Python and a C++ subscriber, both ends' tools.

Usage: daemon_test.py GFPD GFP EXAMPLE_SUBSCRIBER. Exit code 77 (skipped) where python3-zmq, -protobuf or -numpy is absent.
"""
import collections
import json
import os
import pathlib
import signal
import socket
import subprocess
import sys
import tempfile
import time

try:
    import numpy as np
    import zmq  # noqa: F401
    import google.protobuf  # noqa: F401
except ImportError as missing:
    print(f"skipped: {missing}")
    sys.exit(77)

GFPD, GFP, EXAMPLE = sys.argv[1:4]
DEADLINE_S = 120  # generous: the test ends with what it waits for
CONFIG = """
sensors:
  - name: virtual
    driver: synthetic
    synthetic: {seed: 7, rate_hz: 10, table: {objects: 3}}
pipeline: {method: gfp_robust}
"""


def wait_for(what, condition):
    end = time.monotonic() + DEADLINE_S
    while time.monotonic() < end:
        result = condition()
        if result is not None:
            return result
    raise AssertionError(f"did not come within {DEADLINE_S} s: {what}")


def assert_closed(triangles):
    """Every directed edge once, and its opposite once: closed and consistently oriented."""
    edges = collections.Counter()
    for a, b in ((0, 1), (1, 2), (2, 0)):
        edges.update(map(tuple, triangles[:, [a, b]]))
    assert all(count == 1 and edges[(b, a)] == 1 for (a, b), count in edges.items()), "an edge without its opposite"


def check_python_client():
    from gfp_client import SceneSubscriber, Subscriber, depth_m

    scenes = SceneSubscriber()

    def complete():
        scene = scenes.next(1)
        if scene and scene.objects and all(o.triangles is not None for o in scene.objects) and any(o.grasps for o in scene.objects):
            return scene
        return None

    scene = wait_for("a scene with meshes and a grasp", complete)
    assert scene.header.sensor == "virtual" and scene.header.frame_id == "virtual_optical"
    for thing in scene.objects:
        assert thing.vertices.shape == (thing.message.vertices.count, 3) and np.isfinite(thing.vertices).all()
        assert not thing.vertices.flags.owndata, "the vertices were copied"
        assert thing.closed
        assert_closed(thing.triangles)
        assert thing.sigma_m.shape == thing.observed.shape == (len(thing.vertices),)
        assert 0.2 < thing.vertices_camera()[:, 2].mean() < 3, "the object stands in front of the camera"
        assert thing.grasps or thing.no_grasp_reason, "neither a grasp nor a reason"
        for grasp in thing.grasps:
            assert np.allclose(grasp.T_camera_tcp[:3, :3] @ grasp.T_camera_tcp[:3, :3].T, np.eye(3), atol=1e-6)
            assert 0 < grasp.width_m < 0.2 and len(grasp.contacts) == 2

    depth = Subscriber(["/gfp/sensor/virtual/depth/"]).receive(DEADLINE_S)
    assert depth is not None and depth_m(depth).shape == (480, 640) and depth_m(depth).max() > 0.3
    return len(scene.objects)


def check_control():
    """What the control socket answers, and a client that learns its messages from it."""
    from gfp_client import Control

    control = Control(timeout_s=DEADLINE_S)
    topics = [topic for topic, _, _ in control.snapshot("/gfp/")]
    assert "/gfp/scene/" in topics and "/gfp/status/gfpd/" in topics, topics
    fitted = control.fit(region_px=(0, 0, 640, 480))
    assert fitted and all(thing.triangles is not None for thing in fitted), "a fit without its meshes"
    assert control.set_parameters(**{"pipeline.segmentation.min_points": 301}) == {"pipeline.segmentation.min_points": "301"}
    try:
        control.set_parameters(**{"pipeline.segmentation.min_points": -1})
        raise AssertionError("a parameter out of its range was taken")
    except RuntimeError as refused:
        assert "min_points" in str(refused), refused
    alone = {key: value for key, value in os.environ.items() if key not in ("GFP_DESCRIPTORS", "PYTHONPATH")}
    client = pathlib.Path(os.environ["RUNTIME_DIRECTORY"]) / "gfp_client.py"  # away from any gfp.desc
    client.write_text(pathlib.Path(sys.modules["gfp_client"].__file__).read_text())
    learnt = subprocess.run([sys.executable, "-c", "import gfp_client; print(len(gfp_client.MESSAGES))"], env=alone, cwd=client.parent, capture_output=True, text=True, timeout=DEADLINE_S)
    assert learnt.returncode == 0 and int(learnt.stdout) > 20, learnt.stderr


def check_curve(folder):
    """tcp with keys: who is authorized is served, in Python and by the tools; who is not gets nothing."""
    from gfp_client import Curve, SceneSubscriber, Subscriber, depth_m

    folder = pathlib.Path(folder)
    for name in ("robot", "alice", "mallory"):
        assert run(GFP, "key", "new", str(folder / name)).returncode == 0
    (folder / "authorized").mkdir()
    (folder / "alice.pub").rename(folder / "authorized" / "alice.pub")
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        tcp = f"tcp://127.0.0.1:{probe.getsockname()[1]}"
    config = folder / "curve.yaml"
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        sensor_tcp = f"tcp://127.0.0.1:{probe.getsockname()[1]}"
    remote = {"state": tcp, "sensor": sensor_tcp}
    publish = "".join(f"  {name}_endpoints: ['ipc://{folder}/curve/{name}'{', ' + repr(remote[name]) if name in remote else ''}]\n" for name in ("sensor", "state", "control"))
    config.write_text(CONFIG + "publish:\n" + publish)
    assert run(GFPD, "--config", str(config)).returncode == 78, "tcp was opened without a key"
    config.write_text(config.read_text() + f"  curve_key: {folder}/robot.key\n  authorized_keys: {folder}/authorized\n")
    daemon = subprocess.Popen([GFPD, "--config", str(config)], stderr=subprocess.DEVNULL)
    try:
        scenes = SceneSubscriber([tcp], curve=Curve(folder / "robot.pub", folder / "alice.key"))
        assert wait_for("a scene over tcp with CURVE", lambda: scenes.next(1)).header.sensor == "virtual"
        subscribers = [Subscriber(["/gfp/sensor/virtual/depth/"], [endpoint], curve=curve) for endpoint, curve in
                       ((sensor_tcp, Curve(folder / "robot.pub", folder / "alice.key")), (f"ipc://{folder}/curve/sensor", None))]
        images = [{}, {}]  # by sequence: one of both that is the same frame

        def same_frame():
            for subscriber, seen in zip(subscribers, images):
                if message := subscriber.receive(0.1):
                    seen[message.payload.header.sequence] = message
            both = set(images[0]) & set(images[1])
            return tuple(seen[min(both)] for seen in images) if both else None

        far, near = wait_for("a depth image over tcp and over ipc", same_frame)
        assert (far.envelope.encoding, near.envelope.encoding) == (1, 0)
        assert (depth_m(far) == depth_m(near)).all() and depth_m(far).max() > 0.3
        keys = ["--endpoint", tcp, "--server-key", str(folder / "robot.pub"), "--key"]
        top = run(GFP, "top", "--count", "1", "--json", *keys, str(folder / "alice.key"))
        assert top.returncode == 0 and "status" in top.stdout, top.stderr
        assert run(GFP, "top", "--seconds", "1", *keys, str(folder / "mallory.key")).returncode == 69, "a stranger was served"
    finally:
        daemon.kill()
        daemon.wait()


def run(*command):
    return subprocess.run(command, capture_output=True, text=True, timeout=DEADLINE_S)


def check_tools():
    sub = run(GFP, "sub", "/gfp/scene/", "--count", "2", "--json")
    assert sub.returncode == 0, sub.stderr
    line = json.loads(sub.stdout.splitlines()[0])
    assert line["sensor"] == "virtual" and line["objects"][0]["T_camera_object"][3] == [0, 0, 0, 1]
    table = run(GFP, "sub", "/gfp/scene/", "--count", "1")
    assert table.returncode == 0 and "virtual" in table.stdout, table.stderr
    echo = run(GFP, "echo", "/gfp/status/virtual/", "--count", "1", "--json")
    assert echo.returncode == 0 and json.loads(echo.stdout)["payload"]["driver"] == "synthetic", echo.stderr
    assert run(GFP, "echo", "/gfp/mesh/", "--count", "1").returncode == 0
    example = subprocess.Popen([EXAMPLE], stdout=subprocess.PIPE, text=True)
    first = example.stdout.readline()
    example.kill()
    example.wait()
    assert "vertices" in first and "grasps" in first, first


def check_reload(daemon, config):
    config.write_text(CONFIG.replace("gfp_robust", "gfp_robust_").replace("seed: 7", "sed: 7"))
    daemon.send_signal(signal.SIGHUP)
    assert run(GFP, "sub", "/gfp/scene/", "--count", "3").returncode == 0, "a bad reload stopped the stream"
    assert daemon.poll() is None, "a bad reload ended the daemon"
    config.write_text(CONFIG)
    daemon.send_signal(signal.SIGHUP)
    assert run(GFP, "sub", "/gfp/scene/", "--count", "3").returncode == 0


def main():
    with tempfile.TemporaryDirectory() as folder:
        os.environ["RUNTIME_DIRECTORY"] = folder
        config = pathlib.Path(folder) / "gfpd.yaml"
        config.write_text(CONFIG)
        log = pathlib.Path(folder) / "gfpd.log"
        manager = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
        manager.bind(folder + "/notify")
        manager.settimeout(DEADLINE_S)
        os.environ["NOTIFY_SOCKET"] = folder + "/notify"
        daemon = subprocess.Popen([GFPD, "--config", str(config)], stderr=log.open("w"))
        del os.environ["NOTIFY_SOCKET"]
        try:
            assert manager.recv(100) == b"READY=1" and manager.recv(100) == b"WATCHDOG=1", "not what Type=notify waits for"
            objects = check_python_client()
            check_control()
            check_tools()
            check_curve(folder)
            check_reload(daemon, config)
            second = run(GFPD, "--config", str(config))
            assert second.returncode == 69 and "another gfpd" in second.stderr, second.stderr
            daemon.send_signal(signal.SIGTERM)
            assert daemon.wait(timeout=DEADLINE_S) == 0, f"SIGTERM ended it with {daemon.returncode}"
            text = log.read_text()
            assert "did you mean seed" in text and "reloaded" in text and "stopped" in text, text
            print(f"ok: {objects} object(s) with closed meshes and grasps, in Python and C++")
        finally:
            if daemon.poll() is None:
                daemon.kill()
            print(log.read_text(), file=sys.stderr)


main()
