# SPDX-License-Identifier: Apache-2.0
"""A job that runs for some seconds on any machine, watched while something happens to its server or connection."""
import json
import subprocess
import time

from cli_case import FLATLIGHT, CliCase

SCENE = ("gallery:cornell", "--method", "path-tracing", "--anew", "--quiet")


class RunningJobCase(CliCase):
    def serve(self, daemon):
        self.environment["FLATLIGHT_SERVER"] = daemon.address

    def samples_for(self, seconds):
        """So many that a job takes about that long on the server, as busy as it is now."""
        samples = 1024
        while True:
            begin = time.monotonic()
            self.run_cli("watch", self.run_cli("submit", *SCENE, "--samples", str(samples)).stdout.strip(), "--quiet")
            if (took := time.monotonic() - begin) > 0.5:
                return int(samples * seconds / took)
            samples *= 4

    def submit(self, samples, *more):
        return self.run_cli("submit", *SCENE, "--samples", str(samples), *more).stdout.strip()

    def start_watch(self, job, server=None):
        watch = subprocess.Popen([FLATLIGHT, "watch", job, "--json", *(("--server", server) if server else ())], text=True,
                                 stdout=subprocess.PIPE, stderr=subprocess.PIPE, env=self.environment)
        self.addCleanup(watch.__exit__, None, None, None)
        self.addCleanup(watch.kill)
        while json.loads(self.run_cli("top", "--json").stdout).get("watches", 0) == 0:
            self.assertIsNone(watch.poll(), "the watch has not begun")
            time.sleep(0.05)
        return watch

    def start(self, seconds, server=None):
        """A job that takes about that long: its name, its watch, and what a twin of it has found undisturbed."""
        samples = self.samples_for(seconds)
        twin = self.twin(samples)
        job = self.submit(samples)
        return job, self.start_watch(job, server), twin

    def show(self, job):
        return json.loads(self.run_cli("show", job, "--json").stdout)

    def probes(self, job):
        return json.loads(self.run_cli("fetch", job, "-o", "-").stdout)["probes"]

    def assert_ends_whole(self, watch, job, twin):
        """The watch ends with the job, and that with the bits of the twin, to which nothing happened."""
        out, errors = watch.communicate(timeout=120)
        self.assertEqual(watch.returncode, 0, errors)
        self.assertEqual([json.loads(out)[key] for key in ("name", "state")], [job, "SUCCEEDED"])
        self.assertEqual(self.probes(job), twin)

    def twin(self, samples):
        job = self.submit(samples)
        self.run_cli("watch", job, "--quiet")
        return self.probes(job)
