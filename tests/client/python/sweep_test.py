# SPDX-License-Identifier: Apache-2.0
"""python3 -m flatlight sweep: what is submitted, what the table says, what survives being ended."""
import csv
import json
import signal
import subprocess
import sys

import flatlight
from flatlight import sweep, sweep_file
from python_case import PythonCase, main

SWEEP = {"scenes": ["gallery:penumbra"], "settings": {"max_bounces": 0},
         "runs": [{"method": "exact"}, {"method": "path-tracing", "samples": [64, 256], "seed": [0, 1]}]}
ENDLESS = {"scenes": ["gallery:cornell"], "settings": {"samples": 1000000000}, "runs": [{"seed": [0, 1, 2]}]}


class SweepFileTest(PythonCase):
    def expand(self, **content):
        return [run.values for run in sweep_file.read(self.write("s.json", json.dumps({"scenes": ["gallery:ring"]} | content)))]

    def test_lists_are_varied_the_last_fastest(self):
        self.assertEqual(self.expand(settings={"seed": 3}, runs=[{"samples": [16, 32], "method": ["path-tracing", "ray-tracing"]}, {}]),
                         [{"seed": 3, "samples": 16, "method": "path-tracing"}, {"seed": 3, "samples": 16, "method": "ray-tracing"},
                          {"seed": 3, "samples": 32, "method": "path-tracing"}, {"seed": 3, "samples": 32, "method": "ray-tracing"},
                          {"seed": 3}])
        self.assertEqual(self.expand(settings={"seed": [1, 2]}, runs=[{"seed": 7}]), [{"seed": 7}])
        self.assertEqual(self.expand(), [{}])
        self.assertEqual(self.expand(runs=[{"no_skip": ["colour", "visibility"]}]), [{"no_skip": ["colour", "visibility"]}])
        self.assertEqual(self.expand(runs=[{"no_skip": [[], ["colour"]]}]), [{"no_skip": []}, {"no_skip": ["colour"]}])

    def test_keys_are_of_the_work_and_not_of_its_place(self):
        def keys(**content):
            return [run.key for run in sweep_file.read(self.write("s.json", json.dumps(content)))]
        scene = self.write("room.json", "{}")
        before = keys(scenes=["room.json", "gallery:ring"], settings={"seed": 1, "samples": 16})
        self.assertEqual(keys(scenes=["gallery:ring", "room.json"], runs=[{"samples": 16, "seed": 1}]), before[::-1])
        self.write("room.json", "{} ")
        self.assertNotEqual(keys(scenes=["room.json"], settings={"seed": 1, "samples": 16}), before[:1], scene)

    def test_mistakes_have_their_place(self):
        for content, message in (
                ("{", "s.json: is not JSON: "),
                ('{"scenes": ["gallery:ring"], "scenes": []}', "s.json: scenes: comes twice"),
                ("[]", "s.json: must be an object"),
                ('{"scenes": []}', "s.json: scenes: must be a list"),
                ('{"scenes": ["gallery:ring"], "run": []}', "s.json: run: is unknown; allowed: scenes, settings, runs, class"),
                ('{"scenes": ["gallery:ring"], "settings": {"sample": 3}}', "s.json: settings: sample: is not a setting; did you mean samples?"),
                ('{"scenes": ["gallery:ring"], "runs": [{}, {"method": "exct"}]}', r"s.json: runs\[1\]: method: is 'exct'; allowed: "),
                ('{"scenes": ["gallery:ring"], "runs": [{"seed": []}]}', "s.json: seed: is an empty list"),
                ('{"scenes": ["gallery:ring"], "runs": [{"seed": [1, 1]}]}', "s.json: gallery:ring with .* comes twice"),
                ('{"scenes": ["none.json"]}', "none.json: No such file"),
                (json.dumps({"scenes": ["gallery:ring"], "runs": [{"seed": list(range(101)), "samples": list(range(1, 101))}]}),
                 r"s.json: runs\[0\]: makes more than 10000 runs")):
            with self.assertRaisesRegex(flatlight.BadRequest, message):
                sweep_file.read(self.write("s.json", content))


class SweepTest(PythonCase):
    def sweep(self, address, *arguments, status=0):
        run = subprocess.run([sys.executable, "-m", "flatlight", "sweep", self.path("s.json"), "--server", address, *arguments],
                             capture_output=True, text=True, timeout=90)
        self.assertEqual(run.returncode, status, run.stdout + run.stderr)
        return run

    def table(self):
        with open(self.path("t.csv"), encoding="utf-8", newline="") as file:
            return list(csv.DictReader(file))

    def test_a_table_and_results(self):
        address = self.serve().address
        self.write("s.json", json.dumps(SWEEP))
        run = self.sweep(address, "-o", self.path("t.csv"), "--results", self.path("results"))
        self.assertRegex(run.stderr, r"(?m)^\[1/5\] penumbra 100 %")
        lines = [line.split() for line in run.stdout.splitlines()]
        self.assertEqual(lines[0][:5], ["RUN", "METHOD", "SAMPLES", "SEED", "STATE"])
        self.assertEqual([line[:6] for line in lines[1:3]],
                         [["1", "exact", "-", "-", "succeeded", "converged"],
                          ["2", "path-tracing", "64", "0", "succeeded", "samples-done"]])
        table = self.table()
        client = self.connect(address)
        for row in table:
            result = flatlight.load(self.path(f"results/{row['run']}.json"))
            self.assertEqual(float(row["mean"]), result[0].irradiance.mean())
            self.assertEqual(result.message.settings.samples, int(row["samples"] or 0))
            self.assertEqual(client.job(row["job"]).progress.rays, float(row["rays"] or 0))
        self.assertAlmostEqual(float(table[3]["mean"]), float(table[0]["mean"]), delta=0.01 * float(table[0]["mean"]))
        self.assertLess(float(table[3]["relative_error"]), float(table[1]["relative_error"]))

    def test_the_same_command_goes_on(self):
        address = self.serve().address
        self.write("s.json", json.dumps(SWEEP | {"runs": SWEEP["runs"][:1]}))
        self.sweep(address)
        self.write("s.json", json.dumps(SWEEP))  # More runs: those that are there stay.
        self.sweep(address, "--quiet", "-o", self.path("t.csv"))
        before = self.table()
        self.sweep(address, "-o", self.path("t.csv"))
        self.assertEqual(self.table(), before)
        client = self.connect(address)
        self.assertEqual(len(list(client.jobs())), 5)
        client.job(before[2]["job"]).delete()
        self.sweep(address, "-o", self.path("t.csv"))
        again = self.table()
        self.assertNotEqual(again[2]["job"], before[2]["job"])
        self.assertEqual(again[2]["mean"], before[2]["mean"])
        self.assertEqual(len(list(client.jobs())), 5)

    def test_an_answer_that_was_lost_makes_no_second_job(self):
        address = self.serve().address
        self.write("s.json", json.dumps(SWEEP | {"runs": SWEEP["runs"][:1]}))
        self.sweep(address)
        # As it stood after the request was sent and before its answer came.
        client = self.connect(address)
        with open(self.path("s.json.jobs"), encoding="utf-8") as file:
            state = json.load(file)[address]
        key, = state["jobs"]
        lost = flatlight.Client.submit
        request_id = "7b1f9c4e-6a53-4c7c-9d1b-0d5b8f7f2a10"
        job = lost(client, "gallery:penumbra", max_bounces=0, method="exact", request_id=request_id)
        self.write("s.json.jobs", json.dumps({address: {"jobs": {}, "pending": {key: request_id}}}))
        self.sweep(address, "-o", self.path("t.csv"))
        self.assertEqual(self.table()[0]["job"], job.name)

    def test_an_interrupted_wait_leaves_jobs_that_are_found_again(self):
        address = self.serve().address
        self.write("s.json", json.dumps(ENDLESS))
        waiting = subprocess.Popen([sys.executable, "-m", "flatlight", "sweep", self.path("s.json"), "--server", address],
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.assertIn("[1/3] cornell", waiting.stderr.readline())
        waiting.send_signal(signal.SIGINT)
        _, errors = waiting.communicate(timeout=60)
        self.assertEqual(waiting.returncode, 130)
        self.assertIn("interrupted; jobs go on", errors)
        self.assertNotIn("Traceback", errors)
        run = self.sweep(address, "--no-wait", "-o", self.path("t.csv"))
        self.assertEqual(len(run.stdout.splitlines()), 4)
        client = self.connect(address)
        self.assertEqual({job.name for job in client.jobs()}, {row["job"] for row in self.table()})
        for job in client.jobs():
            job.cancel()
        self.sweep(address, "-o", self.path("t.csv"), status=1)
        self.assertEqual({row["state"] for row in self.table()}, {"cancelled"})
        self.sweep(address, "--again", "--no-wait")
        self.assertEqual(len(list(client.jobs())), 6)

    def test_where_a_server_takes_no_more_the_sweep_waits_for_its_own(self):
        class Crowded(flatlight.Client):  # The real limit is 1000.
            refused = 0

            def submit(self, *arguments, **keywords):
                if sum(not job.ended for job in self.jobs()) >= 2:
                    self.refused += 1
                    raise flatlight.Denied("2 jobs have not ended", reason="TOO_MANY_JOBS")
                return super().submit(*arguments, **keywords)

        self.write("s.json", json.dumps(SWEEP | {"runs": [{"method": "path-tracing", "samples": 4096, "seed": [1, 2, 3, 4]}]}))
        with Crowded(self.serve().address) as client:
            everything = sweep.Sweep(client, self.path("s.json"), quiet=True)
            everything.submit()
            everything.wait()
            self.assertEqual({job.state for job in everything.jobs.values()}, {"SUCCEEDED"})
            self.assertEqual(len(list(client.jobs())), 4)
            self.assertGreaterEqual(client.refused, 1)
        with Crowded(self.serve().address) as client:  # Full of others' jobs: nothing to wait for.
            for _ in range(2):
                flatlight.Client.submit(client, "gallery:cornell", samples=1000000000)
            with self.assertRaisesRegex(flatlight.Denied, "2 jobs have not ended"):
                sweep.Sweep(client, self.path("s.json"), quiet=True).submit()

    def test_errors_have_the_statuses_of_the_command_line(self):
        address = self.serve().address
        self.write("s.json", json.dumps(SWEEP | {"runs": [{"method": "exact", "samples": 16}]}))
        self.assertIn("gallery:penumbra with", self.sweep(address, status=2).stderr)
        self.write("s.json", json.dumps(SWEEP))
        self.assertIn("cannot reach", self.sweep("127.0.0.1:1", status=3).stderr)
        locked = self.serve(token="secret of a test of a sweep").address
        self.assertNotIn("Traceback", self.sweep(locked, status=4).stderr)
        self.assertIn("no-folder", self.sweep(address, "-o", self.path("no-folder/t.csv"), status=5).stderr)
        self.write("s.json.jobs", "nothing")
        self.assertIn("s.json.jobs: is not what a sweep keeps", self.sweep(address, status=2).stderr)


if __name__ == "__main__":
    main()
