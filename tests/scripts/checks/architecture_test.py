#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests that flags and intrinsics of one kind of processor stand in the named files alone, so that all others compile on any."""

import pathlib
import re
import subprocess
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from launcher_fixture import ROOT

# Each file, and why it must know the processor.
NAMED = {"base/code_path.hpp": "asks the processor for the instructions of x86-64-v3 and v4",
         "base/float_register.hpp": "reads and writes the register of the float arithmetic",
         "CMakeLists.txt": "the flags of x86-64-v3 and v4, for the inner loops",
         "cmake/Arm64.cmake": "the cross compiler",
         "base/float_environment.cpp": "WebAssembly has no such register",
         "sand/grid/dual_kernel.hpp": "WebAssembly has one version of each kernel",
         "sand/grid/erosion_kernel.hpp": "the same",
         "sand/model/tool_kernel.hpp": "the same",
         "sand/tin/flow/sweep_kernel.hpp": "the same",
         "sand/CMakeLists.txt": "the same",
         "sand/grid/erosion_fluxes.hpp": "chooses the loops for WebAssembly",
         "sand/grid/erosion_loops.hpp": "leaves out the loops that it replaces",
         "sand/grid/erosion_short_run.hpp": "the same",
         "sand/grid/erosion_loops_wasm.hpp": "the loops for WebAssembly",
         "cmake/Web.cmake": "the flags of WebAssembly",
         "scene/CMakeLists.txt": "ends where a page needs no more",
         "haptic_bridge/CMakeLists.txt": "the same",
         "web/CMakeLists.txt": "the program for WebAssembly",
         "web/exported.hpp": "how its functions are exported"}
KNOWS = re.compile(r"[<\"][a-z]*intrin\.h|\b_mm[0-9]*_|__m(128|256|512)|__builtin_(cpu_|ia32_)|\basm\b|__(x86_64|aarch64|i386|arm|amd64|SSE|AVX|wasm)\w*\b|\bwasm_\w+|EMSCRIPTEN|"
                   r"-m(simd128|arch|tune|fma|avx|sse|cpu)\b|aarch64|cpuid")


def sources():
    listed = subprocess.run(["git", "ls-files", "--cached", "--others", "--exclude-standard", "*.cpp", "*.hpp", "*.c", "*.h", "*.cmake",
                             "*CMakeLists.txt", "CMakePresets.json"], cwd=ROOT, capture_output=True, text=True, check=True)
    return [name for name in listed.stdout.split() if (ROOT / name).exists()]


def code_of(name):
    """Returns the lines of a file without comments, with their numbers."""
    lines = (ROOT / name).read_text(encoding="utf-8").split("\n")
    end = "#" if name.endswith((".txt", ".cmake")) else "//"
    return [(number, line.split(end)[0] if "include" not in line else line) for number, line in enumerate(lines, start=1)]


class Architecture(unittest.TestCase):
    def test_only_the_named_files_know_the_processor(self):
        found = {}
        for name in sources():
            for number, line in code_of(name):
                if KNOWS.search(line):
                    found.setdefault(name, []).append(f"{name}:{number}: {line.strip()}")
        self.assertEqual([places[0] for name, places in found.items() if name not in NAMED], [])
        self.assertEqual(sorted(found), sorted(NAMED), "a file of the list has nothing to do with the processor any more")


if __name__ == "__main__":
    unittest.main()
