# SPDX-License-Identifier: Apache-2.0
"""Commands against a server that takes few requests a second: they wait as long as it says, and say so in one line.
retry_test.py FLATLIGHT FLATLIGHTD"""
import os
import sys
import unittest

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
from cli_case import FLATLIGHTD, CliCase
from daemon import Daemon

LINE = r"^flatlight: the server refuses for now \(TOO_MANY_REQUESTS\); trying again in [0-9.]+ m?s, up to 4 times$"


class RetryTest(CliCase):
    def test_too_many_requests_take_longer_and_are_answered(self):
        with Daemon(FLATLIGHTD, arguments=("--quota", "admin.requests=1")) as daemon:
            # Ten at once, and one a second; a command makes two. A slow machine takes more of them to come to that.
            said = ""
            for _ in range(100):
                said = self.run_cli("scenes", "--server", daemon.address).stderr
                if said:
                    break
            self.assertRegex(said, f"(?m){LINE}")
            quiet = [self.run_cli("submit", "gallery:penumbra", "--quiet", "--server", daemon.address).stderr
                     for _ in range(2)]
            self.assertEqual(quiet, ["", ""])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=1)
