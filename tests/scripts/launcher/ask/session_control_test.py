#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests what `sandwall ctl` answers without a master: its help, and while a session is being started again."""

import pathlib
import re
import socket
import subprocess
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "support"))
from launcher_fixture import ROOT
from supervisor_fixture import HOST, Supervised
from ask import session_control


class Ctl(Supervised):
    def ctl(self, *words):
        ended = subprocess.run([str(ROOT / "scripts" / "sandwall"), "ctl", str(self.folder / "out"), *words], env=self.environment,
                               capture_output=True, text=True, timeout=60, stdin=subprocess.DEVNULL)
        return ended.returncode, ended.stdout, ended.stderr.replace(str(self.folder) + "/", "")

    def test_a_session_that_is_being_started_again_is_reported_with_its_failure(self):
        self.tries("progress 7 6; dies 2 host 11", 'touch "$folder/again"; while [ ! -e "$folder/on" ]; do sleep 0.02; done; '
                   'progress 9 8; while [ ! -e "$folder/off" ]; do sleep 0.02; done; exit 0')
        process = self.begin(["-", "-"])
        self.wait_for("second try", (self.folder / "again").exists)
        status, printed, error = self.ctl("status")
        self.assertEqual((status, printed), (2, ""))
        self.assertEqual(error, f"sandwall: out: the session is being started again, because rank 2 on {HOST} was killed by SIGSEGV; "
                         "try again in a moment\n")
        marker = self.folder / "out" / "log" / session_control.RESTARTING
        self.assertTrue(marker.exists())
        (self.folder / "on").touch()
        self.wait_for("first frame", lambda: not marker.exists())
        (self.folder / "off").touch()
        self.assertEqual(process.wait(60), 0)
        self.assertEqual(self.ctl("status"), (2, "", "sandwall: out: no session is running in this folder\n"))

    def test_a_session_that_is_being_started_is_reported(self):
        self.tries('touch "$folder/began"; while [ ! -e "$folder/off" ]; do sleep 0.02; done; exit 0')
        process = self.begin(["-"])
        self.wait_for("try", (self.folder / "began").exists)
        self.assertEqual(self.ctl("status")[2], "sandwall: out: the session is being started; try again in a moment\n")
        (self.folder / "off").touch()
        self.assertEqual(process.wait(60), 0)

    def test_a_link_in_place_of_the_socket_commands_no_other_session(self):
        for name in ("out", "mine"):
            (self.folder / name).mkdir()
        with socket.socket(socket.AF_UNIX) as listener:
            listener.bind(str(self.folder / "mine" / "control"))
            listener.listen()
            listener.setblocking(False)
            (self.folder / "out" / "control").symlink_to(self.folder / "mine" / "control")
            self.assertEqual(self.ctl("stop"), (2, "", "sandwall: out: no session is running in this folder\n"))
            with self.assertRaises(BlockingIOError):
                listener.accept()

    def test_help_lists_every_verb_of_the_master(self):
        listed = re.findall(r'\{"([a-z-]+)", ".*", (?:atOnce|byDesk)', (ROOT / "master/operator/verbs.hpp").read_text())
        self.assertGreater(len(listed), 10)
        for word in ("help", "--help", "-h"):
            status, printed, error = self.ctl(word)
            self.assertEqual((status, error), (0, ""), word)
            self.assertEqual([line.split()[0] for line in printed.splitlines()], listed)
        told = subprocess.run([ROOT / "scripts" / "sandwall", "ctl", "--help"], env=self.environment, capture_output=True, text=True, timeout=60)
        self.assertEqual((told.returncode, told.stderr), (0, ""))
        for verb in listed:
            self.assertRegex(told.stdout, rf"[ \n]{verb}\b")


if __name__ == "__main__":
    unittest.main()
