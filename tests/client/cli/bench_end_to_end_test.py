# SPDX-License-Identifier: Apache-2.0
"""`flatlight bench` as a user runs it: bench_end_to_end_test.py FLATLIGHT FLATLIGHTD [unittest options]"""
import csv
import json
import os
import signal
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, __file__.rsplit("/", 2)[0])
from daemon import Daemon

FLATLIGHT, FLATLIGHTD = sys.argv[1:3]
SMALL = ["bench", "gallery:penumbra", "--max-bounces", "0", "--methods", "exact,path-tracing", "--budgets", "16,64,256", "--seeds", "3"]


class BenchEndToEnd(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="flatlight-test-")
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        self.environment = {key: value for key, value in os.environ.items() if not key.startswith("FLATLIGHT_")}

    def path(self, name):
        return os.path.join(self.folder, name)

    def run_cli(self, *arguments, status=0):
        run = subprocess.run([FLATLIGHT, *arguments], capture_output=True, text=True, timeout=90, cwd=self.folder,
                             env=self.environment, stdin=subprocess.DEVNULL)
        self.assertEqual(run.returncode, status, f"{arguments}\n{run.stdout}\n{run.stderr}")
        return run

    def rows(self, name):
        with open(self.path(name), newline="") as file:
            return list(csv.DictReader(file))

    def write_rows(self, name, rows):
        with open(self.path(name), "w", newline="") as file:
            writer = csv.DictWriter(file, rows[0].keys(), lineterminator="\n")
            writer.writeheader()
            writer.writerows(rows)

    def text(self, name):
        with open(self.path(name)) as file:
            return file.read()

    # --- a benchmark

    def test_all_forms(self):
        run = self.run_cli(*SMALL, "-o", "b.csv", "-o", "b.svg", "-o", "b.png", "-o", "b.json")
        for text in ("12 runs", "SLOPE OVER TIME", "truth exact", "wrote b.csv, b.svg, b.png, b.json"):
            self.assertIn(text, run.stdout)
        self.assertEqual(run.stderr, "")
        self.assertEqual(sorted(os.listdir(self.folder)), ["b.csv", "b.json", "b.png", "b.svg"])
        rows = self.rows("b.csv")
        self.assertEqual(len(rows), 12)
        self.assertEqual(sorted({row["budget"] for row in rows}), ["", "16", "256", "64"])
        sampled = [row for row in rows if row["method"] == "path-tracing"]
        self.assertEqual(len({row["seed"] for row in sampled}), 9)
        for row in sampled:
            self.assertGreater(float(row["irradianceRms"]), 0)
            self.assertGreater(float(row["cpuSeconds"]), 0)
            self.assertEqual((row["gradientRms"], row["endReason"], row["repeat"]), ("", "samples-done", "0"))
        for row in rows:
            if row["method"] == "exact":
                self.assertEqual((row["seed"], row["irradianceRms"], row["hessianRms"]), ("", "0", "0"))
        self.assertTrue(self.text("b.svg").startswith("<?xml"))
        report = json.loads(self.text("b.json"))
        curve = next(curve for curve in report["curves"] if curve["method"] == "path-tracing")
        self.assertLess(curve["slopeOverSamples"]["slope"], -0.4)
        self.assertEqual(report["findings"], [])

    def test_a_row_is_a_run_that_render_repeats(self):
        self.run_cli(*SMALL[:4], "--methods", "path-tracing", *SMALL[6:], "-o", "b.csv", "-q")
        row = self.rows("b.csv")[0]
        scene = ["gallery:penumbra", "--max-bounces", "0"]
        self.run_cli("render", *scene, "--samples", row["budget"], "--seed", row["seed"], "-o", "a.json", "-q")
        self.run_cli("render", *scene, "--method", "exact", "-o", "exact.json", "-q")
        run = self.run_cli("compare", "a.json", "exact.json", "--json")
        compared = json.loads(run.stdout)["quantities"][0]
        self.assertAlmostEqual(float(row["irradianceRms"]), compared["rms"], delta=1e-12)
        self.assertAlmostEqual(float(row["irradianceMeanZ2"]), compared["meanZ2"], delta=1e-9)

    def test_standard_output_is_for_machines(self):
        run = self.run_cli(*SMALL, "--json")
        self.assertEqual(len(json.loads(run.stdout)["curves"]), 4)
        self.assertIn("12 runs", run.stderr)
        self.assertEqual(self.run_cli(*SMALL, "--quiet").stdout, "")

    def test_only_what_is_missing_is_done(self):
        self.run_cli(*SMALL, "-o", "b.csv")
        before = self.text("b.csv")
        run = self.run_cli(*SMALL, "-o", "b.csv")
        self.assertIn("0 runs; 12 there already", run.stdout)
        self.assertEqual(self.text("b.csv"), before)
        run = self.run_cli(*SMALL[:-1], "4", "--repeats", "2", "-o", "b.csv")
        self.assertIn("20 runs; 12 there already", run.stdout)
        self.assertTrue(self.text("b.csv").startswith(before))
        rows = self.rows("b.csv")
        runs = {(row["method"], row["budget"], row["seed"], row["repeat"]) for row in rows}
        self.assertEqual((len(rows), len(runs)), (32, 32))
        errors = {}  # A repeat has the same bits.
        for row in rows:
            self.assertEqual(errors.setdefault((row["budget"], row["seed"]), row["irradianceRms"]), row["irradianceRms"])

    def test_the_time_limit_leaves_budgets_out(self):
        run = self.run_cli("bench", "gallery:ring", "--methods", "path-tracing", "--seeds", "2", "--time-limit", "1")
        self.assertRegex(run.stdout, r"left out   gallery:ring path-tracing from \d+ samples on: another .* \(--time-limit 1\)")
        run = self.run_cli("bench", "gallery:ring", "--max-bounces", "0", "--methods", "exact", "--time-limit", "1e-9")
        self.assertIn("0 runs", run.stdout)

    # --- files that do not fit

    def test_other_runs_are_refused(self):
        self.run_cli(*SMALL, "-o", "b.csv", "-q")
        rows = self.rows("b.csv")
        for column, value, reason in (("server", "0.0.1", "the server's build is 0.0.1, not"),
                                      ("processor", "Z80", "the machine is Z80, "),
                                      ("sceneHash", "0.0", "gallery:penumbra was another scene then"),
                                      ("truth", "file 00", "the truth of gallery:penumbra is file 00, not exact"),
                                      ("settings", "--max-bounces 7", "settings of gallery:penumbra .* are --max-bounces 7, not ")):
            self.write_rows("other.csv", [{**row, column: value} for row in rows])
            run = self.run_cli(*SMALL, "-o", "other.csv", status=2)
            self.assertRegex(run.stderr, f"^flatlight: other.csv holds other runs: {reason}.*--force")
            self.assertEqual(len(self.rows("other.csv")), 12)
        run = self.run_cli(*SMALL, "-o", "other.csv", "--force")
        self.assertIn("12 runs\n", run.stdout)
        self.assertEqual(len(self.rows("other.csv")), 24)

    def test_damage_is_told_with_its_place(self):
        self.run_cli(*SMALL, "-o", "b.csv", "-q")
        good = self.text("b.csv")
        lines = good.splitlines(keepends=True)
        for text, place in ((good[:-10], rf"line 13, column {len(lines[12]) - 9}: the file ends in the middle of a row"),
                            (good + "a,b\n", "line 14, column 3: the row ends with value 2"),
                            (lines[0] + lines[1].replace("exact", '"exact', 1), r"line 2, column \d+: the quotation mark"),
                            ("rubbish\n", "line 1, column 1: 'rubbish' is no column")):
            with open(self.path("b.csv"), "w") as file:
                file.write(text)
            for command in ([*SMALL, "-o", "b.csv"], ["bench", "compare", "b.csv", "b.csv"]):
                self.assertRegex(self.run_cli(*command, status=2).stderr, "^flatlight: b.csv: " + place)
            self.assertEqual(self.text("b.csv"), text)

    def test_bad_usage(self):
        for arguments, message in (([], "a SCENE or --gallery is needed"),
                                   (["gallery:nothing"], "there is no scene gallery:nothing"),
                                   (["missing.json"], "missing.json cannot be read"),
                                   (["gallery:ring", "gallery:ring"], "gallery:ring is the same scene as gallery:ring"),
                                   (["gallery:ring", "--methods", "magic"], "--methods: 'magic'; must be one or more of exact, "),
                                   (["gallery:ring", "--methods", "exact,exact"], "--methods: exact is there twice"),
                                   (["gallery:ring", "--budgets", "16,,64"], "--budgets: '16,,64'; must be numbers"),
                                   (["gallery:ring", "--budgets", "16,16"], "--budgets: 16 is there twice"),
                                   (["gallery:ring", "--seeds", "0"], "--seeds: '0'; must be a whole number from 1 to 10000"),
                                   (["gallery:ring", "--time-limit", "0"], "--time-limit: '0'; must be a number above 0"),
                                   (["gallery:ring", "--no-skip", "lunch"], "--no-skip"),
                                   (["gallery:ring", "-o", "b.npy"], "must end in one of .csv .svg .png .json"),
                                   (["gallery:ring", "-o", "a.csv", "-o", "b.csv"], "b.csv is a second .csv")):
            self.assertIn(message, self.run_cli("bench", *arguments, status=2).stderr)
        scene = {"name": "mirror", "plane": {
            "materials": [{"name": "mirror", "mirror": {"reflectance": [0.9]}}],
            "curves": [{"name": "floor", "segment": {"a": {"x": 0, "y": 0}, "b": {"x": 1, "y": 0}}, "material": "mirror",
                        "emission": {"radiance": [1]}}]}, "probes": [{"name": "floor", "curve": "floor", "count": 4}]}
        with open(self.path("mirror.json"), "w") as file:
            json.dump(scene, file)
        self.assertIn("nothing gives the truth of 2 bounces",
                      self.run_cli("bench", "mirror.json", "--max-bounces", "2", status=2).stderr)
        os.remove(self.path("mirror.json"))
        self.assertIn("no/b.csv", self.run_cli("bench", "gallery:ring", "-o", "no/b.csv", status=5).stderr)
        self.assertEqual(os.listdir(self.folder), [])

    # --- other truths

    def test_a_sampled_truth_is_told_from_the_error(self):
        run = self.run_cli("bench", "gallery:corner", "--budgets", "64", "--truth-samples", "256", "--seeds", "4", "-o", "b.csv")
        self.assertIn("gallery:corner without exact: ", run.stdout)
        self.assertIn("TRUTH'S OWN", run.stdout)
        for row in self.rows("b.csv"):
            self.assertEqual(row["truth"], "path-tracing 256")
            self.assertGreater(float(row["irradianceTruthRms"]), 0)
            self.assertNotIn("max-bounces", row["settings"])

    def test_all_bounces_have_a_truth(self):
        run = self.run_cli("bench", "gallery:corner", "--methods", "path-tracing", "--budgets", "16,64", "--seeds", "2", "-o", "b.csv")
        self.assertIn("truth reference", run.stdout)
        for row in self.rows("b.csv"):
            self.assertEqual((row["method"], row["truth"]), ("path-tracing", "reference"))
            self.assertLess(float(row["irradianceMeanZ2"]), 10)
            self.assertNotIn("max-bounces", row["settings"])

    def test_a_stored_truth(self):
        self.run_cli("render", "gallery:corner", "--max-bounces", "1", "--samples", "512", "-o", "truth.json", "-q")
        self.run_cli("bench", "gallery:corner", "gallery:ring", "--methods", "path-tracing", "--budgets", "16", "--seeds", "2",
                     "--truth", "truth.json", "-o", "b.csv", "-q")
        for row in self.rows("b.csv"):
            stored = row["scene"] == "gallery:corner"
            self.assertEqual(row["truth"].startswith("file "), stored)
            self.assertEqual("--max-bounces 1" in row["settings"], stored)
        run = self.run_cli("bench", "gallery:ring", "--truth", "truth.json", status=2)
        self.assertIn("truth.json is of none of the scenes", run.stderr)

    # --- servers and signals

    def test_a_server_keeps_no_jobs_of_a_benchmark(self):
        with Daemon(FLATLIGHTD) as daemon:
            self.environment["FLATLIGHT_SERVER"] = daemon.address
            self.run_cli(*SMALL, "-o", "b.csv", "-q")
            self.assertEqual(json.loads(self.run_cli("jobs", "--json").stdout), {})
            self.run_cli("submit", "gallery:penumbra", "--samples", "4000000000", "-q")
            self.assertIn("the server has other jobs to do (1)", self.run_cli(*SMALL, "-o", "b.csv").stdout)

    def test_ctrl_c_keeps_what_is_done(self):
        command = ["bench", "gallery:penumbra", "--methods", "path-tracing", "--budgets", "1024,1000000000", "--seeds", "2"]
        process = subprocess.Popen([FLATLIGHT, *command, "-o", "b.csv"], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                   text=True, env=self.environment, cwd=self.folder)
        self.addCleanup(process.kill)
        while "1000000000" not in process.stdout.readline():  # The first budget is done.
            self.assertIsNone(process.poll())
        process.send_signal(signal.SIGINT)
        _, errors = process.communicate(timeout=30)
        self.assertEqual(process.returncode, 130)
        self.assertEqual(errors, "flatlight: interrupted; 1 run more in b.csv, where the same command goes on\n")
        self.assertEqual(len(self.rows("b.csv")), 1)
        command[command.index("1024,1000000000")] = "1024"
        self.assertIn("1 run; 1 there already", self.run_cli(*command, "-o", "b.csv").stdout)

    # --- comparison

    def test_compare(self):
        self.run_cli(*SMALL[:-1], "8", "-o", "a.csv", "-q")
        run = self.run_cli("bench", "compare", "a.csv", "a.csv")
        self.assertIn("0 worse, 0 better", run.stdout)
        rows = self.rows("a.csv")
        for row in rows:  # Without noise, so that the machine at hand does not matter.
            row["cpuSeconds"] = "0.5"
        self.write_rows("a.csv", rows)
        self.write_rows("b.csv", [{**row, "cpuSeconds": "0.6"} for row in rows])
        run = self.run_cli("bench", "compare", "a.csv", "b.csv", status=10)
        self.assertIn("4 worse, 0 better", run.stdout)
        self.assertEqual(self.run_cli("bench", "compare", "a.csv", "b.csv", "-q", status=10).stdout, "")
        self.run_cli("bench", "compare", "a.csv", "b.csv", "--least", "0.25")
        self.assertIn("4 better", self.run_cli("bench", "compare", "b.csv", "a.csv").stdout)
        report = json.loads(self.run_cli("bench", "compare", "a.csv", "b.csv", "--json", status=10).stdout)
        self.assertEqual(report["overall"]["verdict"], "worse")
        self.write_rows("b.csv", [{**row, "cpuSeconds": "0.6", "processor": "Z80"} for row in rows])
        self.assertIn("different machines", self.run_cli("bench", "compare", "a.csv", "b.csv").stdout)
        self.write_rows("b.csv", [{**row, "sceneHash": "0.0"} for row in rows])
        self.assertIn("no point in common", self.run_cli("bench", "compare", "a.csv", "b.csv", status=2).stderr)
        self.assertIn("missing.csv", self.run_cli("bench", "compare", "a.csv", "missing.csv", status=2).stderr)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
