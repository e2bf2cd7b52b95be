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
            check_tools()
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
