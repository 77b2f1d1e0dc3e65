#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests that a session whose processes do not fit the memory of a host is refused in one line before anything starts."""

import pathlib
import resource
import sys
import tempfile
import unittest
from unittest import mock

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "support"))
from launcher_fixture import CHECK, LauncherTest
from base.bad_input import BadInput
from hosts import reachable, session_memory
from job.rank_hosts import HERE

MIB = 2 ** 20
LINES = f"""server {10 * MIB} {20 * MIB} {30 * MIB} {4 * MIB}
master {10 * MIB} {90 * MIB} {50 * MIB} {4 * MIB}
1 {10 * MIB} {20 * MIB} {60 * MIB} {20 * MIB}
2 {10 * MIB} {20 * MIB} {60 * MIB} {20 * MIB}
"""


class Needs(unittest.TestCase):
    def setUp(self):
        self.needs = session_memory.needs_of(LINES)

    def refusal(self, names, free, **identities):
        try:
            session_memory.require("s.toml", self.needs, names, free, identities)
        except BadInput as complaint:
            return str(complaint)
        return ""

    def test_other_lines_are_skipped(self):
        self.assertEqual(list(self.needs), ["server", "master", 1, 2])
        self.assertEqual(session_memory.needs_of("made-up\nserver 1 2 3\n1 2 3 4 -5\n0 1 2 3 4\n"), {})

    def test_the_largest_figure_counts_and_code_only_once(self):
        needed = (30 + 90 + 60 + 40) * MIB
        self.assertEqual(self.refusal([HERE, HERE], {HERE: needed}), "")
        self.assertEqual(self.refusal([HERE, HERE], {HERE: needed - 1}),
                         "s.toml: needs 220 MiB on this machine for the haptic server, the master and 2 ranks, where 220 MiB are free; "
                         + session_memory.ADVICE)

    def test_each_host_has_the_ranks_of_the_wall_file(self):
        self.assertEqual(self.refusal([HERE, "n1"], {HERE: 180 * MIB, "n1": 60 * MIB}), "")
        self.assertTrue(self.refusal([HERE, "n1"], {HERE: 180 * MIB, "n1": 59 * MIB}).startswith(
            "s.toml: needs 60 MiB on n1 for 1 rank, where 59 MiB are free; "))
        self.assertEqual(self.refusal([HERE, "n1"], {HERE: 180 * MIB}), "", "a host whose memory is not known")

    def test_two_names_of_one_machine_share_its_memory(self):
        free = {HERE: 180 * MIB, "n1": 60 * MIB, "n2": 60 * MIB}
        self.assertEqual(self.refusal(["n1", "n2"], free, n1="a/1", n2="a/2"), "")
        self.assertTrue(self.refusal(["n1", "n2"], free, n1="a/1", n2="a/1").startswith(
            "s.toml: needs 100 MiB on n1 for 2 ranks, where 60 MiB are free; "))
        self.assertEqual(self.refusal(["n1", "n2"], {**free, "n1": 100 * MIB, "n2": 100 * MIB}, n1="a/1", n2="a/1"), "")
        self.assertTrue(self.refusal([HERE, "me"], {HERE: 219 * MIB, "me": 230 * MIB}, me="a/1", **{HERE: "a/1"}).startswith(
            "s.toml: needs 220 MiB on this machine for the haptic server, the master and 2 ranks, where 219 MiB are free; "))

    def test_a_host_that_has_not_told_what_it_is_counts_by_its_name(self):
        self.assertEqual(self.refusal(["n1", "n2"], {"n1": 60 * MIB, "n2": 60 * MIB}, n1="", n2=""), "")

    def test_a_limit_of_the_process_counts(self):
        with mock.patch.object(resource, "getrlimit", return_value=(89 * MIB, 89 * MIB)):
            self.assertIn("needs 90 MiB in the master, and ulimit -v allows 89 MiB", self.refusal([HERE, HERE], {}))
        with mock.patch.object(resource, "getrlimit", return_value=(90 * MIB, 90 * MIB)):
            self.assertEqual(self.refusal([HERE, HERE], {}), "")

    def test_a_host_tells_its_free_memory_by_its_program(self):
        with tempfile.TemporaryDirectory() as name:
            check = pathlib.Path(name) / "sandwall-check"
            self.assertIsNone(reachable.free_here(str(check)), "no program")
            for said, free in (("free 4096", 4096), ("free -1", None), ("sandwall 1.0", None), ("", None)):
                check.write_text(f"#!/bin/sh\n[ \"$*\" = --free-memory ] && echo '{said}'\n")
                check.chmod(0o755)
                self.assertEqual(reachable.free_here(str(check)), free, said)


class Session(LauncherTest):
    """A session with a made-up sandwall-check, which states the memory, and an mpirun that leaves a mark."""

    def setUp(self):
        super().setUp()
        for name in ("sandwall-master", "sandwall-render-node", "sandwall-haptic-server"):
            self.script(name, "#!/bin/sh\necho '{\"build\": \"0123456789abcdef\"}'\n")
        self.script("mpirun", "#!/bin/sh\necho started >> \"${0%/*}/../started\"\n")

    def server_needs(self, number):
        """Makes the server need so many bytes, and keeps the question."""
        free = '[ "$1" = --free-memory ] && { echo "free 1000000"; exit; }'
        answer = f'{free}\n[ "$2" = --memory ] && {{ echo "$*" > "{self.folder}/asked"; echo "server 1 1 {number} 0"; echo "master 1 1 1 0"; echo "1 1 1 1 0"; exit; }}'
        self.script("sandwall-check", CHECK.replace("\n", f"\n{answer}\n", 1))

    def test_that_does_not_fit_is_refused_before_mpirun_starts(self):
        self.server_needs(2 ** 50)
        line = self.refused(["-"], "--device", "script:gis", "--gl", "osmesa")
        self.assertRegex(line, r"^sandwall: scene\.toml: needs 1048576\.0 GiB on this machine for the haptic server, the master and 1 rank, where ")
        self.assertFalse((self.folder / "started").exists())
        self.assertNotIn("--no-checkpoints", (self.folder / "asked").read_text())

    def test_that_has_no_server_of_its_own_counts_none(self):
        self.server_needs(2 ** 50)
        self.start(["-"], "--gl", "osmesa", "--restarts", "0")
        self.assertTrue((self.folder / "started").exists())

    def test_that_writes_no_checkpoints_asks_for_the_memory_without(self):
        self.server_needs(2 ** 50)
        self.refused(["-"], "--device", "script:gis", "--gl", "osmesa", "--checkpoint", "0")
        self.assertIn("--no-checkpoints", (self.folder / "asked").read_text())


if __name__ == "__main__":
    unittest.main()
