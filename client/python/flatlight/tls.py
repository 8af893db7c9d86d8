# SPDX-License-Identifier: Apache-2.0
"""How a connection is kept from others' eyes."""
import os
import re
import ssl

import grpc
from flatlight.errors import BadRequest

_SYSTEM_CA = "/etc/ssl/certs/ca-certificates.crt"  # Debian's. grpcio brings a list of its own, which knows no local one.


class Tls:
    """See Client. Without anything given, and with `local`, it is off."""

    def __init__(self, local, ca, cert, key, name):
        ca = os.fspath(ca or os.environ.get("FLATLIGHT_TLS_CA", ""))
        self.name = name or os.environ.get("FLATLIGHT_TLS_NAME", "")
        if not cert and not key:
            cert, key = (os.environ.get("FLATLIGHT_TLS_" + which, "") for which in ("CERT", "KEY"))
        cert, key = os.fspath(cert or ""), os.fspath(key or "")
        if bool(cert) != bool(key):
            raise BadRequest("tls_cert and tls_key belong together: a certificate, and its private key")
        self.on = bool(ca or cert or self.name or not local)
        self.ca = _read("tls_ca", ca or (_SYSTEM_CA if self.on and os.path.exists(_SYSTEM_CA) else ""))
        self.cert, self.key = _read("tls_cert", cert), _read("tls_key", key)
        for name, path, text in (("tls_ca", ca, self.ca), ("tls_cert", cert, self.cert)):
            if path and not re.search(b"-----BEGIN (TRUSTED |X509 )?CERTIFICATE-----", text):
                raise BadRequest(f"{name}: {path} holds no certificate in PEM form")
        if cert:
            _check_pair(cert, key)

    def channel(self, address, options):
        if not self.on:
            return grpc.insecure_channel(address, options=list(options.items()))
        if self.name:
            options = options | {"grpc.ssl_target_name_override": self.name}
        credentials = grpc.ssl_channel_credentials(self.ca or None, self.key or None, self.cert or None)
        return grpc.secure_channel(address, credentials, options=list(options.items()))


def _read(name, path):
    if not path:
        return b""
    try:
        with open(path, "rb") as file:
            return file.read()
    except OSError as error:
        raise BadRequest(f"{name}: cannot read {path}: {error.strerror}") from None


def _check_pair(cert, key):
    try:
        # A passphrase that is none, where the key has one: nobody shall be asked in a notebook.
        ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT).load_cert_chain(cert, key, password="")
    except ssl.SSLError as error:
        raise BadRequest(f"tls_key: {key} is not the key of the certificate {cert}, or has a passphrase "
                         f"({error.reason or error})") from None
