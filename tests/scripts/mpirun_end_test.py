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

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "scripts"))
sys.dont_write_bytecode = True
import mpirun_end
import processes

SECONDS = 0.5
# Each begins as a shell and becomes a program that waits for no child: the child that ends stays a zombie.
STUCK = "sleep 0.2 & exec sleep 1000"
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


if __name__ == "__main__":
    unittest.main()
