#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests on which machine each rank runs."""

import socket
import tempfile
import unittest

import launcher_fixture  # finds scripts/
import rank_hosts
from rank_hosts import HERE


class HostsOfWall(unittest.TestCase):
    def test_a_tile_without_a_host_is_drawn_here(self):
        self.assertEqual(rank_hosts.hosts_of_wall("-\nnode1\n-\n", "wall"), [HERE, "node1", HERE])

    def test_this_machine_is_known_by_its_name(self):
        name = socket.gethostname()
        self.assertEqual(rank_hosts.hosts_of_wall(f"{name}\nlocalhost\n127.0.0.1\n", "wall"), [HERE] * 3)

    def test_a_name_that_ssh_or_mpirun_would_misread_is_refused(self):
        for name in ("-oProxyCommand=x", "a,b", "a:2", "a/b", "a;b", "x" * 300):
            with self.assertRaisesRegex(rank_hosts.BadInput, "wall.toml: '.*' is not a host name"):
                rank_hosts.hosts_of_wall(name, "wall.toml")


class HostsOfFile(unittest.TestCase):
    def hosts(self, text, ranks):
        with tempfile.NamedTemporaryFile("w", suffix=".hosts") as file:
            file.write(text)
            file.flush()
            try:
                return rank_hosts.hosts_of_file(file.name, ranks)
            except rank_hosts.BadInput as complaint:
                return str(complaint).replace(file.name, "FILE")

    def test_ranks_fill_the_slots_in_order(self):
        self.assertEqual(self.hosts("a slots=2\nb\nc slots=3\n", 5), ["a", "a", "b", "c", "c"])

    def test_comments_and_empty_lines_are_skipped(self):
        self.assertEqual(self.hosts("# the wall\n\na slots=2  # head\r\n\tb\n", 3), ["a", "a", "b"])

    def test_too_few_slots_are_counted(self):
        self.assertEqual(self.hosts("a slots=2\nb\n", 4),
                         "FILE: 3 slots are too few for the wall's 4 render ranks; add hosts, or slots=N")
        self.assertIn("FILE: 0 slots are too few", self.hosts("", 1))

    def test_the_line_of_a_mistake_is_named(self):
        self.assertEqual(self.hosts("a\nb slot=2\n", 2), "FILE:2: 'slot=2' is neither slots=N nor spare")
        self.assertEqual(self.hosts("a slots=2 b\n", 2), "FILE:1: 'slots=2 b' is neither slots=N nor spare")
        self.assertEqual(self.hosts("a slots=-1\n", 2), "FILE:1: 'slots=-1' is neither slots=N nor spare")
        self.assertEqual(self.hosts("a slots=0\n", 2), "FILE:1: slots must be from 1 to 1024, got 0")
        self.assertEqual(self.hosts("a slots=9999\n", 2), "FILE:1: slots must be from 1 to 1024, got 9999")
        self.assertIn("FILE:3: 'a,b' is not a host name", self.hosts("\n\na,b\n", 2))

    def test_a_file_that_is_not_there_is_named(self):
        with self.assertRaisesRegex(rank_hosts.BadInput, "--hosts /nowhere: cannot be read"):
            rank_hosts.hosts_of_file("/nowhere", 1)


class Network(unittest.TestCase):
    def test_a_network_is_written_as_mpirun_takes_it(self):
        self.assertEqual(rank_hosts.checked_network("10.1.2.3/24"), "10.1.2.0/24")

    def test_anything_else_is_refused(self):
        for text in ("", "10.0.0.1", "eth0", "10.0.0.0/33", "10.0.0/24", "10.0.0.0/24,lo"):
            with self.assertRaisesRegex(rank_hosts.BadInput, f"--network: '{text}' is not a network"):
                rank_hosts.checked_network(text)


class Programs(unittest.TestCase):
    def test_every_change_of_host_is_a_program_of_its_own(self):
        # mpirun numbers ranks program by program. So rank r must be on the r-th host of the list.
        words = rank_hosts.programs(["a", "a", HERE, "b", "a"], ["master"], ["node"])
        self.assertEqual(" ".join(words), "-n 1 --host localhost master : -n 2 --host a:2 node : "
                         "-n 1 --host localhost:1 node : -n 1 --host b:1 node : -n 1 --host a:1 node")

    def test_one_machine_needs_no_hosts(self):
        self.assertEqual(" ".join(rank_hosts.programs([HERE] * 3, ["master"], ["node"])), "-n 1 master : -n 3 node")


if __name__ == "__main__":
    unittest.main()
