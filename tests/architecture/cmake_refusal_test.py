# SPDX-License-Identifier: Apache-2.0
"""Shows that CMake itself refuses what breaks the layers, with the project's own flatlight_library.

Usage: cmake_refusal_test.py ROOT CMAKE
"""

import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

ROOT, CMAKE = pathlib.Path(sys.argv[1]), sys.argv[2]


def flatlight_library():
    """The function as the root CMakeLists.txt defines it."""
    text = (ROOT / "CMakeLists.txt").read_text(encoding="utf-8")
    return re.search(r"^function\(flatlight_library .*?^endfunction\(\)$", text, re.MULTILINE | re.DOTALL)[0]


class CMakeRefusalTest(unittest.TestCase):
    def configure(self, folders):
        """Configures a project with the folders, in their order: pairs of a name and the arguments of its library."""
        with tempfile.TemporaryDirectory() as project:
            lines = ["cmake_minimum_required(VERSION 3.25)", "project(fake LANGUAGES NONE)", flatlight_library()]
            for name, arguments in folders:
                folder = pathlib.Path(project, "core", name)
                folder.mkdir(parents=True)
                (folder / f"{name}.h").touch()
                (folder / "CMakeLists.txt").write_text(f"flatlight_library(core_{name} HEADERS {name}.h {arguments})\n")
                lines.append(f"add_subdirectory(core/{name})")
            pathlib.Path(project, "CMakeLists.txt").write_text("\n".join(lines), encoding="utf-8")
            command = [CMAKE, "-G", "Ninja", "-S", project, "-B", f"{project}/build"]
            return subprocess.run(command, capture_output=True, text=True, check=False)

    def compiles(self, dependencies):
        """Whether core/scene, which includes core/math/math.h, compiles with the given DEPS."""
        with tempfile.TemporaryDirectory() as project:
            files = {
                "CMakeLists.txt": "cmake_minimum_required(VERSION 3.25)\nproject(fake LANGUAGES CXX)\n"
                f"add_library(flatlight_warnings INTERFACE)\n{flatlight_library()}\n"
                "add_subdirectory(core/math)\nadd_subdirectory(core/scene)\n",
                "core/math/CMakeLists.txt": "flatlight_library(core_math HEADERS math.h)\n",
                "core/math/math.h": "",
                "core/scene/CMakeLists.txt": f"flatlight_library(core_scene SOURCES scene.cc {dependencies})\n",
                "core/scene/scene.cc": '#include "core/math/math.h"\n',
            }
            for path, text in files.items():
                file = pathlib.Path(project, path)
                file.parent.mkdir(parents=True, exist_ok=True)
                file.write_text(text, encoding="utf-8")
            build = f"{project}/build"
            subprocess.run([CMAKE, "-G", "Ninja", "-S", project, "-B", build], capture_output=True, check=True)
            outcome = subprocess.run([CMAKE, "--build", build], capture_output=True, text=True, check=False)
            return outcome.returncode == 0, outcome.stdout

    def refused(self, folders, message):
        outcome = self.configure(folders)
        self.assertNotEqual(outcome.returncode, 0)
        self.assertIn(message, " ".join(outcome.stderr.split()))

    def test_downward_dependency_is_fine(self):
        outcome = self.configure([("math", ""), ("scene", "DEPS flatlight::core_math")])
        self.assertEqual(outcome.returncode, 0, outcome.stderr)

    def test_upward_dependency(self):
        self.refused(
            [("math", "DEPS flatlight::core_scene"), ("scene", "")],
            "core_math depends on flatlight::core_scene, which is not in a lower layer",
        )

    def test_upward_private_dependency(self):
        self.refused(
            [("math", "PRIVATE_DEPS flatlight::core_scene"), ("scene", "")],
            "core_math depends on flatlight::core_scene, which is not in a lower layer",
        )

    def test_circular_dependency(self):
        self.refused(
            [("math", "DEPS flatlight::core_scene"), ("scene", "DEPS flatlight::core_math")],
            "core_math depends on flatlight::core_scene, which is not in a lower layer",
        )

    def test_dependency_on_itself(self):
        self.refused([("math", "DEPS flatlight::core_math")], "core_math depends on flatlight::core_math")

    def test_an_include_needs_a_declared_dependency(self):
        self.assertTrue(self.compiles("DEPS flatlight::core_math")[0])
        done, output = self.compiles("")
        self.assertFalse(done)
        self.assertIn("core/math/math.h: No such file", output)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
