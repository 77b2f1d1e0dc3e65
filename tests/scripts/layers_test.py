#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests that each folder includes only folders that it may include, and that the check finds a wrong include.

usage: layers_test.py BUILD_FOLDER
"""

import copy
import pathlib
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
BUILD = pathlib.Path(sys.argv.pop(1)).resolve() if len(sys.argv) > 1 else ROOT / "build" / "release"
sys.path.insert(0, str(ROOT / "scripts" / "checks"))
import layers  # noqa: E402

PROJECT = layers.Project.of(ROOT, BUILD)


def changed(more):
    """Returns the faults of the project with changed or additional sources. A text of None removes a source."""
    project = copy.deepcopy(PROJECT)
    sources = {**project.sources, **more}
    sources = {path: text for path, text in sources.items() if text is not None}
    other = layers.Project(sources, project.targets)
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

    def test_a_source_away_from_its_header_is_named(self):
        self.assertIn("sand/model/erosion.cpp: implements sand/grid/erosion.hpp and is in another folder",
                      changed({"sand/model/erosion.cpp": PROJECT.sources["sand/grid/erosion.cpp"]}))

    def test_a_private_header_is_for_its_folder_and_its_tests(self):
        name = "sand/grid/erosion_kernel.hpp"
        self.assertIn(f"sand/replica.cpp: includes {name}, which is private to its folder",
                      changed(including("sand/replica.cpp", name)))
        self.assertEqual(changed(including("tests/sand/grid/settle_test.cpp", name)), [])

    def test_a_crowded_folder_is_named(self):
        more = {f"examples/much/part_{i}.cpp": "" for i in range(layers.MOST_SOURCES + 1)}
        self.assertEqual(changed(more), ["examples/much: holds 26 sources, more than 25; divide it"])

    def test_a_source_of_no_library_is_named(self):
        self.assertEqual(changed({"dust/grain.cpp": ""}),
                         ["dust/grain.cpp: no library of the project holds it; add it to a CMakeLists.txt"])

    def test_the_force_loop_and_a_replay_of_it_link_no_network(self):
        network = {"haptic_link", "haptic_client", "haptic_server"}  # without asio, because host/ uses its thread pool
        for name in ("haptic_loop", "sandwall-replay"):
            self.assertIn("haptic_hand", linked(name))
            self.assertEqual(linked(name) & network, set(), name)
        self.assertIn("haptic_link", linked("haptic_server"))

    def test_the_drawing_is_of_these_arrows(self):
        drawn = layers.fingerprint(PROJECT) in (ROOT / "docs" / "layers.svg").read_text()
        self.assertTrue(drawn, "run scripts/checks/layers.py build/release --svg docs/layers.svg")


if __name__ == "__main__":
    unittest.main()
