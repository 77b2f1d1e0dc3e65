#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests how scripts/sandwall run waits for hosts and displays that are not there yet, and the sample unit of systemd."""

import pathlib
import re
import shutil
import signal
import subprocess
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "support"))
from launcher_fixture import ROOT
from supervisor_fixture import Supervised, without_command

UNIT = ROOT / "scripts" / "launcher" / "samples" / "sandwall.service"
NOT_YET = 75
MISSING = "rank 1 (tile a) on x: --gl glfw: cannot open X display :0"
NO_DISPLAY = f"complain 0 'sandwall-master: {MISSING}'; exit {NOT_YET}"
# A host that answers from the n-th question on, where n is in the file `comes`.
LATE = """#!/bin/sh
folder=${0%/*}/..; shift
n=$(($(cat "$folder/asked" 2>/dev/null || echo 0) + 1)); echo $n > "$folder/asked"
[ $n -ge "$(cat "$folder/comes")" ] || { echo "ssh: connect to host late1 port 22: Connection refused" >&2; exit 255; }
exec sh -c "$*"
"""
# A host that is silent until there is a file `speaks`, and then answers.
SILENT = """#!/bin/sh
folder=${0%/*}/..; shift
echo asked >> "$folder/asked"
until [ -e "$folder/speaks" ]; do sleep 0.05; done
echo "Good morning"
exec sh -c "$*"
"""
# A host that answers none of its first questions. The file `comes` has the number of the first that it answers.
MUTE = LATE.replace('{ echo "ssh: connect to host late1 port 22: Connection refused" >&2; exit 255; }', "exec sleep 1000")
# Runs the launcher with another limit, in a process of its own.
WITH = "import runpy, sys; from hosts import reachable; reachable.{}; sys.argv = sys.argv[1:]; runpy.run_path(sys.argv[0], run_name='__main__')"


class WaitForWall(Supervised):
    limit = None  # an assignment to a limit of reachable.py

    def command(self, hosts, *options):
        words = super().command(hosts, *options)
        if self.limit is None:
            return words
        self.environment["PYTHONPATH"] = str(ROOT / "scripts" / "launcher")
        return [sys.executable, "-c", WITH.format(self.limit), *words]

    def test_without_the_option_what_may_come_has_a_status_of_its_own(self):
        self.tries(NO_DISPLAY)
        self.assertEqual(self.ended(["-"]), (NOT_YET, "", f"sandwall-master: {MISSING}\n"))
        self.assertEqual(len(self.commands()), 1)

    def test_a_display_that_comes_is_waited_for(self):
        self.tries(NO_DISPLAY, NO_DISPLAY, "complain 0 'a line of the master'; progress 1 1; exit 0")
        status, printed, error = self.ended(["-"], "--wait-for-wall", "60")
        self.assertEqual((status, printed, len(self.commands())), (0, "a line of progress\n", 3), error)
        self.assertEqual(error, f"sandwall: waits up to 60 s for this: {MISSING}\na line of the master\n")
        self.assertFalse((self.folder / "out" / "failures.jsonl").exists())

    def test_a_session_without_restarts_waits_too(self):
        self.tries(NO_DISPLAY, "progress 1 1; exit 0")
        self.assertEqual((self.ended(["-"], "--wait-for-wall", "60", "--restarts", "0")[0], len(self.commands())), (0, 2))

    def test_a_wall_that_never_comes_is_named(self):
        self.tries(*[NO_DISPLAY] * 9)
        status, _, error = self.ended(["-"], "--wait-for-wall", "0.5")
        self.assertEqual((status, error.splitlines()[-1]), (NOT_YET, f"sandwall: {MISSING}; waited 0.5 s for it (--wait-for-wall)"))

    def test_bad_input_is_not_waited_for(self):
        self.tries("complain 0 'sandwall-master: no'; exit 2")
        self.assertEqual(self.ended(["-"], "--wait-for-wall", "60"), (2, "", "sandwall-master: no\n"))

    def test_a_host_that_comes_is_waited_for(self):
        self.script("agent", LATE)
        self.write("comes", "3")
        self.tries("progress 1 1; exit 0")
        missing = "late1 (rank 1): cannot be reached: ssh: connect to host late1 port 22: Connection refused; docs/hosts.md"
        self.assertEqual(self.ended(["late1"])[::2], (NOT_YET, f"sandwall: {missing}\n"))
        self.assertEqual(self.ended(["late1"], "--wait-for-wall", "60")[::2], (0, f"sandwall: waits up to 60 s for this: {missing}\n"))

    def test_ctrl_c_ends_the_wait(self):
        self.script("agent", LATE)
        self.write("comes", "999")
        self.tries(*[NO_DISPLAY] * 99)
        for host in ("late1", "-"):
            process = self.begin([host], "--wait-for-wall", "86400")
            self.assertIn("waits up to 86400 s", process.stderr.readline())
            process.send_signal(signal.SIGINT)
            error = process.communicate(timeout=60)[1]
            self.assertEqual((process.returncode, error), (0, "sandwall: stopped while it waited for the wall\n"))

    def test_a_host_that_answers_after_a_silence_is_named_and_then_taken(self):
        self.limit = "SILENT_SECONDS = 0"
        self.script("agent", SILENT)
        self.tries(*["progress 1 1; exit 0"] * 2)
        for options in ((), ("--wait-for-wall", "60")):
            (self.folder / "speaks").unlink(missing_ok=True)
            process = self.begin(["silent1", "silent1"], *options)
            self.assertEqual(process.stderr.readline(), "sandwall: waits up to 45 s for the answer of silent1; docs/hosts.md\n")
            self.write("speaks", "")
            error = process.communicate(timeout=60)[1]
            self.assertEqual((process.returncode, without_command(error)), (0, ""), options)
        self.assertEqual(len(self.commands()), 2)

    def test_a_host_that_is_silent_for_too_long_is_asked_again(self):
        self.limit = "REACH_SECONDS = 1"
        self.script("agent", MUTE)
        self.tries("progress 1 1; exit 0")
        missing = "silent1 (rank 1): no answer within 1 s; docs/hosts.md"
        self.write("comes", "2")
        self.assertEqual(self.ended(["silent1"])[::2], (NOT_YET, f"sandwall: {missing}\n"))
        self.write("comes", "3")
        self.assertEqual(self.ended(["silent1"], "--wait-for-wall", "60")[::2], (0, f"sandwall: waits up to 60 s for this: {missing}\n"))

    def test_ctrl_c_ends_the_wait_for_a_host_that_is_silent(self):
        self.script("agent", SILENT)
        for options in ((), ("--wait-for-wall", "86400")):
            (self.folder / "asked").unlink(missing_ok=True)
            process = self.begin(["silent1"], *options)
            self.wait_for("question", (self.folder / "asked").exists)
            process.send_signal(signal.SIGINT)
            error = process.communicate(timeout=60)[1]
            self.assertEqual((process.returncode, error), (0, "sandwall: stopped while it waited for the wall\n"), options)

    def test_a_display_that_goes_while_the_wall_is_shown_is_a_failure_like_others(self):
        self.tries("progress 7 6; dies 1 host 9", NO_DISPLAY, "progress 8 7; exit 0")
        status, _, error = self.ended(["-"])
        self.assertEqual((status, len(self.commands())), (0, 3), error)

    def test_a_wait_that_is_no_time_is_refused(self):
        for value, words in (("0", "more than 0 and at most 86400 s"), ("-1", "more than 0"), ("nan", "must be a finite number, got nan"),
                             ("86401", "at most 86400 s, which is a day"), ("soon", "invalid float value: 'soon'")):
            self.assertIn(words, self.refused(["-"], f"--wait-for-wall={value}"), value)


class SampleUnit(unittest.TestCase):
    def test_the_unit_starts_again_after_a_wall_that_has_not_come(self):
        text = UNIT.read_text()
        never = re.findall(r"(?m)^RestartPreventExitStatus=(.*)$", text)
        self.assertEqual((never, re.findall(r"(?m)^Restart=(.*)$", text)), (["2"], ["on-failure"]))
        self.assertRegex(text, r" --wait-for-wall \d+\b")

    @unittest.skipUnless(shutil.which("systemd-analyze"), "systemd-analyze is not installed")
    def test_systemd_takes_the_unit(self):
        ended = subprocess.run(["systemd-analyze", "verify", UNIT], capture_output=True, text=True, timeout=60)
        # A machine without the package has no /usr/bin/sandwall.
        lines = [line for line in ended.stderr.splitlines() if UNIT.name in line and "/usr/bin/sandwall is not executable" not in line]
        self.assertEqual(lines, [])


if __name__ == "__main__":
    unittest.main()
