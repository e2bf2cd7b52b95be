#!/usr/bin/env python3
"""The view of a real gfpd: starts one on the synthetic driver, then runs a client on its port.

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
    # Node looks for packages beside the script: a copy of it stands beside them.
    return shutil.copy(HERE / SCRIPT, MODULES / SCRIPT)


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def main():
    if SCRIPT == "browser_test.mjs" and not os.path.exists("/usr/bin/chromium"):
        skip("/usr/bin/chromium is not installed")
    script = fetch_packages()
    port = free_port()
    with tempfile.TemporaryDirectory() as folder:
        config = pathlib.Path(folder) / "gfpd.yaml"
        config.write_text(f"""
sensors: [{{name: virtual, driver: synthetic, synthetic: {{seed: 7, rate_hz: 10, table: {{objects: 4, classes: [mug, bottle, box, bowl, can]}}}}}}]
view: {{port: {port}}}
""")
        daemon = subprocess.Popen([GFPD, "--config", str(config)], env={**os.environ, "RUNTIME_DIRECTORY": folder}, stderr=subprocess.PIPE, text=True)
        try:
            for line in daemon.stderr:  # until it listens
                if "the view is at" in line:
                    break
            page = urllib.request.urlopen(urllib.request.Request(f"http://127.0.0.1:{port}/", headers={"Accept-Encoding": "gzip"})).read()
            if SCRIPT == "browser_test.mjs" and len(page) < 10_000:
                skip("this build has no page")
            sys.exit(subprocess.run(["node", script, str(port), *ARGUMENTS], timeout=900).returncode)
        finally:
            daemon.terminate()
            daemon.communicate()


main()
