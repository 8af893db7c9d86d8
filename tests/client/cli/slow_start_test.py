# SPDX-License-Identifier: Apache-2.0
"""A private server that is slow to start, and one that does nothing. Run with FLATLIGHT FLATLIGHTD."""
import os
import shutil
import subprocess
import sys
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
from cli_case import FLATLIGHT, FLATLIGHTD, CliCase  # noqa: E402

LONGER_THAN_THE_PATIENCE_WITH_IDLERS = 12  # s


class SlowStartTest(CliCase):
    def start(self, name, script):
        """`flatlight render` with `script` for a server, which lies beside it."""
        programs = self.path(name)
        os.mkdir(programs)
        shutil.copy(FLATLIGHT, os.path.join(programs, "flatlight"))
        server = os.path.join(programs, "flatlightd")
        with open(server, "w") as file:
            file.write(f"#!{sys.executable}\n{script}")
        os.chmod(server, 0o755)
        process = subprocess.Popen([os.path.join(programs, "flatlight"), "render", "gallery:unit-light", "--method", "exact",
                                    "-o", self.path(name + ".json")], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                   text=True, env=self.environment)
        self.addCleanup(process.__exit__, None, None, None)
        self.addCleanup(process.kill)
        return process

    # Both at once, as each takes its time.
    def test_who_gets_on_is_waited_for_and_who_does_nothing_is_not(self):
        busy = self.start("busy", f"import os, sys, time\nend = time.monotonic() + {LONGER_THAN_THE_PATIENCE_WITH_IDLERS}\n"
                                  f"while time.monotonic() < end:\n    pass\nos.execv({FLATLIGHTD!r}, sys.argv)\n")
        idle = self.start("idle", "import time\nprint('half way', flush=True)\ntime.sleep(600)\n")
        out, errors = idle.communicate(timeout=90)
        self.assertEqual(idle.returncode, 3, errors)
        self.assertRegex(errors, r"cannot start a private server: after \d+ s \S+/flatlightd does not listen, and has done "
                                 r"nothing for 10 s\nflatlight: half way\n")
        out, errors = busy.communicate(timeout=90)
        self.assertEqual(busy.returncode, 0, errors)
        self.assertEqual(errors, "flatlight: its own server is slow to start; waiting as long as it gets on\n")
        self.assertEqual(len(self.read_json("busy.json")["probes"]), 1)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=1)
