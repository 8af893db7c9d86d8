# SPDX-License-Identifier: Apache-2.0
"""A server that knows its users, as its keeper and a class use it. Run with FLATLIGHT FLATLIGHTD."""
import csv
import io
import json
import os
import subprocess
import sys
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
from cli_case import FLATLIGHT, FLATLIGHTD, CliCase  # noqa: E402
from daemon import Daemon  # noqa: E402


class UsersTest(CliCase):
    def user(self, *arguments, status=0):
        run = subprocess.run([FLATLIGHTD, "user", *arguments, "--data", self.path("data")], capture_output=True, text=True,
                             timeout=60, cwd=self.folder)
        self.assertEqual(run.returncode, status, f"{arguments}\n{run.stdout}\n{run.stderr}")
        return run

    def tokens(self, *arguments):
        return {row["name"]: row["token"] for row in csv.DictReader(io.StringIO(self.user("add", *arguments).stdout))}

    def as_user(self, token, *arguments, status=0):
        return self.run_cli(*arguments, status=status, env=self.environment | {"FLATLIGHT_TOKEN": token})

    def test_a_class_sees_its_own_jobs(self):
        with Daemon(FLATLIGHTD, arguments=("--data", self.path("data"))) as daemon:
            self.environment["FLATLIGHT_SERVER"] = daemon.address
            self.run_cli("jobs")
            self.write("class.csv", "name,role,groups\nada,,lab-1;lab-2\nbob,student,\ngus,grader,\n")
            tokens = self.tokens("--roster", "class.csv")
            self.assertEqual(list(tokens), ["ada", "bob", "gus"])
            tokens |= self.tokens("ina", "--role", "instructor", "--group", "staff")
            self.assertEqual(self.user("list").stdout, "name,role,groups,state\nada,student,lab-1;lab-2,active\n"
                             "bob,student,,active\ngus,grader,,active\nina,instructor,staff,active\n")

            self.assertIn("Bearer TOKEN", self.run_cli("jobs", status=4).stderr)
            self.assertEqual(self.run_cli("health").stdout, f"{daemon.address} SERVING\n")
            job = self.as_user(tokens["ada"], "submit", "gallery:cornell", "--samples", "1000000000",
                               "--quiet").stdout.strip()
            self.assertIn(job[5:], self.as_user(tokens["ada"], "jobs").stdout)
            self.assertNotIn(job[5:], self.as_user(tokens["bob"], "jobs").stdout)
            self.assertIn("does not exist", self.as_user(tokens["bob"], "show", job, status=2).stderr)
            self.assertIn("not yours", self.as_user(tokens["gus"], "cancel", job, status=4).stderr)
            activity = json.loads(self.as_user(tokens["bob"], "top", "--json").stdout)
            self.assertEqual([user["user"] for user in activity["users"]], ["(others)"])
            self.assertNotIn("jobs", activity)
            top = self.as_user(tokens["bob"], "top", "--once").stdout
            self.assertIn("and 1 other job", top)
            self.assertNotIn(job[5:13], top)
            self.assertIn(job[5:13], self.as_user(tokens["ina"], "top", "--once").stdout)

            self.user("revoke", "ada")
            self.assertIn("revoked", self.as_user(tokens["ada"], "jobs", status=4).stderr)
            self.as_user(tokens["ina"], "cancel", job)
            self.assertIn(job[5:], self.as_user(tokens["ina"], "jobs").stdout)
            self.assertEqual(self.as_user(tokens["ina"], "jobs", "--mine").stdout, "no jobs\n")
            self.assertEqual(self.as_user(tokens["ina"], "jobs", "--prune", "0").stdout, "no jobs\n")
            again = self.tokens("ada")["ada"]
            self.assertIn(job[5:], self.as_user(again, "jobs").stdout)
        self.assertIn("cannot reach the server", self.run_cli("health", status=3).stderr)
        for name in os.listdir(self.path("data")):
            if os.path.isfile(self.path("data/" + name)):
                with open(self.path("data/" + name), "rb") as file:
                    self.assertNotIn(again.encode(), file.read(), name)

    def test_scenes_are_shared(self):
        tokens = self.tokens("ada") | self.tokens("bob", "--group", "lab-1")
        ada, bob = tokens["ada"], tokens["bob"]
        with Daemon(FLATLIGHTD, arguments=("--data", self.path("data"))) as daemon:
            self.environment["FLATLIGHT_SERVER"] = daemon.address
            self.write("mine.json", self.run_cli("scenes", "penumbra", env=self.environment | {"FLATLIGHT_TOKEN": ada}).stdout)
            self.assertEqual(self.as_user(ada, "scenes", "--mine").stdout, "you have uploaded no scenes\n")
            self.as_user(ada, "validate", "mine.json")
            digest = self.as_user(ada, "scenes", "--mine").stdout.split()[0]
            self.assertEqual(len(digest), 64)
            name = "scenes/" + digest
            self.as_user(bob, "validate", name, status=2)
            self.assertEqual(self.as_user(bob, "scenes", "--shared").stdout, "no scenes are shared with you\n")
            self.assertIn("no uploaded scene begins",
                          self.as_user(bob, "share", name[:12], "--with", "course", status=2).stderr)
            shared = self.as_user(ada, "share", name[:12], "--with", "group:lab-1").stdout
            self.assertEqual(shared, f"{name} shared with group:lab-1 (read)\n")
            self.assertIn("good scene", self.as_user(bob, "validate", name).stdout)
            self.assertRegex(self.as_user(bob, "scenes", "--shared").stdout, digest + ".*ada")
            self.assertIn("not yours", self.as_user(bob, "scenes", digest[:5], "--delete", status=4).stderr)
            self.as_user(ada, "unshare", name, "--with", "group:lab-1", "--quiet")
            self.as_user(bob, "validate", name, status=2)
            self.assertEqual(self.as_user(ada, "scenes", digest[:5], "--delete").stdout, f"{name} deleted\n")
            self.assertEqual(self.as_user(ada, "scenes", "--mine").stdout, "you have uploaded no scenes\n")
            self.assertIn("--delete", self.as_user(ada, "scenes", "--delete", status=2).stderr)
            self.assertIn("excludes", self.as_user(ada, "scenes", "--mine", "--shared", status=2).stderr)

    def test_quotas_are_shown_and_refusals_say_when_to_try_again(self):
        quotas = ("--quota", "student.jobs=1", "--quota", "student.cpu-seconds=5400", "--quota", "student.requests=0.01")
        arguments = ("--data", self.path("data"), *quotas)
        with Daemon(FLATLIGHTD, arguments=arguments[:6]) as daemon:
            self.environment["FLATLIGHT_SERVER"] = daemon.address
            tokens = self.tokens("ada") | self.tokens("gus", "--role", "grader")
            shown = self.as_user(tokens["ada"], "quota").stdout
            self.assertRegex(shown, r"^ada, student\n\n")
            self.assertRegex(shown, r"\njobs +0 +1 +that have not ended\n")
            self.assertRegex(shown, r"\nprocessor time +0 s +1:30:00 +today; the next day begins in [0-9:]+( s)?\n")
            self.assertRegex(shown, r"\nwatches +0 +8 *\n")
            self.assertRegex(shown, r"\nstorage +0 bytes +512 MiB +scenes and jobs\n")
            self.assertRegex(shown, r"\nrequests +1 +500 +50 more a second\n")
            self.assertRegex(self.as_user(tokens["gus"], "quota").stdout, r"\nprocessor time +0 s +no limit ")
            told = json.loads(self.as_user(tokens["ada"], "quota", "--json").stdout)
            self.assertEqual((told["user"], told["jobs"]["limit"]), ("ada", 1))
            self.as_user(tokens["ada"], "submit", "gallery:cornell", "--samples", "1000000000", "--quiet")
            refused = self.as_user(tokens["ada"], "submit", "gallery:cornell", "--samples", "16", status=4).stderr
            self.assertIn("max_jobs_per_user: 1 of your jobs have not ended; allowed: 1. Wait for one, or cancel one (try again "
                          "in 2 s)", refused)
            waited, said = refused.splitlines()  # As one job may end soon, it was tried again first.
            self.assertRegex(waited, r"the server refuses for now \(TOO_MANY_JOBS\); trying again in [0-9.]+ s, up to 4 times")
            self.assertIn("max_jobs_per_user", said)
            self.assertRegex(self.as_user(tokens["ada"], "quota").stdout, r"\njobs +1 +1 ")
        with Daemon(FLATLIGHTD, arguments=arguments) as daemon:
            self.environment["FLATLIGHT_SERVER"] = daemon.address
            self.as_user(tokens["ada"], "quota")
            refused = self.as_user(tokens["ada"], "quota", status=4).stderr
            self.assertRegex(refused, r"max_requests_per_user: .*allowed: 1, and 0.01 more a second "
                             r"\(try again in (\d\d|100) s\)")
        bad = subprocess.run([FLATLIGHTD, "--quota", "student.jobs=many"], capture_output=True, text=True, timeout=60)
        self.assertEqual(bad.returncode, 2)
        self.assertIn('the value "many" must be none, or a whole number greater than 0', bad.stderr)

    def test_jobs_are_shared(self):
        tokens = self.tokens("ada") | self.tokens("bob", "--group", "lab-1") | self.tokens("cyd")
        ada, bob, cyd = tokens["ada"], tokens["bob"], tokens["cyd"]
        with Daemon(FLATLIGHTD, arguments=("--data", self.path("data"))) as daemon:
            self.environment["FLATLIGHT_SERVER"] = daemon.address
            job = self.as_user(ada, "submit", "gallery:cornell", "--samples", "1000000000", "--quiet").stdout.strip()
            start = job[5:13]  # Of its UUID.
            shared = self.as_user(ada, "share", start, "--with", "group:lab-1", "--with", "user:cyd").stdout
            self.assertEqual(shared, f"{job} shared with group:lab-1 (read), user:cyd (read)\n")
            self.assertIn("user:cyd (read)", self.as_user(ada, "show", start).stdout)
            self.assertEqual(self.as_user(bob, "jobs").stdout, "no jobs\n")
            header, row = self.as_user(bob, "jobs", "--shared").stdout.splitlines()
            self.assertEqual((header.split()[:2], row.split()[:2]), (["JOB", "OWNER"], [job[5:], "ada"]))
            seen = self.as_user(bob, "show", start).stdout
            self.assertRegex(seen, r"owner +ada")
            self.assertNotIn("cyd", seen)
            self.assertIn("not yours", self.as_user(bob, "pause", start, status=4).stderr)

            self.as_user(ada, "share", job, "--with", "group:lab-1", "--control", "--quiet")
            self.assertIn("paused", self.as_user(bob, "pause", start).stdout)
            self.assertIn("not delete, share or show it", self.as_user(bob, "unshare", job, "--with", "user:cyd", status=4).stderr)
            left = json.loads(self.as_user(ada, "unshare", job, "--with", "group:lab-1", "--json").stdout)
            self.assertEqual(left["shares"], [{"grantee": "user:cyd", "access": "READ"}])
            self.assertIn("does not exist", self.as_user(bob, "show", job, status=2).stderr)
            self.assertEqual(self.as_user(bob, "jobs", "--shared").stdout, "no jobs are shared with you\n")
            self.as_user(cyd, "show", job)
            self.assertIn("shared with nobody", self.as_user(ada, "unshare", job, "--with", "user:cyd").stdout)
            self.assertIn("is not shared with user:cyd",
                          self.as_user(ada, "unshare", job, "--with", "user:cyd", status=2).stderr)
            self.assertIn("allowed: user:NAME", self.as_user(ada, "share", job, "--with", "cyd", status=2).stderr)
            self.assertIn("--with", self.as_user(ada, "share", job, status=2).stderr)
            self.assertIn("excludes", self.as_user(ada, "jobs", "--shared", "--prune", "1d", status=2).stderr)
            self.as_user(ada, "cancel", job)

    def test_a_room_reviews_a_job(self):
        tokens = self.tokens("ina", "--role", "instructor") | self.tokens("ada", "--group", "lab-1") | self.tokens("bob")
        ina, ada, bob = tokens["ina"], tokens["ada"], tokens["bob"]
        data = ("--data", self.path("data"))
        with Daemon(FLATLIGHTD, arguments=data) as daemon:
            self.environment["FLATLIGHT_SERVER"] = daemon.address
            job = self.as_user(bob, "submit", "gallery:unit-light", "--quiet").stdout.strip()
            room = self.as_user(ina, "room", "create", "Lab 3").stdout.strip()
            self.assertRegex(room, "^rooms/[0-9a-f-]{36}$")
            start = room[6:14]
            self.assertIn("shared with group:lab-1 (read)",
                          self.as_user(ina, "room", "share", start, "--with", "group:lab-1").stdout)
            self.assertIn("does not exist", self.as_user(ada, "show", job, status=2).stderr)
            looks = self.as_user(ina, "room", "look", start, "--job", job, "--probe", "floor", "--point", "7", "--exposure",
                                 "-1.5", "--tone-mapping", "linear").stdout
            self.assertEqual(looks, f"looks at {job} floor point 7, -1.5 stops, linear\n")
            self.as_user(ada, "show", job)
            note = self.as_user(ada, "room", "note", start, "here it is dark", "--at", "0.5,-1").stdout
            self.assertRegex(note, r"^\S+Z ada: here it is dark \(at 0.5,-1\)\n$")
            shown = self.as_user(ada, "room", "show", start).stdout
            self.assertTrue(shown.endswith("\n\n" + note), shown)
            self.assertNotIn("lab-1", shown)
            self.assertIn("lab-1", self.as_user(ina, "room", "show", start).stdout)
            self.assertIn("Lab 3", self.as_user(ada, "room", "list").stdout)
            self.assertEqual(self.as_user(bob, "room", "list").stdout, "no rooms\n")
            self.assertIn("does not exist", self.as_user(bob, "room", "watch", room, status=2).stderr)
            self.assertIn("may watch it", self.as_user(ada, "room", "close", room, status=4).stderr)
            # A watch goes on over a restart of the server.
            watch = subprocess.Popen([FLATLIGHT, "room", "watch", room], stdout=subprocess.PIPE, text=True,
                                     env=self.environment | {"FLATLIGHT_TOKEN": ada}, cwd=self.folder)
            self.assertEqual(watch.stdout.readline(), note)
            self.assertEqual(watch.stdout.readline(), looks)
        with Daemon(FLATLIGHTD, listen=daemon.address, arguments=data):
            again = self.as_user(ina, "room", "note", room, "so it is").stdout
            self.assertEqual(watch.stdout.readline(), again)
            self.as_user(ina, "room", "look", room, "--job", "")
            self.assertEqual(watch.stdout.readline(), "looks at nothing\n")
            self.assertEqual(self.as_user(ina, "room", "close", room).stdout, f"{room} closed\n")
            self.assertEqual(watch.communicate(timeout=60)[0], "closed\n")
            self.assertEqual(watch.returncode, 0)
            whole = json.loads(self.as_user(ada, "room", "show", room, "--json").stdout)
            self.assertEqual([entry["text"] for entry in whole["notes"]], ["here it is dark", "so it is"])
            self.assertIn("is closed", self.as_user(ada, "room", "note", room, "late", status=2).stderr)
            for wrong in (["--point", "x"], ["--exposure", "bright"], ["--tone-mapping", "square"]):
                self.assertIn(wrong[0], self.as_user(ina, "room", "look", room, *wrong, status=2).stderr)
            self.assertIn("X,Y", self.as_user(ina, "room", "note", room, "x", "--at", "1", status=2).stderr)
            self.as_user(ina, "room", "delete", room)
            self.assertEqual(self.as_user(ina, "room", "list").stdout, "no rooms\n")

    def test_mistakes(self):
        self.assertIn("NAME or --roster", self.user("add", status=2).stderr)
        self.assertIn("--role", self.user("add", "ada", "--role", "king", status=2).stderr)
        self.assertIn("the server's own", self.user("add", "owner", status=2).stderr)
        self.assertIn("no user \"ada\"", self.user("revoke", "ada", status=1).stderr)
        self.tokens("ada")
        self.assertIn("already", self.user("add", "ada", status=1).stderr)
        self.write("class.csv", "name\nbob\nada\n")
        self.assertIn("class.csv:3", self.user("add", "--roster", "class.csv", status=1).stderr)
        self.assertEqual(self.user("list").stdout, "name,role,groups,state\nada,student,,active\n")
        self.assertIn("excludes", self.user("add", "--roster", "class.csv", "--role", "grader", status=2).stderr)
        self.assertIn("none.csv", self.user("add", "--roster", "none.csv", status=1).stderr)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=1)
