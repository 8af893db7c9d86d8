# SPDX-License-Identifier: Apache-2.0
"""A watch while the job runs, and its connection is cut every second, or its server is stopped. Run with FLATLIGHT
FLATLIGHTD; FLATLIGHT_STOP_SECONDS in the environment stops the server for longer than the test has time for."""
import os
import signal
import sys
import time
import unittest

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path[:0] = [os.path.join(HERE, ".."), os.path.join(HERE, "..", "python")]
STOP_SECONDS = float(os.environ.get("FLATLIGHT_STOP_SECONDS", "3"))
from cli_case import FLATLIGHTD  # noqa: E402
from daemon import Daemon  # noqa: E402
from proxy import Proxy  # noqa: E402
from running_jobs import RunningJobCase  # noqa: E402


class InterruptedWatchTest(RunningJobCase):
    def test_a_connection_that_is_cut_every_second_while_the_job_runs(self):
        with Daemon(FLATLIGHTD) as daemon, Proxy(daemon.address) as proxy:
            self.serve(daemon)
            job, watch, twin = self.start(seconds=6, server=proxy.address)
            cuts = 0
            while watch.poll() is None:
                if self.show(job)["state"] == "RUNNING":
                    proxy.cut()
                    cuts += 1
                time.sleep(1)
            self.assert_ends_whole(watch, job, twin)
            self.assertGreaterEqual(cuts, 3)
            self.assertGreaterEqual(proxy.connections, cuts)

    def test_a_server_that_is_stopped_for_a_while_goes_on(self):
        with Daemon(FLATLIGHTD) as daemon:
            self.serve(daemon)
            job, watch, twin = self.start(seconds=3)
            self.assertEqual(self.show(job)["state"], "RUNNING")
            daemon.process.send_signal(signal.SIGSTOP)
            time.sleep(STOP_SECONDS)
            self.assertIsNone(watch.poll(), "the watch has given up")
            daemon.process.send_signal(signal.SIGCONT)
            self.assert_ends_whole(watch, job, twin)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=1)
