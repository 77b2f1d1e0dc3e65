#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests how the launcher finds walls, scenes, sessions and programs, in the sources and in an installed tree."""

import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "support"))
from launcher_fixture import ROOT, LauncherTest
from base import layout
from base.bad_input import BadInput


class Names(unittest.TestCase):
    def setUp(self):
        folder = self.enterContext(tempfile.TemporaryDirectory(prefix="sandwall-layout-"))
        self.folder = pathlib.Path(folder)
        self.addCleanup(os.chdir, os.getcwd())
        os.chdir(folder)

    def test_every_known_name_is_a_file(self):
        for kind, least in (("walls", 14), ("scenes", 8), ("strokes", 4)):
            names = layout.known(kind)
            self.assertGreaterEqual(len(names), least)
            for name in names:
                self.assertTrue(pathlib.Path(layout.found(kind, name)).is_file(), name)
        self.assertEqual(layout.found("walls", "desktop"), layout.found("walls", "desktop.toml"))

    def test_a_file_of_the_current_folder_goes_before_a_known_name(self):
        (self.folder / "dunes").write_text("")
        self.assertEqual(layout.found("scenes", "dunes"), "dunes")

    def test_a_path_is_left_to_its_reader(self):
        self.assertEqual(layout.found("scenes", "no/such.toml"), "no/such.toml")

    def test_an_unknown_name_lists_the_known_ones(self):
        with self.assertRaisesRegex(BadInput, "^dnes: no file and no known name; scenes .*: dunes, .*, writing$"):
            layout.found("scenes", "dnes")

    def test_a_journal_and_its_folder_name_the_same_session(self):
        session = self.folder / "session"
        session.mkdir()
        self.assertEqual(layout.session_at(str(session / "session.journal")), str(session / "session.journal"))
        (session / "session.journal").write_text("")
        for named in (session, session / "session.journal"):
            self.assertEqual(layout.session_at(str(named)), str(session))
            self.assertEqual(layout.journal_at(str(named)), str(session / "session.journal"))


class InstalledTree(LauncherTest):
    """The launcher in a made-up installed tree, called through the link in its bin folder."""

    def setUp(self):
        super().setUp()
        self.prefix = self.folder / "prefix"
        self.private = self.prefix / "lib" / "sandwall"
        shutil.copytree(ROOT / "scripts" / "launcher", self.private / "python", ignore=shutil.ignore_patterns("samples", "__pycache__"))
        for file in (self.folder / "bin").iterdir():
            shutil.copy(file, self.private)
        for kind in ("walls", "scenes"):
            (self.prefix / "share" / "sandwall" / kind).mkdir(parents=True)
            (self.prefix / "share" / "sandwall" / kind / "small.toml").write_text("-\n")
        (self.prefix / "bin").mkdir()
        (self.prefix / "bin" / "sandwall").symlink_to("../lib/sandwall/python/sandwall")
        del self.environment["SANDWALL_BIN"]

    def call(self, *words):
        return subprocess.run([str(self.prefix / "bin" / "sandwall"), *words], env=self.environment, text=True, capture_output=True,
                              timeout=120, stdin=subprocess.DEVNULL, cwd=self.folder)

    def test_it_finds_its_own_programs_walls_and_scenes(self):
        ended = self.call("run", "--wall", "small", "--scene", "small", "--print-command")
        self.assertEqual((ended.returncode, ended.stderr), (0, ""))
        for path in (self.private / "sandwall-master", *(self.prefix / "share" / "sandwall" / kind / "small.toml" for kind in ("scenes", "walls"))):
            self.assertIn(f"{path} ", ended.stdout)
        self.assertEqual(self.call("list", "walls").stdout, "small\n")

    def test_it_works_from_another_prefix(self):
        self.prefix = self.prefix.rename(self.folder / "moved")
        ended = self.call("run", "--wall", "small", "--scene", "small", "--print-command")
        self.assertEqual((ended.returncode, ended.stderr), (0, ""))
        self.assertIn(f"{self.prefix}/lib/sandwall/sandwall-master ", ended.stdout)

    def test_tools_get_all_their_options(self):
        ended = self.call("check", "--what", "a wall", "--help")
        self.assertEqual((ended.returncode, ended.stderr), (2, "made-up sandwall-check: --what a wall --help\n"))

    def test_check_takes_the_name_of_a_wall(self):
        small = self.prefix / "share" / "sandwall" / "walls" / "small.toml"
        self.assertEqual(self.call("check", "small", "small").stderr, f"made-up sandwall-check: {small} small\n")
        self.assertEqual(self.call("check", "smal").stderr,
                         "sandwall: smal: no file and no known name; walls that come with Sandwall: small\n")

    def test_check_writes_a_new_wall_named_before_or_behind_the_option(self):
        for words in (("mine.toml", "--new", "2x2"), ("mine.toml", "--new=2x2"), ("--new", "2x2", "mine.toml"), ("small", "--new", "2x2")):
            self.assertEqual(self.call("check", *words).stderr, f"made-up sandwall-check: {' '.join(words)}\n")

    def test_ctl_takes_the_journal_of_a_session(self):
        (self.folder / "out").mkdir()
        (self.folder / "out" / "session.journal").write_text("")
        ended = self.call("ctl", "out/session.journal", "status")
        self.assertEqual((ended.returncode, ended.stderr), (2, "sandwall: out: no session is running in this folder\n"))

    def test_programs_of_another_build_are_refused_in_one_line(self):
        (self.private / "python" / "build.json").write_text('{"build": "0123456789abcdef"}')
        self.script("sandwall-master", '#!/bin/sh\necho \'{"build": "00000000000000ff"}\'\n')
        self.environment["SANDWALL_BIN"] = str(self.folder / "bin")
        ended = self.call("run", "--wall", "small", "--scene", "small")
        self.assertEqual((ended.returncode, ended.stdout), (2, ""))
        self.assertEqual(ended.stderr, f"sandwall: {self.folder / 'bin' / 'sandwall-master'}: is of build 00000000000000ff, and this launcher "
                         "of 0123456789abcdef; install programs and launcher of one build, or unset SANDWALL_BIN\n")
        self.assertFalse((self.folder / "sessions").exists())

    def test_the_doctor_names_programs_of_another_build(self):
        for build, red in (("0123456789abcdef", False), ("00000000000000ff", True)):
            (self.private / "python" / "build.json").write_text(json.dumps({"build": build}))
            for name in ("master", "render-node", "haptic-server"):
                program = self.private / f"sandwall-{name}"
                program.write_text('#!/bin/sh\necho \'{"build": "0123456789abcdef"}\'\n')
                program.chmod(0o755)
            ended = self.call("doctor", "--json", "--out", str(self.folder))
            found = [one for one in json.loads(ended.stdout)["findings"] if one["check"] == "launcher"]
            self.assertEqual(len(found), int(red), ended.stdout)
            if red:
                self.assertEqual(ended.returncode, 1)
                self.assertFalse(found[0]["good"])
                self.assertIn(f"and this launcher of {build}", found[0]["message"])

    def test_a_folder_of_programs_that_is_none_names_the_variable(self):
        self.environment["SANDWALL_BIN"] = "/nowhere"
        ended = self.call("run", "--wall", "small", "--scene", "small")
        self.assertEqual((ended.returncode, ended.stdout, ended.stderr), (2, "", "sandwall: SANDWALL_BIN: /nowhere is not a folder; unset it, or "
                         "set it to the folder of the programs\n"))
        self.environment["SANDWALL_BIN"] = str(self.folder)
        ended = self.call("run", "--wall", "small", "--scene", "small")
        self.assertEqual((ended.returncode, ended.stdout, ended.stderr), (2, "", f"sandwall: {self.folder}/sandwall-master: does not exist; unset "
                         "SANDWALL_BIN, or set it to the folder of the programs\n"))


class Completion(LauncherTest):
    def completed(self, *words):
        """Returns what bash offers for the last of the words that follow `sandwall`."""
        script = (f"sandwall() {{ '{ROOT}/scripts/sandwall' \"$@\"; }}; source '{ROOT}/scripts/launcher/completion.bash'; "
                  'COMP_WORDS=(sandwall "$@"); COMP_CWORD=$#; _sandwall; printf "%s\\n" "${COMPREPLY[@]}"')
        return subprocess.run(["bash", "-c", script, "bash", *words], text=True, capture_output=True, timeout=60,
                              cwd=self.folder, check=True).stdout.split()

    def test_it_offers_every_command(self):
        told = subprocess.run([f"{ROOT}/scripts/sandwall", "--help"], text=True, capture_output=True, check=True).stdout
        commands = re.findall(r"^    ([a-z-]+) ", told.partition("commands:")[2], re.MULTILINE)
        self.assertIn("run", commands)
        self.assertEqual(sorted(set(commands) - set(self.completed(""))), [])

    def test_it_offers_files_only_where_a_file_can_stand(self):
        (self.folder / "egl.toml").write_text("")
        self.assertEqual(self.completed("run", "--gl", "eg"), ["egl"])
        self.assertEqual(self.completed("eg"), [])
        self.assertEqual(self.completed("run", "--scene", "eg"), ["egl.toml"])

    def test_it_offers_names_and_options(self):
        self.assertEqual(self.completed("run", "--wall", "tiled_3"), ["tiled_3x4"])
        self.assertEqual(self.completed("run", "--scene", "dun"), ["dunes"])
        self.assertEqual(self.completed("try", "dun"), ["dunes"])
        self.assertEqual(self.completed("try", "--ne"), ["--new"])
        self.assertEqual(self.completed("run", "--device", "poi"), ["pointer"])
        self.assertEqual(self.completed("run", "--device", "script", ":", "gi"), ["gis"])  # as bash splits script:gi
        self.assertIn("gis", self.completed("run", "--device", "script", ":"))
        self.assertEqual(self.completed("run", "--device", "trace", ":", "gi"), [])
        self.assertIn("--resume", self.completed("run", "--res"))
        self.assertEqual(self.completed("ctl", "out", "swap"), ["swap-eyes"])


if __name__ == "__main__":
    unittest.main()
