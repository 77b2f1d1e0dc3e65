#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests which output of its programs scripts/sandwall run passes on, and how it is stopped."""

import os
import pathlib
import pty
import signal
import subprocess
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "support"))
from supervisor_fixture import Supervised
from job import mpirun_end


class Output(Supervised):
    def test_tags_and_banners_are_not_shown(self):
        self.tries("""
printf '[1,0]<stdout>:half a [1,1]<stdout>:whole of 1\\n[1,0]<stdout>:line\\n'
printf '[1,1]<stderr>:a [1,1]<std'; sleep 0.3; printf 'err>:tag in pieces\\n' >&1
printf '[1,1]<stderr>:' >&2; sleep 0.3; echo 'to stderr' >&2
banner 'a word of mpirun' 'and another'
echo '[host:12] 1 more process has sent a help message' >&2
echo 'ssh says something' >&2
printf '[1,0]<stdout>:no end'
exit 0""")
        self.assertEqual(self.ended(["-"]), (0, "whole of 1\nhalf a line\na tag in pieces\nno end\n", "to stderr\nssh says something\n"))

    def test_a_launcher_without_a_reader_goes_on(self):
        self.tries("for n in 1 2 3; do progress $n $n; sleep 0.2; done; touch $folder/done; exit 0")
        process = subprocess.Popen(self.command(["-"]), env=self.environment, stdin=subprocess.DEVNULL,
                                   stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
        process.stdout.close()
        self.assertEqual(process.wait(60), 0)
        self.assertTrue((self.folder / "done").exists())

    def test_where_no_log_can_be_written_the_master_has_the_word(self):
        (self.folder / "out").mkdir()
        (self.folder / "out" / "log").write_text("a file")
        self.tries("complain 0 'out: cannot be written'; exit 2")
        self.assertEqual(self.ended(["-"]), (2, "", "out: cannot be written\n"))


def environments():
    for entry in pathlib.Path("/proc").iterdir():
        if entry.name.isdigit():
            try:
                yield (entry / "environ").read_bytes().decode(errors="replace")
            except OSError:
                pass


class Stopping(Supervised):
    def setUp(self):
        super().setUp()
        signal.signal(signal.SIGHUP, signal.SIG_DFL)  # nohup may have started the tests

    def test_a_session_that_fails_while_it_is_stopped_is_not_started_again(self):
        self.tries("progress 1 1; read -r line; dies 1 host 9")
        process = self.begin(["-"])
        self.wait_for("journal", (self.folder / "out/session.journal").exists)
        process.send_signal(signal.SIGINT)
        process.communicate(timeout=60)
        self.assertEqual((process.returncode, len(self.commands())), (137, 1))

    def stopped_at_its_start(self, *options):
        """Sends SIGINT to a session before its first frame. Returns its status and what it has printed for a person."""
        process = self.begin(["-"], *options)
        self.wait_for("job", (self.folder / "began").exists)
        process.send_signal(signal.SIGINT)
        error = process.communicate(timeout=60)[1]
        return process.returncode, error

    def test_one_ctrl_c_ends_a_start_that_does_not_listen(self):
        self.tries("touch $folder/began; while :; do sleep 0.05; done")
        status, error = self.stopped_at_its_start()
        self.assertEqual((status, len(self.commands())), (0, 1), error)
        self.assertIn("sandwall: stopped before the first frame\n", error)
        self.assertFalse((self.folder / "out" / "failures.jsonl").exists())

    def test_a_session_that_has_shown_a_frame_before_may_end_in_order(self):
        self.tries("touch $folder/began; read -r line; sleep 3; progress 1 1; touch $folder/ended; exit 0")
        status, error = self.stopped_at_its_start("--resume")
        self.assertEqual(status, 0, error)
        self.assertNotIn("stopped before", error)
        self.assertTrue((self.folder / "ended").exists())

    def hung_up(self, command, terminal, types):
        """Sends SIGHUP to a session that `command` starts. Then types a line that ends it, if the test expects it to continue.

        Returns the line that has ended it, and what it has printed for a person.
        """
        ours, theirs = pty.openpty()
        self.addCleanup(os.close, ours)
        for name in ("tries", "asked", "out/session.journal"):
            (self.folder / name).unlink(missing_ok=True)
        process = subprocess.Popen([*command, *self.command(["-"])], env=self.environment, stdin=theirs if terminal else subprocess.PIPE,
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, start_new_session=True)
        os.close(theirs)
        self.wait_for("journal", (self.folder / "out/session.journal").exists)
        process.send_signal(signal.SIGHUP)
        if types:
            for _ in range(10):  # the launcher looks for signals between two of these lines
                self.assertEqual(process.stdout.readline(), "a line of progress\n")
            os.write(ours if terminal else process.stdin.fileno(), b"typed\n")
        error = process.communicate(timeout=60)[1]
        self.assertEqual(process.returncode, 0, error)
        return (self.folder / "asked").read_text(), error

    def test_the_end_of_its_terminal_ends_a_session_unless_nohup_has_started_it(self):
        self.tries("until read -r -t 0.1 part; do typed=$typed$part; progress 1 1; done; echo $typed$part > $folder/asked; exit 0")
        asked, error = self.hung_up([], terminal=True, types=False)
        self.assertEqual(asked, "stop\n")
        self.assertIn("stopping", error)
        ignoring = ["sh", "-c", "trap '' HUP; exec \"$@\"", "sh"]
        for command, terminal in ((ignoring, True), ([], False), (["nohup", "timeout", "100"], False)):
            self.assertEqual(self.hung_up(command, terminal, types=True)[0], "typed\n", command)

    def test_ctrl_c_ends_a_wait_between_two_tries(self):
        # From the second restart on, the launcher waits before a restart.
        self.tries(*["progress 1 1; dies 1 host 9"] * 9)
        process = self.begin(["-"], "--restarts", "9")
        while "(5 of --restarts 9" not in process.stderr.readline():
            self.assertIsNone(process.poll())
        process.send_signal(signal.SIGINT)
        error = process.communicate(timeout=60)[1]
        self.assertEqual((process.returncode, len(self.commands())), (1, 5), error)
        self.assertIn("sandwall: stopped between two tries", error)

    def test_a_crash_of_mpirun_is_a_failure_and_another_signal_is_told(self):
        for name, status in (("SEGV", 1), ("ABRT", 1), ("TERM", 143)):
            self.tries(f"kill -{name} $$")
            (self.folder / "tries").unlink(missing_ok=True)
            self.assertEqual(self.ended(["-"], "--restarts", "0")[0], status, name)

    def killed_at_its_start(self, script):
        """Kills the launcher before its first frame, and waits until nothing of the job is left."""
        self.tries(f"touch $folder/began; {script}")
        self.environment["TMPDIR"] = str(self.folder / "temporary")
        (self.folder / "temporary").mkdir()
        process = self.begin(["-"])
        self.wait_for("job", (self.folder / "began").exists)
        process.kill()
        process.wait(60)
        self.wait_for("end", lambda: not any(f"SANDWALL_JOB={process.pid}-" in text for text in environments()))
        self.wait_for("removal", lambda: not list((self.folder / "temporary").iterdir()))

    def test_a_launcher_that_is_killed_before_the_first_frame_ends_its_job_at_once(self):
        # The made-up mpirun would read the scene for an hour. It does not notice that its input has ended.
        self.killed_at_its_start("exec sleep 3600")

    def test_a_deaf_job_of_a_launcher_that_is_killed_before_the_first_frame_is_killed(self):
        self.killed_at_its_start("trap '' TERM HUP INT; sleep 3600 & setsid sleep 3600; sleep 3600")

    def test_a_launcher_that_is_killed_while_it_asks_hosts_leaves_no_question(self):
        self.script("agent", f"#!/bin/sh\necho $$ > {self.folder}/asks.new; mv {self.folder}/asks.new {self.folder}/asks; exec sleep 3600\n")
        process = self.begin(["node1"])
        self.wait_for("question", (self.folder / "asks").exists)
        process.kill()
        process.wait(60)
        asks = int((self.folder / "asks").read_text())
        self.wait_for("end", lambda: not ((found := mpirun_end.process(asks)) and found.runs()))

    def test_one_ctrl_c_ends_the_start_of_a_job_without_a_log_by_the_end_of_its_input(self):
        self.tries("touch $folder/began; while read -r line; do :; done; exit 76")
        status, error = self.stopped_at_its_start("--restarts", "0")
        self.assertEqual(status, 0, error)
        self.assertIn("sandwall: stopped before the first frame\n", error)

    def test_a_killed_launcher_leaves_nothing(self):
        self.tries("progress 1 1; read -r line; exit 1")
        process = self.begin(["-"])
        self.wait_for("journal", (self.folder / "out/session.journal").exists)
        process.kill()
        process.wait(60)
        # The input of mpirun has ended, and it is not started again.
        self.wait_for("end", lambda: not any(f"SANDWALL_JOB={process.pid}-" in text for text in environments()))
        self.assertEqual(len(self.commands()), 1)


if __name__ == "__main__":
    unittest.main()
