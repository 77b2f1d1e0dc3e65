#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests that one session at a time uses a folder, and that the lines typed into scripts/sandwall reach the master."""

import contextlib
import os
import pathlib
import pty
import signal
import subprocess
import sys
import tempfile
import time
import unittest
from unittest import mock

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "support"))
from launcher_fixture import LauncherTest
from base import session_folder

MPIRUN = """#!/bin/sh
echo "mpirun $*"
"""
# Prints the lines of its standard input, until "stop".
LISTENING_MPIRUN = """#!/bin/sh
while read -r line; do echo "told: $line"; [ "$line" = stop ] && exit 0; done
exit 9
"""


class OneFolder(LauncherTest):
    def start_waiting(self):
        """Starts a session that runs until a line is written to its input."""
        self.script("mpirun", "#!/bin/sh\n: >\"$STARTED\"; read -r line\n")
        started = self.folder / "started"
        process = subprocess.Popen(self.command(["-"], "--journal", "off"), env={**self.environment, "STARTED": started},
                                   stdin=subprocess.PIPE, stdout=subprocess.DEVNULL, text=True)
        self.addCleanup(process.kill)
        deadline = time.monotonic() + 60
        while not started.exists() and time.monotonic() < deadline:
            time.sleep(0.01)
        return process

    def test_a_second_session_is_refused_and_leaves_the_logs_of_the_first_alone(self):
        first = self.start_waiting()
        log = self.folder / "out" / "log" / "try_1.out"
        log.write_text("of the first")
        second = self.start(["-"])
        self.assertEqual((second.returncode, second.stdout), (1, ""))
        self.assertEqual(second.stderr, f"sandwall: {self.folder / 'out'}: another session runs in this folder; stop that "
                         "one first, or choose another --out\n")
        self.assertEqual(log.read_text(), "of the first")
        first.communicate("stop\n", timeout=60)
        self.script("mpirun", MPIRUN)
        self.assertEqual(self.start(["-"]).returncode, 0)


class FolderInUse(unittest.TestCase):
    """Two launchers that need the same folder, with a clock that the test moves."""

    def setUp(self):
        self.folder = self.enterContext(tempfile.TemporaryDirectory(prefix="sandwall-folder-"))
        self.now = 1000.0
        self.release_at = float("inf")
        self.first = self.enterContext(contextlib.ExitStack())
        self.first.enter_context(session_folder.held(self.folder))
        clock = mock.Mock(**{"monotonic.side_effect": lambda: self.now, "sleep.side_effect": self.sleep})
        self.enterContext(mock.patch("base.session_folder.time", clock))

    def sleep(self, seconds):
        self.now += seconds
        if self.now >= self.release_at:
            self.first.close()

    def enter(self):
        """Enters the folder as the second launcher. Returns the seconds that it has waited."""
        began = self.now
        with session_folder.held(self.folder):
            return self.now - began

    def test_a_second_launcher_goes_on_when_the_first_ends_within_five_seconds(self):
        self.release_at = self.now + 4.9
        waited = self.enter()
        self.assertTrue(4.9 <= waited <= 5, waited)

    def test_a_second_launcher_is_refused_after_five_seconds(self):
        began = self.now
        with self.assertRaises(session_folder.InUse):
            self.enter()
        self.assertTrue(5 <= self.now - began <= 5.1, self.now - began)

    def test_nobody_waits_for_a_folder_that_is_free(self):
        self.first.close()
        self.assertEqual(self.enter(), 0)


class Input(LauncherTest):
    def test_what_is_typed_reaches_the_master(self):
        self.script("mpirun", LISTENING_MPIRUN)
        ended = self.start(["-"], stdin=None, input="settle\n\n  stop  \n")
        self.assertEqual((ended.returncode, ended.stdout, ended.stderr), (0, "told: settle\ntold: stop\n", ""))

    def test_a_last_line_without_an_end_counts(self):
        self.script("mpirun", LISTENING_MPIRUN)
        ended = self.start(["-"], stdin=None, input="stop")
        self.assertEqual((ended.returncode, ended.stdout), (0, "told: stop\n"))

    def test_the_end_of_our_input_means_nothing(self):
        # If the end of input were passed on, this mpirun would end with status 9 before it reads "stop".
        started = self.folder / "started"
        self.script("mpirun", LISTENING_MPIRUN.replace("while", f"touch {started}; while"))
        process = subprocess.Popen(self.command(["-"]), env=self.environment, stdin=subprocess.DEVNULL,
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.addCleanup(process.kill)
        deadline = time.monotonic() + 60
        while not started.exists() and time.monotonic() < deadline:
            time.sleep(0.01)
        time.sleep(0.5)
        process.send_signal(signal.SIGINT)
        out, error = process.communicate(timeout=60)
        self.assertEqual((process.returncode, out), (0, "told: stop\n"), error)

    def end_with_open_input(self, theirs):
        """Runs a session that ends by itself while its input stays open and silent."""
        self.script("mpirun", MPIRUN)
        for _ in range(3):
            ended = self.start(["-"], stdin=theirs)
            self.assertEqual((ended.returncode, ended.stderr), (0, ""))
            self.assertTrue(ended.stdout.startswith("mpirun --tag-output "))

    def test_a_session_ends_quietly_while_its_input_is_open(self):
        theirs, ours = os.pipe()
        self.addCleanup(os.close, ours)
        self.addCleanup(os.close, theirs)
        self.end_with_open_input(theirs)

    def test_a_session_ends_quietly_at_a_terminal(self):
        ours, theirs = pty.openpty()
        self.addCleanup(os.close, ours)
        self.addCleanup(os.close, theirs)
        self.end_with_open_input(theirs)


if __name__ == "__main__":
    unittest.main()
