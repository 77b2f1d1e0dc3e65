#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tries nan and inf on every option of the launcher and of the other scripts that takes a number.

The options come from the parser of the launcher and from the sources of the scripts. So a new option is tested too.
"""

import argparse
import contextlib
import importlib.machinery
import importlib.util
import io
import os
import pathlib
import re
import subprocess
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "scripts" / "launcher"))

from base.command_line import Parser, above, at_least, within

NOT_FINITE = ("nan", "NaN", "-nan", "inf", "-inf", "Infinity", "1e999")
OPTION = re.compile(r'add_argument\("(--[a-z-]+)", type=([^\n]+)')


def launcher():
    """Returns scripts/sandwall as a module."""
    loader = importlib.machinery.SourceFileLoader("sandwall", str(ROOT / "scripts" / "sandwall"))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader("sandwall", loader))
    loader.exec_module(module)
    return module


def parsers(parser):
    """Returns the parsers of all commands, by their words."""
    found = {}
    for action in parser._actions:
        if isinstance(action, argparse._SubParsersAction):
            for name, command in action.choices.items():
                found.update({(name, *words): inner for words, inner in {(): command, **parsers(command)}.items()})
    return found


def refusal(parser, words):
    """Returns exit status and error output of a command line; status None if the parser accepts it."""
    error = io.StringIO()
    try:
        with contextlib.redirect_stderr(error):
            parser.parse_args(words)
    except SystemExit as end:
        return end.code, error.getvalue()
    return None, error.getvalue()


def scripts_with_numbers():
    """Returns (script, option) for each option of a script with a type that is neither a path nor a text.

    Modules of the launcher are no scripts. Launcher tries their options.
    """
    listed = subprocess.run(["git", "ls-files", "*.py"], cwd=ROOT, text=True, capture_output=True).stdout.split()
    files = listed or [str(path.relative_to(ROOT)) for path in ROOT.glob("scripts/**/*.py")]
    return [(file, option) for file in files for option, kind in OPTION.findall((ROOT / file).read_text(encoding="utf-8"))
            if not kind.startswith(("pathlib.", "str")) and not file.startswith("scripts/launcher/")]


class Launcher(unittest.TestCase):
    def test_every_option_that_takes_a_number_refuses_what_is_not_finite(self):
        parser = launcher().options()
        tried = set()
        for words, command in parsers(parser).items():
            for action in command._actions:
                if action.type is None or not action.option_strings:
                    continue
                option = action.option_strings[0]
                tried.add(option)
                for text in NOT_FINITE:
                    status, error = refusal(parser, [*words, f"{option}={text}"])
                    self.assertEqual(status, 2, f"{words} {option}={text} {error}")
                    self.assertRegex(error, rf"\Asandwall {' '.join(words)}: argument {option}: "
                                            rf"(must be a finite number, got {text}|invalid int value: '{text}'); try --help\n\Z")
        self.assertLessEqual({"--force-scale", "--refresh", "--frame-timeout", "--checkpoint", "--restart-window", "--steps"}, tried)

    def test_numbers_have_the_bounds_of_the_programs(self):
        parser = launcher().options()
        session = ["run", "--wall", "w"]
        for option, good, bad, words in (("--force-scale", ("0", "1"), ("-1e-9", "1.0001"), "from 0 to 1"),
                                         ("--refresh", ("1", "1e3"), ("0.99", "-60"), "from 1 to 1000"),
                                         ("--frame-timeout", ("2", "3600"), ("1.9", "-1"), "from 2 to 3600")):
            for text in good:
                self.assertEqual(refusal(parser, [*session, f"{option}={text}"]), (None, ""))
            for text in bad:
                self.assertEqual(refusal(parser, [*session, f"{option}={text}"]),
                                 (2, f"sandwall run: argument {option}: {text} must be {words}; try --help\n"))


class Scripts(unittest.TestCase):
    def test_every_option_that_takes_a_number_refuses_what_is_not_finite(self):
        found = scripts_with_numbers()
        self.assertIn(("scripts/figures/sessions/latency.py", "--warm-up"), found)
        for file, option in found:
            for text in ("nan", "-inf"):
                ended = subprocess.run([sys.executable, str(ROOT / file), f"{option}={text}"], text=True, capture_output=True,
                                       stdin=subprocess.DEVNULL, timeout=60, env={**os.environ, "PYTHONDONTWRITEBYTECODE": "1"})
                self.assertEqual((ended.returncode, ended.stdout), (2, ""), f"{file} {option}={text} {ended.stderr}")
                *before, last = ended.stderr.splitlines()
                self.assertRegex(last, f"argument {option}: .*{text}")
                if file.startswith("scripts/"):
                    self.assertEqual(before, [], file)


class Types(unittest.TestCase):
    def test_bounds_belong_to_the_numbers_or_not(self):
        parser = Parser(prog="p")
        for name, kind in (("least", at_least(float, 2)), ("above", above(float, 2)), ("within", within(int, 2, 4))):
            parser.add_argument(f"--{name}", type=kind)
        self.assertEqual(vars(parser.parse_args(["--least=2", "--above=2.5", "--within=4"])), {"least": 2.0, "above": 2.5, "within": 4})
        for word, complaint in (("--least=1.9", "1.9 must be 2 or more"), ("--above=2", "2 must be more than 2"),
                                ("--within=5", "5 must be from 2 to 4"), ("--within=2.5", "invalid int value: '2.5'"),
                                ("--above=far", "invalid float value: 'far'"), ("--above=inf", "must be a finite number, got inf")):
            self.assertEqual(refusal(parser, [word]), (2, f"p: argument {word.split('=')[0]}: {complaint}; try --help\n"))


if __name__ == "__main__":
    unittest.main()
