#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests the command in the last line of `run`, which continues the session."""

import argparse
import pathlib
import shlex
import subprocess
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import journal_begin
from launcher_fixture import ROOT, LauncherTest
import resume_command

LAST = " continues with this sand\n"


class Words(unittest.TestCase):
    def words(self, **given):
        """Returns the words behind those of every command, for options of `run` as the user has given them."""
        options = {"wall": "desktop", "scene": "dunes", "device": "none", "gl": "auto", "here": False, "as_heights": False, **given}
        words = resume_command.words_of(argparse.Namespace(**options), "out/a b")[1:]
        self.assertEqual(words[:6], ["run", "--resume", "--out", "out/a b", "--wall", "desktop"])
        return words[6:]

    def test_they_have_the_hand_and_the_scene_that_its_server_reads(self):
        self.assertEqual(self.words(device="script:gis"), ["--scene", "dunes", "--device", "script:gis"])
        self.assertEqual(self.words(device="script:gis", scene="p.jpg", as_heights=True), ["--scene", "p.jpg", "--as-heights", "--device", "script:gis"])
        self.assertEqual(self.words(device="pointer", gl="glfw"), ["--device", "pointer"])
        self.assertEqual(self.words(haptic="127.0.0.1:1"), ["--haptic", "127.0.0.1:1"])

    def test_they_have_hosts_and_pictures(self):
        self.assertEqual(self.words(hosts="hosts", network="10.0.0.0/24", secret_file="s", stereo="mono", gl="egl", steps=3, pace="fast"),
                         ["--hosts", "hosts", "--network", "10.0.0.0/24", "--secret-file", "s", "--stereo", "mono", "--gl", "egl"])
        self.assertEqual(self.words(here=True, desk="800x600+0+0"), ["--desk", "800x600+0+0", "--here"])

    def test_they_have_the_options_of_the_launcher_unless_they_are_the_usual_ones(self):
        self.assertEqual(self.words(restarts=3, restart_window=60.0, wait_for_wall=None, gl_threads=None, json=False), [])
        self.assertEqual(self.words(restarts=0, restart_window=2.5, wait_for_wall=90.0, gl_threads=0, json=True),
                         ["--restarts", "0", "--restart-window", "2.5", "--wait-for-wall", "90", "--gl-threads", "0", "--json"])

    def test_they_have_the_options_of_the_programs_that_are_given(self):
        self.assertEqual(self.words(device="script:gis", tls=True, force_scale=0.5, map=["scale=2", "turn=90"], journal="required", checkpoint=0.0),
                         ["--scene", "dunes", "--device", "script:gis", "--tls", "--checkpoint", "0", "--map", "scale=2", "--map", "turn=90",
                          "--force-scale", "0.5"])

    def test_they_leave_out_what_ends_or_disturbs_the_session_and_the_values_of_variables(self):
        self.assertEqual(self.words(frames=9, warm_up=3, inject=["hang:1"], record="ticks.csv", env=["TOKEN=secret", "XAUTHORITY"]),
                         ["--env", "TOKEN", "--env", "XAUTHORITY"])


class LastLine(LauncherTest):
    def setUp(self):
        super().setUp()
        self.script("mpirun", '#!/bin/sh\necho "mpirun $*"\ncat "$BEGIN" > "$OUT/session.journal"\nexit ${STATUS:-0}\n')
        (self.folder / "begin").write_bytes(journal_begin.OURS)
        self.environment.update(BEGIN=str(self.folder / "begin"), OUT=str(self.folder / "out"))

    def last(self, *options, status=0):
        """Returns the words of the last line's command, from `run` on."""
        ended = self.start(["-"], *options)
        self.assertEqual(ended.returncode, status, ended.stderr)
        line = ended.stderr.splitlines(keepends=True)[-1]
        self.assertTrue(line.startswith("sandwall: `") and line.endswith("`" + LAST), ended.stderr)
        return shlex.split(line.removeprefix("sandwall: `").removesuffix("`" + LAST).replace(str(self.folder) + "/", ""))[1:]

    def test_it_leaves_out_the_end_of_the_session(self):
        self.assertEqual(self.last("--steps", "3", "--pace", "fast"), ["run", "--resume", "--out", "out", "--wall", "wall"])

    def test_the_command_can_be_started(self):
        again = subprocess.run([str(ROOT / "scripts" / "sandwall"), *self.last(), "--print-command"], cwd=self.folder, env=self.environment,
                               capture_output=True, text=True, timeout=60, stdin=subprocess.DEVNULL)
        self.assertEqual(again.returncode, 0, again.stderr)
        self.assertIn("--out out", again.stdout)

    def test_it_is_the_last_line_also_after_a_failure(self):
        self.environment["STATUS"] = "1"
        self.assertEqual(self.last("--restarts", "0", status=1)[-2:], ["--restarts", "0"])

    def test_a_session_that_is_refused_or_has_no_journal_has_no_such_line(self):
        self.environment["STATUS"] = "2"
        self.assertNotIn(LAST, self.start(["-"]).stderr)
        (self.folder / "out" / "session.journal").unlink()
        self.script("mpirun", "#!/bin/sh\n")
        self.assertNotIn(LAST, self.start(["-"]).stderr)


if __name__ == "__main__":
    unittest.main()
