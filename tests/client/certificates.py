# SPDX-License-Identifier: Apache-2.0
"""Certificates of a test, made by openssl in a folder of its own."""
import os
import subprocess

_DAYS = ("-days", "2")


class Authority:
    """Signs certificates for 127.0.0.1 and localhost, of the curve P-256."""

    def __init__(self, folder, name):
        self.folder = folder
        self.certificate, self._key = self._path(name + "-ca.pem"), self._path(name + "-ca.key")
        _openssl("req", "-x509", *_DAYS, "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:P-256", "-nodes", "-subj", "/CN=" + name,
                 "-keyout", self._key, "-out", self.certificate)

    def issue(self, name, names="IP:127.0.0.1,DNS:localhost"):
        """The paths of a certificate and its key."""
        certificate, key, request = (self._path(name + ending) for ending in (".pem", ".key", ".csr"))
        _openssl("req", "-new", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:P-256", "-nodes", "-subj", "/CN=" + name,
                 "-addext", "subjectAltName=" + names, "-keyout", key, "-out", request)
        _openssl("x509", "-req", *_DAYS, "-in", request, "-CA", self.certificate, "-CAkey", self._key, "-CAcreateserial",
                 "-copy_extensions", "copy", "-out", certificate)
        return certificate, key

    def _path(self, name):
        return os.path.join(self.folder, name)


def _openssl(*arguments):
    subprocess.run(["openssl", *arguments], check=True, capture_output=True, timeout=60)
