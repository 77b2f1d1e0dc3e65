#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests that the launcher offers every option that a program offers to it, checks its values, and passes it on.

Needs the lists of options beside the built programs. usage: program_options_test.py
"""

import contextlib
import io
import os
import pathlib
import subprocess
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "support"))
from launcher_fixture import BIN, ROOT, LauncherTest
from base import program_options
from base.bad_input import BadInput
from base.command_line import Parser
from base.program_options import MASTER, NODE, PROGRAMS, SERVER


def good_value(option):
    """Returns a value that the program takes, or None for a flag."""
    if option["kind"] == "flag":
        return None
    if "values" in option:
        return option["values"][-1]
    if option["kind"] == "text":
        return "some.0"
    bounds = [option[key] for key in ("most", "least") if key in option]
    return str(program_options.whole(bounds[0])) if bounds else "7"


def parser_of(command):
    parser = Parser(prog="p")
    program_options.add(parser, command)
    return parser


class Offered(unittest.TestCase):
    def test_each_is_taken_and_passed_on_to_every_program_that_has_it(self):
        tried = 0
        for command in ("run", "film", "doctor"):
            for program in PROGRAMS:
                for option in program_options.offered(command, program):
                    value = good_value(option)
                    words = [option["name"]] + ([] if value is None else [value])
                    with self.subTest(f"{command}: {program} {words}"):
                        args = parser_of(command).parse_args(words)
                        passed = program_options.words(args, command, program)
                        self.assertEqual(passed[passed.index(option["name"]):][:len(words)], words)
                        tried += 1
        self.assertGreater(tried, 30)

    def test_nothing_is_passed_on_that_is_not_given_and_has_no_default(self):
        args = parser_of("run").parse_args([])
        self.assertEqual(program_options.words(args, "run", SERVER), ["--pace", "realtime"])
        self.assertEqual(program_options.words(args, "run", NODE)[:2], ["--gl", "auto"])

    def test_a_list_is_passed_on_one_by_one(self):
        args = parser_of("run").parse_args(["--show", "force", "--show", "help", "--map", "a=1"])
        words = program_options.words(args, "run", MASTER)
        self.assertEqual([words[i + 1] for i, word in enumerate(words) if word == "--show"], ["force", "help"])

    def test_every_bound_and_every_name_is_checked(self):
        for option in (option for program in PROGRAMS for option in program_options.offered("run", program)):
            bad = ["no such"] if "values" in option else []
            bad += [str(option["most"] + 1)] if "most" in option else []
            bad += [str(option["least"] - 1)] if "least" in option else []
            bad += ["0"] if option.get("above") == 0 else []
            bad += ["nan", "many"] if option["kind"] in ("integer", "number") else []
            for value in bad:
                said = io.StringIO()
                with self.subTest(f"{option['name']}={value}"), contextlib.redirect_stderr(said), self.assertRaises(SystemExit) as ended:
                    parser_of("run").parse_args([f"{option['name']}={value}"])
                self.assertEqual((ended.exception.code, said.getvalue().count("\n")), (2, 1))
                self.assertIn(option["name"], said.getvalue())

    def test_options_that_exclude_each_other_are_refused_together(self):
        with contextlib.redirect_stderr(io.StringIO()) as said, self.assertRaises(SystemExit):
            parser_of("run").parse_args(["--steps", "1", "--frames", "1"])
        self.assertIn("not allowed with argument --steps", said.getvalue())


class Devices(LauncherTest):
    def setUp(self):
        super().setUp()
        folder = os.getcwd()
        self.addCleanup(os.chdir, folder)
        os.chdir(self.folder)

    def test_known_strokes_are_a_device(self):
        self.assertEqual(program_options.device("script:stroke"), f"script:{ROOT / 'haptic_bridge' / 'devices' / 'stroke.strokes'}")
        (self.folder / "stroke").write_text("")
        for spec in ("script:stroke", "script:gis", "script:none.strokes", "script:no/such", "spacenav", "spacenav:./my_spnav.so",
                     "driver:./my.so:what", "sim:touch", "trace:hand.csv", "pointer", "none"):
            self.assertEqual(program_options.device(spec), spec)

    def test_an_unknown_device_names_the_known_ones(self):
        with self.assertRaisesRegex(BadInput, "^giss: no file and no known name; strokes .*: ellipses, .*, stroke$"):
            program_options.device("script:giss")
        with self.assertRaisesRegex(BadInput, "--device pointer"):
            program_options.device("mouse")


class WithoutABuild(LauncherTest):
    def test_one_line_says_how_to_build(self):
        for options in (self.folder / "bin").glob("*.json"):
            options.unlink()
        for words in (["run", "--help"], ["doctor"], ["film", "--help"]):
            ended = subprocess.run([ROOT / "scripts" / "sandwall", *words], env=self.environment, text=True, capture_output=True, timeout=60)
            self.assertEqual((ended.returncode, ended.stdout), (2, ""))
            self.assertRegex(ended.stderr, r"\Asandwall: .*/bin/sandwall-\S+\.json: no list of options of this build; run cmake --build \S+\n\Z")
        ended = subprocess.run([ROOT / "scripts" / "sandwall", "--help"], env=self.environment, text=True, capture_output=True, timeout=60)
        self.assertEqual((ended.returncode, ended.stderr), (0, ""))

    def test_every_program_lists_its_options(self):
        for name in ("master", "render-node", "haptic-server", "replay", "relax", "check", "compare", "track", "watch"):
            self.assertTrue((BIN / f"sandwall-{name}.json").is_file(), name)


if __name__ == "__main__":
    unittest.main()
