# SPDX-License-Identifier: Apache-2.0
"""What is asked of the image: each claim of the recipe and of docs/service.md is tried, and raises if it does not hold."""
import json
import os
import pathlib
import shutil
import subprocess
import sys
import time

import yaml

from container import Container, Network

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/client"))
from certificates import Authority  # noqa: E402

# Seconds long, so that a server can be stopped in the midst of it.
LONG = ("gallery:cornell", "--method", "path-tracing", "--samples", "16384")
START_SECONDS = 30
STOP_SECONDS = 30


def claim(text, holds):
    if not holds:
        raise AssertionError("NOT SO: " + text)
    print("   proven:", text, flush=True)


class Client:
    """`flatlight` outside of the container, on its network."""

    def __init__(self, program, network, folder, **environment):
        self.words = [*network.prefix, str(program)]
        self.folder = folder
        self.environment = {name: value for name, value in os.environ.items() if not name.startswith("FLATLIGHT_")}
        self.environment.update(environment)

    def __call__(self, *arguments, status=0):
        run = subprocess.run([*self.words, *arguments], env=self.environment, cwd=self.folder, capture_output=True,
                             text=True, timeout=600)
        if run.returncode != status:
            raise AssertionError(f"flatlight {arguments}: {run.returncode}\n{run.stdout}\n{run.stderr}")
        return run.stdout

    def probes(self, job):
        return json.loads(self("fetch", job, "-o", "-"))["probes"]

    def job(self, job):
        return json.loads(self("show", job, "--json"))


def new_volume(root, place, folder):
    """As an engine makes one: with what the image has there, owner and mode included."""
    shutil.rmtree(folder, ignore_errors=True)
    subprocess.run(["cp", "-a", str(root / place.lstrip("/")), str(folder)], check=True)
    return folder


def await_health(container, command, timeout):
    """Seconds until the check says that the container is healthy."""
    start = time.monotonic()
    while time.monotonic() - start < START_SECONDS:
        if container.run(*command, timeout=timeout, capture_output=True).returncode == 0:
            return time.monotonic() - start
        time.sleep(0.1)
    raise AssertionError(f"not healthy within {START_SECONDS} s: {command}")


def seconds(text):
    return float(text.removesuffix("s"))


def try_programs(image):
    """Without a server: docker run --rm flatlight flatlight render …; returns the result of LONG."""
    out = image.root / "tmp/trial"
    out.mkdir(mode=0o777, exist_ok=True)
    out.chmod(0o777)
    image.run("flatlight", "render", "gallery:penumbra", "--method", "exact", "--max-bounces", "0", "--quiet",
              "-o", "/tmp/trial/a.json", "-o", "/tmp/trial/a.csv", "-o", "/tmp/trial/a.png", "-o", "/tmp/trial/a.svg",
              "-o", "/tmp/trial/a.npy", check=True)
    image.run("flatlight", "render", "gallery:cornell", "--picture", "32x32", "--samples", "4", "--quiet",
              "-o", "/tmp/trial/b.exr", "-o", "/tmp/trial/b.hdr", "-o", "/tmp/trial/b.png", check=True)
    sizes = {file.name: file.stat().st_size for file in out.iterdir()}
    claim("the image's programs find all that they need: " + ", ".join(sorted(sizes)), len(sizes) == 8 and all(sizes.values()))
    run = image.run("flatlight", "render", *LONG, "--quiet", "-o", "-", check=True, capture_output=True)
    shutil.rmtree(out)
    return json.loads(run.stdout)["probes"]


def try_alone(stage, image, folder, program, expected):
    """The image's own command, health check and volume."""
    volume = new_volume(image.root, stage.volumes[0], folder / "volume")
    timeout = seconds(stage.health_options["timeout"])
    with Network() as network:
        server = Container(image.root, image.user, image.workdir, image.environment, {stage.volumes[0]: volume}, network)
        client = Client(program, network, folder, FLATLIGHT_SERVER=stage.health[-1])
        claim("the health check fails where nothing serves",
              server.run(*stage.health, timeout=timeout, capture_output=True).returncode != 0)
        running = server.start(*stage.command)
        try:
            waited = await_health(server, stage.health, timeout)
            claim(f"the health check passes {waited:.1f} s after the start", True)
            claim("the server is the first process, and user and rights are none of root's",
                  running.status("NSpid")[-1] == "1" and "0" not in running.status("Uid")
                  and int(running.status("CapEff")[0], 16) == 0)
            done = client("submit", "gallery:penumbra", "--method", "exact", "--max-bounces", "0", "--quiet").strip()
            client("watch", done, "--json")
            before = client.probes(done)
            job = client("submit", *LONG, "--quiet").strip()
            while client.job(job).get("progress", {}).get("fraction", 0) < 0.1:
                time.sleep(0.05)
            claim("a job is under way", client.job(job)["state"] == "RUNNING")
            begin = time.monotonic()
            status = running.stop(STOP_SECONDS)
            claim(f"SIGTERM ends it with status {status} within {time.monotonic() - begin:.1f} s", status == 0)
            claim("the health check fails then",
                  server.run(*stage.health, timeout=timeout, capture_output=True).returncode != 0)
            running = server.start(*stage.command)
            await_health(server, stage.health, timeout)
            claim("a new container finds the ended job in the volume", client.probes(done) == before)
            client("watch", job, "--json")
            claim("the one that was under way went on and has the bits of one that was never stopped",
                  client.job(job)["state"] == "SUCCEEDED" and client.probes(job) == expected)
            claim("and ends with status 0 as well", running.stop(STOP_SECONDS) == 0)
        finally:
            running.kill()


class Service:
    """A service of a compose file; what this does not know is an error."""

    KNOWN = {"image", "build", "command", "environment", "healthcheck", "ports", "volumes", "read_only", "tmpfs", "cap_drop",
             "security_opt", "restart", "stop_grace_period"}

    def __init__(self, path):
        whole = yaml.safe_load(path.read_text(encoding="utf-8"))
        (description,) = whole["services"].values()
        if unknown := set(description) - self.KNOWN:
            raise ValueError(f"{path}: cannot try {unknown}")
        expected = {"read_only": True, "tmpfs": ["/tmp"], "cap_drop": ["ALL"], "security_opt": ["no-new-privileges:true"]}
        for key, value in expected.items():
            if description[key] != value:
                raise ValueError(f"{path}: {key} is {description[key]}, and only {value} can be tried")
        self.command = description["command"]
        self.environment = description["environment"]
        self.health = description["healthcheck"]["test"][1:]
        self.timeout = seconds(description["healthcheck"]["timeout"])
        self.grace = seconds(description["stop_grace_period"])
        self.mounts = dict(reversed(mount.split(":")[:2]) for mount in description["volumes"])


def try_compose(stage, image, folder, program):
    service = Service(ROOT / "docker/compose.yaml")
    mounts = {}
    for place, source in service.mounts.items():
        mounts[place] = new_volume(image.root, place, folder / "compose-volume") if source == "data" else None
    (certificates,) = [place for place, mounted in mounts.items() if mounted is None]
    mounts[certificates] = folder / "certificates"
    shutil.rmtree(mounts[certificates], ignore_errors=True)
    mounts[certificates].mkdir()
    authority = Authority(str(mounts[certificates]), "own")
    authority.issue("server")
    shutil.copy(authority.certificate, mounts[certificates] / "ca.pem")
    uid = int(next(line.split(":")[2] for line in image.read("/etc/passwd").splitlines() if line.startswith(image.user)))
    os.chown(mounts[certificates] / "server.key", uid, uid)
    with Network() as network:
        server = Container(image.root, image.user, image.workdir, {**image.environment, **service.environment}, mounts,
                           network, read_only=True, no_capabilities=True)
        refused = server.run(*service.command, capture_output=True, text=True, timeout=START_SECONDS)
        claim("without users it serves no other machine: " + refused.stderr.strip(), refused.returncode == 2)
        added = server.run("flatlightd", "user", "add", "--data", "/data", "ina", "--role", "admin", check=True,
                           capture_output=True, text=True)
        token = added.stdout.splitlines()[1].split(",")[1]
        running = server.start(*service.command)
        try:
            waited = await_health(server, service.health, service.timeout)
            claim(f"with TLS, users and a read-only root it is healthy {waited:.1f} s after the start", True)
            claim("it can gain no rights", running.status("NoNewPrivs") == ["1"]
                  and int(running.status("CapBnd")[0], 16) == 0)
            tls = {"FLATLIGHT_SERVER": service.environment["FLATLIGHT_SERVER"],
                   "FLATLIGHT_TLS_CA": str(mounts[certificates] / "ca.pem")}
            Client(program, network, folder, **tls)("jobs", status=4)
            client = Client(program, network, folder, **tls, FLATLIGHT_TOKEN=token)
            client("render", "gallery:penumbra", "--quiet", "-o", "compose.png", "-o", "compose.json")
            claim("a client outside renders with the token, and not without",
                  json.loads((folder / "compose.json").read_text(encoding="utf-8"))["probes"] != [])
            begin = time.monotonic()
            status = running.stop(service.grace)
            claim(f"SIGTERM ends it with status {status} within {time.monotonic() - begin:.1f} s", status == 0)
        finally:
            running.kill()


def run(stage, image, folder, program):
    """`image` is a container of what `stage` made; `program` the flatlight that reaches it from outside."""
    print("== what the image does", flush=True)
    installed = image.run("dpkg-query", "-f", "${Package}\n", "-W", check=True, capture_output=True, text=True).stdout.split()
    megabytes = sum(file.lstat().st_size for file in image.root.rglob("*") if file.is_file() and not file.is_symlink()) / 1e6
    claim(f"it has {len(installed)} packages, {megabytes:.0f} MB, and no compiler",
          not any(package.startswith(("g++", "gcc-12-b", "clang", "cmake")) and package != "gcc-12-base"
                  for package in installed))
    version = image.run("flatlightd", "--version", check=True, capture_output=True, text=True).stdout.strip()
    claim(f"its results name what it was built of: {version}", "+" in version)
    expected = try_programs(image)
    try_alone(stage, image, folder, program, expected)
    try_compose(stage, image, folder, program)
