# SPDX-License-Identifier: Apache-2.0
"""`flatlight watch` on a connection that is cut, or falls silent. Run with FLATLIGHT FLATLIGHTD."""
import contextlib
import json
import os
import subprocess
import sys
import time
import unittest

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path[:0] = [os.path.join(HERE, ".."), os.path.join(HERE, "..", "python")]
from cli_case import FLATLIGHT, FLATLIGHTD, CliCase  # noqa: E402
from daemon import Daemon  # noqa: E402
from proxy import Proxy  # noqa: E402

# Long enough that it can be paused before it ends.
JOB = ("gallery:cornell", "--method", "path-tracing", "--samples", "4096", "--anew", "--quiet")
CUTS = 5


class CutConnectionTest(CliCase):
    @contextlib.contextmanager
    def watched_job(self):
        """A job that rests, its twin that runs, and a watch of the first through a proxy."""
        with Daemon(FLATLIGHTD) as daemon, Proxy(daemon.address) as proxy:
            self.environment["FLATLIGHT_SERVER"] = daemon.address
            job, other = (self.run_cli("submit", *JOB).stdout.strip() for _ in range(2))
            self.run_cli("pause", job)
            watch = subprocess.Popen([FLATLIGHT, "watch", job, "--json", "--server", proxy.address], text=True,
                                     stdout=subprocess.PIPE, stderr=subprocess.PIPE, env=self.environment)
            self.addCleanup(watch.kill)
            self.await_watch(watch)
            yield job, other, watch, proxy

    # A command whose first call already fails says so, and ends.
    def await_watch(self, watch):
        while json.loads(self.run_cli("top", "--json").stdout).get("watches", 0) == 0:
            self.assertIsNone(watch.poll(), "the watch has not begun")
            time.sleep(0.05)

    def await_connections(self, watch, proxy, number):
        while proxy.connections < number:
            self.assertIsNone(watch.poll(), "the watch has given up")
            time.sleep(0.01)

    def assert_ends_whole(self, watch, job, other):
        out, errors = watch.communicate()
        self.assertEqual(watch.returncode, 0, errors)
        self.assertEqual([json.loads(out)[key] for key in ("name", "state")], [job, "SUCCEEDED"])
        self.run_cli("watch", other)
        one, same = (json.loads(self.run_cli("fetch", name, "-o", "-").stdout) for name in (job, other))
        self.assertEqual(one["probes"], same["probes"])

    # The job rests meanwhile, so that no cut comes too late.
    def test_a_watch_that_is_cut_again_and_again_ends_with_the_job(self):
        with self.watched_job() as (job, other, watch, proxy):
            for made in range(1, CUTS + 1):
                self.await_connections(watch, proxy, made)
                proxy.cut()
            self.await_connections(watch, proxy, CUTS + 1)
            self.run_cli("resume", job)
            self.assert_ends_whole(watch, job, other)

    # No error tells that the other side has vanished.
    def test_a_watch_whose_connection_falls_silent_makes_another(self):
        with self.watched_job() as (job, other, watch, proxy):
            proxy.silence()
            self.run_cli("resume", job)
            self.assert_ends_whole(watch, job, other)
            self.assertGreater(proxy.connections, 1)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=1)
