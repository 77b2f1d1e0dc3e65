#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests that code for newer processors shares no function with other code of a program.

If two objects have the same inline function, the linker keeps one copy for both. The copy of x86-64-v4 would then end every
program on an older processor.

usage: kernels_test.py BUILD_FOLDER
"""

import pathlib
import re
import subprocess
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[3]
BUILD = pathlib.Path(sys.argv.pop(1)).resolve() if len(sys.argv) > 1 else ROOT / "build" / "release"
SHARED = re.compile(r"^\S* *[uVvWw] (.*)$")  # kinds of symbols of which a linker keeps one copy


def shared(text, path):
    """Returns the symbols in the output of nm that are outside the namespace of their code path."""
    found = (SHARED.match(line) for line in text.splitlines())
    return [match[1] for match in found if match and f"::{path}::" not in match[1]]


class Kernels(unittest.TestCase):
    def test_every_function_of_a_kernel_is_in_the_namespace_of_its_path(self):
        for path in ("v3", "v4"):
            objects = sorted(BUILD.glob(f"**/*_{path}.dir/**/*.o"))
            self.assertTrue(objects, f"{BUILD} has no code for {path}; build it")
            for name in objects:
                text = subprocess.run(["nm", "-C", "--defined-only", name], capture_output=True, text=True, check=True).stdout
                self.assertIn(f"::{path}::", text, f"{name} has no code of its own")
                self.assertEqual(shared(text, path), [], name)

    def test_a_shared_function_is_found(self):
        text = "0000000000000000 W sand::grid::v4::sweep(int)\n0000000000000000 W int const& std::max<int>(int const&, int const&)\n"
        self.assertEqual(shared(text, "v4"), ["int const& std::max<int>(int const&, int const&)"])


if __name__ == "__main__":
    unittest.main()
