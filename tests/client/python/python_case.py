# SPDX-License-Identifier: Apache-2.0
"""What tests of the package have in common. Importers are run with FLATLIGHT FLATLIGHTD as arguments."""
import os
import sys
import tempfile
import unittest

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
import flatlight
from daemon import Daemon

FLATLIGHT, FLATLIGHTD = sys.argv[1:3]
ENDLESS = {"scene": "gallery:cornell", "method": "path-tracing", "samples": 1000000000}


class PythonCase(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="flatlight-test-")
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def path(self, name):
        return os.path.join(self.folder, name)

    def write(self, name, text):
        with open(self.path(name), "w", encoding="utf-8") as file:
            file.write(text)
        return self.path(name)

    def serve(self, *arguments, **options):
        daemon = Daemon(FLATLIGHTD, arguments=arguments, **options)
        daemon.__enter__()
        self.addCleanup(daemon.__exit__)
        return daemon

    def connect(self, address, **options):
        client = flatlight.Client(address, **options)
        self.addCleanup(client.close)
        return client


def main():
    unittest.main(argv=sys.argv[:1], verbosity=1)
