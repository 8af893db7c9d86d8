# SPDX-License-Identifier: Apache-2.0
"""A flatlightd on loopback for as long as a `with` block lasts."""
import os
import re
import subprocess


class Daemon:
    def __init__(self, program, token=None, listen="127.0.0.1:0", arguments=(), environment=None, prefix=()):
        environment = {**os.environ, **(environment or {})}
        environment.pop("FLATLIGHT_TOKEN", None)
        if token:
            environment["FLATLIGHT_TOKEN"] = token
        # It ends with its standard input, so also when this process is killed.
        self.process = subprocess.Popen([*prefix, program, "--listen", listen, "--threads", "2", "--exit-with-parent",
                                         *arguments],
                                        stdin=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=environment)

    def __enter__(self):
        line = self.process.stderr.readline()
        match = re.search(r"listening on (\S+)", line)
        if not match:
            self.__exit__()
            raise RuntimeError("flatlightd did not start: " + line)
        self.address = match.group(1)
        return self

    def __exit__(self, *unused):
        self.process.stdin.close()
        self.process.wait(timeout=30)
        self.process.stderr.close()
