# SPDX-License-Identifier: Apache-2.0
"""Irradiance caching as a user runs it: caching_end_to_end_test.py FLATLIGHT FLATLIGHTD [unittest options]"""
import csv
import json
import re
import sys
import unittest

sys.path.insert(0, __file__.rsplit("/", 2)[0])
from cli_case import FLATLIGHTD, CliCase
from daemon import Daemon


class CachingEndToEnd(CliCase):
    def test_figures_of_irradiance_caching(self):
        run = self.run_cli("figure", "extrapolation", "-o", "a.csv", "-o", "a.svg")
        rows = [line.split() for line in run.stdout.splitlines() if re.match(r"0\.", line)]
        self.assertEqual([row[1] for row in rows], ["1", "2", "1", "2"])
        for first, second in (rows[:2], rows[2:]):
            self.assertLess(5 * float(second[2]), float(first[2]))
        with open(self.path("a.csv")) as file:
            self.assertEqual(len({row["probe"] for row in csv.DictReader(file)}), 5)

        run = self.run_cli("figure", "records-walls", "-o", "b.json", "-o", "b.svg")
        errors = {tuple(line.split()[::2][:2]): float(line.split()[-2]) for line in run.stdout.splitlines()
                  if re.match("(white|black|no) wall ", line)}
        for wall in ("white", "black", "no"):
            self.assertGreater(errors[wall, "split-sphere"], 2.5 * errors[wall, "occlusion-hessian"])
        records = self.read_json("b.json")["records"]
        rows = {wall: [record["position"] for record in records if record["curve"] == wall + ", occlusion-hessian"]
                for wall in ("black wall", "no wall")}
        self.assertEqual(len(rows["no wall"]), 10)
        self.assertEqual(rows["black wall"], rows["no wall"])
        with open(self.path("b.svg")) as file:
            text = file.read()
        for wall in ("white wall", "black wall", "no wall"):
            self.assertIn(wall + ", split-sphere", text)

        self.run_cli("figure", "records-errors", "-o", "c.csv", "-o", "c.svg")
        with open(self.path("c.csv")) as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(len(rows), 2 * 3 * 6 * 6)
        at = lambda scene, degree, control, records: float(next(
            row["relativeRmsError"] for row in rows
            if [row["scene"], row["degree"], row["errorControl"], row["records"]] == [scene, degree, control, records]))
        self.assertGreater(at("blocker", "1", "split-sphere", "16"), 30 * at("blocker", "2", "visibility-events", "16"))
        self.run_cli("figure", "records-errors", "-o", "c.json", status=2)

    def test_the_log_of_records(self):
        with Daemon(FLATLIGHTD) as daemon:
            self.environment["FLATLIGHT_SERVER"] = daemon.address
            name = self.run_cli("submit", "gallery:blocker", "--method", "irradiance-caching", "--quiet").stdout.strip()
            watch = self.run_cli("watch", name, "--records")
            self.assertIn("succeeded", watch.stderr)
            log = [json.loads(line) for line in watch.stdout.splitlines()]
            result = json.loads(self.run_cli("fetch", name, "--json").stdout)
            for record in result["records"]:
                self.assertEqual(len(record.pop("radius")), 2)
            self.assertEqual(log, result["records"])
            self.assertEqual(len(log), result["statistics"]["records"])
            waves = [record["wave"] for record in log]
            self.assertEqual(waves, sorted(waves))
            self.assertGreater(waves[-1], 0)

    def test_records_are_reused(self):
        caching = ["gallery:cornell", "--method", "irradiance-caching"]
        self.run_cli("render", *caching, "--tolerance", "0.05", "-o", "coarse.json")
        again = self.run_cli("render", *caching, "--tolerance", "0.05", "--records", "coarse.json", "-o", "again.json")
        self.run_cli("compare", "coarse.json", "again.json", "--tolerance", "0")
        coarse, same = (self.read_json(name) for name in ("coarse.json", "again.json"))
        self.assertEqual(same["records"], coarse["records"])
        self.assertEqual(same["recordsSeal"], coarse["recordsSeal"])
        self.assertNotEqual(same["jobKey"], coarse["jobKey"])
        self.assertEqual(same["statistics"]["reusedRecords"], len(coarse["records"]))
        self.assertIn(f"({len(coarse['records'])} reused)", again.stdout)
        self.run_cli("render", *caching, "--tolerance", "0.01", "--records", "coarse.json", "-o", "fine.json")
        fine = self.read_json("fine.json")
        self.assertGreater(fine["statistics"]["records"], fine["statistics"]["reusedRecords"])

        text = json.dumps(coarse)
        coarse["records"][0]["irradiance"][0] *= 1 + 1e-15
        self.write("changed.json", json.dumps(coarse))
        del coarse["records"][0]
        self.write("shorter.json", json.dumps(coarse))
        self.write("cut.json", text[:-len(text) // 3])
        self.run_cli("render", "gallery:cornell", "--samples", "1", "-o", "none.json")
        for records, arguments, message in (
                ("changed.json", caching, "do not match their checksum"),
                ("shorter.json", caching, "do not match their checksum"),
                ("cut.json", caching, "cut.json is not a result in JSON form"),
                ("none.json", caching, "holds no records"),
                ("gone.json", caching, "gone.json"),
                ("jobs/7", caching, "a job is named jobs/{uuid}"),
                ("coarse.json", ["gallery:penumbra", *caching[1:]], "are of another world"),
                ("coarse.json", [*caching, "--max-bounces", "1"], "max bounces all, and this job has 1"),
                ("coarse.json", [*caching, "--samples", "32"], "with gather"),
                ("coarse.json", ["gallery:cornell"], "are for irradiance-caching alone")):
            error = self.run_cli("render", *arguments, "--records", records, status=2).stderr
            self.assertIn(message, error)
            self.assertEqual(error.count("\n"), 1, error)

    def test_records_gather_from_a_photon_map(self):
        caching = ["gallery:penumbra", "--method", "irradiance-caching", "--gather", "from-photon-map",
                   "--samples", "64"]
        plan = self.run_cli("explain", *caching, "--photons", "5000").stdout
        self.assertIn("64 rays each that end in a map of 5000 photons", plan)
        self.run_cli("render", *caching, "--photons", "5000", "-o", "few.json")
        self.assertEqual(self.read_json("few.json")["statistics"]["photons"], 5000)
        error = self.run_cli("render", *caching, "--photons", "6000", "--records", "few.json", status=2).stderr
        self.assertIn("photons 5000, and this job has 6000", error)

    def test_records_of_a_job_on_the_server(self):
        with Daemon(FLATLIGHTD) as daemon:
            self.environment["FLATLIGHT_SERVER"] = daemon.address
            caching = ["gallery:blocker", "--method", "irradiance-caching"]
            name = self.run_cli("submit", *caching, "--quiet").stdout.strip()
            self.run_cli("watch", name)
            self.run_cli("render", *caching, "--records", name, "-o", "a.json")
            self.run_cli("fetch", name, "-o", "b.json")
            self.run_cli("render", *caching, "--records", "b.json", "-o", "c.json")
            self.run_cli("render", *caching, "-o", "d.json")
            a, b, c, d = (self.read_json(f"{name}.json") for name in "abcd")
            # What the server remembers counts only if it is asked for.
            self.assertEqual(d["jobKey"], b["jobKey"])
            self.assertNotIn("reusedRecords", d["statistics"])
            self.assertEqual(a["jobKey"], c["jobKey"])
            for result in (a, c, d):
                self.assertEqual(result["records"], b["records"])


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
