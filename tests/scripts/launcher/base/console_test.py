#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests that a session continues when the launcher's own output cannot be written, as on a full disk."""

import os
import pathlib
import subprocess
import sys
import tempfile
import unittest
from unittest import mock

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "support"))
from supervisor_fixture import Supervised
from base import console
from job import job_log, open_mpi


class FullDisk(Supervised):
    def ended_into(self, stdout, stderr, *options):
        """Runs a session of one rank whose output goes to these files. Returns the exit status of the launcher."""
        return subprocess.run(self.command(["-"], *options), env=self.environment, stdin=subprocess.DEVNULL,
                              stdout=stdout, stderr=stderr, timeout=120).returncode

    def full(self):
        full = open("/dev/full", "wb")
        self.addCleanup(full.close)
        return full

    def test_a_session_survives_standard_output_that_is_full(self):
        self.tries("progress 7 6; dies 1 host 9", "progress 9 8; exit 0")
        self.assertEqual(self.ended_into(self.full(), subprocess.DEVNULL), 0)
        self.assertEqual(len(self.commands()), 2)

    def test_a_session_survives_standard_error_that_is_full(self):
        self.environment["SANDWALL_EVENTS"] = "1"
        self.tries("progress 7 6; complain 1 'last words'; dies 1 host 9", "progress 9 8; exit 0")
        self.assertEqual(self.ended_into(subprocess.DEVNULL, self.full()), 0)
        self.assertEqual(len(self.commands()), 2)

    def test_a_session_survives_output_that_is_closed(self):
        self.tries("progress 7 6; dies 1 host 9", "progress 9 8; exit 0")
        command = ["sh", "-c", 'exec "$@" >&- 2>&-', "sh", *self.command(["-"])]
        self.assertEqual(subprocess.run(command, env=self.environment, stdin=subprocess.DEVNULL, timeout=120).returncode, 0)

    def test_bad_input_keeps_its_status(self):
        ended = self.ended_into(self.full(), self.full(), "--network", "nowhere")
        self.assertEqual(ended, 2)

    def test_a_session_without_restarts_survives_too(self):
        self.tries("echo said; exit 0")
        self.assertEqual(self.ended_into(self.full(), self.full(), "--restarts", "0"), 0)

    def test_a_session_that_is_given_up_keeps_its_status(self):
        self.tries("dies 1 host 9", "dies 1 host 9")
        self.assertEqual(self.ended_into(self.full(), self.full(), "--restarts", "1"), 1)


class LogWithoutDisk(unittest.TestCase):
    def test_a_job_runs_although_no_file_can_be_made_for_its_output(self):
        said = mock.patch("job.job_stream.print_line")
        said.start()
        self.addCleanup(said.stop)
        log = job_log.JobLog("/nowhere", 1, open_mpi.OpenMpi4("4.1.4"))
        self.addCleanup(log.close)
        event = '@sandwall {"event":"progress","frame":7,"step":6,"fps":60.0,"skew_us":9.0,"hand":"no hand"}'
        subprocess.run(["sh", "-c", f"echo '[1,0]<stderr>:{event}' >&2"], stdout=log.out.file, stderr=log.err.file, check=True)
        log.follow(ended=True)
        self.assertEqual((log.frame, log.step), (7, 6))


class HeldLines(unittest.TestCase):
    def test_the_newest_thousand_are_shown_at_the_first_frame(self):
        with tempfile.TemporaryDirectory(prefix="sandwall-console-") as folder:
            log = job_log.JobLog(folder, 1, open_mpi.OpenMpi4("4.1.4"), held=True)
            self.addCleanup(log.close)
            shown = []
            log.out.shown = mock.Mock(line=shown.append)
            for number in range(1500):
                log.show(log.out, number)
            self.assertEqual(shown, [])
            log.release()
            self.assertEqual(shown, list(range(500, 1500)))
            log.show(log.out, 1500)
            self.assertEqual(shown[1000:], [1500])


class MissingLines(unittest.TestCase):
    def setUp(self):
        self.room = 0  # bytes that the made-up disk still takes
        self.written = b""
        patched = mock.patch("os.write", self.write)
        patched.start()
        self.addCleanup(patched.stop)
        self.console = console.Console(7)

    def write(self, descriptor, text):
        self.assertEqual(descriptor, 7)
        if self.room == 0:
            raise OSError(28, os.strerror(28))
        taken = text[:self.room]
        self.room -= len(taken)
        self.written += taken
        return len(taken)

    def test_they_are_counted_once_when_there_is_room_again(self):
        for number in range(3):
            self.console.line(f"lost {number}")
        self.assertEqual(self.written, b"")
        self.room = 1 << 20
        self.console.line("here")
        self.console.line(b"and here")
        self.assertEqual(self.written, b"sandwall: 3 lines are missing here, because this output could not be written "
                                       b"(No space left on device)\nhere\nand here\n")

    def test_a_line_that_was_cut_ends_before_the_next(self):
        self.room = 4
        self.console.line("cut off")
        self.room = 1 << 20
        self.console.line("whole")
        self.assertEqual(self.written.split(b"\n")[0], b"cut ")
        self.assertRegex(self.written.split(b"\n")[1], b"^sandwall: 1 line is missing here")
        self.assertEqual(self.written.split(b"\n")[2:], [b"whole", b""])

    def test_text_that_no_stream_takes_is_replaced(self):
        self.room = 1 << 20
        self.console.line("half a pair: \ud800")  # JSON of another program may hold it
        self.console.line("a name: \udcff")  # Python's form of a byte in a file's name
        self.assertEqual(self.written, b"half a pair: ?\na name: \xff\n")

    def test_a_stream_that_does_not_exist_is_never_written(self):
        closed = console.Console(None)
        self.room = 1 << 20
        closed.line("nothing")
        self.assertEqual(self.written, b"")


if __name__ == "__main__":
    unittest.main()
