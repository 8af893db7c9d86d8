# SPDX-License-Identifier: Apache-2.0
"""A server whose folder cannot be written, from the start or all at once. Run with FLATLIGHT FLATLIGHTD, as root: for others
nothing of this can be arranged, and the tests are skipped."""
import hashlib
import os
import re
import subprocess
import sys
import unittest
import urllib.request

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
from cli_case import FLATLIGHTD  # noqa: E402
from daemon import Daemon  # noqa: E402
from running_jobs import RunningJobCase  # noqa: E402


def may(*command):
    return os.geteuid() == 0 and subprocess.run(command, capture_output=True).returncode == 0


MAY_MOUNT = may("unshare", "--mount", "mount", "-t", "tmpfs", "tmpfs", "/mnt")


@unittest.skipUnless(MAY_MOUNT, "may not mount here")
class FailingDiskTest(RunningJobCase):
    def setUp(self):
        super().setUp()
        self.data = self.path("data")
        os.mkdir(self.data)

    def daemon(self, mount=""):
        """With the folder mounted in a way of its own, which only the server sees."""
        prefix = ("unshare", "--mount", "sh", "-euc", mount + '\nexec "$@"', "sh") if mount else ()
        return Daemon(FLATLIGHTD, arguments=("--data", self.data, "--metrics", "127.0.0.1:0"), prefix=prefix)

    def serve(self, daemon):
        super().serve(daemon)
        self.metrics = re.search(r"http://\S+", daemon.process.stderr.readline()).group()

    def healthy(self):
        with urllib.request.urlopen(self.metrics, timeout=30) as page:
            return float(re.search(r"^flatlight_storage_healthy (\S+)", page.read().decode(), re.MULTILINE).group(1)) == 1

    def contents(self):
        found = {}
        for folder, _, names in os.walk(self.data):
            for name in names:
                with open(os.path.join(folder, name), "rb") as file:
                    found[os.path.relpath(file.name, self.data)] = hashlib.sha256(file.read()).hexdigest()
        return found

    def ended_job(self):
        job = self.submit(64)
        self.run_cli("watch", job, "--quiet")
        return job, self.probes(job)

    def test_a_folder_that_may_only_be_read_is_refused_at_the_start(self):
        with self.daemon() as daemon:
            self.serve(daemon)
            job, values = self.ended_job()
        before = self.contents()
        for folder in (self.data, self.path("empty")):
            os.makedirs(folder, exist_ok=True)
            refused = subprocess.run(
                ["unshare", "--mount", "sh", "-euc", 'mount --bind "$1" "$1"; mount -o remount,bind,ro "$1"; exec "$0" '
                 '--listen 127.0.0.1:0 --data "$1"', FLATLIGHTD, folder], capture_output=True, text=True, timeout=60)
            self.assertEqual(refused.returncode, 1, refused.stderr)
            self.assertRegex(refused.stderr, rf"^flatlightd: .*{re.escape(folder)}.*Read-only file system.*let the server's user "
                                             r"write there, then try again\n$")
        self.assertEqual(self.contents(), before)
        with self.daemon() as daemon:
            self.serve(daemon)
            self.assertEqual(self.probes(job), values)

    # On a file system that knows no such flag there is nothing to try.
    def test_a_folder_that_may_no_longer_be_written(self):
        if not may("chattr", "+i", self.data) or not may("chattr", "-i", self.data):
            self.skipTest("files cannot be made immutable here")
        self.addCleanup(subprocess.run, ["chattr", "-R", "-i", self.data])
        with self.daemon() as daemon:
            self.serve(daemon)
            ended, values = self.ended_job()
            job, watch, twin = self.start(seconds=2)
            subprocess.run(["chattr", "-R", "+i", self.data], check=True)
            refused = self.run_cli("submit", "gallery:penumbra", status=3).stderr
            self.assertRegex(refused, rf"may not write {re.escape(self.data)}\S* .*let the server's user write there")
            self.assertEqual(self.probes(ended), values)
            self.run_cli("jobs")
            self.run_cli("explain", "gallery:penumbra")
            self.assert_ends_whole(watch, job, twin)
            self.assertFalse(self.healthy())
            subprocess.run(["chattr", "-R", "-i", self.data], check=True)
            again, _ = self.ended_job()
        with self.daemon() as daemon:
            self.serve(daemon)
            self.assertEqual([self.probes(job), self.probes(ended)], [twin, values])
            self.assertEqual(self.show(again)["state"], "SUCCEEDED")

    def test_a_disk_that_is_full_and_then_no_longer(self):
        with self.daemon(f"mount -t tmpfs -o size=8m tmpfs {self.data}") as daemon:
            self.serve(daemon)
            ended, values = self.ended_job()
            job, watch, twin = self.start(seconds=2)
            inside = f"/proc/{daemon.process.pid}/root{self.data}"
            with open(inside + "/filler", "wb", buffering=0) as file:
                try:
                    while file.write(bytes(4096)) == 4096:
                        pass
                except OSError as error:
                    self.assertEqual(error.strerror, "No space left on device")
            refusals = 0
            while not refusals:  # The log that is written ahead may have some room left.
                name = self.run_cli("submit", "gallery:penumbra", "--method", "exact", "--max-bounces", "0", "--quiet",
                                    status=None)
                refusals += name.returncode != 0
            self.assertEqual(name.returncode, 4, name.stderr)
            self.assertRegex(name.stderr, rf"no room to write {re.escape(self.data)}\S* .*free some space, then try again")
            self.assertEqual(self.probes(ended), values)
            self.assert_ends_whole(watch, job, twin)
            self.assertFalse(self.healthy())
            os.remove(inside + "/filler")
            again, _ = self.ended_job()
            while not self.healthy():
                pass
            self.assertEqual(self.show(again)["state"], "SUCCEEDED")
            self.assertEqual([self.probes(job), self.probes(ended)], [twin, values])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=1)
