#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests of scripts/sandwall doctor without a wall, with made-up programs."""

import json
import os
import pathlib
import subprocess
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "support"))
from launcher_fixture import ROOT, LauncherTest
from hosts import this_machine

# Draws with the backends in $BACKENDS. Its first option is --version or --probe.
NODE = """#!/bin/sh
[ "$1" = --version ] && { echo '{"build": "0123456789abcdef"}'; exit 0; }
case " $BACKENDS " in *" $4 "*) echo "{\\"backend\\": \\"$4\\", \\"renderer\\": \\"made-up renderer\\", \\"shortcomings\\": []}"; exit 0 ;; esac
echo "sandwall-render-node: --gl $4: install Debian's made-up package" >&2
exit 2
"""
MPIRUN = """#!/bin/sh
[ -z "$MPI_FAULT" ] || { echo "$MPI_FAULT" >&2; exit 1; }
"""
CHECK = """#!/bin/sh
[ "$1" = --free-memory ] || exec "$0.of_walls" "$@"
[ -n "$MADE_UP_FREE" ] && echo "free $MADE_UP_FREE"
"""


class ThisMachine(LauncherTest):
    def setUp(self):
        super().setUp()
        for name, text in (("sandwall-render-node", NODE), ("sandwall-master", NODE), ("mpirun", MPIRUN)):
            self.script(name, text)
        bin = self.folder / "bin"
        (bin / "sandwall-check").rename(bin / "sandwall-check.of_walls")
        self.script("sandwall-check", CHECK)
        self.environment.update(BACKENDS="osmesa egl glfw", MADE_UP_FREE=str(8192 << 20))

    def doctor(self, *options):
        return subprocess.run([str(ROOT / "scripts" / "sandwall"), "doctor", "--out", str(self.folder), *options], env=self.environment,
                              text=True, capture_output=True, timeout=100, stdin=subprocess.DEVNULL)

    def findings(self, status, *options):
        """Returns {check or backend: finding} of the doctor, which must end with this status."""
        ended = self.doctor("--json", *options)
        self.assertEqual((ended.returncode, ended.stderr), (status, ""))
        found = json.loads(ended.stdout)
        self.assertEqual(found["red"], sum(not one["good"] and one.get("needed", True) for one in found["findings"]))
        return {one.get("backend", one["check"]): one for one in found["findings"]}

    def test_every_question_is_answered(self):
        found = self.findings(0)
        self.assertEqual(list(found), ["master", "disk", "lo", "shm", "limit", "tmp", "build", "mpi", "start", "cores", "memory", "display", "osmesa", "egl", "glfw"])
        self.assertEqual(found["cores"]["cores"], len(os.sched_getaffinity(0)))
        self.assertEqual(found["memory"]["free_mebibytes"], 8192)
        self.assertEqual(found["egl"]["renderer"], "made-up renderer")

    def test_what_a_session_can_do_without_is_not_red(self):
        self.environment["BACKENDS"] = "osmesa"
        found = self.findings(0)
        for name in ("display", "egl", "glfw"):
            self.assertEqual((found[name]["good"], found[name]["needed"]), (False, False), name)
        self.assertIn("install Debian's made-up package", found["egl"]["message"])
        text = self.doctor().stdout
        self.assertRegex(text, r"(?m)^\S+  no   display DISPLAY is not set")
        self.assertTrue(text.endswith("all green\n"), text)

    def test_what_every_session_needs_is_red(self):
        self.environment["BACKENDS"] = "egl glfw"
        self.assertTrue(self.findings(1)["osmesa"]["needed"])
        self.environment.update(BACKENDS="osmesa", MPI_FAULT="no slots")
        self.assertEqual(self.findings(1)["start"]["message"], "no slots")

    def test_a_build_without_osmesa_draws_in_memory_with_egl(self):
        self.script("sandwall-gl-egl.so", "")
        self.environment["BACKENDS"] = "egl"
        found = self.findings(0)
        self.assertNotIn("osmesa", found)
        self.assertTrue(found["egl"]["good"])
        self.environment["BACKENDS"] = "glfw"
        self.assertTrue(self.findings(1)["egl"]["needed"])

    def test_an_mpirun_that_no_session_can_use_is_red(self):
        self.environment["MADE_UP_MPI"] = "3.1"
        self.assertIn("is of Open MPI 3.1; Sandwall supports Open MPI 4.1 and 5", self.findings(1)["start"]["message"])

    def test_a_chosen_backend_is_the_only_one_asked_and_is_needed(self):
        found = self.findings(0, "--gl", "egl")
        self.assertEqual([name for name in found if name in ("osmesa", "egl", "glfw")], ["egl"])
        self.environment["BACKENDS"] = "osmesa"
        self.assertTrue(self.findings(1, "--gl", "egl")["egl"]["needed"])

    def test_a_display_that_does_not_answer_is_named(self):
        self.environment["DISPLAY"] = ":64999"
        self.assertIn("no X server accepts connections at DISPLAY=:64999", self.findings(1)["display"]["message"])
        self.assertFalse(self.findings(0, "--gl", "osmesa")["display"]["needed"])

    def test_memory_decides_the_largest_field(self):
        for megabytes, side in ((256, 0), (310, 512), (460, 1024), (1100, 2048), (8192, 4096)):
            self.environment["MADE_UP_FREE"] = str(megabytes << 20)
            found = self.findings(0 if side else 1)["memory"]
            self.assertEqual(found["largest_side"], side, megabytes)
        self.assertEqual(this_machine.largest_side(0), 0)

    def test_a_program_that_does_not_tell_the_memory_is_red(self):
        self.environment["MADE_UP_FREE"] = ""
        self.assertIn("bin/sandwall-check does not answer ()", self.findings(1)["memory"]["message"])


if __name__ == "__main__":
    unittest.main()
