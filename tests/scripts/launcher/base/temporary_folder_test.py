#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests that the launcher's temporary folder is removed in any case."""

import os
import pathlib
import subprocess
import sys
import tempfile
import time
import unittest
from unittest import mock

LAUNCHER = pathlib.Path(__file__).resolve().parents[4] / "scripts" / "launcher"
sys.path.insert(0, str(LAUNCHER))
sys.dont_write_bytecode = True
from base.temporary_folder import TemporaryFolder

SCOPE = """
import sys, time
sys.path.insert(0, sys.argv[1])
from base.temporary_folder import TemporaryFolder
with TemporaryFolder() as folder:
    open(folder + "/file", "w").close()
    print(folder, flush=True)
    time.sleep(1000)
"""


class Folder(unittest.TestCase):
    def test_it_exists_for_its_scope_and_leaves_no_process(self):
        with TemporaryFolder() as name:
            folder = pathlib.Path(name)
            (folder / "file").write_text("text")
        self.assertFalse(folder.exists())
        with self.assertRaises(ChildProcessError):
            os.waitpid(-1, os.WNOHANG)

    def test_it_is_removed_after_an_error(self):
        with self.assertRaises(ValueError), TemporaryFolder() as name:
            raise ValueError
        self.assertFalse(pathlib.Path(name).exists())
        with tempfile.TemporaryDirectory() as parent, mock.patch("tempfile.tempdir", parent):
            with mock.patch("subprocess.Popen", side_effect=OSError), self.assertRaises(OSError), TemporaryFolder():
                pass
            self.assertEqual(list(pathlib.Path(parent).iterdir()), [])

    def test_it_is_removed_after_a_kill(self):
        with subprocess.Popen([sys.executable, "-c", SCOPE, str(LAUNCHER)], stdout=subprocess.PIPE, text=True) as process:
            folder = pathlib.Path(process.stdout.readline().strip())
            self.assertTrue((folder / "file").exists())
            process.kill()
        deadline = time.monotonic() + 60
        while folder.exists():
            self.assertLess(time.monotonic(), deadline)
            time.sleep(0.01)


if __name__ == "__main__":
    unittest.main()
