#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests that kill_starts.py fails if it has made no try."""

import contextlib
import io
import pathlib
import sys
import unittest
from unittest import mock

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[3] / "scripts" / "checks"))
import kill_starts


class KillStarts(unittest.TestCase):
    def run_with(self, *options, found=None):
        """Runs the script on made-up sessions. `found` is the result of each try. Returns the exit status and what was printed."""
        said = io.StringIO()
        with mock.patch.object(kill_starts, "undisturbed", return_value=1.0), mock.patch.object(kill_starts, "one", return_value=found), \
                mock.patch.object(sys, "argv", ["kill_starts.py", "--side", "64", *options]), \
                contextlib.redirect_stdout(said), contextlib.redirect_stderr(said):
            return kill_starts.main(), said.getvalue()

    def test_tries_that_find_no_process_are_no_success(self):
        status, said = self.run_with("--processes", "master", "--signals", "INT", "--moments", "rank")
        self.assertEqual(status, 1)
        self.assertIn("0 of 0 bad; 1 of 1 tries found no process", said)
        self.assertIn("no try was made", said)

    def test_options_that_ask_for_no_try_are_no_success(self):
        self.assertEqual(self.run_with("--processes", "server", "--signals", "INT", found=(0.5, 0, "ended"))[0], 1)

    def test_tries_count_by_their_time(self):
        options = ["--processes", "master", "--signals", "INT", "--moments", "rank", "--rounds", "3"]
        status, said = self.run_with(*options, found=(0.5, 1, "ended"))
        self.assertEqual(status, 0, said)
        self.assertIn("0 of 3 bad; 0 of 3 tries", said)
        status, said = self.run_with(*options, found=(2.5, 1, "ended"))
        self.assertEqual(status, 1)
        self.assertIn("3 of 3 bad", said)


if __name__ == "__main__":
    unittest.main()
