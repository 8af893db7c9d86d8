# SPDX-License-Identifier: Apache-2.0
"""Shows that check_tree.py can fail: each test makes a small tree with one violation."""

import pathlib
import tempfile
import unittest

import check_tree

LICENCE = "// SPDX-License-Identifier: Apache-2.0\n"


def header(path, *includes):
    guard = "FLATLIGHT_" + path.upper().replace("/", "_").replace(".", "_") + "_"
    return "".join([LICENCE, f"#ifndef {guard}\n#define {guard}\n", *(f"#include {i}\n" for i in includes), "#endif\n"])


def source(*includes):
    return LICENCE + "".join(f"#include {include}\n" for include in includes)


def good_tree():
    return {
        "core/math/CMakeLists.txt": "flatlight_library(core_math HEADERS vec.h)\n",
        "core/math/vec.h": header("core/math/vec.h", "<cmath>"),
        "core/math/internal/split.h": header("core/math/internal/split.h"),
        "core/scene/CMakeLists.txt": "flatlight_library(core_scene\n  HEADERS scene.h  # (The world)\n"
        "  SOURCES scene.cc\n  DEPS flatlight::core_math)\n",
        "core/scene/scene.h": header("core/scene/scene.h", '"core/math/vec.h"'),
        "core/scene/scene.cc": source('"core/scene/scene.h"', '"core/math/vec.h"'),
        "core/plane/CMakeLists.txt": "flatlight_library(core_plane HEADERS plane.h DEPS flatlight::core_scene)\n",
        "core/plane/plane.h": header("core/plane/plane.h", '"core/scene/scene.h"'),
        "core/space/CMakeLists.txt": "flatlight_library(core_space HEADERS space.h)\n",
        "core/space/space.h": header("core/space/space.h"),
        "server/store/CMakeLists.txt": "flatlight_library(server_store HEADERS store.h DEPS flatlight::proto)\n",
        "server/store/store.h": header("server/store/store.h", '"flatlight/v1/result.pb.h"'),
        "client/cli/CMakeLists.txt": "flatlight_program(flatlight SOURCES main.cc DEPS flatlight::proto)\n",
        "client/cli/main.cc": source("<grpcpp/grpcpp.h>", '"flatlight/v1/render_service.grpc.pb.h"'),
        "tests/core/math/CMakeLists.txt": "flatlight_test(vec_test DEPS flatlight::core_math LABELS unit)\n",
        "tests/core/math/vec_test.cc": source('"core/math/vec.h"', '"core/math/internal/split.h"'),
    }


class CheckTreeTest(unittest.TestCase):
    def violations(self, changes):
        with tempfile.TemporaryDirectory() as root:
            for path, text in {**good_tree(), **changes}.items():
                file = pathlib.Path(root, path)
                file.parent.mkdir(parents=True, exist_ok=True)
                file.write_text(text, encoding="utf-8")
            return check_tree.violations(root)

    def expect(self, part, changes):
        """One violation, and its text has `part`."""
        found = self.violations(changes)
        self.assertEqual(len(found), 1, found)
        self.assertIn(part, found[0])

    def test_a_good_tree_has_no_violations(self):
        self.assertEqual(self.violations({}), [])

    def test_upward_dependency(self):
        self.expect(
            "core_math depends on flatlight::core_scene, which is not in a lower layer",
            {"core/math/CMakeLists.txt": "flatlight_library(core_math HEADERS vec.h DEPS flatlight::core_scene)\n"},
        )

    def test_dependency_between_folders_of_one_layer(self):
        self.expect(
            "core_plane depends on flatlight::core_space",
            {
                "core/plane/CMakeLists.txt": "flatlight_library(core_plane HEADERS plane.h\n"
                "  DEPS flatlight::core_scene PRIVATE_DEPS flatlight::core_space)\n"
            },
        )

    def test_plane_includes_space(self):
        self.expect(
            '#include "core/space/space.h": flatlight::core_space is not in the DEPS of core_plane',
            {"core/plane/plane.h": header("core/plane/plane.h", '"core/space/space.h"')},
        )

    def test_folder_without_a_layer(self):
        self.expect(
            "core_magic is in no layer", {"core/magic/CMakeLists.txt": "flatlight_library(core_magic HEADERS magic.h)\n"}
        )

    def test_parent_relative_include(self):
        self.expect(
            "name the header from the root",
            {"core/scene/scene.cc": source('"core/scene/scene.h"', '"../math/vec.h"')},
        )

    def test_include_relative_to_the_folder(self):
        self.expect("no such file", {"core/scene/scene.cc": source('"scene.h"')})

    def test_include_of_a_header_that_is_gone(self):
        self.expect("no such file", {"core/scene/scene.cc": source('"core/scene/old.h"')})

    def test_quotes_are_fine_for_other_libraries(self):
        self.assertEqual(self.violations({"core/scene/scene.cc": source('"absl/status/status.h"')}), [])

    def test_own_header_in_angle_brackets(self):
        self.expect('included with ""', {"core/scene/scene.cc": source("<core/math/vec.h>")})

    def test_internal_header_of_another_folder(self):
        self.expect(
            "only core/math and its tests may include it",
            {"core/scene/scene.cc": source('"core/math/internal/split.h"')},
        )

    def test_include_through_a_dependency_of_a_dependency(self):
        self.expect(
            "flatlight::core_math is not in the DEPS of core_plane",
            {"core/plane/plane.h": header("core/plane/plane.h", '"core/math/vec.h"')},
        )

    def test_core_includes_protobuf(self):
        self.expect(
            "core knows neither protobuf nor gRPC",
            {"core/math/vec.h": header("core/math/vec.h", "<google/protobuf/message.h>")},
        )

    def test_core_links_protobuf(self):
        self.expect(
            "core knows neither protobuf nor gRPC",
            {"core/math/CMakeLists.txt": "flatlight_library(core_math HEADERS vec.h DEPS flatlight::proto)\n"},
        )

    def test_store_includes_grpc(self):
        self.expect(
            "only the service and the app know gRPC",
            {"server/store/store.h": header("server/store/store.h", "<grpcpp/server.h>")},
        )

    def test_store_includes_generated_services(self):
        self.expect(
            "only the service and the app know gRPC",
            {"server/store/store.h": header("server/store/store.h", '"flatlight/v1/render_service.grpc.pb.h"')},
        )

    def test_client_links_core(self):
        self.expect(
            "the client links no core and no server",
            {
                "client/cli/CMakeLists.txt": "flatlight_program(flatlight SOURCES main.cc\n"
                "  DEPS flatlight::proto flatlight::core_math)\n"
            },
        )

    def test_core_links_cgal(self):
        self.expect(
            "core_math links CGAL::CGAL; only tests/bench/peers may",
            {"core/math/CMakeLists.txt": "flatlight_library(core_math HEADERS vec.h PRIVATE_DEPS CGAL::CGAL)\n"},
        )

    def test_a_test_links_cgal_through_the_peers(self):
        self.expect(
            "links flatlight::bench_peers_cgal, and so CGAL",
            {
                "tests/core/math/CMakeLists.txt": "flatlight_test(vec_test\n"
                "  DEPS flatlight::core_math flatlight::bench_peers_cgal LABELS unit)\n"
            },
        )

    def test_client_links_server_later(self):
        text = good_tree()["client/cli/CMakeLists.txt"]
        text += "target_link_libraries(flatlight PRIVATE flatlight::server_store)\n"
        self.expect("the client links no core and no server", {"client/cli/CMakeLists.txt": text})

    def test_shipped_code_links_tests(self):
        self.expect(
            "only tests link tests",
            {
                "tests/support/CMakeLists.txt": "flatlight_library(support HEADERS)\n",
                "client/cli/CMakeLists.txt": "flatlight_program(flatlight SOURCES main.cc\n"
                "  DEPS flatlight::proto flatlight::support)\n",
            },
        )

    def test_two_modules_link_openimageio(self):
        library = "add_library({0} MODULE {0}.cc)\ntarget_link_libraries({0} PRIVATE PkgConfig::OpenImageIO)\n"
        self.expect(
            "only one module may link it",
            {
                "client/a/CMakeLists.txt": library.format("a"),
                "client/a/a.cc": source(),
                "client/b/CMakeLists.txt": library.format("b"),
                "client/b/b.cc": source(),
            },
        )

    def test_file_that_nobody_compiles(self):
        self.expect("no CMakeLists.txt names this file", {"tests/core/math/old_test.cc": source()})

    def test_header_without_a_target(self):
        self.expect(
            "no target is in the folder of this header",
            {"tests/support/status.h": header("tests/support/status.h", '"core/math/vec.h"')},
        )

    def test_wrong_include_guard(self):
        self.expect(
            "FLATLIGHT_CORE_SPACE_SPACE_H_", {"core/space/space.h": header("core/plane/space.h")}
        )

    def test_guard_of_vector_code_toggles(self):
        text = header("core/space/walk-inl.h").replace("WALK-INL", "WALK_INL")
        guard = "FLATLIGHT_CORE_SPACE_WALK_INL_H_"
        self.expect(guard, {"core/space/walk-inl.h": text})
        toggling = text.replace(f"#ifndef {guard}\n", f"#ifdef {guard}\n#undef {guard}\n#else\n")
        self.assertNotIn(guard, "\n".join(self.violations({"core/space/walk-inl.h": toggling})))

    def test_missing_licence(self):
        self.expect("the first line should be the licence", {"tests/core/math/make.py": "print()\n"})

    def test_long_file(self):
        self.expect("split it", {"core/scene/scene.cc": source() + "//\n" * check_tree.MAX_LINES})


if __name__ == "__main__":
    unittest.main()
