# SPDX-License-Identifier: Apache-2.0
"""Watching through all that happens to connections and servers."""
import flatlight
import numpy as np
from proxy import Proxy
from python_case import ENDLESS, PythonCase, main


class WatchTest(PythonCase):
    def assert_same(self, live, result):
        self.assertEqual([probe.name for probe in live], [probe.name for probe in result.probes])
        for one, other in zip(live, result.probes):
            for field in ("positions", "normals", "arc_length", "irradiance", "standard_error", "samples"):
                np.testing.assert_array_equal(getattr(one, field), getattr(other, field), field)

    def test_the_last_picture_is_the_result(self):
        client = self.connect(self.serve().address)
        job = client.submit("gallery:cornell", method="path-tracing", samples=512)
        snapshots = list(job.watch(max_rate=100))
        self.assertEqual([job.state, snapshots[-1].resumes], ["SUCCEEDED", 0])
        self.assert_same(snapshots[-1].probes, job.result())
        self.assertEqual(job.message.scene, "cornell")  # Of the first message alone.
        self.assertTrue(job.message.plan.summary)

    def test_pictures_grow_into_their_shape(self):
        client = self.connect(self.serve().address)
        job = client.submit("gallery:penumbra", probes=[{"name": "p", "fluence": {"width": 300, "height": 200}}], samples=2)
        for last in job.watch():
            for probe in last.probes:
                self.assertEqual(probe.irradiance.shape, (200, 300))
        np.testing.assert_array_equal(last.probes[0].irradiance, job.result()[0].irradiance)

    def test_a_connection_that_is_cut_after_every_message_loses_nothing(self):
        daemon = self.serve()
        with Proxy(daemon.address) as proxy:
            client = self.connect(proxy.address)
            job = client.submit(**ENDLESS)
            rays = []
            for last in job.watch(max_rate=50):
                rays.append(last.job.progress.rays)
                if last.resumes == 10:
                    self.connect(daemon.address).job(job.name).cancel()
                proxy.cut()
            self.assertEqual(job.state, "CANCELLED")
            self.assertEqual(rays, sorted(rays))
            self.assert_same(last.probes, self.connect(daemon.address).job(job.name).result())

    def test_a_connection_that_falls_silent_is_made_anew(self):
        with Proxy(self.serve().address) as proxy:
            client = self.connect(proxy.address)
            job = client.submit(**ENDLESS)
            others = client.render_service  # Another thread's call holds the old connection.
            for number, last in enumerate(job.watch(silence=0.5)):
                if number == 0:
                    proxy.silence()
                elif last.resumes:
                    break
            self.assertGreaterEqual(last.resumes, 1)
            self.assertIsNot(client.render_service, others)

    def test_leaving_cancels_only_on_wish(self):
        client = self.connect(self.serve().address)
        for cancel in (False, True):
            job = client.submit(**ENDLESS, anew=True)
            watch = job.watch(cancel_on_disconnect=cancel)
            next(watch)
            watch.close()
            if not cancel:
                self.assertEqual(job.refresh().state, "RUNNING")
                job.cancel()
            job.wait(progress=None)
            self.assertEqual(job.state, "CANCELLED")

    def test_a_restarted_server_goes_on_with_the_same_bits(self):
        data = self.path("data")
        settings = {"scene": "gallery:cornell", "method": "path-tracing", "samples": 2048}
        first = self.serve("--data", data, "--checkpoint-interval", "0")
        client = self.connect(first.address)
        job = client.submit(**settings)
        epochs = set()
        for last in job.watch(max_rate=100, patience=60):
            if last.probes and not epochs:
                first.process.kill()
                first.process.wait()
                self.serve("--data", data, listen=first.address)
                epochs.add(1)
        self.assertEqual(job.state, "SUCCEEDED")
        self.assertGreaterEqual(last.resumes, 1)
        self.assert_same(last.probes, job.result())
        whole = self.connect(self.serve().address).render(**settings, progress=None)
        self.assert_same(last.probes, whole)

    def test_a_server_that_stays_away_is_an_error(self):
        daemon = self.serve()
        job = self.connect(daemon.address).submit(**ENDLESS)
        with self.assertRaisesRegex(flatlight.Unreachable, "lost the server for more than 0.2 s: cannot reach"):
            for _ in job.watch(patience=0.2):
                daemon.process.kill()

    def test_a_server_that_forgot_the_job_says_so(self):
        first = self.serve()
        job = self.connect(first.address).submit(**ENDLESS)
        with self.assertRaisesRegex(flatlight.JobFailed, "no longer knows " + job.name):
            for snapshot in job.watch():
                if snapshot.resumes == 0 and first.process.poll() is None:
                    first.process.kill()
                    first.process.wait()
                    self.serve(listen=first.address)

    def test_leaving_leaves_the_job_alone(self):
        client = self.connect(self.serve().address)
        job = client.submit(**ENDLESS)
        for _ in job.watch():
            break
        self.assertIn(client.job(job.name).state, ("QUEUED", "RUNNING"))


if __name__ == "__main__":
    main()
