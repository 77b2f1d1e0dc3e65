#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests that a session and the doctor say in one line what mpirun lacks on a machine. Makes namespaces where the system allows it."""

import os
import pathlib
import subprocess
import sys
import tempfile
import unittest
from unittest import mock

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "support"))
from launcher_fixture import ROOT, LauncherTest
from hosts import machine_needs

DF = "Filesystem     1024-blocks  Used Available Capacity Mounted on\ntmpfs                {}     0      {}       0% {}\n"


class Needs(unittest.TestCase):
    def test_shared_memory_must_have_room_for_all_ranks(self):
        self.assertTrue(machine_needs.shared_memory(7, 7, 2).good())
        small, full = machine_needs.shared_memory(6, 6, 2), machine_needs.shared_memory(64, 6, 2)
        self.assertEqual((small.may_come, small.why[:52]), (False, "/dev/shm: has 6 MiB, and 2 processes need 7; mount i"))
        self.assertEqual((full.may_come, full.why[:49]), (True, "/dev/shm: 6 MiB free, and 2 processes need 7; rem"))

    def test_temporary_files_need_room(self):
        self.assertTrue(machine_needs.temporary(12, "/tmp").good())
        self.assertIn("/tmp: 11 MiB free, and mpirun needs 12", machine_needs.temporary(11, "/tmp").why)

    def test_the_folder_is_the_one_that_mpirun_takes(self):
        with tempfile.TemporaryDirectory() as folder, mock.patch.dict(os.environ, TMPDIR=folder):
            self.assertTrue(machine_needs.temporary_here().words.endswith(f" MiB free in {folder}"))
            with mock.patch.dict(os.environ, TMPDIR=f"{folder}/none"):
                found = machine_needs.temporary_here()
                self.assertEqual((found.may_come, found.why.partition(" (")[0]), (False, f"{folder}/none: no temporary file can be made"))

    def test_another_host_is_judged_by_its_answers(self):
        answers = {"shm": DF.format(1024, 1024, "/dev/shm"), "tmp": DF.format(99999, 2048, "/tmp")}
        self.assertEqual([need.why.partition(",")[0] for need in machine_needs.of_answers(answers, 1)],
                         ["/dev/shm: has 1 MiB", "its folder for temporary files: 2 MiB free"])
        self.assertEqual(machine_needs.of_answers({"shm": "df: no such file", "tmp": ""}, 1), [])


class Machine(LauncherTest):
    """A session in namespaces of its own, with a real /dev/shm, TMPDIR and lo."""

    def setUp(self):
        super().setUp()
        self.script("mpirun", "#!/bin/sh\necho started >> \"${0%/*}/../started\"\n")
        for name in ("sandwall-master", "sandwall-render-node"):
            self.script(name, "#!/bin/sh\necho '{\"build\": \"0123456789abcdef\"}'\n")
        (self.folder / "small").mkdir()

    def within(self, namespaces, prepare, *command):
        ended = subprocess.run(["unshare", *namespaces, "sh", "-c", f'{prepare} || exit 77; exec "$@"', "sh", *command], env=self.environment,
                               text=True, capture_output=True, timeout=120, stdin=subprocess.DEVNULL)
        if ended.returncode == 77 or "unshare:" in ended.stderr:
            self.skipTest("this machine does not allow a namespace of a test's own")
        return ended

    def refused_within(self, namespaces, prepare, status, line):
        """Expects one line of the session, and the same line of the doctor."""
        ended = self.within(namespaces, prepare, *self.command(["-"]))
        self.assertEqual((ended.returncode, ended.stderr.count("\n")), (status, 1), ended.stderr)
        self.assertIn(f"sandwall: {line}", ended.stderr.replace(str(self.folder), "."))
        self.assertFalse((self.folder / "started").exists())
        doctor = self.within(namespaces, prepare, str(ROOT / "scripts" / "sandwall"), "doctor", "--out", str(self.folder))
        self.assertEqual(doctor.returncode, 1, doctor.stderr)
        self.assertIn(line, doctor.stdout.replace(str(self.folder), "."), doctor.stderr)

    def test_a_small_shared_memory_is_named(self):
        self.refused_within(["-m"], "mount -t tmpfs -o size=1m none /dev/shm", 2, "/dev/shm: has 1 MiB, and 2 processes need 7")

    def test_a_full_shared_memory_may_still_get_room(self):
        self.refused_within(["-m"], "mount -t tmpfs -o size=16m none /dev/shm && head -c 15m /dev/zero > /dev/shm/full", 75,
                            "/dev/shm: 1 MiB free, and 2 processes need 7")

    def test_a_full_folder_for_temporary_files_is_named(self):
        self.environment["TMPDIR"] = str(self.folder / "small")
        self.refused_within(["-m"], f"mount -t tmpfs -o size=16m none {self.folder}/small && ! cat /dev/zero 2>&- > {self.folder}/small/full", 75,
                            "./small: 0 MiB free, and mpirun needs 12 for temporary files")

    def test_a_limit_of_file_size_is_named(self):
        self.refused_within(["-m"], "ulimit -f 1000", 2, "ulimit -f: a file may have ")

    def test_a_loopback_interface_that_is_down_is_named(self):
        self.refused_within(["-n"], "true", 75, "lo: no connection to 127.0.0.1 (")


if __name__ == "__main__":
    unittest.main()
