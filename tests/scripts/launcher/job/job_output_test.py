#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests that the output of a job stays small on the disk and hinders no process, and that a job ends with its launcher."""

import fcntl
import os
import pathlib
import re
import resource
import subprocess
import sys
import tempfile
import unittest
from unittest import mock

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "support"))
from supervisor_fixture import Supervised
from base import process_marks
from job import bounded_log, job_guard, job_outlet, job_stream, open_mpi, processes

MIB = 1 << 20


def line(number):
    return b"line %06d of the output\n" % number


class Folder(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory(prefix="sandwall-output-")
        self.addCleanup(temporary.cleanup)
        self.path = pathlib.Path(temporary.name, "log")

    def expect_first_and_newest(self, count, most):
        """Expects a log of at most `most` bytes with the first and the newest of `count` lines, and how many bytes are not there."""
        text = self.path.read_bytes()
        self.assertLessEqual(len(text), most)
        found = re.fullmatch(rb"(?s)(.*\n)\[(\d+) bytes are left out here\]\n(.*)", text)
        first, newest = found[1].splitlines(True), found[3].splitlines(True)
        self.assertEqual(first, [line(number) for number in range(len(first))])
        self.assertEqual(newest, [line(number) for number in range(count - len(newest), count)])
        self.assertEqual(int(found[2]), (count - len(first) - len(newest)) * len(line(0)))
        self.assertGreater(min(len(first), len(newest)) * len(line(0)), most // 5)


class BoundedLog(Folder):
    def log(self):
        made = bounded_log.BoundedLog(job_stream.new_log(self.path))
        self.addCleanup(os.close, made.file)
        return made

    def test_a_short_log_is_whole(self):
        log = self.log()
        log.write(line(0) + line(1))
        self.assertEqual(self.path.read_bytes(), line(0) + line(1))

    def test_the_first_and_the_newest_lines_of_a_long_log_are_kept(self):
        with mock.patch("job.bounded_log.MOST_BYTES", 10000):
            log = self.log()
            for number in range(5000):
                log.write(line(number))
                self.assertLessEqual(self.path.stat().st_size, 10000)
        self.expect_first_and_newest(5000, 10000)

    def test_a_limit_of_file_size_shortens_a_log(self):
        with mock.patch("resource.getrlimit", return_value=(10000, 10000)):
            log = self.log()
        for number in range(5000):
            log.write(line(number))
        self.expect_first_and_newest(5000, 10000)

    def test_a_disk_that_is_full_is_named_and_hinders_nobody(self):
        log = bounded_log.BoundedLog(os.open("/dev/full", os.O_RDWR))
        self.addCleanup(os.close, log.file)
        log.write(line(0))
        self.assertEqual(log.why, os.strerror(28))
        nothing = bounded_log.BoundedLog(None)
        nothing.write(line(0))
        self.assertEqual(nothing.why, "")

    def test_the_file_of_a_rank_is_shortened_too(self):
        with mock.patch("job.bounded_log.MOST_BYTES", 100000):
            stream = job_stream.RankStream(str(self.path), mock.Mock(), open_mpi.OpenMpi5("5.0.7"), 1)
            count = 0
            for number in range(20000):
                os.write(stream.file, line(number))
                if number % 100 == 99:
                    count += len(list(stream.lines(False)))
            self.assertEqual(count, 20000)
            self.assertLess(self.path.stat().st_blocks * 512, 20000 * len(line(0)) // 2, "the disk has got nothing back")
            stream.close()
        self.expect_first_and_newest(20000, 100000)


class Outlet(Folder):
    def test_output_that_comes_too_fast_is_left_out_and_not_kept_in_memory(self):
        outlet = job_outlet.Outlet(job_stream.new_log(self.path))
        self.addCleanup(outlet.close)
        pump = job_outlet.Pump([outlet])
        with open(outlet.file, "wb", buffering=0, closefd=False) as file:
            for number in range(0, 40000, 100):
                file.write(b"".join(map(line, range(number, number + 100))))
        pump.stop()
        found, left_out = outlet.take()
        self.assertEqual(found[-len(line(0)) - 1:], line(39999) + b"\n")
        self.assertEqual((len(found), len(found) + left_out), (job_outlet.MOST_WAITING, 40000 * len(line(0)) + 1))
        self.assertEqual(self.path.stat().st_size, 40000 * len(line(0)) + 1)


    def test_the_pipe_holds_what_mpirun_writes_until_it_is_read(self):
        outlet = job_outlet.Outlet(None)
        self.addCleanup(outlet.close)
        # A mebibyte is also the most that Linux gives a user by its default (pipe-max-size).
        most = int(pathlib.Path("/proc/sys/fs/pipe-max-size").read_text())
        self.assertEqual(fcntl.fcntl(outlet.file, fcntl.F_GETPIPE_SZ), min(MIB, most))


class Flood(Supervised):
    def test_a_flood_ends_in_a_small_log(self):
        self.tries("""progress 1 1; say 0 "the first line"; yes '[1,0]<stdout>:one of many lines' | head -c 30000000
            say 0 "the last line"; progress 2 2; exit 0""")
        status, printed, error = self.ended(["-"])
        self.assertEqual(status, 0, error)
        self.assertTrue(printed.endswith("the last line\na line of progress\n"), printed[-200:])
        log = (self.folder / "out/log/try_1.out").read_bytes()
        self.assertLessEqual(len(log), bounded_log.MOST_BYTES)
        self.assertIn(b"the first line\n", log[:200])
        self.assertIn(b"the last line\n", log[-200:])

    def test_a_job_whose_launcher_is_killed_can_go_on_printing_and_ends_in_order(self):
        self.tries("progress 1 1; until [ -e $folder/seen ]; do sleep 0.05; done; progress 2 2; "
                   "read -r line; head -c 5000000 /dev/zero | tr '\\0' x && touch $folder/done; exit 0")
        self.environment["SANDWALL_EVENTS"] = "1"
        process = self.begin(["-"])
        for frame in (1, 2):  # the launcher looks for frames between these two lines
            while f'"frame":{frame},' not in process.stderr.readline():
                self.assertIsNone(process.poll())
            self.write("seen", "")
        process.kill()
        process.wait(60)
        self.wait_for("orderly end", (self.folder / "done").exists)

    def test_a_limit_of_file_size_ends_no_session(self):
        self.tries("progress 1 1; yes '[1,0]<stdout>:one of many lines' | head -c 30000000; progress 2 2; exit 0")
        limit = 16 * MIB
        ended = subprocess.run(self.command(["-"]), env=self.environment, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, timeout=120,
                               preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit)))
        self.assertEqual(ended.returncode, 0)


class Guard(unittest.TestCase):
    def begin(self, script):
        """Starts a made-up mpirun and returns it with its mark."""
        mark = f"{processes.MARK}=made-up-{os.getpid()}-{id(script)}"
        name, _, value = mark.partition("=")
        process = subprocess.Popen(["sh", "-c", script], env={**os.environ, name: value}, stdout=subprocess.PIPE, start_new_session=True)
        self.addCleanup(process.stdout.close)
        self.addCleanup(process.wait)
        process.stdout.readline()
        return process, mark.encode()

    def test_a_job_that_does_not_end_is_killed_with_all_that_it_has_started(self):
        process, mark = self.begin("trap '' TERM; sleep 1000 & setsid sleep 1000 & echo begun; wait")
        with mock.patch.multiple(processes, ORDERLY_END_SECONDS=0.1, KILL_SECONDS=0.2):
            job_guard.end(process.pid, mark, [])
        self.assertEqual(process_marks.marked(mark), [])
        self.assertEqual(process.wait(60), -9)

    def test_a_job_that_ends_in_order_is_left_to_it(self):
        process, mark = self.begin("echo begun; sleep 0.3; exit 7")
        job_guard.end(process.pid, mark, [])
        self.assertEqual(process.wait(60), 7)

    def test_a_job_without_a_frame_is_ended_at_once(self):
        process, mark = self.begin("sleep 1000 & echo begun; wait")
        job_guard.end(process.pid, mark, [], in_order=False)
        self.assertEqual(process_marks.marked(mark), [])
        self.assertEqual(process.wait(60), -15, "it may remove its files")

    def test_a_job_without_a_frame_that_does_not_end_is_killed(self):
        process, mark = self.begin("trap '' TERM; sleep 1000 & setsid sleep 1000 & echo begun; wait")
        job_guard.end(process.pid, mark, [], in_order=False)
        self.assertEqual(process_marks.marked(mark), [])
        self.assertEqual(process.wait(60), -9)

    def test_a_guard_ends_in_order_what_has_shown_a_frame_and_all_else_at_once(self):
        for in_order, status in ((True, 7), (False, -15)):
            with self.subTest(in_order=in_order):
                process, mark = self.begin("echo begun; sleep 2; exit 7" if in_order else "echo begun; exec sleep 1000")
                guard = processes.Guard(process.pid, mark.decode().partition("=")[2], [])
                if in_order:
                    guard.end_in_order()
                os.close(guard.life)  # as when the launcher has been killed
                self.assertEqual(process.wait(60), status)
                self.assertEqual(guard.process.wait(60), 0)

    def test_another_process_with_its_number_is_left_alone(self):
        process, _ = self.begin("echo begun; sleep 0.3; exit 7")
        with mock.patch.multiple(processes, ORDERLY_END_SECONDS=-1, KILL_SECONDS=0):
            job_guard.end(process.pid, b"SANDWALL_JOB=another", [])
        self.assertEqual(process.wait(60), 7)


if __name__ == "__main__":
    unittest.main()
