#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests that every patch of tests/mutations applies, and names a test program and tests that exist.

usage: mutations_test.py
"""

import fnmatch
import re
import subprocess
import unittest

from docs_test import PROJECT, ROOT, tracked

HEADER = re.compile(r"\A# (?P<what>[A-Z].*\.)\n# tests: (?P<program>\w+) (?P<filter>\S+)\n(# programs: [\w -]+\n)?(?=diff --git |--- a/)")
PROGRAMS = {name for file in tracked("tests/*CMakeLists.txt")
            for name in re.findall(r"^ *sandwall_test\((\w+)", (ROOT / file).read_text(), re.MULTILINE)}


def faults(name, text, tests, applies):
    header = HEADER.match(text)
    if header is None:
        yield f"{name}: must begin with the lines '# What is wrong.' and '# tests: PROGRAM FILTER'"
        return
    if header["program"] not in PROGRAMS:
        yield f"{name}: there is no test program {header['program']}"
    for pattern in header["filter"].split(":"):
        # The full name of a test with parameters has an instance in front and a parameter at the end.
        if not any(fnmatch.fnmatchcase(test, pattern) or fnmatch.fnmatchcase(f"x/{test}/x", pattern) for test in tests):
            yield f"{name}: the filter {pattern} runs no test"
    if not applies(text):
        yield f"{name}: no longer applies; make it again from the current source"


def applies(text):
    return subprocess.run(["git", "apply", "--check", "-"], cwd=ROOT, input=text, text=True, capture_output=True).returncode == 0


class Mutations(unittest.TestCase):
    def test_apply_and_name_their_tests(self):
        names = tracked("tests/mutations/*.patch")
        self.assertGreaterEqual(len(names), 12)
        found = [fault for name in names for fault in faults(name, (ROOT / name).read_text(), PROJECT.all_tests(), applies)]
        self.assertEqual(found, [])

    def test_that_do_not_are_named(self):
        good = "# Sand falls up.\n# tests: sand_tests Law.*:x/Law.Holds/*\ndiff --git a/a b/a\n"
        self.assertEqual(list(faults("a", good, {"Law.Holds"}, lambda _: True)), [])
        for bad in (good.replace("Sand", "sand"), good.replace("tests: sand_tests", "test:"), good.replace("sand_tests", "sad_tests"),
                    good.replace("Law.*", "Rule.*"), good.replace("# Sand falls up.\n", "")):
            self.assertEqual(len(list(faults("a", bad, {"Law.Holds"}, lambda _: True))), 1, bad)
        self.assertEqual(len(list(faults("a", good, {"Law.Holds"}, lambda _: False))), 1)


if __name__ == "__main__":
    unittest.main()
