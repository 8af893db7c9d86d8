# SPDX-License-Identifier: Apache-2.0
"""The programs as a user runs them: end_to_end_test.py FLATLIGHT FLATLIGHTD [unittest options]"""
import ast
import csv
import glob
import json
import os
import pty
import re
import resource
import select
import signal
import socket
import struct
import subprocess
import sys
import unittest

sys.path.insert(0, __file__.rsplit("/", 2)[0])
from cli_case import FLATLIGHT, FLATLIGHTD, CliCase
from daemon import Daemon
from picture_files import PictureReader

# A job that would take hours, but for its end.
ENDLESS = ["gallery:penumbra", "--method", "path-tracing", "--samples", "4000000000"]


class EndToEnd(PictureReader, CliCase):
    def assert_no_leftovers(self):
        self.assertEqual(glob.glob(self.path(".flatlight-*")), [])

    # --- render and its outputs

    def test_a_time_limit_ends_before_every_point_had_its_turn(self):
        room = {"name": "room", "plane": {
            "materials": [{"name": "white", "lambertian": {"reflectance": [0.9999]}}],
            "curves": [{"name": "walls", "material": "white", "emission": {"radiance": [1]}, "polyline": {
                "points": [{"x": x, "y": y} for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))], "closed": True}}]},
            "probes": [{"name": "walls", "curve": "walls", "count": 20000}]}
        self.write("room.json", json.dumps(room))
        run = self.run_cli("render", "room.json", "--method", "path-tracing", "--time-limit", "0.5", "-o", "r.json")
        self.assertRegex(run.stdout, "no samples at [0-9]+ of 20000 points\ntime limit reached")
        with open(self.path("r.json")) as file:
            result = json.load(file)
        samples = result["probes"][0]["samples"]
        self.assertEqual(result["endReason"], "TIME_LIMIT")
        self.assertEqual(result["statistics"]["unsampledPoints"], samples.count(0))
        self.assertGreater(samples.count(0), 0)
        self.assertLess(samples.count(0), 20000)
        self.assertEqual(samples.count(16), 20000 - samples.count(0))

    def test_render_writes_every_form(self):
        names = ["r." + form for form in ("json", "csv", "npy", "svg", "png", "exr", "hdr")]
        run = self.run_cli("render", "gallery:unit-light", "--method", "exact", *sum((["-o", n] for n in names), []))
        for text in ("plan", "irradiance 0.70", "error at most", "finished in", "wrote r.json"):
            self.assertIn(text, run.stdout)
        self.assertEqual(run.stderr, "")
        with open(self.path("r.json")) as file:
            result = json.load(file)
        probe = result["probes"][0]
        self.assertEqual((probe["name"], probe["quantity"], probe["channels"]), ("floor", "IRRADIANCE", 1))
        self.assertEqual(result["endReason"], "CONVERGED")
        with open(self.path("r.csv"), newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual([float(row["irradiance"]) for row in rows], probe["irradiance"])
        self.assertEqual([float(row["hessian"]) for row in rows], probe["hessian"])
        self.assertEqual(self.read_npy("r.npy", "irradiance"), probe["irradiance"])
        starts = {"svg": b"<?xml", "png": b"\x89PNG\r\n", "exr": b"\x76\x2f\x31\x01", "hdr": b"#?RADIANCE"}
        for form, start in starts.items():
            with open(self.path("r." + form), "rb") as file:
                self.assertTrue(file.read().startswith(start), form)
        self.assert_no_leftovers()

    def read_npy(self, name, field):
        sizes = {"<i4": ("i", 4), "<f8": ("d", 8)}
        with open(self.path(name), "rb") as file:
            data = file.read()
        self.assertEqual(data[:8], b"\x93NUMPY\x01\x00")
        length = struct.unpack("<H", data[8:10])[0]
        self.assertEqual((10 + length) % 64, 0)
        header = ast.literal_eval(data[10:10 + length].decode("latin1"))
        form = "<" + "".join(sizes[kind][0] for _, kind in header["descr"])
        column = [field_name for field_name, _ in header["descr"]].index(field)
        values = [row[column] for row in struct.iter_unpack(form, data[10 + length:])]
        self.assertEqual(header["shape"], (len(values),))
        return values

    def test_pictures_of_probes_of_different_sizes(self):
        scene = json.loads(self.run_cli("scenes", "unit-light").stdout)
        scene["probes"] = [{**scene["probes"][0], "name": f"p{count}", "count": count} for count in (3, 5)]
        name = self.write("two.json", json.dumps(scene))
        self.run_cli("render", name, "--method", "exact", "-o", "r.exr", "-o", "r.hdr", "-o", "r.json")
        self.assertEqual(sorted(os.listdir(self.folder)), ["r.exr", "r.hdr", "r.json", "tmp", "two.json"])
        with open(self.path("r.json")) as file:
            probes = json.load(file)["probes"]
        with open(self.path("r.exr"), "rb") as file:
            parts, rows = self.read_exr(file.read())
        self.assertEqual([struct.unpack("<4i", part["displayWindow"]) for part in parts], [(0, 0, 4, 0)] * 2)
        self.assertEqual([struct.unpack("<4i", part["dataWindow"]) for part in parts], [(0, 0, 2, 0), (0, 0, 4, 0)])
        for part, row, probe in zip(parts, rows, probes):
            self.assertEqual(part["name"].decode(), probe["name"])
            self.assertEqual(row, struct.unpack(f"<{len(row)}f", struct.pack(f"<{len(row)}f", *probe["irradiance"])))

    def test_a_picture_of_any_scene(self):
        self.run_cli("render", "gallery:cornell", "--picture", "40x30", "--samples", "64", "-o", "p.png", "-o", "p.json",
                     "-o", "p.exr")
        with open(self.path("p.json")) as file:
            probe, = json.load(file)["probes"]
        self.assertEqual((probe["quantity"], probe["width"], probe["height"]), ("FLUENCE", 40, 30))
        self.assertEqual(len(probe["irradiance"]), 3 * 40 * 30)
        low_x, low_y, high_x, high_y = probe["corners"]
        self.assertAlmostEqual((high_x - low_x) / 40, (high_y - low_y) / 30)
        rows = self.read_png("p.png")
        self.assertEqual((len(rows), len(rows[0])), (30, 40))
        # The room is x and y from 0 to 2: a red wall on the left, a green one on the right, a lamp above.
        pixel = lambda x, y: rows[int((high_y - y) / (high_y - low_y) * 30)][int((x - low_x) / (high_x - low_x) * 40)]
        self.assertGreater(pixel(0.1, 0.5)[0], pixel(0.1, 0.5)[1])
        self.assertGreater(pixel(1.9, 0.5)[1], pixel(1.9, 0.5)[0])
        self.assertGreater(sum(pixel(1, 1.9)), sum(pixel(1, 0.1)))
        self.assertEqual(pixel(-0.1, 1), (0, 0, 0))

    def test_a_picture_is_no_curve(self):
        self.assertIn("the result is a picture", self.run_cli(
            "render", "gallery:cornell", "--picture", "4x3", "--samples", "1", "-o", "p.svg", status=5).stderr)
        for bad in ("0x5", "5", "99999x99999", "17000x1"):
            self.assertIn("picture" if "x" not in bad or bad[0] == "0" else "allowed", self.run_cli(
                "render", "gallery:cornell", "--picture", bad, status=2).stderr)

    def test_figures_of_derivatives(self):
        run = self.run_cli("figure", "derivatives-occluded", "--samples", "256", "-o", "f.csv", "-o", "f.svg")
        rows = {tuple(line.split()[:2]): line for line in run.stdout.splitlines() if line}
        with open(self.path("f.csv"), newline="") as file:
            table = list(csv.DictReader(file))
        gradients = {name: [float(row["gradient"]) for row in table if row["probe"] == name]
                     for name in ("exact", "stratified", "polyline", "arc-length")}
        self.assertEqual({len(values) for values in gradients.values()}, {400})
        worst = {name: max(abs(a - b) for a, b in zip(values, gradients["exact"])) for name, values in gradients.items()}
        self.assertLess(worst["stratified"], 1e-9)
        self.assertLess(worst["polyline"], 1e-9)
        self.assertGreater(worst["arc-length"], 0.5)
        self.assertIn("%", rows["arc-length", "gradient"])
        with open(self.path("f.svg")) as file:
            self.assertIn("arc-length", file.read())
        self.assertIn("there are derivatives, derivatives-occluded, photon-map, convergence",
                      self.run_cli("figure", "nothing", status=2).stderr)

    def test_standard_output_is_for_machines(self):
        for arguments in (["-o", "-"], ["--json"], ["-o", "-", "--json", "--quiet"]):
            run = self.run_cli("render", "gallery:unit-light", "--method", "exact", *arguments)
            self.assertEqual(json.loads(run.stdout)["scene"], "unit-light")
            self.assertEqual("plan" in run.stderr, "--quiet" not in arguments)

    def test_scene_from_standard_input_and_same_result_as_gallery(self):
        scene = self.run_cli("scenes", "blocker").stdout
        mine = self.run_cli("render", "-", "--method", "exact", "-o", "-", input=scene)
        theirs = self.run_cli("render", "gallery:blocker", "--method", "exact", "-o", "-")
        self.assertEqual(json.loads(mine.stdout)["probes"], json.loads(theirs.stdout)["probes"])

    def test_path_tracing_agrees_with_exact(self):
        direct = ["gallery:penumbra", "--max-bounces", "0"]
        self.run_cli("render", *direct, "--method", "exact", "-o", "exact.json")
        run = self.run_cli("render", *direct, "--method", "path-tracing", "--samples", "256", "-o", "paths.json")
        self.assertIn("largest relative standard error", run.stdout)
        self.run_cli("compare", "paths.json", "exact.json")
        self.run_cli("compare", "paths.json", "exact.json", "--tolerance", "1e-9", status=10)
        self.run_cli("render", "gallery:unit-light", "--method", "exact", "-o", "other.json")
        self.assertIn("cannot be compared", self.run_cli("compare", "other.json", "paths.json", status=2).stderr)

    def test_any_number_of_threads_gives_the_same_bits(self):
        results = []
        for threads in (1, 2, 7):
            run = self.run_cli("render", "gallery:cornell", "--samples", "32", "--threads", str(threads), "-o", "-")
            result = json.loads(run.stdout)
            self.assertEqual(result["plan"]["settings"]["threads"], threads)
            results.append(result["probes"])
        self.assertEqual(results[0], results[1])
        self.assertEqual(results[0], results[2])

    def test_progress_on_a_terminal_is_one_line_that_fits(self):
        main, side = pty.openpty()
        command = [FLATLIGHT, "render", "gallery:furnace", "--time-limit", "1"]
        with subprocess.Popen(command, stdout=side, stderr=side, env=self.environment, cwd=self.folder) as process:
            os.close(side)
            shown = b""
            while True:
                try:
                    piece = os.read(main, 65536)
                except OSError:  # EIO: the other side is closed.
                    break
                if not piece:
                    break
                shown += piece
        os.close(main)
        self.assertEqual(process.returncode, 0)
        draws = shown.decode().split("\r\x1b[K")
        self.assertGreater(len(draws), 3)
        self.assertRegex(draws[-2], r"^furnace \[#*-*\] +\d+ %  error .* rays/s")
        self.assertLess(max(len(draw) for draw in draws[1:-1]), 80)
        self.assertIn("time limit reached", draws[-1])

    # --- bad input

    def test_every_mistake_of_a_scene_is_printed_with_its_path(self):
        scene = json.loads(self.run_cli("scenes", "penumbra").stdout)
        scene["plane"]["curves"][0]["material"] = "unknown"
        scene["plane"]["materials"][0]["lambertian"]["reflectance"] = [1.5]
        name = self.write("bad.json", json.dumps(scene))
        for command in ("render", "validate", "explain"):
            run = self.run_cli(command, name, status=2)
            self.assertRegex(run.stderr, r"bad\.json: plane\.curves\[0\]\.material: ")
            self.assertRegex(run.stderr, r"bad\.json: plane\.materials\[0\]\.lambertian\.reflectance\[0\]: ")
        report = json.loads(self.run_cli("validate", name, "--json", status=2).stdout)
        self.assertEqual(len(report["diagnostics"]), 2)

    def test_scene_files_that_are_none(self):
        self.write("empty.json", "")
        self.write("rubbish.json", "\x00\x01{{{")
        for name in ("missing.json", "empty.json", "rubbish.json", ".", "gallery:", "gallery:nothing"):
            self.assertIn("flatlight: ", self.run_cli("render", name, status=2).stderr)

    def test_a_file_of_two_gigabytes_is_refused_by_its_size(self):
        with open(self.path("huge.json"), "wb") as file:
            file.truncate(2 << 30)
        self.assertRegex(self.run_cli("render", "huge.json", status=2).stderr, r"huge.json has 2 GiB; allowed .* \d+ MiB")

    def test_bad_settings(self):
        for arguments in (["--samples", "0"], ["--samples", "-1"], ["--samples", "1e9"], ["--seed", "4294967296"],
                          ["--target-error", "0"], ["--target-error", "nan"], ["--time-limit", "inf"],
                          ["--method", "magic"], ["--derivatives", "third"], ["--threads", "0"], ["--max-bounces", ""]):
            run = self.run_cli("render", "gallery:penumbra", *arguments, status=2)
            self.assertRegex(run.stderr, rf"^flatlight: {arguments[0]}: '{re.escape(arguments[1])}'; must be ")
        run = self.run_cli("render", "gallery:penumbra", "--no-skip", "lunch", status=2)
        self.assertRegex(run.stderr, r"^flatlight: --no-skip")
        self.assertEqual(run.stdout, "")

    # --- outputs that cannot be

    def test_outputs_are_checked_before_the_work(self):
        os.mkdir(self.path("folder.json"))
        os.symlink("/dev/full", self.path("full.json"))
        for name in ("no/such/folder/r.json", "folder.json", "full.json"):
            run = self.run_cli("render", *ENDLESS, "-o", name, status=5)
            self.assertIn(name, run.stderr)
        for name in ("r.txt", "r"):
            self.assertIn(name, self.run_cli("render", *ENDLESS, "-o", name, status=2).stderr)
        self.assertTrue(os.path.exists("/dev/full"))

    def test_nothing_is_half_written_when_there_is_no_room(self):
        self.write("r.json", "old")
        room = lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (500, 500))
        for name in ("r.json", "r.csv", "r.npy", "r.hdr", "r.exr", "r.png"):
            run = self.run_cli("render", "gallery:penumbra", "--method", "exact", "--max-bounces", "0", "-o", name,
                               status=5, preexec_fn=room)
            self.assertIn(name + " could not be written", run.stderr)
            self.assert_no_leftovers()
        with open(self.path("r.json")) as file:
            self.assertEqual(file.read(), "old")
        self.assertFalse(os.path.exists(self.path("r.csv")))

    def test_standard_output_that_is_full(self):
        render = ["render", "gallery:unit-light", "--method", "exact"]
        for arguments in (["scenes"], render, [*render, "-o", "-"]):
            with open("/dev/full", "w") as full:
                run = subprocess.run([FLATLIGHT, *arguments], stdout=full, stderr=subprocess.PIPE, text=True, timeout=90,
                                     env=self.environment)
            self.assertEqual(run.returncode, 5, run.stderr)
            self.assertIn("standard output could not be written: No space left", run.stderr)

    def test_standard_input_that_is_closed(self):
        for command in ("validate", "render"):
            run = self.run_cli(command, "-", status=2, preexec_fn=lambda: os.close(0))
            self.assertEqual(run.stderr, "flatlight: standard input is empty\n")

    def test_standard_output_that_is_closed(self):
        for arguments in (["scenes"], ["render", "gallery:unit-light", "--method", "exact"]):
            run = self.run_cli(*arguments, status=5, preexec_fn=lambda: os.close(1))
            self.assertEqual(run.stderr, "flatlight: standard output could not be written: Bad file descriptor\n")

    def test_a_reader_that_goes_away_ends_the_job(self):
        with Daemon(FLATLIGHTD) as daemon:
            self.environment["FLATLIGHT_SERVER"] = daemon.address
            process = self.start("render", *ENDLESS)
            job = re.search(r"jobs/\S+", self.read_until(process.stdout, "job  ")).group()
            process.stdout.close()
            self.assertEqual(process.wait(timeout=30), 5)
            self.assertEqual(process.stderr.read(), "flatlight: standard output could not be written: Broken pipe\n")
            self.assertEqual(json.loads(self.run_cli("show", job, "--json").stdout)["state"], "CANCELLED")

    # --- servers

    def test_commands_about_jobs_need_a_server(self):
        for arguments in (["submit", "gallery:penumbra"], ["jobs"], ["watch", "a"], ["show", "a"], ["fetch", "a"],
                          ["cancel", "a"]):
            self.assertIn("--server", self.run_cli(*arguments, status=2).stderr)

    def test_a_server_that_is_not_there(self):
        with socket.socket() as taken:  # Bound, but not listening: the port refuses connections.
            taken.bind(("127.0.0.1", 0))
            address = "127.0.0.1:%d" % taken.getsockname()[1]
            run = self.run_cli("scenes", "--server", address, status=3)
        self.assertIn(address, run.stderr)
        self.run_cli("jobs", status=3, env={**self.environment, "FLATLIGHT_SERVER": "unix:" + self.path("none")})
        for bad in ("nonsense", "host:", "host:0", "host:99999", "unix:", "::1:7000"):
            self.assertIn(bad, self.run_cli("jobs", "--server", bad, status=2).stderr)

    def test_tokens(self):
        with Daemon(FLATLIGHTD, token="secret") as daemon:
            server = {**self.environment, "FLATLIGHT_SERVER": daemon.address}
            self.run_cli("jobs", status=4, env=server)
            self.run_cli("jobs", status=4, env={**server, "FLATLIGHT_TOKEN": "wrong"})
            self.run_cli("jobs", env={**server, "FLATLIGHT_TOKEN": "secret"})
            self.write("token", "secret\n")
            self.run_cli("jobs", "--token-file", "token", env={**server, "FLATLIGHT_TOKEN": "wrong"})
            self.write("empty", "\n")
            self.assertIn("empty is empty", self.run_cli("jobs", "--token-file", "empty", status=2, env=server).stderr)
            self.assertIn("cannot read none", self.run_cli("jobs", "--token-file", "none", status=2, env=server).stderr)

    def test_a_job_in_steps(self):
        with Daemon(FLATLIGHTD) as daemon:
            self.environment["FLATLIGHT_SERVER"] = daemon.address
            name = self.run_cli("submit", "gallery:furnace", "--samples", "64", "--quiet").stdout.strip()
            self.assertRegex(name, r"^jobs/[0-9a-f-]{36}$")
            uuid = name.split("/")[1]
            self.assertIn("succeeded", self.run_cli("watch", uuid[:6]).stdout)
            self.assertEqual(json.loads(self.run_cli("show", name, "--json").stdout)["state"], "SUCCEEDED")
            self.assertIn("furnace", self.run_cli("show", uuid).stdout)
            self.assertIn(uuid, self.run_cli("jobs").stdout)
            self.assertEqual(json.loads(self.run_cli("jobs", "--json").stdout)["jobs"][0]["name"], name)
            self.run_cli("fetch", uuid, "-o", "a.json")
            self.run_cli("render", "gallery:furnace", "--samples", "64", "-o", "b.json")
            self.run_cli("compare", "a.json", "b.json", "--tolerance", "0")
            self.run_cli("fetch", name, "-o", "no/a.json", status=5)
            for bad in ("", "xyz", "jobs/", uuid[:-1] + "g", "00000000-0000-4000-8000-000000000000"):
                self.run_cli("show", bad, status=2)

    def test_cancel(self):
        with Daemon(FLATLIGHTD) as daemon:
            self.environment["FLATLIGHT_SERVER"] = daemon.address
            name = self.run_cli("submit", *ENDLESS, "--quiet").stdout.strip()
            self.run_cli("fetch", name, "-o", "-", status=2)  # Not yet.
            self.assertIn("cancelled", self.run_cli("cancel", name).stdout)
            self.assertIn("cancelled", self.run_cli("watch", name, status=1).stderr)

    def test_pause_and_resume(self):
        with Daemon(FLATLIGHTD) as daemon:
            self.environment["FLATLIGHT_SERVER"] = daemon.address
            name = self.run_cli("submit", *ENDLESS, "--class", "regrade", "--quiet").stdout.strip()
            self.assertIn("paused", self.run_cli("pause", name).stdout)
            shown = json.loads(self.run_cli("show", name, "--json").stdout)
            self.assertEqual((shown["state"], shown["jobClass"]), ("PAUSED", "REGRADE"))
            self.assertIn("paused", self.run_cli("jobs").stdout)
            self.assertIn("running", self.run_cli("resume", name).stdout)
            self.run_cli("cancel", name)
            self.assertIn("cannot be paused", self.run_cli("pause", name, status=2).stderr)
            self.assertIn("regrade", self.run_cli("submit", *ENDLESS, "--class", "urgent", status=2).stderr)

    # --- signals

    def start(self, *arguments, hang_up=signal.SIG_DFL, **options):
        process = subprocess.Popen([FLATLIGHT, *arguments], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                                   env=self.environment, cwd=self.folder,
                                   preexec_fn=lambda: signal.signal(signal.SIGHUP, hang_up), **options)
        self.addCleanup(process.stdout.close)
        self.addCleanup(process.stderr.close)
        self.addCleanup(process.kill)
        return process

    def read_until(self, stream, text):
        for line in stream:
            if text in line:
                return line
        self.fail("the output ended without: " + text)

    def test_ctrl_c_cancels_the_job(self):
        with Daemon(FLATLIGHTD) as daemon:
            self.environment["FLATLIGHT_SERVER"] = daemon.address
            for sent in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
                process = self.start("render", *ENDLESS, "-o", "r.json")
                job = re.search(r"jobs/\S+", self.read_until(process.stdout, "job  ")).group()
                self.read_until(process.stdout, " %")
                process.send_signal(sent)
                self.assertEqual(process.wait(timeout=30), 130)
                self.assertIn(job + " is cancelled", process.stderr.read())
                self.assertEqual(json.loads(self.run_cli("show", job, "--json").stdout)["state"], "CANCELLED")
        self.assertFalse(os.path.exists(self.path("r.json")))
        self.assert_no_leftovers()

    def test_a_killed_command_takes_its_job_along_if_it_said_so(self):
        with Daemon(FLATLIGHTD) as daemon:
            self.environment["FLATLIGHT_SERVER"] = daemon.address
            process = self.start("render", *ENDLESS, "--cancel-on-disconnect")
            job = re.search(r"jobs/\S+", self.read_until(process.stdout, "job  ")).group()
            self.read_until(process.stdout, " %")
            process.kill()
            self.run_cli("watch", job, status=1)
            process = self.start("render", *ENDLESS)
            job = re.search(r"jobs/\S+", self.read_until(process.stdout, "job  ")).group()
            self.read_until(process.stdout, " %")
            process.kill()
            process.wait(timeout=30)
            self.assertEqual(json.loads(self.run_cli("show", job, "--json").stdout)["state"], "RUNNING")
            process = self.start("watch", job, "--cancel-on-disconnect")
            self.read_until(process.stdout, " %")
            process.send_signal(signal.SIGINT)
            self.assertIn(job + " is cancelled", process.stderr.read())
            self.run_cli("watch", job, status=1)

    def test_ctrl_c_ends_a_private_server(self):
        for sent in (signal.SIGINT, signal.SIGHUP):
            process = self.start("render", *ENDLESS)
            self.read_until(process.stdout, " %")
            server = self.private_server(process.pid)
            process.send_signal(sent)
            self.assertEqual(process.wait(timeout=30), 130)
            self.assertFalse(os.path.exists(f"/proc/{server}"))
            self.assertEqual(os.listdir(self.temporary), [])

    def test_nohup(self):
        process = self.start("render", *ENDLESS, hang_up=signal.SIG_IGN)
        self.read_until(process.stdout, " %")
        process.send_signal(signal.SIGHUP)
        self.read_until(process.stdout, " %")
        process.send_signal(signal.SIGINT)
        self.assertEqual(process.wait(timeout=30), 130)

    def test_ctrl_c_ends_the_wait_for_input(self):
        os.mkfifo(self.path("fifo"))
        result = self.run_cli("render", "gallery:unit-light", "--method", "exact", "-o", "-").stdout
        self.write("r.json", result)
        for arguments in (["render", "-"], ["validate", "fifo"], ["compare", "-", "r.json"]):
            process = self.start(*arguments, stdin=subprocess.PIPE)
            self.addCleanup(process.stdin.close)
            with open(f"/proc/{process.pid}/status") as status:  # A signal before it is caught would end it otherwise.
                while not self.blocks(status, signal.SIGINT):
                    os.sched_yield()
            process.send_signal(signal.SIGINT)
            self.assertEqual(process.wait(timeout=30), 130, arguments)
            self.assertEqual(process.stderr.read(), "flatlight: interrupted\n")
            self.assertEqual(os.listdir(self.temporary), [])

    def blocks(self, status, number):
        status.seek(0)
        return int(re.search(r"SigBlk:\s*(\w+)", status.read()).group(1), 16) >> (number - 1) & 1

    def private_server(self, pid):
        with open(f"/proc/{pid}/task/{pid}/children") as children:
            return int(children.read().split()[0])

    def test_a_private_server_ends_when_its_client_is_killed(self):
        process = self.start("render", *ENDLESS)
        self.read_until(process.stdout, " %")
        server = os.pidfd_open(self.private_server(process.pid))
        process.kill()
        process.wait()
        # A pidfd can be read from when its process has ended.
        ended, _, _ = select.select([server], [], [], 30)
        os.close(server)
        self.assertTrue(ended)

    def test_a_private_server_that_dies_is_reported(self):
        process = self.start("render", *ENDLESS)
        self.read_until(process.stdout, " %")
        os.kill(self.private_server(process.pid), signal.SIGKILL)
        self.assertEqual(process.wait(timeout=60), 3)
        self.assertIn("the private server ended by itself, with signal Killed", process.stderr.read())
        self.assertEqual(os.listdir(self.temporary), [])

    def test_ctrl_c_leaves_a_watched_job_alone(self):
        with Daemon(FLATLIGHTD) as daemon:
            self.environment["FLATLIGHT_SERVER"] = daemon.address
            name = self.run_cli("submit", *ENDLESS, "--quiet").stdout.strip()
            process = self.start("watch", name)
            self.read_until(process.stdout, "%")
            process.send_signal(signal.SIGINT)
            self.assertEqual(process.wait(timeout=30), 130)
            self.assertIn("the job goes on", process.stderr.read())
            self.assertEqual(json.loads(self.run_cli("show", name, "--json").stdout)["state"], "RUNNING")
            self.run_cli("cancel", name)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
