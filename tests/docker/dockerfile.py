# SPDX-License-Identifier: Apache-2.0
"""Reads a Dockerfile into stages of steps: those instructions that docker/Dockerfile needs, and no others."""
import dataclasses
import json
import re

STEPS = ("COPY", "ENV", "RUN", "USER", "WORKDIR")  # In order; the others hold for the whole image.
PROPERTIES = ("CMD", "HEALTHCHECK", "VOLUME")


@dataclasses.dataclass
class Stage:
    base: str  # "debian:bookworm"
    name: str = ""
    steps: list = dataclasses.field(default_factory=list)  # (instruction, arguments), as they are written.
    command: list = dataclasses.field(default_factory=list)
    health: list = dataclasses.field(default_factory=list)
    health_options: dict = dataclasses.field(default_factory=dict)
    volumes: list = dataclasses.field(default_factory=list)


def instructions(text):
    """(instruction, arguments) of each, with lines that go on put together; raises ValueError at what it does not know."""
    lines = [line for line in text.splitlines() if not line.lstrip().startswith("#")]
    for line in re.sub(r"\\\n", "", "\n".join(lines)).splitlines():
        if not line.strip():
            continue
        word, _, arguments = line.strip().partition(" ")
        if word != "FROM" and word not in STEPS + PROPERTIES:
            raise ValueError(f"{word}: not one of FROM {' '.join(STEPS + PROPERTIES)}")
        yield word, arguments.strip()


def parse(text):
    stages = []
    for word, arguments in instructions(text):
        if word == "FROM":
            match = re.fullmatch(r"(\S+)(?: AS (\w+))?", arguments)
            if not match:
                raise ValueError("FROM " + arguments)
            stages.append(Stage(match[1], match[2] or ""))
        elif not stages:
            raise ValueError(word + " before the first FROM")
        elif word == "CMD":
            stages[-1].command = _words(arguments)
        elif word == "VOLUME":
            stages[-1].volumes += arguments.split()
        elif word == "HEALTHCHECK":
            options, _, command = arguments.partition("CMD ")
            stages[-1].health_options = dict(re.findall(r"--([\w-]+)=(\S+)", options))
            stages[-1].health = _words(command)
        else:
            stages[-1].steps.append((word, arguments))
    return stages


def _words(arguments):
    if not arguments.startswith("["):
        raise ValueError("as a JSON list, so that no shell stands between: " + arguments)
    return json.loads(arguments)
