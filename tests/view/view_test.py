#!/usr/bin/env python3
"""The view of a real gfpd: starts one on the synthetic driver, then runs a client on its port. For scripts whose name has `replay` in it, what
that gfpd sees is recorded first, and the client meets a second one that plays the recording.

Usage: view_test.py GFPD MODULES_DIR SCRIPT [ARGUMENT...]. MODULES_DIR gets the client's packages (npm ci) where they are not there.
Exit code 77 (skipped) where node, npm, its packages or the browser are absent.
"""
import os
import pathlib
import shutil
import socket
import subprocess
import sys
import tempfile
import urllib.request

HERE = pathlib.Path(__file__).resolve().parent
GFPD, MODULES = sys.argv[1], pathlib.Path(sys.argv[2])
SCRIPT, ARGUMENTS = sys.argv[3], sys.argv[4:]


def skip(why):
    print(f"skipped: {why}")
    sys.exit(77)


def fetch_packages():
    if not shutil.which("node") or not shutil.which("npm"):
        skip("node or npm is not installed")
    MODULES.mkdir(parents=True, exist_ok=True)
    stamp = MODULES / "installed"
    lock = HERE / "package-lock.json"
    if not stamp.exists() or stamp.stat().st_mtime < lock.stat().st_mtime:
        for file in ("package.json", "package-lock.json"):
            shutil.copy(HERE / file, MODULES / file)
        done = subprocess.run(["npm", "ci", "--no-audit", "--no-fund", "--ignore-scripts", "--prefer-offline"], cwd=MODULES, capture_output=True, text=True)
        if done.returncode != 0:
            skip(f"npm could not fetch the client's packages: {done.stderr[-300:]}")
        stamp.touch()
    # Node looks for packages beside the script: copies of ours stand beside them.
    for file in HERE.glob("*.mjs"):
        shutil.copy(file, MODULES)
    return MODULES / SCRIPT


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


TABLE = "seed: 7, rate_hz: 10, table: {objects: 4, classes: [mug, bottle, box, bowl, can]}"
SENSOR = f"{{name: virtual, driver: synthetic, synthetic: {{{TABLE}}}}}"
OTHER = f"{{name: across, driver: synthetic, synthetic: {{{TABLE}, azimuth_rad: 0.5}}}}"  # it looks at the same table
RECORDED_FRAMES = 80


class Daemon:
    """A gfpd with a configuration; the view's port is free and its own."""

    def __init__(self, folder, text):
        self.port = free_port()
        config = pathlib.Path(folder) / f"{self.port}.yaml"
        config.write_text(f"{text}\nview: {{port: {self.port}}}\n")
        self.process = subprocess.Popen([GFPD, "--config", str(config)], env={**os.environ, "RUNTIME_DIRECTORY": folder}, stderr=subprocess.PIPE, text=True)
        for line in self.process.stderr:  # until it listens
            if "the view is at" in line:
                break

    def stop(self):
        self.process.terminate()
        self.process.communicate()


def record(folder):
    """A recording of what two synthetic sensors see."""
    daemon = Daemon(folder, f"sensors: [{SENSOR}, {OTHER}]\nrecording: {{mode: continuous, folder: {folder}/recordings}}")
    try:
        count = subprocess.run(["node", MODULES / "wait_for_frames.mjs", str(daemon.port), str(RECORDED_FRAMES)], timeout=300)
    finally:
        daemon.stop()
    if count.returncode != 0:
        sys.exit(count.returncode)
    return next(pathlib.Path(folder, "recordings").glob("*.mcap"))


def main():
    is_browser = "browser" in SCRIPT
    if is_browser and not os.path.exists("/usr/bin/chromium"):
        skip("/usr/bin/chromium is not installed")
    script = fetch_packages()
    with tempfile.TemporaryDirectory() as folder:
        primitives = pathlib.Path(folder, "primitives")
        gfp = pathlib.Path(GFPD).parents[1] / "cli" / "gfp"
        subprocess.run([gfp, "primitive", "retype", "mug", "--primitives", primitives, "--set", "auto"], check=True, stdout=subprocess.DEVNULL)
        os.environ.update(GFP_TOOL=str(gfp), GFP_PRIMITIVES=str(primitives))
        if "replay" in SCRIPT:
            recording = record(folder)
            text = "sensors:" + "".join(f"\n  - {{name: {name}, driver: replay, input: {recording}}}" for name in ("virtual", "across"))
        else:
            text = f"sensors: [{SENSOR}]\npipeline: {{shadow: superquadric}}\nprimitives: {primitives}"
        daemon = Daemon(folder, text)
        try:
            page = urllib.request.urlopen(urllib.request.Request(f"http://127.0.0.1:{daemon.port}/", headers={"Accept-Encoding": "gzip"})).read()
            if is_browser and len(page) < 10_000:
                skip("this build has no page")
            sys.exit(subprocess.run(["node", script, str(daemon.port), *ARGUMENTS], timeout=900).returncode)
        finally:
            daemon.stop()


main()
