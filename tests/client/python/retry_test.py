# SPDX-License-Identifier: Apache-2.0
"""Calls that are made again: when, how often, and against servers that are too busy or away for a moment."""
import time
import unittest.mock

import flatlight
import grpc
from flatlight.retry import MOST_TRIES, Retry, is_repeatable
from flatlight.v1 import render_service_pb2, server_service_pb2
from python_case import ENDLESS, FLATLIGHTD, Daemon, PythonCase, main

BUSY, LOST = grpc.StatusCode.RESOURCE_EXHAUSTED, grpc.StatusCode.UNAVAILABLE
GET = render_service_pb2.GetJobRequest()
DELETE = render_service_pb2.DeleteJobRequest()


def error(code, reason="", retry_after=None):
    return flatlight.Error("refused", code, reason, retry_after=retry_after)


class RetryTest(PythonCase):
    def test_a_refusal_is_put_off_as_long_as_the_server_says_and_no_less(self):
        for request in (GET, DELETE):
            with self.assertLogs("flatlight") as logged:
                retry = Retry(request)
                self.assertAlmostEqual(retry.next(error(BUSY, "TOO_MANY_JOBS", 2), lambda: 0), 2.001)
                self.assertAlmostEqual(retry.next(error(BUSY, "TOO_MANY_JOBS", 2), lambda: 0.8), 2.401)
            self.assertEqual(len(logged.output), 1, "it is said once")
            self.assertIn("the server refuses for now (TOO_MANY_JOBS); trying again in 2 s", logged.output[0])

    def test_what_takes_long_or_is_final_is_not_made_again(self):
        for final in (error(BUSY, "STORAGE_USED_UP", 60), error(BUSY, "STORAGE_FULL"), error(LOST, "STORAGE_READ_ONLY"),
                      error(grpc.StatusCode.INVALID_ARGUMENT, "BAD_SCENE"), error(grpc.StatusCode.INTERNAL)):
            self.assertIsNone(Retry(GET).next(final))

    def test_without_an_answer_only_what_may_be_done_twice(self):
        self.assertIsNone(Retry(DELETE).next(error(LOST)))
        with self.assertLogs("flatlight"):
            retry = Retry(GET)
            waits = [retry.next(error(LOST), lambda: 0) for _ in range(MOST_TRIES)]
        self.assertEqual(waits, [0.125, 0.25, 0.5, 1, None])
        create = render_service_pb2.CreateJobRequest()
        self.assertFalse(is_repeatable(create))
        create.request_id = "5f0d8c5e-6a3a-4a57-9c6f-000000000001"
        self.assertTrue(is_repeatable(create))
        self.assertTrue(is_repeatable(server_service_pb2.GetCapabilitiesRequest()))

    def test_a_server_that_is_too_busy_is_asked_again(self):
        client = self.connect(self.serve("--quota", "admin.requests=1").address)
        with self.assertLogs("flatlight") as logged:
            for _ in range(12):  # Ten at once, and one a second.
                client.capabilities()
        self.assertIn("the server refuses for now (TOO_MANY_REQUESTS)", logged.output[0])

    def test_a_job_is_made_once_over_a_restart(self):
        address, data = "unix:" + self.path("socket"), self.path("data")
        client = self.connect(address)
        with Daemon(FLATLIGHTD, listen=address, arguments=("--data", data)):
            client.capabilities()
        started = []

        def start():
            started.append(self.serve("--data", data, listen=address))

        sleep = time.sleep
        # It comes up while the client waits.
        with unittest.mock.patch("time.sleep", side_effect=lambda wait: (started or start(), sleep(wait))):
            with self.assertLogs("flatlight") as logged:
                job = client.submit(**ENDLESS)
        self.assertIn("no answer from the server", logged.output[0])
        self.assertEqual([each.name for each in client.jobs()], [job.name])

    def test_who_waits_for_something_else_says_so(self):
        client = self.connect(self.serve("--quota", "admin.jobs=1").address)
        client.submit(**ENDLESS)
        with unittest.mock.patch("time.sleep") as slept, self.assertRaises(flatlight.Denied):
            client.submit(**ENDLESS, final=("TOO_MANY_JOBS",))
        slept.assert_not_called()


if __name__ == "__main__":
    main()
