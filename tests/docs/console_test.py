# SPDX-License-Identifier: Apache-2.0
"""Runs a page as a reader would: console_test.py PAGE BIN

Files that the page shows under a name ("```json scene.json") are written to an empty folder (those of the tree must be
as the tree has them); then every command of its console blocks runs there, in one shell and in order, and must print
what the page says. The page's server listens on a port that is free here.
"""

import contextlib
import os
import pathlib
import socket
import subprocess
import sys
import tempfile
import time

import markdown

PORT = "127.0.0.1:7000"  # As pages have it.
MARK = "end of the command, status "
ROOT = pathlib.Path(__file__).resolve().parents[2]


def free_address():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return f"127.0.0.1:{probe.getsockname()[1]}"


def wait_for_server(address, seconds=30):
    host, port = address.split(":")
    end = time.monotonic() + seconds
    while True:
        try:
            socket.create_connection((host, int(port)), timeout=1).close()
            return
        except OSError:
            if time.monotonic() > end:
                raise
            time.sleep(0.02)


class Shell:
    """A shell that runs commands one after the other and gives what each prints."""

    def __init__(self, folder, environment):
        self.process = subprocess.Popen(
            ["bash", "--noprofile", "--norc"],
            cwd=folder,
            env=environment,
            encoding="utf-8",
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
        )

    def run(self, command):
        script = f"{command}\n__status=$?; printf '\\n%s%d\\n' '{MARK}' $__status; (exit $__status)\n"
        self.process.stdin.write(script)
        self.process.stdin.flush()
        lines = []
        for line in self.process.stdout:
            if line.startswith(MARK):
                return lines[:-1] if lines[-1] == "" else lines
            lines.append(line.rstrip())
        raise RuntimeError(f"the shell ended in: {command}")

    def close(self):
        self.process.stdin.write("kill $(jobs -p) 2> /dev/null; wait; exit\n")
        self.process.stdin.close()
        self.process.stdout.read()
        self.process.wait()


def check_page(page, bin_folder, folder):
    address = free_address()
    environment = {k: v for k, v in os.environ.items() if not k.startswith("FLATLIGHT_")}
    environment |= {"PATH": f"{bin_folder}:{environment['PATH']}", "LC_ALL": "C.UTF-8", "FLATLIGHT_TREE": str(ROOT)}
    environment |= {"PYTHONPATH": str(pathlib.Path(bin_folder).parent / "python"), "PYTHONNOUSERSITE": "1"}
    blocks = markdown.blocks(page.read_text(encoding="utf-8"))
    for block in blocks:
        if block.title and (ROOT / block.title).exists():
            if (ROOT / block.title).read_text(encoding="utf-8") != block.text:
                yield f"{page.name}:{block.line}: differs from {block.title}"
        elif block.title:
            pathlib.Path(folder, block.title).write_text(block.text, encoding="utf-8")
    with contextlib.closing(Shell(folder, environment)) as shell:
        for block in blocks:
            for line, command, expected in markdown.steps(block) if block.language == "console" else []:
                printed = shell.run(command.replace(PORT, address))
                if command.endswith("&"):
                    wait_for_server(address)
                printed = [text.replace(address, PORT) for text in printed]
                if not markdown.matches(expected, printed):
                    yield "\n".join(
                        [f"{page.name}:{line}: {command}", "  expected:", *expected, "  printed:", *printed, ""]
                    )


def main():
    page, bin_folder = pathlib.Path(sys.argv[1]), sys.argv[2]
    with tempfile.TemporaryDirectory() as folder:
        failures = list(check_page(page, bin_folder, folder))
    print("\n".join(failures) or f"{page.name}: every command prints what the page says")
    sys.exit(1 if failures else 0)


if __name__ == "__main__":
    main()
