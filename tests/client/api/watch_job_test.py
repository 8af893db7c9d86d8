# SPDX-License-Identifier: Apache-2.0
"""The example for other languages, docs/examples/watch_job.py, against a real server: watch_job_test.py EXAMPLE FLATLIGHTD"""
import re
import subprocess
import sys

sys.path.insert(0, __file__.rsplit("/", 2)[0])
from daemon import Daemon

EXAMPLE, FLATLIGHTD = sys.argv[1:3]

with Daemon(FLATLIGHTD) as daemon:
    run = subprocess.run([sys.executable, EXAMPLE, daemon.address], capture_output=True, text=True, timeout=60)
assert run.returncode == 0, run.stderr
progress = re.findall(r"^ *(\d+)%, relative error (\S+)$", run.stdout, re.MULTILINE)
assert progress and progress[-1][0] == "100", run.stdout
assert float(progress[-1][1]) <= 0.01, run.stdout
points = re.findall(r"^s = (\S+) m   E = (\S+) \+- (\S+) W/m$", run.stdout, re.MULTILINE)
assert len(points) == 64, run.stdout
# Direct light of the lamp is L (sin - sin) in closed form. What the floor reflects comes back from the lamp alone, which
# sees less than half of it and reflects 0.8 of that: bounces add less than a fifth.
s, irradiance, error = map(float, points[32])
left, right = s - 2 + 0.5, s - 2 - 0.5
direct = 5 * (left / (left**2 + 4) ** 0.5 - right / (right**2 + 4) ** 0.5)
assert direct - 6 * error <= irradiance <= 1.2 * direct + 6 * error, (direct, points[32])
