#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests `sandwall --version`, which asks made-up programs.

usage: programs_test.py
"""

import json
import pathlib
import subprocess
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from launcher_fixture import ROOT, LauncherTest

NAMES = ("master", "render-node", "haptic-server", "check")  # the made-up programs, in the launcher's order


class Versions(LauncherTest):
    def setUp(self):
        super().setUp()
        for name in NAMES:
            self.answer(name, {"program": f"sandwall-{name}", "version": "1.2.3", "build": "b1", "compiler": "g++ 12"})

    def answer(self, name, value):
        self.script(f"sandwall-{name}", f"#!/bin/sh\n[ \"$*\" = '--version --json' ] && cat <<'END'\n{json.dumps(value)}\nEND\n")

    def ask(self, *options):
        return subprocess.run([str(ROOT / "scripts" / "sandwall"), "--version", *options], env=self.environment, text=True,
                              capture_output=True, timeout=60, stdin=subprocess.DEVNULL)

    def test_of_one_build_are_printed_in_a_line_each(self):
        ended = self.ask()
        self.assertEqual((ended.returncode, ended.stderr), (0, ""))
        self.assertEqual(ended.stdout.splitlines(), [f"sandwall-{name} 1.2.3, build b1, compiler g++ 12" for name in NAMES])
        found = json.loads(self.ask("--json").stdout)
        self.assertEqual((found["version"], found["build"], len(found["programs"])), ("1.2.3", "b1", 4))

    def test_of_several_builds_are_an_error(self):
        self.answer("render-node", {"program": "sandwall-render-node", "version": "1.2.3", "build": "b2"})
        ended = self.ask()
        self.assertEqual(ended.returncode, 1)
        self.assertIn("the programs are of several builds", ended.stderr)
        self.assertIn("sandwall-render-node 1.2.3, build b2\n", ended.stdout)
        self.assertIsNone(json.loads(self.ask("--json").stdout)["build"])

    def test_of_a_program_that_answers_something_else_are_refused_in_one_line(self):
        for bad in (["program", "version", "build"], {"program": "sandwall-master", "version": "1.2.3"},
                    {"program": "sandwall-master", "version": 1, "build": "b1"}, None):
            with self.subTest(bad=bad):
                self.answer("master", bad)
                ended = self.ask()
                self.assertEqual((ended.returncode, ended.stdout), (2, ""))
                self.assertRegex(ended.stderr, r"\A[^\n]*/sandwall-master: does not answer --version --json; [^\n]+\n\Z")


if __name__ == "__main__":
    unittest.main()
