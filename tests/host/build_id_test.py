#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests that the build id follows the code that ranks run, and no path.

usage: build_id_test.py BUILD_FOLDER CMAKE
"""

import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
BUILD, CMAKE = pathlib.Path(sys.argv[1]).resolve(), sys.argv[2]
del sys.argv[1:3]
MANIFEST = BUILD / "host" / "identified.txt"


def identified():
    return [line.removeprefix("file ") for line in MANIFEST.read_text().splitlines() if line.startswith("file ")]


def of_the_sand_alone():
    """Returns whether this is a build without ranks (SANDWALL_SAND_ONLY). It identifies the haptic server and
    modules only."""
    return "flags sandwall-master " not in MANIFEST.read_text()


def build_id(root, manifest=MANIFEST):
    ended = subprocess.run([CMAKE, f"-DMANIFEST={manifest}", f"-DROOT={root}", "-P", ROOT / "cmake" / "build_id.cmake"],
                           capture_output=True, text=True, check=True)
    return ended.stderr.strip()


class BuildId(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="sandwall-build-id-")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def copy(self, name):
        """Copies the identified files into another folder, as in another clone."""
        for path in identified():
            (self.folder / name / path).parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(ROOT / path, self.folder / name / path)
        return self.folder / name

    def test_two_clones_have_the_id_of_this_build(self):
        ours = build_id(ROOT)
        self.assertRegex(ours, r"^[0-9a-f]{16}$")
        self.assertEqual([build_id(self.copy("one")), build_id(self.copy("two"))], [ours, ours])
        self.assertIn(f'"{ours}"', (BUILD / "host" / "build_id.cpp").read_text())
        self.assertNotIn(str(ROOT), MANIFEST.read_text())

    def test_a_changed_constant_in_the_erosion_of_a_tin_changes_it(self):
        clone = self.copy("changed")
        before = build_id(clone)
        source = clone / "sand/tin/flow/weights.cpp"
        text, changes = re.subn(r"(constexpr \w+ \w+ = \d)", r"\g<1>1", source.read_text(), count=1)
        self.assertEqual(changes, 1, "found no constant in this file; name another one in this test")
        source.write_text(text)
        self.assertNotEqual(build_id(clone), before)

    def test_every_source_a_header_a_shader_and_a_flag_change_it(self):
        clone = self.copy("changed")
        before = build_id(clone)
        for path in ("sand/grid/erosion.hpp", "haptic_bridge/client/connection_thread.cpp", "host/worker_pool.cpp", "tracking/dtrack.cpp",
                     "render_node/gl/osmesa.cpp", "render_node/shaders/sand.frag.glsl", "scene/gdal/gdal_raster.cpp",
                     "haptic_bridge/link/security_openssl.cpp", "render_node/gl/glfw_window.cpp"):
            if of_the_sand_alone() and not (clone / path).exists():
                continue
            text = (clone / path).read_text()
            (clone / path).write_text(text + "\n")
            self.assertNotEqual(build_id(clone), before, path)
            (clone / path).write_text(text)
        self.assertEqual(build_id(clone), before)
        manifest = self.folder / "identified.txt"
        manifest.write_text(MANIFEST.read_text().replace("-ffp-contract=off", "-ffp-contract=fast", 1))
        self.assertNotEqual(build_id(clone, manifest), before)

    def test_flags_count_unless_they_are_warnings_debug_information_or_paths(self):
        flags = ["-O2", "-Wall", "-g1", "-I/opt/inc", "-isystem", "/opt/sys", "-ffile-prefix-map=/a/b=.", "-mavx2",
                 "-fdebug-prefix-map=/a=.", "-Wp,-D_GLIBCXX_ASSERTIONS", "-DX=1", "-ffile-compilation-dir=/a",
                 "-fdiagnostics-color", "-fsanitize=address"]
        script = self.folder / "flags.cmake"
        script.write_text(f'include("{ROOT}/cmake/BuildId.cmake")\nset(flags "{";".join(flags)}")\n'
                          'set(PROJECT_SOURCE_DIR /a/b)\nset(PROJECT_BINARY_DIR /a/b/build)\n'
                          'list(APPEND flags "-DDIR=/a/b")\nsandwall_keep_code_flags(flags)\nmessage("${flags}")\n')
        said = subprocess.run([CMAKE, "-P", script], capture_output=True, text=True, check=True).stderr.strip()
        self.assertEqual(said.split(";"), ["-O2", "-mavx2", "-Wp,-D_GLIBCXX_ASSERTIONS", "-DX=1", "-fsanitize=address",
                                           "-DDIR=SOURCE"])

    def test_nothing_that_a_rank_is_compiled_from_is_left_out(self):
        """Compares the identified files with the files that the compiler has read, as ninja has recorded them."""
        if not (BUILD / "bin" / "sandwall-master").exists() or not (BUILD / "build.ninja").exists():
            return  # a build of the sand alone has no ranks
        said = subprocess.run(["ninja", "-C", BUILD, "-t", "deps"], capture_output=True, text=True, check=True).stdout
        read, of_a_rank = set(), False
        # There is a block per object: its path, then the indented files from which it was compiled.
        for line in said.splitlines():
            if line and not line.startswith(" "):
                path = line.split(":")[0]
                of_a_rank = "CMakeFiles/" in path and not path.startswith(("tests/", "bench/"))
                of_a_rank = of_a_rank and any(f"CMakeFiles/{target}.dir/" in path for target in self.targets())
            elif of_a_rank and line.strip():
                path = pathlib.Path(BUILD, line.strip()).resolve()
                if path.is_relative_to(ROOT) and not path.is_relative_to(ROOT / "build") and not path.is_relative_to(BUILD):
                    read.add(str(path.relative_to(ROOT)))
        self.assertGreater(len(read), 200)
        self.assertEqual(sorted(read - set(identified())), [])

    @staticmethod
    def targets():
        return [line.split()[1] for line in MANIFEST.read_text().splitlines()
                if line.startswith("flags ") and not line.startswith("flags of ")]


if __name__ == "__main__":
    unittest.main()
