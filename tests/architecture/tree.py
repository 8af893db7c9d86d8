# SPDX-License-Identifier: Apache-2.0
"""Reads a source tree: which targets its CMakeLists.txt files declare, and what each source file includes."""

import dataclasses
import pathlib
import re

FOLDERS = ("proto", "core", "server", "client", "tests")
SOURCE_SUFFIXES = (".cc", ".h")

_COMMAND = re.compile(r"^[ \t]*([a-z_]+)\s*\(", re.MULTILINE)
_WORD = re.compile(r'"([^"]*)"|([^\s()"]+)')
_INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]', re.MULTILINE)
_KEYWORDS = {"HEADERS", "SOURCES", "DEPS", "PRIVATE_DEPS", "LABELS", "TIMEOUT", "ENVIRONMENT"}
_SCOPES = {"PUBLIC", "PRIVATE", "INTERFACE", "STATIC", "SHARED", "MODULE", "EXCLUDE_FROM_ALL"}


@dataclasses.dataclass
class Target:
    name: str
    kind: str  # "library", "program", "test" or "bench".
    folder: pathlib.PurePosixPath
    files: set = dataclasses.field(default_factory=set)  # Paths from the root.
    dependencies: set = dataclasses.field(default_factory=set)  # As written: flatlight::core_math, GTest::gmock, ...


@dataclasses.dataclass
class Tree:
    root: pathlib.Path
    targets: dict  # By name.
    files: list  # Source files, as paths from the root.

    def text(self, path):
        return (self.root / path).read_text(encoding="utf-8")

    def includes(self, path):
        """The includes of a file: pairs of the opening character and the name."""
        return [(match[1], match[2]) for match in _INCLUDE.finditer(self.text(path))]

    def targets_of(self, path):
        """The targets that compile a file; of a header that none lists, the targets of its folder."""
        owners = [target for target in self.targets.values() if path in target.files]
        for folder in [] if owners else path.parents:
            owners = [target for target in self.targets.values() if target.folder == folder]
            if owners:
                break
        return owners


def read_tree(root):
    root = pathlib.Path(root)
    tree = Tree(root, {}, [])
    for folder in FOLDERS:
        for path in sorted((root / folder).rglob("*")):
            relative = pathlib.PurePosixPath(path.relative_to(root))
            if path.name == "CMakeLists.txt":
                _read_targets(path.read_text(encoding="utf-8"), relative.parent, tree.targets)
            elif path.suffix in SOURCE_SUFFIXES:
                tree.files.append(relative)
    return tree


def _commands(text):
    """The commands of a CMakeLists.txt: pairs of the name and the list of arguments."""
    text = re.sub(r"#[^\n]*", "", text)
    for match in _COMMAND.finditer(text):
        depth, end = 1, match.end()
        while depth and end < len(text):
            depth += {"(": 1, ")": -1}.get(text[end], 0)
            end += 1
        yield match[1], [quoted or bare for quoted, bare in _WORD.findall(text[match.end() : end - 1])]


def _sections(words):
    """Splits HEADERS a b DEPS c into {"HEADERS": [a, b], "DEPS": [c]}; words before a keyword come under ""."""
    sections, current = {"": []}, ""
    for word in words:
        if word in _KEYWORDS:
            current = word
            sections.setdefault(current, [])
        else:
            sections[current].append(word)
    return sections


def _read_targets(text, folder, targets):
    kinds = {
        "flatlight_library": "library",
        "flatlight_program": "program",
        "flatlight_test": "test",
        "flatlight_bench": "bench",
        "flatlight_table_bench": "bench",
        "add_library": "library",
        "add_executable": "program",
    }
    for command, words in _commands(text):
        if command in kinds and "ALIAS" not in words:
            sections = _sections(words[1:])
            files = sections.get("HEADERS", []) + sections.get("SOURCES", [])
            files += [word for word in sections[""] if word not in _SCOPES]
            name = words[0]
            if command in ("flatlight_test", "flatlight_bench", "flatlight_table_bench"):
                name = "_".join((*folder.parts, words[0]))
                files.append(words[0] + ".cc")
            target = targets.setdefault(name, Target(name, kinds[command], folder))
            target.files |= {folder / file for file in files}
            target.dependencies |= set(sections.get("DEPS", []) + sections.get("PRIVATE_DEPS", []))
            if kinds[command] == "bench":
                target.dependencies.add("flatlight::bench_scenes")
            if command == "flatlight_table_bench":
                target.dependencies |= {"flatlight::bench_report", "flatlight::bench_named_scenes"}
        elif command in ("target_link_libraries", "add_dependencies") and words[0] in targets:
            if command == "target_link_libraries":
                targets[words[0]].dependencies |= {word for word in words[1:] if word not in _SCOPES}
