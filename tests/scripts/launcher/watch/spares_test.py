#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests which spare host replaces a lost one."""

import pathlib
import re
import sys
import unittest
from unittest import mock

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "support"))
from supervisor_fixture import Supervised
from hosts import reachable, session_memory
from job.rank_hosts import HERE
from watch.spare_hosts import SessionHosts


class Spares(Supervised):
    def hosts(self, *lines):
        return ["--hosts", self.write("hosts", "\n".join(lines) + "\n")]

    def placed(self):
        """Returns the hosts of the ranks of each try."""
        return [re.findall(r"--host (\S+):\d+", command) for command in self.commands()]

    def test_a_host_that_cannot_be_reached_at_the_start_is_replaced(self):
        self.tries("exit 0")
        status, _, error = self.ended(["-"] * 3, *self.hosts("node1", "away1 slots=2", "small1 spare", "away2 spare slots=2",
                                                            "node7 slots=2 spare", "node8 slots=2 spare"))
        self.assertEqual((status, self.placed()), (0, [["node1", "node7"]]), error)
        self.assertEqual(error, "sandwall: spare away2 cannot be reached either\n"
                         "sandwall: away1 (rank 2): cannot be reached: ssh: connect to host away1 port 22: No route to host; "
                         "docs/hosts.md; spare node7 takes its place (ranks 2, 3)\n")

    def test_a_host_that_has_gone_is_replaced_when_the_session_is_started_again(self):
        self.tries("progress 1 1; mv $folder/bin/agent $folder/bin/there; sed 's/away/node2|away/' $folder/bin/there > $folder/bin/agent; "
                   "chmod +x $folder/bin/agent; dies 2 node2 9", "exit 0")
        status, _, error = self.ended(["-"] * 2, *self.hosts("node1", "node2", "node3 spare"))
        self.assertEqual((status, self.placed()), (0, [["node1", "node2"], ["node1", "node3"]]), error)

    def test_a_broken_host_is_replaced_at_once(self):
        self.tries("""progress 1 1; told '{"what": "broken", "rank": 2, "host": "node2", "message": "rank 2 is broken"}'; ends 0 1""",
                   "exit 0")
        status, _, error = self.ended(["-"] * 2, *self.hosts("node1", "node2", "node3 spare"))
        self.assertEqual((status, self.placed()), (0, [["node1", "node2"], ["node1", "node3"]]), error)
        self.assertIn("sandwall: node2: its ranks have failed too often; spare node3 takes its place (rank 2)", error)

    def test_a_host_that_fails_twice_is_replaced(self):
        self.tries(*["progress 1 1; dies 1 node1 9"] * 2, "exit 0")
        status, _, error = self.ended(["-"] * 2, *self.hosts("node1", "node2", "node3 spare"))
        self.assertEqual((status, self.placed()), (0, [["node1", "node2"]] * 2 + [["node3", "node2"]]), error)

    def test_without_a_spare_a_host_that_fails_is_tried_again(self):
        self.tries(*["progress 1 1; dies 1 node1 9"] * 2, "exit 0")
        self.assertEqual(self.ended(["-"] * 2, *self.hosts("node1", "node2"))[0], 0)

    def test_without_a_spare_a_host_that_has_gone_is_the_end(self):
        self.tries("progress 1 1; mv $folder/bin/agent $folder/bin/there; sed 's/away/node2|away/' $folder/bin/there > $folder/bin/agent; "
                   "chmod +x $folder/bin/agent; dies 2 node2 9")
        status, _, error = self.ended(["-"] * 2, *self.hosts("node1", "node2"))
        self.assertEqual(status, 1)
        self.assertIn("sandwall: the session is given up: node2 (rank 2): cannot be reached", error)
        self.assertIn("rank 2 on node2 was killed by SIGKILL", error)

    def test_spares_draw_nothing_while_all_is_well(self):
        self.assertEqual(self.printed(["-"] * 2, *self.hosts("node1 spare", "node2 slots=2")),
                         self.printed(["-"] * 2, *self.hosts("node2 slots=2")))


class SparesWithTooLittleMemory(unittest.TestCase):
    """Spares that answer, and have less or more memory than a rank needs."""

    def test_are_passed_over(self):
        needs = session_memory.needs_of("master 1 1 1 0\n1 50 60 70 0\n2 50 60 70 0\n")
        hosts = SessionHosts(["n1", "n2"], [("small", 1), ("same", 1), ("large", 1)], "node", "4.1.4", needs=needs)
        hosts.identities = {"n1": "a/1", "n2": "b/2", "small": "c/3", "same": "a/1", "large": "d/4"}
        hosts.free = {"n1": 139, "n2": 70, "small": 69, "same": 139, "large": 70}
        lines = []
        with mock.patch.object(hosts, "ask", return_value=reachable.Answers()):
            self.assertTrue(hosts.replace("n2", "n2 is gone", lines.append))
        self.assertEqual(hosts.names, ["n1", "large"])
        self.assertEqual(lines, ["spare small cannot take the place of n2: needs 0 MiB on small for 1 rank, where 0 MiB are free",
                                 "spare same cannot take the place of n2: needs 0 MiB on n1 for 2 ranks, where 0 MiB are free",
                                 "n2 is gone; spare large takes its place (rank 2)"])
        self.assertEqual(hosts.spares, [("small", 1), ("same", 1)], "they may have the memory later")

    def test_a_name_of_this_machine_is_a_spare_with_the_memory_of_this_machine(self):
        hosts = SessionHosts(["n1"], [("me", 1)], "node", "4.1.4", needs=session_memory.needs_of("master 1 1 1 0\n1 50 60 70 0\n"))
        hosts.identities = {HERE: "a/1", "me": "a/1", "n1": "b/2"}
        hosts.free = {"n1": 500, "me": 500}
        for free, taken in ((70, False), (71, True)):
            with mock.patch.object(hosts, "ask", return_value=reachable.Answers()), mock.patch.object(reachable, "free_here", return_value=free):
                self.assertEqual(hosts.replace("n1", "n1 is gone", lambda line: None), taken, free)


if __name__ == "__main__":
    unittest.main()
