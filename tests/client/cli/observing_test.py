# SPDX-License-Identifier: Apache-2.0
"""What a server tells of its work: metrics, logs, audit. Run with FLATLIGHT FLATLIGHTD PROMTOOL (empty: no promtool)."""
import json
import os
import signal
import subprocess
import sys
import time
import unittest
import urllib.error
import urllib.request

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
from cli_case import FLATLIGHTD, CliCase  # noqa: E402
from daemon import Daemon  # noqa: E402

PROMTOOL = (sys.argv[3:] or [""])[0]


def parse(text):
    """{name{labels}: value} of Prometheus' text format."""
    values = {}
    for line in text.splitlines():
        if line and not line.startswith("#"):
            name, value = line.rsplit(" ", 1)
            values[name] = float(value)
    return values


class ObservingTest(CliCase):
    def serve(self, *arguments):
        daemon = Daemon(FLATLIGHTD, arguments=arguments)
        daemon.__enter__()
        self.addCleanup(daemon.__exit__)
        self.environment["FLATLIGHT_SERVER"] = daemon.address
        return daemon

    def read_metrics(self, daemon):
        if not hasattr(daemon, "metrics"):
            daemon.metrics = daemon.process.stderr.readline().split()[-1]
        with urllib.request.urlopen(daemon.metrics, timeout=30) as answer:
            return answer.read().decode()

    def lines(self, path):
        with open(path) as file:
            return [json.loads(line) for line in file]

    def test_metrics_count_what_happened(self):
        daemon = self.serve("--metrics", "127.0.0.1:0")
        before = parse(self.read_metrics(daemon))
        self.assertEqual(before['flatlight_jobs_ended_total{state="succeeded"}'], 0)
        job = self.run_cli("submit", "gallery:unit-light", "--method", "path-tracing", "--samples", "64", "--class",
                           "graded", "--quiet").stdout.strip()
        self.run_cli("watch", job, "--quiet")
        endless = self.run_cli("submit", "gallery:cornell", "--samples", "1000000000", "--quiet").stdout.strip()
        deadline = time.monotonic() + 60
        while self.jobs()[endless]["state"] != "RUNNING":
            self.assertLess(time.monotonic(), deadline)
        self.assertEqual(parse(self.read_metrics(daemon))['flatlight_jobs{state="running"}'], 1)
        self.run_cli("cancel", endless)
        self.run_cli("show", "jobs/00000000-0000-4000-8000-000000000000", status=2)
        text = self.read_metrics(daemon)
        now = parse(text)
        self.assertEqual(now['flatlight_jobs_ended_total{state="succeeded"}'], 1)
        self.assertEqual(now['flatlight_jobs_ended_total{state="cancelled"}'], 1)
        self.assertEqual(now['flatlight_jobs{state="running"}'], 0)
        self.assertEqual(now['flatlight_queue_wait_seconds_count{class="graded"}'], 1)
        self.assertEqual(now['flatlight_first_picture_seconds_count{class="graded"}'], 1)
        self.assertEqual(now["flatlight_cancel_latency_seconds_count"], 1)
        self.assertEqual(now['flatlight_refusals_total{reason="JOB_NOT_FOUND"}'], 1)
        self.assertEqual(now['flatlight_watches_total{start="new"}'], 1)
        self.assertGreaterEqual(now["flatlight_watch_updates_total"], 1)
        self.assertGreater(now['flatlight_sent_bytes_total{method="RenderService/WatchJob"}'], 1000)
        self.assertGreater(now["flatlight_rays_total"], 256 * 64)
        self.assertGreater(now["process_cpu_seconds_total"], now["flatlight_job_cpu_seconds_total"])
        self.assertGreater(now["flatlight_job_cpu_seconds_total"], 0)
        self.assertNotIn("jobs/", text)
        if PROMTOOL:
            checked = subprocess.run([PROMTOOL, "check", "metrics"], input=text, capture_output=True, text=True, timeout=60)
            self.assertEqual((checked.returncode, checked.stdout + checked.stderr), (0, ""))

    def jobs(self):
        page = json.loads(self.run_cli("jobs", "--json").stdout)
        return {job["name"]: job for job in page["jobs"]}

    def test_metrics_stay_on_this_machine(self):
        for address, why in (("0.0.0.0:0", "not a loopback address"), ("unix:/tmp/metrics", "at HOST:PORT")):
            run = subprocess.run([FLATLIGHTD, "--listen", "127.0.0.1:0", "--metrics", address], capture_output=True,
                                 text=True, timeout=60)
            self.assertEqual(run.returncode, 2, run.stderr)
            self.assertIn(why, run.stderr)

    def test_each_call_is_a_line_with_its_request_and_job(self):
        log = self.path("calls.jsonl")
        self.serve("--log", log)
        job = self.run_cli("submit", "gallery:unit-light", "--quiet").stdout.strip()
        self.run_cli("watch", job, "--quiet")
        self.run_cli("show", "jobs/00000000-0000-4000-8000-000000000000", status=2)
        lines = self.lines(log)
        by_method = {line["method"]: line for line in lines}
        self.assertEqual(by_method["RenderService/CreateJob"]["resource"], job)
        self.assertEqual(by_method["RenderService/WatchJob"]["resource"], job)
        self.assertGreater(by_method["RenderService/WatchJob"]["sent_bytes"], 1000)
        self.assertEqual(by_method["RenderService/GetJob"]["reason"], "JOB_NOT_FOUND")
        self.assertEqual(len({line["request"] for line in lines}), len(lines))
        for line in lines:
            self.assertRegex(line["time"], r"^\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d\.\d{3}Z$")
            self.assertTrue(line["peer"].startswith("ipv4:127.0.0.1:"), line)

    def test_the_audit_log_has_what_changed_something(self):
        data = self.path("data")
        self.serve("--data", data)
        job = self.run_cli("submit", "gallery:unit-light", "--quiet").stdout.strip()
        self.run_cli("jobs")
        self.run_cli("cancel", job)
        lines = self.lines(os.path.join(data, "audit.jsonl"))
        self.assertEqual([(line["method"], line["resource"], line["caller"], line["code"]) for line in lines],
                         [("RenderService/CreateJob", job, "anonymous", "OK"),
                          ("RenderService/CancelJob", job, "anonymous", "OK")])
        self.assertEqual(os.stat(os.path.join(data, "audit.jsonl")).st_mode & 0o077, 0)

    def test_a_log_that_was_moved_away_is_opened_anew(self):
        log = self.path("calls.jsonl")
        daemon = self.serve("--log", log)
        self.run_cli("jobs")
        os.rename(log, log + ".1")
        daemon.process.send_signal(signal.SIGHUP)
        deadline = time.monotonic() + 60
        while not os.path.exists(log):
            self.assertLess(time.monotonic(), deadline)
            time.sleep(0.01)
        old = len(self.lines(log + ".1"))
        self.run_cli("jobs")
        self.assertEqual(len(self.lines(log + ".1")), old)
        self.assertIn("RenderService/ListJobs", [line["method"] for line in self.lines(log)])

    def test_a_log_that_cannot_be_written_is_an_error_at_the_start(self):
        run = subprocess.run([FLATLIGHTD, "--listen", "127.0.0.1:0", "--log", self.path("none/calls")],
                             capture_output=True, text=True, timeout=60)
        self.assertEqual(run.returncode, 1)
        self.assertIn("none/calls: No such file", run.stderr)

    def test_a_full_disk_loses_lines_and_no_calls(self):
        daemon = self.serve("--metrics", "127.0.0.1:0", "--log", "/dev/full")
        self.run_cli("jobs")
        self.assertGreaterEqual(parse(self.read_metrics(daemon))["flatlight_log_lines_lost_total"], 1)

    def test_top_shows_jobs_users_and_rates_in_80_columns(self):
        self.serve()
        endless = [self.run_cli("submit", "gallery:cornell", "--samples", "1000000000", "--quiet").stdout.strip()
                   for _ in range(3)]
        deadline = time.monotonic() + 60
        while {self.jobs()[job]["state"] for job in endless} != {"RUNNING"}:
            self.assertLess(time.monotonic(), deadline)
        self.run_cli("pause", endless[1])
        text = self.run_cli("top", "--once").stdout
        lines = text.splitlines()
        self.assertLessEqual(max(map(len, lines)), 80, text)
        self.assertRegex(text, r"jobs +2 running, 0 waiting, 1 paused; 0 watches")
        self.assertRegex(text, r"work +[\d.]+ M rays/s on \d\.\d\d of \d+ processors?")
        self.assertRegex(text, r"(?m)^anonymous +2 +0 +1 ")
        rows = [line.split() for line in lines if line[:8] in {job[5:13] for job in endless}]
        self.assertEqual({row[2] for row in rows}, {"interactive"})
        self.assertEqual([row[3] for row in rows], ["running", "running", "paused"])
        self.assertEqual(rows[2][0], endless[1][5:13])
        self.assertIn("cornell", rows[2])
        activity = json.loads(self.run_cli("top", "--json").stdout)
        self.assertGreater(activity["cpuSeconds"], activity["jobCpuSeconds"])
        self.assertEqual(len(activity["jobs"]), 3)

    def test_pruning_deletes_what_ended_long_ago(self):
        self.serve()
        ended = self.run_cli("submit", "gallery:unit-light", "--quiet").stdout.strip()
        endless = self.run_cli("submit", "gallery:cornell", "--samples", "1000000000", "--quiet").stdout.strip()
        self.run_cli("watch", ended, "--quiet")
        self.run_cli("jobs", "--prune", "1h")
        self.assertEqual(set(self.jobs()), {ended, endless})
        self.assertIn("--prune: '5x'", self.run_cli("jobs", "--prune", "5x", status=2).stderr)
        self.run_cli("jobs", "--prune", "0")
        self.assertEqual(set(self.jobs()), {endless})


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=1)
