#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests which output of its programs scripts/sandwall run passes on, and how it is stopped."""

import pathlib
import signal
import subprocess
import unittest

from supervisor_fixture import Supervised


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
    def test_a_session_that_fails_while_it_is_stopped_is_not_started_again(self):
        self.tries("progress 1 1; read -r line; dies 1 host 9")
        process = self.begin(["-"])
        self.wait_for("journal", (self.folder / "out/session.journal").exists)
        process.send_signal(signal.SIGINT)
        process.communicate(timeout=60)
        self.assertEqual((process.returncode, len(self.commands())), (137, 1))

    def test_a_connection_that_ends_stops_a_session_unless_nohup_has_started_it(self):
        self.tries("until read -r -t 0.1 line; do progress 1 1; done; echo $line > $folder/asked; exit 0")
        for command in ([], ["nohup"]):
            (self.folder / "tries").unlink(missing_ok=True)
            (self.folder / "asked").unlink(missing_ok=True)
            (self.folder / "out/session.journal").unlink(missing_ok=True)
            process = subprocess.Popen([*command, *self.command(["-"])], env=self.environment, stdin=subprocess.PIPE,
                                       stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
            self.wait_for("journal", (self.folder / "out/session.journal").exists)
            process.send_signal(signal.SIGHUP)
            if command:
                for _ in range(10):  # the launcher looks for signals between two of these lines
                    self.assertEqual(process.stdout.readline(), "a line of progress\n")
                process.stdin.write("typed\n")
                process.stdin.flush()
            error = process.communicate(timeout=60)[1]
            self.assertEqual((process.returncode, (self.folder / "asked").read_text()), (0, "typed\n" if command else "stop\n"), error)
            self.assertEqual("stopping" in error, not command)

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
