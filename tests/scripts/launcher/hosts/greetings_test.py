#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests that the launcher reads the answers of hosts whose logins print lines of their own, or are silent for a while."""

import os
import pathlib
import subprocess
import sys
import tempfile
import unittest
from unittest import mock

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "support"))
import launcher_fixture  # finds scripts/
from base import marked_answer
from hosts import examined_host, reachable
from job import open_mpi

LONG = "x" * 10000
# The text that a login prints before the command, and the text that it prints after the command.
GREETINGS = {"nothing": ("", ""), "a line": ("*** Welcome, last login yesterday ***\n", ""), "two words": ("Good morning\n", ""),
             "10 kB without a line feed": (LONG, ""), "lines before and after": ("program yes\nmachine a b\n", "\nmachine c d\nbye\n"),
             "lines of a terminal": ("Good morning\r\n\r\n", "logout\r\n"), "a time": ("@ 3\n5.0\n", "")}
AGENT = """#!/bin/sh
shift
printf '%s' "$BEFORE"; printf '%s' "$BEFORE" >&2
sleep "${SILENT:-0}"
while [ -n "$UNTIL" ] && [ ! -e "$UNTIL" ]; do sleep 0.05; done
sh -c "$*"; status=$?
printf '%s' "$AFTER"; printf '%s' "$AFTER" >&2
exit $status
"""


class Greetings(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory(prefix="sandwall-greetings-")
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name)
        self.agent = self.script("agent", AGENT)
        self.node = self.script("node", "#!/bin/sh\n")
        self.script("mpirun", "#!/bin/sh\necho 'mpirun (Open MPI) 4.1.4'\n")
        variables = mock.patch.dict(os.environ, {"OMPI_MCA_plm_rsh_agent": self.agent, "PATH": f"{self.folder}:{os.environ['PATH']}"})
        variables.start()
        self.addCleanup(variables.stop)

    def script(self, name, text):
        path = self.folder / name
        path.write_text(text)
        path.chmod(0o755)
        return str(path)

    def every_greeting(self):
        for name, (before, after) in GREETINGS.items():
            with self.subTest(name), mock.patch.dict(os.environ, BEFORE=before, AFTER=after):
                yield

    def test_a_host_is_the_machine_that_it_names_whatever_its_login_prints(self):
        for _ in self.every_greeting():
            found = reachable.ask(["host"], self.node)
            self.assertEqual((found.complaints, found.identities["host"]), ({}, reachable.identity_here()))

    def test_a_host_without_the_programs_is_refused_whatever_its_login_prints(self):
        for _ in self.every_greeting():
            self.assertIn("host (rank 1): has no /nowhere/node; ", reachable.ask(["host"], "/nowhere/node").complaints["host"])

    def test_another_mpirun_is_noticed_whatever_its_login_prints(self):
        self.script("mpirun", "#!/bin/sh\necho loading a module\necho 'mpirun (Open MPI) 5.0.7'\n")
        for _ in self.every_greeting():
            self.assertIn("has mpirun (Open MPI) 5.0.7, and this machine 4.1.4", reachable.ask(["host"], self.node, "4.1.4").complaints["host"])

    def test_a_login_that_runs_no_command_is_named_by_its_last_line(self):
        self.script("agent", "#!/bin/sh\necho Good morning\necho This account is not available.\n")
        self.assertEqual(reachable.ask(["host"], self.node).complaints["host"],
                         "host (rank 1): cannot be reached: This account is not available.; docs/hosts.md")
        self.script("agent", "#!/bin/sh\nexit 0\n")
        self.assertIn("cannot be reached: it runs no command", reachable.ask(["host"], self.node).complaints["host"])

    def test_the_doctor_gets_status_output_and_complaint_of_the_command_alone(self):
        ask = examined_host.Ask("host")
        for _ in self.every_greeting():
            self.assertEqual(ask.run("echo out; printf more; echo err >&2; exit 7"), (7, "out\nmore", "err\n"))
            self.assertEqual(ask.run("cat", "typed\n"), (0, "typed\n", ""))

    def test_a_clock_is_read_whatever_the_login_prints(self):
        ask = examined_host.Ask("host")
        for _ in self.every_greeting():
            ahead, give = ask.clock()
            self.assertLess(abs(ahead), give + 1)
        self.script("date", "#!/bin/sh\n")
        self.assertIsNone(ask.clock())

    def test_a_command_that_is_cut_off_has_no_status(self):
        self.script("agent", "#!/bin/sh\nprintf '\\n@sandwall begin\\nhalf of an answer\\n'\n")
        self.assertEqual(examined_host.Ask("host").run("true")[0:2], (None, ""))

    def test_a_host_that_is_silent_is_left_with_all_that_it_has_started(self):
        with mock.patch.dict(os.environ, SILENT="1000"):
            self.assertEqual(examined_host.Ask("host").run("true", seconds=0.2), (None, "", "no answer within 0.2 s"))

    def test_a_host_may_be_silent_for_half_a_minute(self):
        self.assertGreater(min(reachable.REACH_SECONDS, examined_host.ANSWER_SECONDS), 30)
        for environment in ({}, {"OMPI_MCA_plm_rsh_agent": "ssh -p 2222"}):
            self.assertIn("ConnectTimeout=20", open_mpi.remote_shell(environment), "a host that is off is given up earlier")
        with mock.patch.dict(os.environ, SILENT="1", BEFORE="Good morning\n"), mock.patch("hosts.reachable.REACH_SECONDS", 30):
            self.assertEqual(reachable.ask(["host"], self.node).complaints, {})
        with mock.patch.dict(os.environ, SILENT="1000", BEFORE="Good morning\n"), mock.patch("hosts.reachable.REACH_SECONDS", 0.2):
            self.assertIn("no answer within 0.2 s", reachable.ask(["host"], self.node).complaints["host"])

    def test_a_host_that_answers_after_a_silence_is_named_and_then_taken(self):
        named, speaks = [], self.folder / "speaks"

        def say_silent(hosts):
            named.append(hosts)
            speaks.touch()
        for before in ("", LONG):
            with mock.patch.dict(os.environ, UNTIL=str(speaks), BEFORE=before), mock.patch("hosts.reachable.SILENT_SECONDS", 0):
                found = reachable.ask(["host"], self.node, say_silent=say_silent)
            self.assertEqual((found.complaints, found.identities["host"]), ({}, reachable.identity_here()))
            speaks.unlink()
        self.assertEqual(named, [["host"]] * 2)


class Marks(unittest.TestCase):
    def test_any_shell_runs_a_marked_line(self):
        line = marked_answer.marked("echo \"it's $((1 + 1))\"")
        for shell in ("sh", "bash", "dash"):
            said = subprocess.run([shell, "-c", line], capture_output=True, text=True, timeout=60).stdout
            self.assertEqual(marked_answer.answer(said), (0, "it's 2\n"), shell)

    def test_the_line_of_a_program_is_found_among_those_of_libraries(self):
        self.assertEqual(marked_answer.own_line("sandwall-master: why\nlibGL warning: later\n"), "sandwall-master: why")
        self.assertEqual(marked_answer.own_line("a\n b \n\n"), "b")
        self.assertEqual(marked_answer.own_line(""), "")

    def test_lines_are_found_by_their_first_word(self):
        self.assertEqual(marked_answer.named_lines("a 1\nb 2\na 3\nc\n"), {"a": "1\n3", "b": "2", "c": ""})


if __name__ == "__main__":
    unittest.main()
