#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests what a session prints at its end: which figures it has, and which of them it calls good."""

import copy
import json
import stat
import subprocess
import unittest

from launcher_fixture import LauncherTest

import session_report

KINDS = {"secret": 0, "busy": 0}
SUMMARY = {
    "version": 1, "scene": "dunes", "wall": "small", "ranks": 2, "frames": 600, "steps": 590, "seconds": 10.0, "fps": 59.9,
    "frame_ms": {"count": 590}, "late_frames": 3, "latency_ms": {"mean": 30.0, "p50": 29.5, "p99": 44.0}, "state_hash": "0123456789abcdef",
    "divergences": 0, "server_divergences": 0, "healed": 0, "master_healed": 0, "volume_initial": 900, "volume_final": 890, "volume_outflow": 10,
    "slowest": None, "recoveries": [], "journal": {"state": "written", "policy": "required"},
    "haptic": {"refused_by_server": KINDS, "refused": {"servers": KINDS, "guests": KINDS}, "steps_withheld": 0, "samples_dropped": 0}}
# Writes the summary that a test has prepared, as a master does at the end of a session.
MPIRUN = """#!/bin/sh
echo "frame 1"
while [ $# -gt 0 ]; do [ "$1" = --out ] && { cp "$SUMMARY" "$2/summary.json"; exit "$STATUS"; }; shift; done
"""


def changed(**fields):
    return {**copy.deepcopy(SUMMARY), **fields}


class Text(unittest.TestCase):
    def text(self, summary=SUMMARY, status=0, colours=False):
        return session_report.text_of(summary, "out/s", status, colours)

    def marked(self, mark, summary, status=0):
        """Returns the names of the lines with this mark."""
        return [name for found, name, _ in session_report.lines_of(summary, "out/s") if found == mark]

    def test_a_good_session_is_called_good_in_a_dozen_lines(self):
        lines = self.text().splitlines()
        self.assertEqual(lines[0], "dunes: good")
        self.assertLessEqual(len(lines), 13)
        self.assertTrue(lines[-1].endswith("sandwall replay out/s --hash"), lines[-1])
        for words in ("small, 2 render ranks", "59.9 frames/s", "3 of 590 measured, 0.5 %", "29.5 ms from hand to picture", "0123456789abcdef",
                      "exact", "written (required)", "out/s"):
            self.assertIn(words, self.text())
        self.assertEqual(len({line.index(line.split(None, 2)[1]) for line in lines[1:-2]}), 1, "the names must be aligned")

    def test_each_figure_that_is_not_good_is_marked(self):
        for mark, name, fields in (
                ("note", "late", {"late_frames": 60}),
                ("note", "recoveries", {"recoveries": [{}]}),
                ("note", "sand", {"divergences": 1, "healed": 1}),
                ("note", "slowest", {"slowest": {"name": "rank 2", "share": 0.9}}),
                ("note", "hand", {"haptic": {**SUMMARY["haptic"], "steps_withheld": 2}}),
                ("note", "refused", {"haptic": {**SUMMARY["haptic"], "refused_by_server": {"secret": 1}}}),
                ("BAD", "sand", {"server_divergences": 1}),
                ("BAD", "volume", {"volume_final": 891}),
                ("BAD", "journal", {"journal": {"state": "failed", "policy": "best-effort"}})):
            summary = changed(**fields)
            self.assertEqual(self.marked(mark, summary), [name])
            self.assertEqual(self.text(summary).splitlines()[0], "dunes: good, 1 note" if mark == "note" else "dunes: NOT GOOD, exit status 0")
        self.assertEqual(self.text(status=1).splitlines()[0], "dunes: NOT GOOD, exit status 1")

    def test_colours_change_no_word(self):
        coloured = self.text(changed(late_frames=60), colours=True)
        self.assertIn("\033[33mnote\033[0m", coloured)
        self.assertNotIn("\033", self.text())

    def test_a_session_without_a_hand_or_a_journal_says_so(self):
        summary = changed(latency_ms={"mean": 0, "p50": 0, "p99": 0}, journal={"state": "off", "policy": "off"})
        self.assertIn("no hand moved the sand", self.text(summary))
        self.assertNotIn("replay", self.text(summary))
        report = session_report.json_of(summary, "out/s", 0)
        self.assertEqual((report["session"]["latency_ms"], report["session"]["replay"], report["good"]), (None, None, True))


class Sessions(LauncherTest):
    def setUp(self):
        super().setUp()
        self.script("mpirun", MPIRUN)
        self.environment.update(STATUS="0", SUMMARY=self.write("prepared.json", json.dumps(SUMMARY)))

    def test_a_session_ends_with_the_report(self):
        ended = self.start(["-"], "--gl", "osmesa")
        self.assertEqual((ended.returncode, ended.stderr), (0, ""))
        self.assertTrue(ended.stdout.startswith("frame 1\ndunes: good\n"), ended.stdout)
        self.assertTrue(ended.stdout.endswith(f"replay {self.folder / 'out'} --hash\n"), ended.stdout)

    def test_json_is_all_of_the_standard_output(self):
        for restarts in ("0", "3"):
            ended = self.start(["-"], "--gl", "osmesa", "--json", "--restarts", restarts)
            report = json.loads(ended.stdout)
            self.assertEqual((report["good"], report["status"], report["out"]), (True, 0, str(self.folder / "out")))
            self.assertEqual(ended.stderr, "frame 1\n")

    def test_the_summary_of_an_earlier_session_is_not_reported(self):
        self.start(["-"], "--gl", "osmesa")
        self.script("mpirun", "#!/bin/sh\nexit 2\n")
        self.assertEqual(self.start(["-"], "--gl", "osmesa").stdout, "")
        report = json.loads(self.start(["-"], "--gl", "osmesa", "--json").stdout)
        self.assertEqual((report["status"], report["good"], report["session"]), (2, False, None))

    def test_a_session_without_out_gets_a_new_folder(self):
        command = [word for word in self.command(["-"], "--gl", "osmesa") if word not in ("--out", str(self.folder / "out"))]
        ended = self.start_here(command)
        self.assertEqual(ended.returncode, 0, ended.stderr)
        made = list((self.folder / "sessions").iterdir())
        self.assertEqual(len(made), 1)
        self.assertRegex(made[0].name, r"^scene-\d{8}-\d{6}$")
        self.assertEqual(ended.stderr, f"sandwall: the session's folder is sessions/{made[0].name}\n")
        self.assertIn(f"  folder      sessions/{made[0].name}\n", ended.stdout)
        self.assertFalse(made[0].stat().st_mode & (stat.S_IWGRP | stat.S_IWOTH))

    def test_a_refused_session_leaves_no_folder(self):
        self.script("mpirun", "#!/bin/sh\nexit 2\n")
        command = [word for word in self.command(["-"], "--gl", "osmesa", "--restarts", "0") if word not in ("--out", str(self.folder / "out"))]
        self.assertEqual(self.start_here(command).returncode, 2)
        self.assertFalse((self.folder / "sessions").exists())

    def test_resume_needs_the_folder(self):
        command = [word for word in self.command(["-"], "--resume") if word not in ("--out", str(self.folder / "out"))]
        ended = self.start_here(command)
        self.assertEqual((ended.returncode, ended.stderr), (2, "sandwall: --resume: name the session's folder with --out\n"))

    def start_here(self, command):
        return subprocess.run(command, env=self.environment, text=True, capture_output=True, timeout=120, stdin=subprocess.DEVNULL, cwd=self.folder)


if __name__ == "__main__":
    unittest.main()
