#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests the list of all files that a session writes (scripts/checks/session_files.py), with the programs of this build."""

import pathlib
import re
import subprocess
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[3]
# At least these files are in the list. So the test cannot pass because a session has ended early.
EXPECTED = ("./", "capture_001/", "capture_001/wall_left.png", "checkpoints/", "checkpoints/N.checkpoint", "control", "divergence.txt", "drills.done",
            "failure.json", "failures.jsonl", "incidents.json", "log/", "log/report.txt", "log/restarting", "log/try_1.err", "log/try_1.out", "recoveries.jsonl",
            "saves/", "saves/dunes.sand", "session.journal", "summary.json", "ticks.csv", "wall_left.png")


class Files(unittest.TestCase):
    def test_no_file_of_a_session_is_writable_for_others_under_a_umask_of_0(self):
        listed = subprocess.run([sys.executable, ROOT / "scripts" / "checks" / "session_files.py", "000"], capture_output=True, text=True, timeout=300)
        self.assertEqual((listed.returncode, listed.stderr), (0, ""))
        modes = dict(re.findall(r"^\| `(.*)` \| \S+ (\d+) \|$", listed.stdout, flags=re.MULTILINE))
        self.assertEqual(set(EXPECTED) - set(modes), set())
        for name, mode in modes.items():
            self.assertEqual(mode, "0755" if name.endswith("/") else "0600" if name == "control" else "0644", name)


if __name__ == "__main__":
    unittest.main()
