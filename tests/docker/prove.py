# SPDX-License-Identifier: Apache-2.0
"""Runs docker/Dockerfile and docker/compose.yaml without an engine, in fresh Debian roots, and tries what comes out.

    python3 tests/docker/prove.py FOLDER [--ccache DIR] [--client PROGRAM] [--mirror URL] [--stage build|image|all]

As root, with debootstrap and python3-yaml; FOLDER takes some 10 GB and is kept. The steps are read from the files
themselves, and each root begins as debootstrap makes it. `image` goes on with the roots that an earlier run has left.
"""
import argparse
import os
import pathlib
import shlex
import shutil
import subprocess
import sys

import dockerfile
import image_trial
from container import Container, copy_root, debian_root

ROOT = pathlib.Path(__file__).resolve().parents[2]


class Builder:
    """`docker build`, step by step."""

    def __init__(self, folder, mirror, ccache):
        self.folder = folder
        self.mirror = mirror
        self.ccache = ccache
        self.roots = {}
        self.ignored = (ROOT / ".dockerignore").read_text(encoding="utf-8").split()

    def root_of(self, stage):
        return self.folder / (stage.name or "image")

    def build(self, stage):
        root = self.root_of(stage)
        print("== FROM", stage.base, flush=True)
        copy_root(debian_root(stage.base, self.folder, self.mirror), root)
        if stage.base.endswith("-slim"):
            self.slim(root)
        inside = Container(root)
        if self.ccache:
            inside.volumes = {"/ccache": self.ccache}
            inside.environment.update(CCACHE_DIR="/ccache", CCACHE_BASEDIR="/src", CCACHE_NOHASHDIR="1")
        for word, arguments in stage.steps:
            print("==", word, arguments, flush=True)
            if word == "ENV":
                inside.environment.update([arguments.split("=", 1)])
            elif word == "USER":
                inside = Container(root, arguments, inside.workdir, {"PATH": inside.environment["PATH"]})
            elif word == "WORKDIR":
                inside.workdir = arguments
                (root / arguments.lstrip("/")).mkdir(parents=True, exist_ok=True)
            elif word == "COPY":
                self.copy(arguments.split(), root)
            else:
                inside.shell(arguments)
        self.roots[stage.name] = root
        return inside

    def copy(self, words, root):
        source_root, ignored = ROOT, self.ignored
        if words[0].startswith("--from="):
            source_root, ignored = self.roots[words.pop(0).removeprefix("--from=")], []
        *sources, target = words
        for source in sources:
            path = source_root / source.lstrip("/")
            into = root / target.lstrip("/")
            if path.is_dir():
                shutil.copytree(path, into, symlinks=True, dirs_exist_ok=True,
                                ignore=lambda place, names: ignored if pathlib.Path(place) == ROOT else [])
            else:
                into.parent.mkdir(parents=True, exist_ok=True)
                shutil.copy2(path, into)
            subprocess.run(["chown", "-R", "--no-dereference", "0:0", str(into)], check=True)

    @staticmethod
    def slim(root):
        """The slim images leave documentation out, also that of packages that are installed later."""
        (root / "etc/dpkg/dpkg.cfg.d/docker").write_text(
            "path-exclude /usr/share/doc/*\npath-include /usr/share/doc/*/copyright\npath-exclude /usr/share/man/*\n"
            "path-exclude /usr/share/info/*\npath-exclude /usr/share/locale/*\n", encoding="ascii")


def prove_tree(root, ccache):
    """./run, all tests compiled and linked, and those that take no long while, on what docker/packages.txt brought."""
    inside = Container(root, workdir="/src")
    if ccache:
        inside.volumes = {"/ccache": ccache}
        inside.environment.update(CCACHE_DIR="/ccache")
    for command in ("./run", "./run test -LE 'statistical|slow'"):
        print("== in the bare root:", command, flush=True)
        inside.shell(command)


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--ccache", type=pathlib.Path)
    parser.add_argument("--client", type=pathlib.Path, default=ROOT / "build/release/bin/flatlight")
    parser.add_argument("--mirror", default="http://deb.debian.org/debian")
    parser.add_argument("--stage", choices=("build", "image", "all"), default="all")
    options = parser.parse_args()
    if os.geteuid() != 0:
        sys.exit("prove.py: mounts and chroot want root")
    if missing := [program for program in ("debootstrap", "unshare", "nsenter", "setpriv") if not shutil.which(program)]:
        sys.exit("prove.py: not installed: " + " ".join(missing))
    options.folder = options.folder.resolve()
    options.folder.mkdir(parents=True, exist_ok=True)
    *stages, image = dockerfile.parse((ROOT / "docker/Dockerfile").read_text(encoding="utf-8"))
    builder = Builder(options.folder, options.mirror, options.ccache)
    for stage in stages:
        if options.stage == "image":
            builder.roots[stage.name] = builder.root_of(stage)
        else:
            builder.build(stage)
    if options.stage != "image":
        prove_tree(builder.root_of(stages[0]), options.ccache)
    if options.stage != "build":
        builder.ccache = None
        inside = builder.build(image)
        image_trial.run(image, inside, options.folder, options.client)
    print("All of it was proven:", shlex.join(sys.argv))


if __name__ == "__main__":
    main()
