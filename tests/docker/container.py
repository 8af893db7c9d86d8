# SPDX-License-Identifier: Apache-2.0
"""Programs in a folder that holds a Debian root, as an engine would run them: by unshare, mount, chroot and setpriv."""
import os
import pathlib
import shlex
import shutil
import signal
import subprocess
import sys

PATH = "/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin"
_DEVICES = ("null", "zero", "full", "random", "urandom", "tty")


class Network:
    """A network of its own with a loopback and nothing else, for as long as a `with` block lasts."""

    _HOLD = ("import fcntl, socket, struct, sys\n"
             "with socket.socket() as s:\n"
             "    fcntl.ioctl(s, 0x8914, struct.pack('16sh', b'lo', 1))\n"  # SIOCSIFFLAGS, IFF_UP.
             "print(flush=True)\nsys.stdin.read()\n")

    def __enter__(self):
        self._holder = subprocess.Popen(["unshare", "--net", sys.executable, "-c", self._HOLD], stdin=subprocess.PIPE,
                                        stdout=subprocess.PIPE)
        self._holder.stdout.readline()
        self.prefix = ["nsenter", f"--net=/proc/{self._holder.pid}/ns/net"]
        return self

    def __exit__(self, *unused):
        self._holder.communicate()


class Container:
    """What `docker run` is told: of `root`, as `user`, with `environment`, `volumes` ({place inside: folder outside})."""

    def __init__(self, root, user="root", workdir="/", environment=None, volumes=None, network=None, read_only=False,
                 no_capabilities=False):
        self.root = pathlib.Path(root)
        self.user = user
        self.workdir = workdir
        home = next((line.split(":")[5] for line in self.read("/etc/passwd").splitlines() if line.startswith(user + ":")),
                    "/")
        self.environment = {"PATH": PATH, "HOME": home, **(environment or {})}
        self.volumes = volumes or {}
        self.network = network
        self.read_only = read_only
        self.no_capabilities = no_capabilities

    def read(self, path):
        return (self.root / path.lstrip("/")).read_text(encoding="utf-8")

    def words(self, command):
        """The command that runs `command` inside, where it is the first process."""
        root = shlex.quote(str(self.root))
        lines = [f"mount --bind {root} {root}", f"mount -t proc proc {root}/proc",
                 f"mount -t tmpfs -o mode=755 dev {root}/dev", f"mkdir {root}/dev/shm {root}/dev/pts",
                 f"mount -t tmpfs -o mode=1777 shm {root}/dev/shm",
                 f"mount -t devpts -o newinstance,ptmxmode=0666 pts {root}/dev/pts",
                 f"ln -s pts/ptmx {root}/dev/ptmx", f"ln -s /proc/self/fd {root}/dev/fd"]
        for device in _DEVICES:
            lines += [f"touch {root}/dev/{device}", f"mount --bind /dev/{device} {root}/dev/{device}"]
        for place, folder in self.volumes.items():
            self._make_folder(place)
            lines.append(f"mount --bind {shlex.quote(str(folder))} {root}{place}")
        if self.read_only:
            lines += [f"mount -o remount,bind,ro {root}", f"mount -t tmpfs -o mode=1777 tmp {root}/tmp"]
        inside = ["chroot", str(self.root), "setpriv"]
        if self.user != "root":
            inside += [f"--reuid={self.user}", f"--regid={self.user}", "--init-groups"]
        else:
            inside += ["--clear-groups"]
        if self.no_capabilities:
            inside += ["--bounding-set=-all", "--inh-caps=-all", "--no-new-privs"]
        inside += ["env", "-i", "-C", self.workdir, *(f"{name}={value}" for name, value in self.environment.items())]
        lines.append("exec " + shlex.join([*inside, *command]))
        network = self.network.prefix if self.network else []
        return [*network, "unshare", "--mount", "--pid", "--fork", "--kill-child", "sh", "-euc", "\n".join(lines)]

    def run(self, *command, **options):
        return subprocess.run(self.words(command), **options)

    def start(self, *command, **options):
        return Running(subprocess.Popen(self.words(command), stdin=subprocess.DEVNULL, **options))

    def shell(self, text):
        """RUN."""
        self.run("/bin/sh", "-c", text, check=True, stdin=subprocess.DEVNULL)

    def _make_folder(self, place):
        (self.root / place.lstrip("/")).mkdir(parents=True, exist_ok=True)


class Running:
    """A container that has been started."""

    def __init__(self, process):
        self.process = process

    def first(self):
        """The number that the first process inside has outside."""
        with open(f"/proc/{self.process.pid}/task/{self.process.pid}/children", encoding="ascii") as file:
            return int(file.read().split()[0])

    def status(self, field):
        with open(f"/proc/{self.first()}/status", encoding="ascii") as file:
            return next(line.split(":")[1].split() for line in file if line.startswith(field + ":"))

    def stop(self, seconds):
        """`docker stop`: the exit status; raises if it takes longer than that."""
        os.kill(self.first(), signal.SIGTERM)
        return self.process.wait(timeout=seconds)

    def kill(self):
        if self.process.poll() is None:
            self.process.kill()
            self.process.wait()


def debian_root(base, folder, mirror):
    """What an image debian:SUITE or debian:SUITE-slim holds, by debootstrap."""
    image, _, tag = base.partition(":")
    suite = tag.removesuffix("-slim")
    if image != "debian" or not suite.isalpha():
        raise ValueError("FROM " + base + ": only debian:SUITE can be made by debootstrap")
    folder = pathlib.Path(folder)
    whole = folder / suite
    if not whole.exists():
        part = folder / (suite + ".part")
        shutil.rmtree(part, ignore_errors=True)
        subprocess.run(["debootstrap", "--variant=minbase", suite, str(part), mirror], check=True,
                       stdout=subprocess.DEVNULL)
        security = mirror.removesuffix("/debian") + "/debian-security"
        (part / "etc/apt/sources.list").write_text(f"deb {mirror} {suite} main\ndeb {mirror} {suite}-updates main\n"
                                                   f"deb {security} {suite}-security main\n", encoding="ascii")
        # As the images have it: no package starts a service.
        (part / "usr/sbin/policy-rc.d").write_text("#!/bin/sh\nexit 101\n", encoding="ascii")
        (part / "usr/sbin/policy-rc.d").chmod(0o755)
        part.rename(whole)
    return whole


def copy_root(source, target):
    shutil.rmtree(target, ignore_errors=True)
    subprocess.run(["cp", "-a", str(source), str(target)], check=True)
    # These an engine writes.
    shutil.copy("/etc/resolv.conf", target / "etc/resolv.conf")
    (target / "etc/hosts").write_text("127.0.0.1 localhost\n::1 localhost ip6-localhost ip6-loopback\n", encoding="ascii")
