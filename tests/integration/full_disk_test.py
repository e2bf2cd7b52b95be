#!/usr/bin/env python3
"""A recording on a real disk of 64 MB (tmpfs) that gets full, twice: before the guard's limit, and to the last byte. The stream goes on
without a gap, what was recorded is closed and sound, and recording is back at most 5 s after there is room again.

Usage: full_disk_test.py GFPD GFP. Exit code 77 (skipped) where a tmpfs cannot be mounted, or python3-zmq, -protobuf or -numpy is absent.
"""
import json
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time

try:
    from gfp_client import Control, Subscriber
except ImportError as missing:
    print(f"skipped: {missing}")
    sys.exit(77)

GFPD, GFP = sys.argv[1:3]
DEADLINE_S = 100  # generous: the test ends with what it waits for
BACK_WITHIN_S = 5
CONFIG = """
sensors:
  - {name: virtual, driver: synthetic, synthetic: {seed: 7, rate_hz: 15, table: {objects: 2}}}
view: {enabled: false}
recording: {mode: continuous, folder: DISK, zstd_level: 0, content: {color: true}}
"""


class Run:
    """A gfpd that records on the disk, and somebody who listens to its frames."""

    def __init__(self, config, disk, min_free_mb):
        self.disk, self.ballast = disk, disk / "ballast"
        self.daemon = subprocess.Popen([GFPD, "--config", config, "--set", f"recording.min_free_mb={min_free_mb}"], stderr=subprocess.PIPE, text=True)
        self.depth = Subscriber(["/gfp/sensor/virtual/depth/"])
        self.control = Control(timeout_s=DEADLINE_S)
        self.next_seq = None
        self.missed = 0

    def until(self, what, condition):
        """Listens until the recorder's status is so; returns the seconds that it took."""
        begin = time.monotonic()
        while time.monotonic() < begin + DEADLINE_S:
            self.listen()
            status = self.control.recorder()
            if condition(status):
                return time.monotonic() - begin, status
        raise AssertionError(f"did not come within {DEADLINE_S} s: {what}; {status}")

    def listen(self):
        frames = 0
        while frames < 3:
            message = self.depth.receive(DEADLINE_S)
            assert message is not None, "the stream has stopped"
            self.missed += 0 if self.next_seq is None else message.envelope.seq - self.next_seq
            self.next_seq = message.envelope.seq + 1
            frames += 1

    def fill(self, leave_mb):
        room = os.statvfs(self.disk)
        with self.ballast.open("wb") as file:
            os.posix_fallocate(file.fileno(), 0, max(1, room.f_bavail * room.f_frsize - leave_mb * 1_000_000))

    def end(self):
        self.daemon.send_signal(signal.SIGTERM)
        text = self.daemon.communicate(timeout=DEADLINE_S)[1]
        assert self.daemon.returncode == 0, text
        return text


def check_sound(disk, files_at_least):
    files = [file for file in disk.iterdir() if file.name != "ballast"]
    assert len(files) >= files_at_least, files
    for file in files:
        assert file.suffix == ".mcap", f"{file} was not closed"
        repaired = subprocess.run([GFP, "repair", file, "--json"], capture_output=True, text=True, timeout=DEADLINE_S)
        assert json.loads(repaired.stdout.splitlines()[0])["outcome"] == "sound", (file, repaired.stdout)


def check(config, disk, min_free_mb, full_state):
    """Full, room again, and full again, which is how it ends."""
    for file in disk.iterdir():
        file.unlink()
    run = Run(config, disk, min_free_mb)
    try:
        run.until("a recording", lambda status: status.state == "recording" and status.messages > 0)
        run.fill(min_free_mb + 4)
        run.until(full_state, lambda status: status.state == full_state)
        _, before = run.until("losses that are counted", lambda status: status.lost_messages > 0)
        run.ballast.unlink()
        back_s, after = run.until("recording again", lambda status: status.state == "recording" and status.messages > before.messages)
        run.fill(min_free_mb + 4)
        run.until(f"{full_state} again", lambda status: status.state == full_state)
        text = run.end()
    finally:
        run.daemon.kill()
    assert back_s <= BACK_WITHIN_S, f"recording was back {back_s:.1f} s after there was room"
    assert run.missed == 0, f"{run.missed} frames were lost to the stream"
    check_sound(disk, 2 if full_state == "no_space" else 1)
    print(f"{full_state}: back after {back_s:.1f} s, {after.lost_messages} messages lost, none of the stream")
    return text


def main():
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        os.environ["RUNTIME_DIRECTORY"] = str(folder)
        disk = folder / "disk"
        disk.mkdir()
        mounted = subprocess.run(["mount", "-t", "tmpfs", "-o", "size=64m", "tmpfs", disk], capture_output=True, text=True)
        if mounted.returncode != 0:
            print(f"skipped: a tmpfs cannot be mounted here ({mounted.stderr.strip()})")
            sys.exit(77)
        try:
            config = folder / "gfpd.yaml"
            config.write_text(CONFIG.replace("DISK", str(disk)))
            check(config, disk, 8, "no_space")
            assert "No space left on device" in check(config, disk, 0, "failing")
        finally:
            subprocess.run(["umount", "-l", disk], check=True)


main()
