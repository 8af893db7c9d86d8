# SPDX-License-Identifier: Apache-2.0
"""The server's clock is set by a day, to and fro, while jobs run and are watched. Run with FLATLIGHT FLATLIGHTD."""
import datetime
import glob
import json
import os
import sys
import time
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
from cli_case import FLATLIGHTD  # noqa: E402
from daemon import Daemon  # noqa: E402
from running_jobs import SCENE, RunningJobCase  # noqa: E402

LIBRARIES = glob.glob("/usr/lib/*/faketime/libfaketimeMT.so.1")  # Debian's libfaketime.
TIME_LIMIT = 3.0  # s
DAY = 86400


class ClockJumpTest(RunningJobCase):
    def set_clock(self, seconds):
        """Ahead by so many. The clock that only ever goes on, by which time is measured, is left alone, as a real jump does."""
        with open(self.path("offset.new"), "w") as file:
            file.write(f"{seconds:+d}")
        os.rename(self.path("offset.new"), self.path("offset"))

    def ended(self, job):
        return datetime.datetime.fromisoformat(self.show(job)["endTime"]).timestamp()

    @unittest.skipUnless(LIBRARIES, "libfaketime is not installed")
    def test_jobs_watches_and_deadlines_do_not_mind(self):
        self.set_clock(0)
        faked = {"LD_PRELOAD": LIBRARIES[0], "FAKETIME_TIMESTAMP_FILE": self.path("offset"), "FAKETIME_NO_CACHE": "1",
                 "FAKETIME_DONT_FAKE_MONOTONIC": "1"}
        with Daemon(FLATLIGHTD, arguments=("--data", self.path("data")), environment=faked) as daemon:
            self.serve(daemon)
            samples = self.samples_for(seconds=4)
            twin = self.twin(samples)
            early = self.submit(64)
            self.run_cli("watch", early, "--quiet")
            job = self.submit(samples)
            limited = self.run_cli("submit", *SCENE, "--time-limit", str(TIME_LIMIT)).stdout.strip()
            watch = self.start_watch(job)
            for offset in (DAY, -DAY, 0, DAY):
                self.set_clock(offset)
                # A whole small job at each of the four times: it is accepted, watched and kept.
                small = self.submit(64)
                self.run_cli("watch", small, "--quiet")
                self.assertAlmostEqual(self.ended(small), time.time() + offset, delta=600)
                self.assertEqual(self.show(early)["state"], "SUCCEEDED", "ended jobs are kept for longer than a day")
            self.assert_ends_whole(watch, job, twin)
            self.run_cli("watch", limited, "--quiet")
            self.assertEqual(self.show(limited)["endReason"], "TIME_LIMIT")
            statistics = json.loads(self.run_cli("fetch", limited, "-o", "-").stdout)["statistics"]
            self.assertGreaterEqual(statistics["wallSeconds"], 0.9 * TIME_LIMIT, "no jump ends it sooner")
            self.assertLess(statistics["wallSeconds"], 600, "or later")
            self.set_clock(-DAY)
        # The next process begins a day before what it finds was written.
        with Daemon(FLATLIGHTD, arguments=("--data", self.path("data")), environment=faked) as daemon:
            self.serve(daemon)
            self.assertEqual(self.probes(job), twin)
            self.assertEqual(self.show(early)["state"], "SUCCEEDED")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=1)
