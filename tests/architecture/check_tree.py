# SPDX-License-Identifier: Apache-2.0
"""Checks that the tree keeps to its architecture: python3 check_tree.py ROOT

Prints every violation and exits with 1 if there is one. CMake refuses upward and circular dependencies by itself; this
checks what it cannot see: which layers may know each other at all, and that includes are declared where they are used.
"""

import pathlib
import re
import sys

import tree as source_tree

# A folder may depend on folders of lower layers only; folders of one layer don't know each other.
LAYERS = [
    ["core/math"],
    ["core/execution", "core/sampling", "core/statistics"],
    ["core/scene", "core/grading"],
    ["core/cache"],
    ["core/plane", "core/space"],
    ["core/render"],
    ["server/store"],
    ["server/quota"],
    ["server/convert"],
    ["server/gallery"],
    ["server/scheduler"],
    ["server/telemetry"],
    ["server/review"],
    ["server/webhook"],
    ["server/service"],
    ["server/app"],
]
LAYER_OF = {folder: layer for layer, folders in enumerate(LAYERS) for folder in folders}

# Headers that a folder must not include, with the reason.
FORBIDDEN_INCLUDES = [
    ("core", r"(google/protobuf|grpc|flatlight/v1|google/rpc)", "core knows neither protobuf nor gRPC"),
    ("core", r"(fstream|filesystem)$", "core touches no files"),
    ("server/convert", r"(grpc|.*\.grpc\.pb\.h$)", "only the service and the app know gRPC"),
    ("server/gallery", r"(grpc|.*\.grpc\.pb\.h$)", "only the service and the app know gRPC"),
    ("server/store", r"(grpc|.*\.grpc\.pb\.h$)", "only the service and the app know gRPC"),
    ("server/quota", r"(grpc|.*\.grpc\.pb\.h$)", "only the service and the app know gRPC"),
    ("server/scheduler", r"(grpc|.*\.grpc\.pb\.h$)", "only the service and the app know gRPC"),
    ("server/telemetry", r"(grpc|.*\.grpc\.pb\.h$)", "only the service and the app know gRPC"),
    ("server/review", r"(grpc|.*\.grpc\.pb\.h$)", "only the service and the app know gRPC"),
    ("server/webhook", r"(grpc|.*\.grpc\.pb\.h$)", "only the service and the app know gRPC"),
]

MAX_LINES = 499
LICENCE = "SPDX-License-Identifier: Apache-2.0"
LICENSED_SUFFIXES = (".cc", ".h", ".proto", ".py")


def module_of(path):
    """core/plane for core/plane/exact/direct.cc."""
    return "/".join(path.parts[:2])


def is_inside(path, folder):
    return path == pathlib.PurePosixPath(folder) or pathlib.PurePosixPath(folder) in path.parents


def check_links(tree):
    """Which target may link which."""
    for target in tree.targets.values():
        own = module_of(target.folder)
        top = target.folder.parts[0]
        if top in ("core", "server") and own not in LAYER_OF:
            yield f"{target.folder}: {target.name} is in no layer; name its folder in check_tree.py"
            continue
        for dependency in sorted(target.dependencies):
            if top == "core" and re.match(r"(flatlight::proto$|gRPC::|protobuf::)", dependency):
                yield f"{target.folder}: {target.name} links {dependency}; core knows neither protobuf nor gRPC"
            other = tree.targets.get(dependency.removeprefix("flatlight::"))
            if not dependency.startswith("flatlight::") or other is None:
                continue
            if other.folder.parts[0] == "tests" and top != "tests":
                yield f"{target.folder}: {target.name} links {dependency}; only tests link tests"
            elif top == "client" and other.folder.parts[0] in ("core", "server"):
                yield f"{target.folder}: {target.name} links {dependency}; the client links no core and no server"
            elif top in ("core", "server") and other.folder.parts[0] in ("core", "server"):
                theirs = module_of(other.folder)
                if theirs != own and LAYER_OF.get(theirs, len(LAYERS)) >= LAYER_OF[own]:
                    yield f"{target.folder}: {target.name} depends on {dependency}, which is not in a lower layer"
            elif top in ("core", "server") and other.folder.parts[0] == "client":
                yield f"{target.folder}: {target.name} links {dependency}; nothing but the client's tests does"


def check_pictures(tree):
    """OpenImageIO costs some 260 libraries at start-up, so one small module links it and is loaded when needed."""
    users = sorted(t.name for t in tree.targets.values() if any("OpenImageIO" in d for d in t.dependencies))
    if len(users) > 1:
        yield f"OpenImageIO is linked by {', '.join(users)}; only one module may link it"


def check_peers(tree):
    """CGAL is under the GPL, so only what is never shipped may link it; Box2D is there to be measured against alone."""
    for target in tree.targets.values():
        for dependency in sorted(target.dependencies):
            if re.match(r"(CGAL|box2d)::", dependency) and not is_inside(target.folder, "tests/bench/peers"):
                yield f"{target.folder}: {target.name} links {dependency}; only tests/bench/peers may"
            if dependency.startswith("flatlight::bench_peers") and not is_inside(target.folder, "tests/bench/peers"):
                yield f"{target.folder}: {target.name} links {dependency}, and so CGAL; only tests/bench/peers may"


def check_includes(tree):
    """Every include of a project header is declared, and none goes round the rules."""
    for path in tree.files:
        owners = tree.targets_of(path)
        declared = set().union(*(owner.dependencies for owner in owners))
        for opening, name in tree.includes(path):
            where = f"{path}: #include {opening}{name}{'>' if opening == '<' else opening}"
            for folder, pattern, reason in FORBIDDEN_INCLUDES:
                if is_inside(path, folder) and re.match(pattern, name):
                    yield f"{where}: {reason}"
            if name.startswith(("flatlight/v1/", "google/rpc/")):
                if owners and "flatlight::proto" not in declared:
                    yield f"{where}: flatlight::proto is not in the DEPS of {names(owners)}"
                continue
            if "../" in name:
                yield f"{where}: name the header from the root of the tree"
                continue
            header = pathlib.PurePosixPath(name)
            if header not in tree.files:
                if len(header.parts) == 1 and opening == '"' or header.parts[0] in source_tree.FOLDERS:
                    yield f"{where}: no such file; name the header from the root of the tree"
                continue
            if opening == "<":
                yield f'{where}: the project\'s own headers are included with ""'
            for parent in header.parents:
                if parent.name == "internal" and not is_inside(path, parent.parent):
                    if not is_inside(path, pathlib.PurePosixPath("tests") / parent.parent):
                        yield f"{where}: only {parent.parent} and its tests may include it"
            providers = tree.targets_of(header)
            if owners and providers and not any(p in owners or f"flatlight::{p.name}" in declared for p in providers):
                yield f"{where}: flatlight::{names(providers)} is not in the DEPS of {names(owners)}"


def check_files(tree):
    """Every file is compiled, short, licensed; a header has the guard that its path calls for."""
    for path in tree.files:
        if path.suffix == ".cc" and not any(path in target.files for target in tree.targets.values()):
            yield f"{path}: no CMakeLists.txt names this file"
        if path.suffix == ".h":
            if not tree.targets_of(path):
                yield f"{path}: no target is in the folder of this header"
            guard = "FLATLIGHT_" + re.sub(r"[^A-Z0-9]", "_", str(path).upper()) + "_"
            # Vector code is included once for every vector unit, so its guard is one that toggles.
            opening = f"#ifdef {guard}\n#undef {guard}\n" if path.stem.endswith("-inl") else f"#ifndef {guard}\n"
            if opening not in tree.text(path) or f"#define {guard}\n" not in tree.text(path):
                yield f"{path}: the include guard should be {guard}"
    for folder in source_tree.FOLDERS:
        for file in sorted((tree.root / folder).rglob("*")):
            if file.suffix not in LICENSED_SUFFIXES or "node_modules" in file.parts:
                continue
            lines = file.read_text(encoding="utf-8").splitlines()
            path = file.relative_to(tree.root)
            if not any(LICENCE in line for line in lines[:2]):
                yield f"{path}: the first line should be the licence: {LICENCE}"
            if len(lines) > MAX_LINES:
                yield f"{path}: {len(lines)} lines; split it (at most {MAX_LINES})"


def names(targets):
    return " or ".join(sorted(target.name for target in targets))


def violations(root):
    tree = source_tree.read_tree(root)
    checks = (check_links, check_pictures, check_peers, check_includes, check_files)
    return [violation for check in checks for violation in check(tree)]


def main():
    if len(sys.argv) != 2:
        sys.exit("usage: check_tree.py ROOT")
    found = violations(sys.argv[1])
    print("\n".join(found) or "The tree keeps to its architecture.")
    sys.exit(1 if found else 0)


if __name__ == "__main__":
    main()
