# SPDX-License-Identifier: Apache-2.0
"""The package against a real server: jobs, results as arrays, errors."""
import json
import os
import subprocess
import uuid
from unittest import mock

import flatlight
import numpy as np
from python_case import ENDLESS, FLATLIGHT, PythonCase, main

LAMP = {
    "name": "lamp",
    "plane": {
        "materials": [{"name": "black", "lambertian": {"reflectance": [0]}}],
        "curves": [{"name": "floor", "segment": {"a": {"x": -2, "y": 0}, "b": {"x": 2, "y": 0}}, "material": "black"},
                   {"name": "lamp", "segment": {"a": {"x": 0.5, "y": 2}, "b": {"x": -0.5, "y": 2}}, "material": "black",
                    "emission": {"radiance": [5]}}]},
    "probes": [{"name": "floor", "curve": "floor", "count": 64}]}


def sine(x):
    """Of the angle at which the floor sees a point 2 above it, x to the side."""
    return x / np.hypot(x, 2)


class ClientTest(PythonCase):
    def test_values_and_derivatives_are_those_of_the_closed_form(self):
        client = self.connect(self.serve().address)
        floor = client.render(LAMP, method="exact", progress=None)["floor"]
        x = floor.positions[:, 0]
        left, right = x + 0.5, x - 0.5  # E = L (sin - sin), Lambert's law in the plane.
        np.testing.assert_allclose(floor.irradiance, 5 * (sine(left) - sine(right)), rtol=1e-13)
        slope = 5 * (4 / (left**2 + 4) ** 1.5 - 4 / (right**2 + 4) ** 1.5)
        np.testing.assert_allclose(floor.gradient, slope, atol=1e-13)
        bend = 5 * (-12 * left / (left**2 + 4) ** 2.5 + 12 * right / (right**2 + 4) ** 2.5)
        np.testing.assert_allclose(floor.hessian, bend, atol=1e-12)
        np.testing.assert_allclose(floor.arc_length, x + 2, atol=1e-15)
        self.assertIsNone(floor.standard_error)
        self.assertTrue(floor.known.all())
        self.assertEqual(floor.normals.shape, (64, 2))

    def test_equal_work_is_done_again_only_on_wish(self):
        client = self.connect(self.serve().address)
        jobs = [client.submit(LAMP, method="path-tracing", samples=16, anew=anew).wait(progress=None).refresh()
                for anew in (False, False, True)]
        self.assertEqual([job.message.shared_work for job in jobs], [False, True, False])
        one, _, other = [job.result()["floor"] for job in jobs]
        np.testing.assert_array_equal(one.irradiance, other.irradiance)

    def test_colours_pictures_and_errors_have_the_shapes_of_the_csv_file(self):
        client = self.connect(self.serve().address)
        picture = {"name": "plane", "fluence": {"width": 20, "height": 10}}
        result = client.render("gallery:lens", probes=[picture], samples=16, progress=None)
        plane = result["plane"]
        self.assertEqual((plane.irradiance.shape, plane.quantity), ((10, 20, 3), "FLUENCE"))
        self.assertEqual(plane.corners.shape, (2, 2))
        job = client.submit("gallery:cornell", method="path-tracing", samples=64)
        floor = job.wait(progress=None).result()[0]
        path = self.path("table.csv")
        subprocess.run([FLATLIGHT, "fetch", job.name, "--server", client.address, "-o", path], check=True, timeout=60)
        table = np.genfromtxt(path, delimiter=",", names=True)
        for channel, name in enumerate("RGB"):
            np.testing.assert_array_equal(floor.irradiance[:, channel], table[f"irradiance{name}"])
            np.testing.assert_array_equal(floor.error[:, channel], table[f"standardError{name}"])
        np.testing.assert_array_equal(floor.positions[:, 1], table["y"])

    def test_records_are_rows(self):
        client = self.connect(self.serve().address)
        job = client.submit("gallery:corner", method="irradiance-caching", tolerance=0.01)
        result = job.wait(progress=None).result()
        records, count = result.records, len(result.records)
        self.assertEqual(count, result.statistics.records)
        for field, shape in (("position", (count, 2)), ("radius", (count, 2)), ("irradiance", (count,)),
                             ("gradient", (count,)), ("hessian", (count,)), ("arc_length", (count,))):
            self.assertEqual(getattr(records, field).shape, shape)
        # At a record's own place the probe has the record's irradiance and slope.
        floor, seen = result[0], records.bounce == 0
        curve = records.curve[np.flatnonzero(seen)[0]]
        same = np.array([name == curve for name in records.curve]) & seen
        found = np.interp(records.arc_length[same], floor.arc_length, floor.irradiance)
        np.testing.assert_allclose(found, records.irradiance[same], rtol=0.02)
        self.assertEqual(len(client.render("gallery:unit-light", progress=None).records), 0)

    def test_files_are_those_of_the_command_line(self):
        client = self.connect(self.serve().address)
        result = client.render("gallery:unit-light", progress=None)
        result.save(self.path("saved.json"))
        loaded = flatlight.load(self.path("saved.json"))
        np.testing.assert_array_equal(loaded[0].hessian, result[0].hessian)
        scene = self.write("lamp.json", json.dumps(LAMP))
        run = subprocess.run([FLATLIGHT, "render", scene, "-o", self.path("cli.json")], capture_output=True, timeout=60)
        self.assertEqual(run.returncode, 0, run.stderr)
        from_file = client.render(scene, progress=None)
        np.testing.assert_array_equal(flatlight.load(self.path("cli.json"))[0].irradiance, from_file[0].irradiance)
        compared = subprocess.run([FLATLIGHT, "compare", self.path("saved.json"), self.path("saved.json")], timeout=60)
        self.assertEqual(compared.returncode, 0)
        with self.assertRaisesRegex(flatlight.BadRequest, "lamp.json holds no probes|is not a result"):
            flatlight.load(self.write("lamp.json", "{}"))

    def test_large_scenes_go_up_in_pieces(self):
        client = self.connect(self.serve().address)
        curves = [{"name": f"speck {i}", "segment": {"a": {"x": i, "y": 5}, "b": {"x": i + 0.5, "y": 5}},
                   "material": "black"} for i in range(8000)]
        scene = LAMP | {"plane": LAMP["plane"] | {"curves": LAMP["plane"]["curves"] + curves}}
        self.assertGreater(len(json.dumps(scene)), 3 * (256 << 10))
        self.assertEqual(client.validate(scene), [])

    def test_mistakes_come_all_with_their_paths(self):
        client = self.connect(self.serve().address)
        wrong = json.loads(json.dumps(LAMP).replace('"reflectance": [0]', '"reflectance": [2]'))
        wrong["probes"][0]["count"] = 0
        with self.assertRaises(flatlight.BadRequest) as caught:
            client.submit(wrong)
        paths = [path for path, _ in caught.exception.mistakes]
        self.assertEqual(paths, ["plane.materials[0].lambertian.reflectance[0]", "probes[0].count"])
        self.assertEqual(caught.exception.reason, "BAD_SCENE")
        self.assertEqual([path for path, _ in client.validate(wrong)], paths)
        for call, message in (
                (lambda: client.submit(LAMP, metod="exact"), "metod: is not a setting; did you mean method?"),
                (lambda: client.submit(LAMP, method="exct"), "method: is 'exct'; allowed: exact, path-tracing, .*did you mean exact"),
                (lambda: client.submit(LAMP, samples="x"), "samples: is 'x'"),
                (lambda: client.submit(LAMP, samples=0), "settings.samples: is 0"),
                (lambda: client.submit(LAMP, job_class="grade"), "allowed: interactive, graded, regrade"),
                (lambda: client.submit(self.path("none.json")), "none.json: No such file"),
                (lambda: client.submit("gallery:none"), "scenes/none does not exist"),
                (lambda: client.job("jobs/00000000-0000-4000-8000-000000000000"), "jobs/00000000"),
                (lambda: flatlight.Client("nowhere"), "'nowhere'; must be HOST:PORT or unix:PATH")):
            with self.assertRaisesRegex(flatlight.BadRequest, message):
                call()
        with self.assertRaisesRegex(flatlight.Unreachable, "cannot reach the server at 127.0.0.1:1: "):
            self.connect("127.0.0.1:1").capabilities()

    def test_settings_have_the_names_of_the_options_and_of_json(self):
        wanted = flatlight.settings(method="path-tracing", target_error=0.5, no_skip="colour")
        self.assertEqual(flatlight.settings(method="PATH_TRACING", targetError=0.5, **{"no-skip": ["colour"]}), wanted)
        self.assertEqual(flatlight.settings(method="path-tracing", target_error=0.5, no_skip="colour", seed=None), wanted)

    def test_no_proxy_stands_before_a_server_on_this_machine(self):
        address = self.serve().address
        with mock.patch.dict(os.environ, {"http_proxy": "http://127.0.0.1:1", "no_proxy": "", "no_grpc_proxy": ""}):
            self.connect(address).capabilities()
            self.connect(address.replace("127.0.0.1", "localhost")).capabilities()

    def test_a_token_is_asked_for(self):
        daemon = self.serve(token="secret of a test of the package")
        with self.assertRaises(flatlight.Denied):
            self.connect(daemon.address).capabilities()
        self.connect(daemon.address, token="secret of a test of the package").capabilities()

    def test_jobs_are_controlled(self):
        client = self.connect(self.serve().address)
        request_id = str(uuid.uuid4())
        job = client.submit(**ENDLESS, job_class="regrade", request_id=request_id)
        self.assertEqual(client.submit(**ENDLESS, job_class="regrade", request_id=request_id).name, job.name)
        self.assertEqual(job.pause().state, "PAUSED")
        self.assertEqual(client.job(job.name).state, "PAUSED")
        self.assertNotEqual(job.resume().state, "PAUSED")
        self.assertEqual(job.cancel().wait(progress=None).state, "CANCELLED")
        self.assertEqual([other.name for other in client.jobs()], [job.name])
        job.share("course").share("user:ada", control=True)
        again = client.job(job.name)
        self.assertEqual((again.owner, again.shares), ("anonymous", {"course": "READ", "user:ada": "CONTROL"}))
        self.assertEqual(again.unshare("course").shares, {"user:ada": "CONTROL"})
        with self.assertRaises(flatlight.BadRequest):
            again.unshare("course")
        self.assertEqual(list(client.jobs(shared=True)), [], "they are all the caller's own")
        self.assertEqual([each.name for each in client.jobs(own=True)], [each.name for each in client.jobs()])
        job.delete()
        self.assertEqual(list(client.jobs()), [])


if __name__ == "__main__":
    main()
