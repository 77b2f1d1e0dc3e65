#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests that each folder includes only folders that it may include, and that the check finds a wrong include.

usage: layers_test.py BUILD_FOLDER
"""

import copy
import pathlib
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[3]
BUILD = pathlib.Path(sys.argv.pop(1)).resolve() if len(sys.argv) > 1 else ROOT / "build" / "release"
sys.path.insert(0, str(ROOT / "scripts" / "checks"))
import layers  # noqa: E402
import product  # noqa: E402

PROJECT = layers.Project.of(ROOT, BUILD)


def changed(more, others=()):
    """Returns the faults of the project with changed or additional sources. A text of None removes a source.

    `others` are additional sources in other languages.
    """
    project = copy.deepcopy(PROJECT)
    sources = {**project.sources, **more}
    sources = {path: text for path, text in sources.items() if text is not None}
    other = layers.Project(sources, project.targets, [*project.others, *others])
    return layers.faults(other)


def including(path, name):
    return {path: PROJECT.sources[path] + f'\n#include "{name}"\n'}


def linked(name):
    """Returns all libraries that a target links, with the PRIVATE links of its libraries."""
    found, waiting = set(), [name]
    while waiting:
        target = PROJECT.targets.get(waiting.pop(), {"link_libraries": []})
        more = set(target["link_libraries"]) - found
        found |= more
        waiting += more
    return found


class Layers(unittest.TestCase):
    def test_the_folders_of_the_product_are_those_of_its_targets(self):
        tops = {source.partition("/")[0] for target in PROJECT.targets.values() for source in target["sources"] if source in PROJECT.sources}
        self.assertEqual(set(product.folders()), tops - set(product.AROUND))

    def test_no_file_includes_what_its_folder_may_not(self):
        self.assertEqual(layers.faults(PROJECT), [])

    def test_a_wrong_include_is_named(self):
        self.assertIn("sand/grid/erosion.cpp: includes host/whole_file.hpp of host, which sand_grid does not link at all",
                      changed(including("sand/grid/erosion.cpp", "host/whole_file.hpp")))
        self.assertIn("scene/load/scene_file.hpp: includes master/session.hpp of master, which scene_load does not link "
                      "PUBLIC, as a header needs", changed(including("scene/load/scene_file.hpp", "master/session.hpp")))

    def test_a_circle_of_folders_within_a_library_is_named(self):
        found = changed(including("sand/tin/mesh/mesh.cpp", "sand/tin/refine/coarsening.hpp"))
        self.assertIn("sand/tin/mesh -> sand/tin/refine -> sand/tin/mesh: a circle of folders, closed by "
                      "sand/tin/refine/coarsening.hpp that includes sand/tin/mesh/neighbourhood.hpp", found)

    def test_a_circle_of_benchmarks_is_named(self):
        found = changed(including("bench/report/csv.cpp", "bench/sand/piles.hpp"))
        self.assertEqual(found, ["bench/report -> bench/sand -> bench/report: a circle of folders, closed by "
                                 "bench/sand/bounds.cpp that includes bench/report/curves.hpp"])

    def test_a_circle_of_tests_is_named(self):
        found = changed(including("tests/support/seed.hpp", "tests/master/journal/keeper_fixture.hpp"))
        self.assertEqual(len(found), 1)
        self.assertIn("tests/support -> tests/master/journal -> tests/support: a circle of folders", found[0])

    def test_a_subfolder_that_includes_the_folder_above_is_named(self):
        for path, name in (("sand/force/surface_patch.cpp", "sand/replica.hpp"), ("bench/sand/parts.cpp", "bench/bench.hpp"),
                           ("render_node/tool/reach.cpp", "render_node/redraw.hpp"),
                           ("tests/master/steps/live_steps_test.cpp", "tests/master/steps.hpp")):
            with self.subTest(path):
                below, above = path.rpartition("/")[0], name.rpartition("/")[0]
                found = changed({name: PROJECT.sources.get(name, ""), **including(path, name)})
                self.assertTrue(any(f"{below} -> {above}: a circle of folders, closed by {path} that includes {name}" in fault
                                    for fault in found), found)

    def test_a_subfolder_that_reaches_the_folder_above_through_another_is_named(self):
        found = changed({"examples/a/own.hpp": "", "examples/a/below/child.hpp": '#include "examples/other/aside.hpp"',
                         "examples/other/aside.hpp": '#include "examples/a/own.hpp"'})
        self.assertEqual(len(found), 1)
        self.assertIn("examples/a -> examples/a/below -> examples/other -> examples/a: a circle of folders", found[0])

    def test_a_folder_may_include_its_subfolders(self):
        self.assertEqual(changed(including("sand/replica.cpp", "sand/grid/erosion.hpp")), [])
        self.assertEqual(changed(including("bench/sandwall_bench.cpp", "bench/report/timing.hpp")), [])

    def test_a_header_with_the_name_of_another_type_is_named(self):
        text = "namespace master {\n\nclass Sieve final : public Grid {\npublic:\n    void shake();\n};\n\n}\n"
        self.assertEqual(changed({"master/journal/riddle.hpp": text}),
                         ["master/journal/riddle.hpp: declares Sieve alone; name the header by it"])
        for allowed in ("master/journal/sieve.hpp", "master/sieves/sieve.hpp"):
            self.assertEqual(changed({allowed: text}), [])
        for own in ("TinMesh", "MeshTin"):
            self.assertEqual(list(layers.misnamed(layers.Project({"a/tin/mesh.hpp": f"struct {own} {{\n"}, {}))), [])
        both = text.replace("}\n", "}\n[[nodiscard]] Sieve sieveOf(int width);\n")
        self.assertEqual(changed({"master/journal/riddle.hpp": both}), [])

    def test_a_header_in_the_namespace_of_another_folder_is_named(self):
        for path, text, own in (("master/journal/sieve.hpp", "namespace journal {\n}\n", "master"),
                                ("sand/tin/mesh/sieve.hpp", "namespace sand {\n}\n", "sand::tin"),
                                ("scene/relax/sieve.hpp", "namespace scene {\n}\n", "scene::relax")):
            self.assertEqual(changed({path: text}), [f"{path}: is in another namespace than {own}"])
        self.assertEqual(changed({"sand/model/sieve.hpp": "namespace sand {\n}\n"}), [])

    def test_a_source_away_from_its_header_is_named(self):
        self.assertIn("sand/model/erosion.cpp: implements sand/grid/erosion.hpp and is in another folder",
                      changed({"sand/model/erosion.cpp": PROJECT.sources["sand/grid/erosion.cpp"]}))

    def test_a_private_header_is_for_its_folder_and_its_tests(self):
        name = "sand/grid/erosion_kernel.hpp"
        self.assertIn(f"sand/replica.cpp: includes {name}, which is private to its folder",
                      changed(including("sand/replica.cpp", name)))
        self.assertEqual(changed(including("tests/sand/grid/settle_test.cpp", name)), [])

    def test_a_crowded_folder_is_named(self):
        numbers = range(layers.MOST_SOURCES + 1)
        for ending in ("cpp", "hpp"):
            self.assertEqual(changed({f"examples/much/part_{i}.{ending}": "" for i in numbers}),
                             [f"examples/much: holds 26 sources *.{ending}, more than 25; divide it"])
        for ending in layers.OTHER_LANGUAGES:
            self.assertEqual(changed({}, [f"examples/much/part_{i}.{ending}" for i in numbers]),
                             [f"examples/much: holds 26 sources *.{ending}, more than 25; divide it"])

    def test_a_header_and_its_source_count_once(self):
        pairs = {f"examples/much/part_{i}.{ending}": "" for i in range(layers.MOST_SOURCES) for ending in ("cpp", "hpp")}
        self.assertEqual(changed(pairs), [])

    def test_a_source_of_no_library_is_named(self):
        self.assertEqual(changed({"dust/grain.cpp": ""}),
                         ["dust/grain.cpp: no library of the project holds it; add it to a CMakeLists.txt"])

    def test_the_force_loop_and_a_replay_of_it_link_no_network(self):
        network = {"haptic_link", "haptic_client", "haptic_server"}  # without asio, because host/ uses its thread pool
        for name in ("haptic_loop", "sandwall-replay"):
            self.assertIn("haptic_hand", linked(name))
            self.assertEqual(linked(name) & network, set(), name)
        self.assertIn("haptic_link", linked("haptic_server"))

    def test_neither_the_journal_nor_the_master_links_the_force_loop(self):
        self.assertIn("haptic_loop", linked("sandwall-replay"))
        for name in ("journal_files", "sandwall-master"):
            self.assertIn("scene_load", linked(name))
            self.assertNotIn("haptic_loop", linked(name), name)

    def test_a_replica_with_its_journal_and_its_hand_links_neither_files_nor_threads_nor_sockets(self):
        pure = {"base", "shapes", "glm::glm", "sand", "sand_force", "sand_grid", "sand_model", "sand_tin", "scene_model", "scene_text", "journal", "haptic_hand",
                "fmt::fmt", "PkgConfig::XXHASH", "PkgConfig::ZSTD"}
        for name in ("journal", "haptic_hand", "scene_text", "web"):
            self.assertIn("scene_model", linked(name))
            self.assertEqual(linked(name) - pure, set(), name)
        self.assertIn("host", linked("journal_files"))

    def test_shapes_include_neither_opengl_nor_another_folder(self):
        path = "shapes/tool/mesh.cpp"
        for name in ("glad/gl.h", "GL/gl.h", "GLFW/glfw3.h", "fmt/format.h", "scene/model/scene.hpp"):
            with self.subTest(name):
                found = changed({path: PROJECT.sources[path] + f"\n#include <{name}>\n"})
                self.assertEqual(found, [f"{path}: includes {name}; shapes/ includes base/, sand/, glm/ and the standard library alone"])
        self.assertTrue(any("of render_gl, which shapes does not link" in fault
                            for fault in changed(including(path, "render_node/gl/solid_mesh.hpp"))))
        self.assertEqual(changed({path: PROJECT.sources[path] + "\n#include <glm/gtc/constants.hpp>\n#include <bit>\n"}), [])
        self.assertEqual(linked("shapes") - {"base", "sand_model", "glm::glm", "fmt::fmt", "PkgConfig::XXHASH", "PkgConfig::ZSTD"}, set())

    def test_the_drawing_is_of_these_arrows(self):
        drawn = layers.fingerprint(PROJECT) in (ROOT / "docs" / "layers.svg").read_text()
        self.assertTrue(drawn, "run scripts/checks/layers.py build/release --svg docs/layers.svg")


if __name__ == "__main__":
    unittest.main()
