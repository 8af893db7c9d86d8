# SPDX-License-Identifier: Apache-2.0
"""The program against a server that speaks TLS. Run with FLATLIGHT FLATLIGHTD."""
import os
import subprocess
import sys
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
from certificates import Authority  # noqa: E402
from cli_case import FLATLIGHTD, CliCase  # noqa: E402
from daemon import Daemon  # noqa: E402


class TlsTest(CliCase):
    def setUp(self):
        super().setUp()
        self.authority = Authority(self.folder, "school")
        self.server_cert, self.server_key = self.authority.issue("server")
        self.as_server = ("--tls-cert", self.server_cert, "--tls-key", self.server_key)
        self.ca = ("--tls-ca", self.authority.certificate)

    def serve(self, *arguments):
        daemon = Daemon(FLATLIGHTD, arguments=(*self.as_server, *arguments))
        daemon.__enter__()
        self.addCleanup(daemon.__exit__)
        self.environment["FLATLIGHT_SERVER"] = daemon.address
        return daemon

    def test_a_job_goes_both_ways(self):
        self.serve()
        self.run_cli("render", "gallery:unit-light", "--quiet", "-o", "a.json", *self.ca)
        self.assertTrue(self.read_json("a.json")["probes"])
        self.environment["FLATLIGHT_TLS_CA"] = self.authority.certificate
        self.run_cli("jobs")
        # A server of one's own needs none.
        del self.environment["FLATLIGHT_SERVER"]
        self.run_cli("explain", "gallery:unit-light")
        self.assertIn("give --server", self.run_cli("explain", "gallery:unit-light", *self.ca, status=2).stderr)

    def test_who_is_not_vouched_for_is_told_why(self):
        daemon = self.serve()
        other = Authority(self.folder, "other")
        self.assertIn("was not signed by " + other.certificate,
                      self.run_cli("jobs", "--tls-ca", other.certificate, status=3).stderr)
        self.assertIn("this system's authorities", self.run_cli("jobs", "--tls-name", "localhost", status=3).stderr)
        self.assertIn("does it speak TLS?", self.run_cli("jobs", status=3).stderr)
        self.assertIn("see --tls-name", self.run_cli("jobs", *self.ca, "--tls-name", "elsewhere", status=3).stderr)
        self.run_cli("jobs", *self.ca, "--tls-name", "localhost")
        self.run_cli("jobs", *self.ca, "--server", daemon.address.replace("127.0.0.1", "localhost"))
        with Daemon(FLATLIGHTD) as plain:
            self.assertIn("it does not speak TLS",
                          self.run_cli("jobs", *self.ca, "--server", plain.address, status=3).stderr)

    def test_with_another_machine_tls_is_always_spoken(self):
        # Of no machine (RFC 5737): what matters is that the token would not go there in the clear.
        error = self.run_cli("jobs", "--server", "192.0.2.1:7000", "--tls-ca", "none.pem", status=2).stderr
        self.assertIn("none.pem: No such file", error)

    def test_a_server_may_ask_for_certificates(self):
        students = Authority(self.folder, "class")
        self.serve("--tls-client-ca", students.certificate)
        cert, key = students.issue("ada")
        self.run_cli("jobs", *self.ca, "--tls-cert", cert, "--tls-key", key)
        self.environment |= {"FLATLIGHT_TLS_CERT": cert, "FLATLIGHT_TLS_KEY": key}
        self.run_cli("jobs", *self.ca)
        strange_cert, strange_key = self.authority.issue("eve")
        self.run_cli("jobs", *self.ca, "--tls-cert", strange_cert, "--tls-key", strange_key, status=3)
        del self.environment["FLATLIGHT_TLS_CERT"], self.environment["FLATLIGHT_TLS_KEY"]
        self.assertIn("does it ask for certificates?", self.run_cli("jobs", *self.ca, status=3).stderr)

    def test_files_that_do_not_fit(self):
        cert, key = self.authority.issue("ada")
        self.environment["FLATLIGHT_SERVER"] = "127.0.0.1:1"
        for arguments, message in ((("--tls-cert", cert), "belong together"),
                                   (("--tls-cert", cert, "--tls-key", self.server_key), "is not the key of the certificate"),
                                   (("--tls-cert", key, "--tls-key", key), "holds no certificate"),
                                   (("--tls-cert", cert, "--tls-key", cert), "holds no private key"),
                                   (("--tls-ca", key), "holds no certificate"),
                                   (("--tls-ca", self.folder), "Is a directory"),
                                   (("--tls-ca", ""), "--tls-ca: is empty")):
            self.assertIn(message, self.run_cli("jobs", *arguments, status=2).stderr)

    def test_mistakes_of_who_starts_the_server(self):
        def refused(*arguments, listen="127.0.0.1:0"):
            run = subprocess.run([FLATLIGHTD, "--listen", listen, "--exit-with-parent", *arguments], text=True,
                                 capture_output=True, timeout=60, stdin=subprocess.DEVNULL)
            self.assertEqual(run.returncode, 2, run.stderr)
            return run.stderr

        self.assertIn("requires --tls-key", refused("--tls-cert", self.server_cert))
        self.assertIn("requires --tls-cert", refused("--tls-client-ca", self.server_cert))
        self.assertIn("a file is needed", refused("--tls-cert", "", "--tls-key", ""))
        _, other_key = self.authority.issue("other")
        self.assertIn("is not that of the certificate", refused("--tls-cert", self.server_cert, "--tls-key", other_key))
        self.assertIn("user add", refused(*self.as_server, listen="0.0.0.0:0"))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=1)
