# SPDX-License-Identifier: Apache-2.0
"""A sweep's file: {"scenes": [...], "settings": {...}, "runs": [{...}, ...]}, where a list of values is varied."""
import hashlib
import itertools
import json
import os
from dataclasses import dataclass

from flatlight import scenes
from flatlight.errors import BadRequest
from flatlight.settings import field_name, settings

_KEYS = ("scenes", "settings", "runs", "class")
_MAX_RUNS = 10000  # A slip of the pen is not to fill a server.


@dataclass(frozen=True)
class Run:
    """One job of a sweep. scene: as a Client takes it; label: as the file has it; values: the settings by name. key: equal
    for the same work, whatever the file's order."""

    scene: str
    label: str
    values: dict
    job_class: str
    key: str


def read(path):
    """The Runs of a file, in its order: by scene, then by the elements of "runs", in each of which the last setting
    varies fastest. Paths of scenes are relative to the file's folder. Raises BadRequest with the place of a mistake."""
    try:
        with open(path, encoding="utf-8") as file:
            content = json.load(file, object_pairs_hook=lambda pairs: _object(path, pairs))
    except OSError as error:
        raise BadRequest(f"{path}: {error.strerror}") from None
    except ValueError as error:  # Also of bytes that are no UTF-8.
        raise BadRequest(f"{path}: is not JSON: {error}") from None
    _check(path, content)
    runs, seen = [], set()
    for scene in content["scenes"]:
        located, content_hash = _locate(path, scene)
        for values in _expand(path, content):
            identity = json.dumps([content_hash, sorted(values.items())])
            key = hashlib.sha256(identity.encode()).hexdigest()
            if key in seen:
                raise BadRequest(f"{path}: {scene} with {values} comes twice")
            seen.add(key)
            runs.append(Run(located, scene, values, content.get("class"), key))
    return runs


def _object(path, pairs):
    names = [name for name, _ in pairs]
    for name in names:
        if names.count(name) > 1:
            raise BadRequest(f"{path}: {name}: comes twice in an object")
    return dict(pairs)


def _check(path, content):
    if not isinstance(content, dict):
        raise BadRequest(f"{path}: must be an object with {', '.join(_KEYS)}")
    for key in content:
        if key not in _KEYS:
            raise BadRequest(f"{path}: {key}: is unknown; allowed: {', '.join(_KEYS)}")
    listed = content.get("scenes")
    if not (isinstance(listed, list) and listed and all(isinstance(scene, str) for scene in listed)):
        raise BadRequest(f"{path}: scenes: must be a list of files or gallery:NAME, at least one")
    if not isinstance(content.get("settings", {}), dict):
        raise BadRequest(f"{path}: settings: must be an object")
    runs = content.get("runs", [{}])
    if not (isinstance(runs, list) and runs and all(isinstance(run, dict) for run in runs)):
        raise BadRequest(f"{path}: runs: must be a list of objects, at least one")


def _locate(path, scene):
    """Where the scene is, and what tells its content apart."""
    if scene.startswith(("gallery:", "scenes/")):
        return scene, scene
    located = os.path.join(os.path.dirname(path), scene)
    return located, hashlib.sha256(scenes.scene_bytes(located)).hexdigest()


def _expand(path, content):
    common = content.get("settings", {})
    expanded = []
    for index, block in enumerate(content.get("runs", [{}])):
        named = {}
        for values, place in ((common, "settings"), (block, f"runs[{index}]")):
            named |= {_name(path, place, name): value for name, value in values.items()}
        choices = [_choices(f"{path}: {name}", name, value) for name, value in named.items()]
        count = 1
        for choice in choices:
            count *= len(choice)
        if len(expanded) + count > _MAX_RUNS:
            raise BadRequest(f"{path}: runs[{index}]: makes more than {_MAX_RUNS} runs a scene")
        for combination in itertools.product(*choices):
            values = dict(zip(named, combination))
            try:
                settings(**values)
            except BadRequest as error:
                raise BadRequest(f"{path}: runs[{index}]: {error}") from None
            expanded.append(values)
    return expanded


def _name(path, place, name):
    try:
        return field_name(name)
    except BadRequest as error:
        raise BadRequest(f"{path}: {place}: {error}") from None


def _choices(place, name, value):
    """The values that a setting takes in turn. no_skip is a list itself, and varied by a list of lists."""
    if not isinstance(value, list) or name == "no_skip" and not any(isinstance(item, list) for item in value):
        return [value]
    if not value:
        raise BadRequest(f"{place}: is an empty list")
    return value
