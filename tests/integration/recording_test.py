#!/usr/bin/env python3
"""Recording and replay with the real programs: gfpd records a virtual table, and so does gfp record beside it; both files fit, replay and
compare equal to themselves; what a kill leaves is closed by the next start.

Usage: recording_test.py GFPD GFP
"""
import json
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time

GFPD, GFP = sys.argv[1:3]
DEADLINE_S = 200  # generous: the test ends with what it waits for
CONFIG = """
sensors:
  - name: virtual
    driver: synthetic
    synthetic: {seed: 7, rate_hz: 5, table: {objects: 2}}
recording: {mode: continuous, folder: RECORDINGS, min_free_mb: 1}
"""
TWO_SENSORS = """
sensors:
  - {name: left, driver: synthetic, synthetic: {seed: 4, rate_hz: 5, azimuth_rad: -2.2, table: {objects: 2}}}
  - {name: right, driver: synthetic, synthetic: {seed: 4, rate_hz: 5, azimuth_rad: -0.9, table: {objects: 2}}}
recording: {mode: continuous, folder: RECORDINGS, min_free_mb: 1}
"""


def wait_for(what, condition):
    end = time.monotonic() + DEADLINE_S
    while time.monotonic() < end:
        result = condition()
        if result:
            return result
        time.sleep(0.05)
    raise AssertionError(f"did not come within {DEADLINE_S} s: {what}")


def gfp(*arguments, expected=0):
    done = subprocess.run([GFP, *map(str, arguments)], capture_output=True, text=True, timeout=DEADLINE_S)
    assert done.returncode == expected, f"gfp {arguments}: exit code {done.returncode}\n{done.stdout}\n{done.stderr}"
    return done.stdout


def lines(text):
    return [json.loads(line) for line in text.splitlines()]


def check_recorder(folder, config):
    """Over the control socket: what was off is started and stopped, a ring is triggered; each file is whole."""

    def recorder(action, expected=0):
        return json.loads(gfp("recorder", action, "--json", expected=expected) or "{}")

    def with_daemon(mode, check):
        recordings = folder / mode
        daemon = subprocess.Popen([GFPD, "--config", config, "--set", f"recording.mode={mode}", "--set", f"recording.folder={recordings}", "--set", "recording.after_trigger_s=0.5"], stderr=subprocess.DEVNULL)
        try:
            gfp("sub", "/gfp/scene/", "--count", 1)
            check(recordings)
            daemon.send_signal(signal.SIGTERM)
            assert daemon.wait(timeout=DEADLINE_S) == 0
        finally:
            daemon.kill()
        files = sorted(recordings.glob("*"))
        for file in files:
            assert file.suffix == ".mcap" and lines(gfp("repair", file, "--json"))[0]["outcome"] == "sound", file
        return files

    def off(recordings):
        assert recorder("status")["state"] == "off" and not recordings.exists()
        recorder("trigger", expected=64)
        for count in (1, 2):
            assert recorder("start")["state"] == "recording"
            wait_for("something in the file", lambda: recorder("status")["bytes"] > 0 and recorder("status")["file"].endswith(".active"))
            stopped = recorder("stop")
            assert (stopped["state"], stopped["mode"], stopped["files"], stopped["lost_messages"]) == ("off", "off", count, 0), stopped
            assert pathlib.Path(stopped["file"]).is_file(), stopped
        recorder("start")  # and what is open when the daemon ends is closed
        wait_for("a third file", lambda: recorder("status")["file"].endswith(".active"))

    def ring(recordings):
        assert recorder("status")["state"] == "ring"
        wait_for("a file of the ring", lambda: recorder("trigger")["messages"] > 0)
        wait_for("its end", lambda: recorder("status")["state"] == "ring")

    assert len(with_daemon("off", off)) == 3
    assert len(with_daemon("ring", ring)) >= 1


def check_two_sensors(folder):
    """A recording of two sensors: all of it is played, in the order of recording at any speed, to the same objects; one of them if its topic is named."""
    config, recordings = folder / "two.yaml", folder / "two"
    config.write_text(TWO_SENSORS.replace("RECORDINGS", str(recordings)))
    daemon = subprocess.Popen([GFPD, "--config", config], stderr=subprocess.DEVNULL)
    try:
        gfp("sub", "/gfp/scene/", "--count", 6)
        daemon.send_signal(signal.SIGTERM)
        assert daemon.wait(timeout=DEADLINE_S) == 0
    finally:
        daemon.kill()
    recording = next(recordings.glob("*.mcap"))
    played = []
    for speed in (0, 1):
        kept = folder / f"played_{speed}"
        options = ["--set", "recording.mode=continuous", "--set", f"recording.folder={kept}", "--set", "recording.min_free_mb=1", "--set", "log.level=off"]
        said = lines(gfp("replay", recording, "--speed", speed, "--json", *options))[0]
        assert said["sensor"] == "left, right" and said["frames"] >= 6 and said["objects"] > 0, said
        played.append(next(kept.glob("*.mcap")))
    assert lines(gfp("diff", *played, "--json"))[0]["differences"] == []
    alone = lines(gfp("replay", recording, "--speed", 0, "--json", "--topic", "/gfp/sensor/right/depth/", "--set", "log.level=off"))[0]
    assert alone["sensor"] == "right" and 0 < alone["frames"] < said["frames"], alone
    gfp("replay", recording, "--name", "other", expected=64)


def main():
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        os.environ["RUNTIME_DIRECTORY"] = str(folder / "run")
        (folder / "run").mkdir()
        recordings = folder / "recordings"
        config = folder / "gfpd.yaml"
        config.write_text(CONFIG.replace("RECORDINGS", str(recordings)))

        daemon = subprocess.Popen([GFPD, "--config", config])
        try:
            first = folder / "first.mcap"
            summary = lines(gfp("record", first, "--count", 6, "--seconds", DEADLINE_S, "--json"))[0]
            assert summary["frames"] >= 1 and summary["scenes"] >= 1 and summary["corrupt"] == 0, summary
            wait_for("a second of recording", lambda: any(p.stat().st_size > 1_000_000 for p in recordings.glob("*.active")))
            daemon.send_signal(signal.SIGKILL)
            daemon.wait()
            assert list(recordings.glob("*.mcap.active")) and not list(recordings.glob("*.mcap"))

            daemon = subprocess.Popen([GFPD, "--config", config])
            wait_for("the killed recording to be closed", lambda: list(recordings.glob("*.mcap")))
            killed = next(recordings.glob("*.mcap"))
            wait_for("a second recording", lambda: any(p.stat().st_size > 1_000_000 for p in recordings.glob("*.active")))
            daemon.send_signal(signal.SIGTERM)
            assert daemon.wait(timeout=DEADLINE_S) == 0
        finally:
            daemon.kill()
        assert len(list(recordings.glob("*.mcap"))) == 2 and not list(recordings.glob("*.active"))

        for file in [first, *recordings.glob("*.mcap")]:
            assert lines(gfp("repair", file, "--json"))[0]["outcome"] == "sound", file
            assert lines(gfp("diff", file, file, "--json"))[0]["differences"] == []

        check_recorder(folder, config)
        check_two_sensors(folder)

        # The recording fits to the same objects every time, and gfp replay publishes every frame of it.
        fits = [folder / "a.jsonl", folder / "b.jsonl"]
        for fit in fits:
            fit.write_text(gfp("fit", first, "--json"))
        gfp("diff", *fits)
        frames = lines(fits[0].read_text())
        assert len(frames) == summary["frames"] and frames[0]["sensor"] == "virtual" and any(frame["objects"] for frame in frames)
        played = lines(gfp("replay", first, "--speed", 0, "--json", "--set", "log.level=off"))[0]
        assert played["frames"] == summary["frames"] and played["sensor"] == "virtual", played

        # An object that moved by 5 mm is a difference, and diff says which and by how much.
        index = next(i for i, frame in enumerate(frames) if frame["objects"])
        frames[index]["objects"][0]["T_camera_object"][0][3] += 0.005
        moved = folder / "moved.jsonl"
        moved.write_text("".join(json.dumps(frame) + "\n" for frame in frames))
        found = lines(gfp("diff", fits[0], moved, "--json", expected=1))[0]["differences"]
        assert [d["what"] for d in found] == ["position"] and abs(found[0]["delta"] - 0.005) < 1e-9, found
        gfp("diff", fits[0], moved, "--position", 0.01)
        gfp("diff", fits[0], killed, "--no-grasps", expected=1)  # other frames

        # Cut in the middle: repaired in place, and what is left is equal. (The daemon's file has several chunks, the short one perhaps not.)
        cut = folder / "cut.mcap"
        cut.write_bytes(killed.read_bytes()[: killed.stat().st_size * 2 // 3])
        assert lines(gfp("repair", cut, "--json"))[0]["outcome"] == "closed"
        assert all(d["what"] == "frame" for d in lines(gfp("diff", killed, cut, "--json", expected=1))[0]["differences"])
        gfp("repair", folder / "missing.mcap", expected=66)
        gfp("replay", config, expected=65)
        print("recorded, killed, recovered, replayed, compared")


main()
