# SPDX-License-Identifier: Apache-2.0
"""What tests of the program have in common. Importers are run with FLATLIGHT FLATLIGHTD as the first arguments."""
import json
import os
import subprocess
import sys
import tempfile
import unittest

FLATLIGHT, FLATLIGHTD = sys.argv[1:3]


class CliCase(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="flatlight-test-")
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        self.temporary = os.path.join(self.folder, "tmp")
        os.mkdir(self.temporary)
        self.environment = {key: value for key, value in os.environ.items() if not key.startswith("FLATLIGHT_")}
        self.environment["TMPDIR"] = self.temporary

    def path(self, name):
        return os.path.join(self.folder, name)

    def run_cli(self, *arguments, status=0, text=True, **options):
        """With the exit status that is expected; None: any."""
        options.setdefault("env", self.environment)
        run = subprocess.run([FLATLIGHT, *arguments], capture_output=True, text=text, timeout=90, cwd=self.folder, **options)
        self.assertIn(run.returncode, [run.returncode if status is None else status], f"{arguments}\n{run.stdout}\n{run.stderr}")
        self.assertEqual(os.listdir(self.temporary), [], "a private server left its folder")
        return run

    def write(self, name, text):
        with open(self.path(name), "w") as file:
            file.write(text)
        return name

    def read_json(self, name):
        with open(self.path(name)) as file:
            return json.load(file)
