# SPDX-License-Identifier: Apache-2.0
"""The package against a server that speaks TLS."""
import os
from unittest import mock

import flatlight
from python_case import PythonCase, main

from certificates import Authority


class TlsTest(PythonCase):
    def setUp(self):
        super().setUp()
        self.authority = Authority(self.folder, "school")
        self.server_cert, self.server_key = self.authority.issue("server")

    def serve_tls(self, *arguments):
        return self.serve("--tls-cert", self.server_cert, "--tls-key", self.server_key, *arguments).address

    def test_a_job_goes_both_ways(self):
        address = self.serve_tls()
        client = self.connect(address, tls_ca=self.authority.certificate)
        self.assertEqual(len(client.render("gallery:unit-light", progress=None)["floor"].irradiance), 256)
        with mock.patch.dict(os.environ, {"FLATLIGHT_TLS_CA": self.authority.certificate}):
            self.connect(address).capabilities()
            self.connect(address, tls_name="localhost").capabilities()

    def test_who_is_not_vouched_for_is_not_trusted(self):
        address = self.serve_tls()
        other = Authority(self.folder, "other")
        for options in ({"tls_ca": other.certificate}, {"tls_name": "localhost"}, {},
                        {"tls_ca": self.authority.certificate, "tls_name": "elsewhere"}):
            with self.assertRaises(flatlight.Unreachable, msg=options):
                self.connect(address, **options).capabilities()

    def test_a_server_may_ask_for_certificates(self):
        students = Authority(self.folder, "class")
        address = self.serve_tls("--tls-client-ca", students.certificate)
        cert, key = students.issue("ada")
        trust = {"tls_ca": self.authority.certificate}
        self.connect(address, tls_cert=cert, tls_key=key, **trust).capabilities()
        with mock.patch.dict(os.environ, {"FLATLIGHT_TLS_CERT": cert, "FLATLIGHT_TLS_KEY": key}):
            self.connect(address, **trust).capabilities()
        with self.assertRaises(flatlight.Unreachable):
            self.connect(address, **trust).capabilities()

    def test_files_that_do_not_fit(self):
        cert, key = self.authority.issue("ada")
        for options, message in (({"tls_cert": cert}, "belong together"),
                                 ({"tls_cert": cert, "tls_key": self.server_key}, "is not the key of the certificate"),
                                 ({"tls_cert": key, "tls_key": key}, "holds no certificate"),
                                 ({"tls_ca": key}, "holds no certificate"),
                                 ({"tls_ca": self.path("none.pem")}, "none.pem: No such file")):
            with self.assertRaisesRegex(flatlight.BadRequest, message):
                flatlight.Client("127.0.0.1:1", **options)


if __name__ == "__main__":
    main()
