# SPDX-License-Identifier: Apache-2.0
"""The server tells a URL of a job's end. Run with FLATLIGHT FLATLIGHTD."""
import base64
import csv
import hashlib
import hmac
import io
import json
import os
import re
import signal
import subprocess
import sys
import time
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
from cli_case import FLATLIGHT, FLATLIGHTD, CliCase  # noqa: E402
from daemon import Daemon  # noqa: E402
from webhook_receiver import Receiver  # noqa: E402

ENDLESS = ("gallery:cornell", "--samples", "1000000000", "--quiet")
SHORT = ("gallery:unit-light", "--quiet")


class WebhookTest(CliCase):
    def serve(self, *allowed, more=(), listen="127.0.0.1:0", environment=None):
        arguments = [argument for host in allowed for argument in ("--webhook-allow", host)]
        daemon = Daemon(FLATLIGHTD, listen=listen, arguments=(*arguments, "--data", self.path("data"), *more),
                        environment=environment)
        daemon.__enter__()
        self.addCleanup(daemon.__exit__)
        self.environment["FLATLIGHT_SERVER"] = daemon.address
        return daemon

    def submit(self, url, what=SHORT, **options):
        return self.run_cli("submit", *what, "--webhook", url, **options).stdout.strip()

    def webhook(self, job):
        return json.loads(self.run_cli("show", job, "--json").stdout)["webhook"]

    def await_state(self, job, state, attempts=None, seconds=60):
        end = time.monotonic() + seconds
        while (now := self.webhook(job)).get("state") != state or attempts not in (None, now.get("attempts", 0)):
            self.assertLess(time.monotonic(), end, now)
            time.sleep(0.05)
        return now

    def verify(self, post, secret):
        """As a receiver does it, by the specification."""
        path, headers, body = post
        signed = f"{headers['webhook-id']}.{headers['webhook-timestamp']}.".encode() + body
        digest = hmac.new(base64.b64decode(secret.removeprefix("whsec_")), signed, hashlib.sha256).digest()
        return "v1," + base64.b64encode(digest).decode() in headers["webhook-signature"].split(" ")

    def log(self):
        with open(self.path("calls.jsonl")) as file:
            return [line for line in map(json.loads, file) if "webhook" in line]

    def test_the_end_of_a_job_is_told_and_signed(self):
        with Receiver() as receiver:
            daemon = self.serve(receiver.host, more=("--log", self.path("calls.jsonl")))
            job = self.submit(receiver.url)
            post, = receiver.await_posts(1)
            path, headers, body = post
            self.assertEqual(path, "/hook?token=hidden")
            self.assertEqual(headers["content-type"], "application/json")
            event = json.loads(body)
            self.assertEqual(event["id"], headers["webhook-id"])
            self.assertEqual((event["type"], event["data"]["job"], event["data"]["state"]), ("job.succeeded", job, "SUCCEEDED"))
            self.assertEqual(event["data"]["links"], {"GetJob": {"name": job}, "GetResult": {"name": job}})
            self.assertEqual(event["data"]["owner"], "anonymous")
            self.assertIn("flatlightd/" + event["data"]["build"], headers["user-agent"])
            self.assertLess(abs(int(headers["webhook-timestamp"]) - time.time()), 600)
            secret = self.run_cli("webhook-secret").stdout.strip()
            self.assertEqual(len(base64.b64decode(secret.removeprefix("whsec_"))), 32)
            self.assertTrue(self.verify(post, secret))
            self.assertFalse(self.verify((path, headers, body + b" "), secret))
            told = self.await_state(job, "DELIVERED")
            self.assertEqual((told["url"], told["attempts"]), (receiver.url, 1))
            self.assertIn("delivered", self.run_cli("show", job).stdout)

            cancelled = self.submit(receiver.url, ENDLESS)
            self.assertEqual(self.webhook(cancelled)["state"], "WAITING")
            self.run_cli("cancel", cancelled)
            self.assertEqual(json.loads(receiver.await_posts(2)[1][2])["type"], "job.cancelled")
            self.await_state(cancelled, "DELIVERED")
            line, other = self.log()
            self.assertEqual([line[key] for key in ("webhook", "resource", "host", "attempt")],
                             ["delivered", job, "127.0.0.1", 1])
            for name in ("calls.jsonl", "data/audit.jsonl"):
                with open(self.path(name)) as file:
                    text = file.read()
                self.assertNotIn("hidden", text)
                self.assertIn(f'"resource":"{cancelled}","host"', text)
        # The same secret for as long as the folder is there.
        daemon.__exit__()
        self.serve()
        self.assertEqual(self.run_cli("webhook-secret").stdout.strip(), secret)

    def test_a_secret_is_rotated(self):
        with Receiver() as receiver:
            daemon = self.serve(receiver.host)
            first = self.run_cli("webhook-secret").stdout.strip()
            run = self.run_cli("webhook-secret", "--rotate", "--keep-earlier", "12h")
            second = run.stdout.strip()
            self.assertNotEqual(second, first)
            self.assertRegex(run.stderr, rf"signed with {re.escape(first[:12])}\.\.\. too, until \d{{4}}-")
            self.assertNotIn(first, run.stderr)
            self.await_state(self.submit(receiver.url), "DELIVERED")
            post = receiver.posts[0]
            self.assertEqual(len(post[1]["webhook-signature"].split(" ")), 2)
            self.assertTrue(self.verify(post, first) and self.verify(post, second))
            with open(self.path("data/audit.jsonl")) as file:
                text = file.read()
            self.assertIn('"ServerService/RotateWebhookSecret"', text)
            self.assertNotIn("whsec", text)
            # The earlier ones are kept over a restart too, and are over at once where somebody else knows them.
            daemon.__exit__()
            self.serve(receiver.host)
            self.assertEqual(self.run_cli("webhook-secret").stdout.strip(), second)
            third = self.run_cli("webhook-secret", "--rotate", "--keep-earlier", "0").stdout.strip()
            self.await_state(self.submit(receiver.url), "DELIVERED")
            post = receiver.posts[1]
            self.assertTrue(self.verify(post, third))
            self.assertFalse(self.verify(post, first) or self.verify(post, second))
            self.assertIn("allowed: 0 to 2592000",
                          self.run_cli("webhook-secret", "--rotate", "--keep-earlier", "31d", status=2).stderr)

    def test_without_a_folder_too(self):
        with Receiver() as receiver, Daemon(FLATLIGHTD, arguments=("--webhook-allow", receiver.host)) as daemon:
            self.environment["FLATLIGHT_SERVER"] = daemon.address
            job = self.submit(receiver.url)
            receiver.await_posts(1)
            self.await_state(job, "DELIVERED")
            # What ends with the server is told before it has ended.
            last = self.submit(receiver.url, ENDLESS)
            daemon.process.send_signal(signal.SIGTERM)
            self.assertEqual(daemon.process.wait(timeout=60), 0)
            self.assertEqual(json.loads(receiver.await_posts(2)[1][2])["data"]["job"], last)

    def test_what_was_not_taken_is_sent_again(self):
        with Receiver(500) as receiver:
            self.serve(receiver.host, more=("--log", self.path("calls.jsonl")))
            job = self.submit(receiver.url)
            failed = self.await_state(job, "SENDING", attempts=1)
            self.assertEqual(failed["error"], "answered with status 500")
            self.assertIn("nextAttemptTime", failed)
            first, second = receiver.await_posts(2)
            self.assertEqual((first[1]["webhook-id"], first[2]), (second[1]["webhook-id"], second[2]))
            secret = self.run_cli("webhook-secret").stdout.strip()
            self.assertTrue(self.verify(first, secret) and self.verify(second, secret))
            self.assertNotIn("error", self.await_state(job, "DELIVERED", attempts=2))
            self.assertEqual([line["webhook"] for line in self.log()], ["failed", "delivered"])
            with open(self.path("data/audit.jsonl")) as file:
                self.assertEqual(sum("webhook" in json.loads(line) for line in file), 1)

    def test_who_is_gone_is_not_asked_again(self):
        with Receiver(410) as receiver:
            self.serve(receiver.host)
            given_up = self.await_state(self.submit(receiver.url), "GIVEN_UP")
            self.assertEqual((given_up["attempts"], given_up["error"]), (1, "answered with status 410"))

    def test_nobody_is_told_unless_allowed(self):
        with Receiver() as receiver:
            self.serve()
            self.assertIn("started without --webhook-allow", self.run_cli("submit", *SHORT, "--webhook", receiver.url,
                                                                          status=None).stderr)
            self.assertEqual(self.run_cli("jobs").stdout, "no jobs\n")
        bad = subprocess.run([FLATLIGHTD, "--webhook-allow", "http://x/"], capture_output=True, text=True, timeout=60)
        self.assertEqual(bad.returncode, 2)
        self.assertIn("must be HOST or HOST:PORT", bad.stderr)

    def test_a_name_does_not_lead_inside(self):
        with Receiver() as receiver:
            port = receiver.host.rsplit(":", 1)[1]
            self.serve(f"localhost:{port}", "127.0.0.1:1")
            for url in (receiver.url, f"http://[::1]:{port}/", "http://localhost/", "file:///etc/passwd",
                        f"http://localhost:{port}@127.0.0.1:{port}/"):
                self.assertIn("webhook: ", self.run_cli("submit", *SHORT, "--webhook", url, status=2).stderr)
            given_up = self.await_state(self.submit(f"http://localhost:{port}/"), "GIVEN_UP")
            self.assertRegex(given_up["error"], r"stands for (127\.0\.0\.1|::1), which is no public address")
            self.assertEqual(receiver.posts, [])

    def test_a_name_that_is_allowed_with_its_address(self):
        with Receiver() as receiver:
            port = receiver.host.rsplit(":", 1)[1]
            # A proxy of the environment would connect to what was not checked.
            self.serve(f"localhost:{port}", receiver.host, environment={"http_proxy": "http://127.0.0.1:1/"})
            self.await_state(self.submit(f"http://localhost:{port}/"), "DELIVERED")
            self.assertEqual(len(receiver.posts), 1)

    def test_redirects_are_not_followed(self):
        with Receiver() as elsewhere, Receiver(302, headers=[("location", elsewhere.url)]) as receiver:
            self.serve(receiver.host, elsewhere.host)
            failed = self.await_state(self.submit(receiver.url), "SENDING", attempts=1)
            self.assertIn("redirects are not followed", failed["error"])
            self.assertEqual(elsewhere.posts, [])

    def test_what_was_allowed_before_a_restart_is_not_now(self):
        with Receiver(500) as receiver:
            daemon = self.serve(receiver.host)
            job = self.submit(receiver.url)
            self.await_state(job, "SENDING", attempts=1)
            daemon.__exit__()
            self.serve("example.org")
            self.assertIn("sends nothing to 127.0.0.1", self.await_state(job, "GIVEN_UP")["error"])
            self.assertEqual(len(receiver.posts), 1)

    def test_killed_between_end_and_delivery(self):
        with Receiver(9) as receiver:
            daemon = self.serve(receiver.host)
            job = self.submit(receiver.url)
            waiting = self.submit(receiver.url, ENDLESS)
            receiver.await_posts(1)  # It has come, and has no answer.
            os.kill(daemon.process.pid, signal.SIGKILL)
            daemon.process.wait(timeout=60)
            self.serve(receiver.host)
            first, second = receiver.await_posts(2)
            self.assertEqual((first[1]["webhook-id"], first[2]), (second[1]["webhook-id"], second[2]))
            self.await_state(job, "DELIVERED")
            # Of a job that goes on, the webhook waits on, and comes when it ends.
            self.assertEqual(self.webhook(waiting)["state"], "WAITING")
            self.run_cli("cancel", waiting)
            self.assertEqual(json.loads(receiver.await_posts(3)[2][2])["data"]["job"], waiting)

    def test_who_is_slow_holds_up_nobody(self):
        with Receiver(*[60] * 10) as slow, Receiver() as quick:
            self.serve(slow.host, quick.host)
            tokens = {}
            for name in ("ada", "bob"):
                added = subprocess.run([FLATLIGHTD, "user", "add", name, "--data", self.path("data")], capture_output=True,
                                       text=True, timeout=60, check=True).stdout
                tokens[name] = next(csv.DictReader(io.StringIO(added)))["token"]
            self.environment["FLATLIGHT_TOKEN"] = tokens["ada"]
            hung = [self.submit(slow.url) for _ in range(5)]
            slow.await_posts(2)
            self.environment["FLATLIGHT_TOKEN"] = tokens["bob"]
            self.await_state(self.submit(quick.url), "DELIVERED")
            self.run_cli("render", "gallery:unit-light", "--quiet", "-o", self.path("out.json"))
            self.assertEqual(slow.most_at_once, 2, "no more at once of one user")
            # Nobody signs for another one.
            secret = self.run_cli("webhook-secret").stdout.strip()
            self.assertTrue(self.verify(quick.posts[0], secret))
            self.assertFalse(self.verify(slow.posts[0], secret))
            # Nor sees whom it tells.
            self.environment["FLATLIGHT_TOKEN"] = tokens["ada"]
            self.run_cli("share", hung[0], "--with", "user:bob", "--control")
            self.environment["FLATLIGHT_TOKEN"] = tokens["bob"]
            self.assertNotIn("webhook", json.loads(self.run_cli("show", hung[0], "--json").stdout))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=1)
