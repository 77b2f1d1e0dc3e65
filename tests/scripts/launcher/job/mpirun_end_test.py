#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests that an mpirun that does not end after its last process is found and killed."""

import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time
import unittest
from unittest import mock

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[4] / "scripts" / "launcher"))
sys.dont_write_bytecode = True
from job import mpirun_end, processes

SECONDS = 0.5
# Each begins as a shell and becomes a program that waits for no child: the child that ends stays a zombie.
STUCK = "sleep 2 & exec sleep 1000"
AT_WORK = "sleep 0.2 & exec python3 -c 'while True: pass'"
WITH_A_RANK = "sleep 0.2 & sleep 1000 & exec sleep 1000"
BEFORE_ITS_RANKS = "exec sleep 1000"


class NoSignal:
    count = 0


def job(script):
    made = processes.Job(["sh", "-c", script], dict(os.environ))
    made.end_watch.seconds = SECONDS
    return made


def end_of(made, seconds):
    """Returns the status of a job, or None if it has not ended in `seconds`."""
    until = time.monotonic() + seconds
    while time.monotonic() < until:
        status = made.look(NoSignal)
        if status is not None:
            return status
    return None


class MpirunEnd(unittest.TestCase):
    def setUp(self):
        self.jobs = []
        # Looks often, so that the test is short.
        self.addCleanup(setattr, mpirun_end, "LOOK_SECONDS", mpirun_end.LOOK_SECONDS)
        mpirun_end.LOOK_SECONDS = 0.05

    def tearDown(self):
        for made in self.jobs:
            made.signal(9)
            made.process.wait()
            made.process.stdin.close()

    def begin(self, script):
        self.jobs.append(job(script))
        return self.jobs[-1]

    def test_one_that_sleeps_after_its_last_process_is_killed(self):
        self.assertEqual(end_of(self.begin(STUCK), 60), processes.STUCK_STATUS)

    def test_one_with_work_a_rank_or_no_rank_yet_is_left(self):
        for script in (AT_WORK, WITH_A_RANK, BEFORE_ITS_RANKS):
            with self.subTest(script):
                made = self.begin(script)
                self.assertIsNone(end_of(made, 4 * SECONDS))
                self.assertFalse(made.stuck)

    def test_a_process_with_a_strange_name_is_read(self):
        with tempfile.TemporaryDirectory() as folder:
            name = pathlib.Path(folder, "a) Z 1 (b")
            name.symlink_to(shutil.which("sleep"))
            with subprocess.Popen([name, "1000"]) as child:
                found = mpirun_end.process(child.pid)
                child.kill()
        self.assertEqual(found.parent, os.getpid())
        self.assertTrue(found.runs())

    def test_a_process_that_has_ended_is_none(self):
        with subprocess.Popen(["true"]) as child:
            child.wait()
        self.assertIsNone(mpirun_end.process(child.pid))


class EndWatch(unittest.TestCase):
    """An mpirun with the id 10 and a rank with the id 11. The test moves the clock and tells what /proc shows."""

    def setUp(self):
        self.now = 1000.0
        self.shown = {}
        patched = mock.patch("job.mpirun_end.process", lambda pid: self.shown.get(pid))
        patched.start()
        self.addCleanup(patched.stop)
        patched = mock.patch("job.mpirun_end.running_child", lambda parent: next(
            (pid for pid, found in self.shown.items() if found.parent == parent and found.runs()), None))
        patched.start()
        self.addCleanup(patched.stop)
        self.watch = mpirun_end.EndWatch(10)

    def show(self, seconds, mpirun="S", ticks=lambda second: 0, rank=None, faults=0):
        """Shows an mpirun in this state for some seconds, with a rank in the state `rank`. ticks(second) is the processor
        time that mpirun has used. Returns the second in which it counts as stuck, or None."""
        for tenth in range(seconds * 10):
            self.now += 0.1
            self.shown = {10: mpirun_end.Process(mpirun, 1, ticks(tenth / 10), faults)}
            if rank:
                self.shown[11] = mpirun_end.Process(rank, 10, 5)
            if self.watch.stuck(self.now):
                return tenth / 10
        return None

    def test_one_that_sleeps_after_its_last_rank_is_stuck_after_ten_seconds(self):
        self.assertIsNone(self.show(60, rank="S"))
        found = self.show(60)
        self.assertTrue(10 <= found <= 11.5, f"{found} s: it looks twice in a second")

    def test_one_whose_last_rank_is_a_zombie_or_dead_is_stuck(self):
        for state in "ZX":
            with self.subTest(state):
                self.watch = mpirun_end.EndWatch(10)
                self.show(1, rank="R")
                self.assertIsNotNone(self.show(12, rank=state))

    def test_one_that_computes_is_not_stuck_although_it_sleeps_whenever_it_is_looked_at(self):
        self.show(1, rank="S")
        self.assertIsNone(self.show(60, ticks=int))
        self.assertIsNone(self.show(60, ticks=lambda second: 1000 + int(second / 9)), "a tick in nine seconds is work")
        found = self.show(60, ticks=lambda second: 9999)
        self.assertTrue(10 <= found <= 11.5, f"{found} s after its last work")

    def test_one_that_waits_for_a_processor_or_a_disk_is_not_stuck(self):
        for state in "RD":
            with self.subTest(state):
                self.watch = mpirun_end.EndWatch(10)
                self.show(1, rank="S")
                self.assertIsNone(self.show(60, mpirun=state))

    def test_one_before_its_first_rank_or_with_a_rank_is_not_stuck(self):
        self.assertIsNone(self.show(110))
        self.assertIsNone(self.show(60, rank="S"))
        self.assertIsNone(self.show(9))
        self.assertIsNone(self.show(60, rank="R"), "another rank")
        self.assertIsNone(self.show(9), "the seconds count from the end of the last rank")

    def test_one_that_sleeps_before_its_first_rank_is_stuck_after_two_minutes(self):
        found = self.show(200)
        self.assertTrue(120 <= found <= 122, f"{found} s: it looks twice in a second")

    def test_one_whose_ranks_have_ended_unseen_is_stuck_sooner_than_one_before_them(self):
        found = self.show(200, faults=9)
        self.assertTrue(10 <= found <= 11.5, f"{found} s: its ranks may be on other hosts")

    def test_one_whose_ranks_end_in_their_first_instant_here_is_stuck_after_a_second(self):
        self.watch = mpirun_end.EndWatch(10, here=True)
        self.assertIsNone(self.show(2, rank="R"))
        found = self.show(60, faults=9)
        self.assertTrue(1 <= found <= 1.6, f"{found} s")

    def test_one_here_whose_children_nobody_has_seen_is_stuck_after_ten_seconds(self):
        self.watch = mpirun_end.EndWatch(10, here=True)
        self.assertIsNone(self.show(2))
        found = self.show(60, faults=9)
        self.assertTrue(10 <= found <= 11.5, f"{found} s: they may be commands of a script around mpirun")

    def test_one_here_whose_ranks_have_lived_for_long_is_stuck_after_ten_seconds(self):
        self.watch = mpirun_end.EndWatch(10, here=True)
        self.assertIsNone(self.show(4, rank="R"))
        found = self.show(60, faults=9)
        self.assertTrue(10 <= found <= 11.5, f"{found} s")

    def test_one_here_before_its_first_rank_is_not_stuck(self):
        self.watch = mpirun_end.EndWatch(10, here=True)
        self.assertIsNone(self.show(110))

    def test_one_that_has_ended_is_not_stuck(self):
        self.show(1, rank="S")
        self.show(9)
        self.shown = {}
        self.now += 60
        self.assertFalse(self.watch.stuck(self.now))


if __name__ == "__main__":
    unittest.main()
