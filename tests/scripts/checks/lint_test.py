#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests that scripts/lint.sh checks every folder of the project.

usage: lint_test.py BUILD_FOLDER, of a build with CMAKE_EXPORT_COMPILE_COMMANDS
"""

import json
import pathlib
import re
import subprocess
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[3]
BUILD = pathlib.Path(sys.argv.pop(1) if len(sys.argv) > 1 else ROOT / "build" / "release")


def tracked(*patterns):
    """Returns tracked paths, relative to the root of the repository."""
    listed = subprocess.run(["git", "ls-files", "-z", *patterns], cwd=ROOT, capture_output=True, check=True, text=True)
    return [pathlib.PurePath(name) for name in listed.stdout.split("\0") if name]


def linted():
    """Returns the sources that run-clang-tidy selects: compiled ones that match the pattern in scripts/lint.sh."""
    script = (ROOT / "scripts" / "lint.sh").read_text()
    pattern = re.search(r'^every_source="([^"]+)"$', script, re.MULTILINE)[1].replace("$here", re.escape(str(ROOT)))
    compiled = json.loads((BUILD / "compile_commands.json").read_text())
    found = set()
    for command in compiled:
        path = pathlib.Path(command["directory"], command["file"])
        if path.parent.name == "Unity":
            # A unity source includes the sources that scripts/lint.sh, without unity builds, compiles one by one.
            found |= set(re.findall(r'#include "(/[^"]+)"', path.read_text()))
        else:
            found.add(str(path))
    # The checkout may be reached by a link. scripts/lint.sh and ROOT have the path without links.
    found = {str(pathlib.Path(path).resolve()) for path in found}
    return {pathlib.Path(path).relative_to(ROOT) for path in found if re.search(pattern, path)}


class Lint(unittest.TestCase):
    def test_every_folder_with_sources_has_one_that_is_linted(self):
        folders = {path.parts[0] for path in tracked("*.cpp")}
        self.assertEqual(folders - {path.parts[0] for path in linted()}, set())

    def test_every_source_is_linted(self):
        self.assertEqual(set(map(pathlib.Path, tracked("*.cpp"))) - linted(), set())

    def test_headers_of_every_folder_pass_the_filter(self):
        header_filter = re.search(r"^HeaderFilterRegex: '(.*)'$", (ROOT / ".clang-tidy").read_text(), re.MULTILINE)[1]
        for path in tracked("*.hpp"):
            self.assertRegex(str(ROOT / path), header_filter)

    def test_nothing_that_is_built_is_linted(self):
        self.assertEqual([path for path in linted() if path.parts[0] == "build"], [])


if __name__ == "__main__":
    unittest.main()
