#!/usr/bin/env python3
"""What the view costs a running gfpd: CPU time of its thread in % of a core, with viewers that take what the page takes (scene, meshes,
statuses, depth, colour, camera) from a virtual Kinect at 30 Hz.

Usage: view_cost.py GFPD MODULES_DIR [CLIENTS=2] [SECONDS=10]. MODULES_DIR: build/release/tests/view/clients, as the view's tests leave it.
"""
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time

HERE = pathlib.Path(__file__).resolve().parent
GFPD, MODULES = sys.argv[1], pathlib.Path(sys.argv[2])
CLIENTS, SECONDS = (int(argument) for argument in (sys.argv[3:] + ["2", "10"][len(sys.argv) - 3:])[:2])
PORT = 20_000 + os.getpid() % 20_000


def cpu_s(pid, name):
    """User and system time so far of the threads of that name."""
    total = 0
    for task in pathlib.Path(f"/proc/{pid}/task").iterdir():
        if (task / "comm").read_text().strip() == name:
            fields = (task / "stat").read_text().rsplit(")", 1)[1].split()
            total += int(fields[11]) + int(fields[12])
    return total / os.sysconf("SC_CLK_TCK")


with tempfile.TemporaryDirectory() as folder:
    config = pathlib.Path(folder) / "gfpd.yaml"
    config.write_text(f"sensors: [{{name: virtual, driver: synthetic, synthetic: {{seed: 7, rate_hz: 30, table: {{objects: 5}}}}}}]\nview: {{port: {PORT}}}\n")
    daemon = subprocess.Popen([GFPD, "--config", str(config)], env={**os.environ, "RUNTIME_DIRECTORY": folder}, stderr=subprocess.PIPE, text=True)
    for line in daemon.stderr:
        if "the view is at" in line:
            break
    script = shutil.copy(HERE / "view_client.mjs", MODULES)
    clients = [subprocess.Popen(["node", script, str(PORT), str(SECONDS + 3)], stdout=subprocess.PIPE, text=True) for _ in range(CLIENTS)]
    try:
        time.sleep(2)  # of the measurement: what comes first is not counted
        begin, begin_s = cpu_s(daemon.pid, "gfp-view"), time.monotonic()
        time.sleep(SECONDS)
        share = (cpu_s(daemon.pid, "gfp-view") - begin) / (time.monotonic() - begin_s)
        heard = [json.loads(client.communicate()[0]) for client in clients]
    finally:
        daemon.terminate()
        daemon.communicate()
    print(json.dumps({"clients": CLIENTS, "core_share": round(share, 3), "heard_per_s": heard}))
