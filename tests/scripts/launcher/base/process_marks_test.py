#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests that a process is found by its environment at every moment, also while it begins another program.

usage: process_marks_test.py
"""

import pathlib
import subprocess
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[4] / "scripts" / "launcher"))
from base import process_marks  # noqa: E402

MARK = {"SANDWALL_TEST_MARK": "1"}
READS = 2000


class Marks(unittest.TestCase):
    def begin(self, command, environment):
        process = subprocess.Popen(command, env=environment)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        return process

    def test_are_found_while_a_process_begins_another_program(self):
        again = 'exec /bin/sh -c "$0" "$0"'
        process = self.begin(["/bin/sh", "-c", again, again], MARK)
        found = [process_marks.has_mark(process.pid, b"SANDWALL_TEST_MARK=1") for _ in range(READS)]
        self.assertEqual(found.count(False), 0)

    def test_an_empty_environment_is_told_from_one_that_is_not_there_yet(self):
        process = self.begin(["/bin/sleep", "1000"], {})
        self.assertEqual(process_marks.environment_of(pathlib.Path("/proc", str(process.pid))), b"")

    def test_of_a_process_that_has_ended_are_not_found(self):
        process = self.begin(["/bin/true"], MARK)
        process.wait()
        self.assertFalse(process_marks.has_mark(process.pid, b"SANDWALL_TEST_MARK=1"))

    def test_of_a_process_that_nobody_has_waited_for_are_not_found(self):
        process = self.begin(["/bin/true"], MARK)
        while pathlib.Path(f"/proc/{process.pid}/stat").read_text().rpartition(")")[2].split()[0] != "Z":
            pass
        self.assertFalse(process_marks.has_mark(process.pid, b"SANDWALL_TEST_MARK=1"))


if __name__ == "__main__":
    unittest.main()
