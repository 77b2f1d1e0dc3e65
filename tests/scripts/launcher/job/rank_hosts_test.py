#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests on which machine each rank runs."""

import pathlib
import socket
import sys
import tempfile
import unittest
from unittest import mock

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "support"))
import launcher_fixture  # finds scripts/
from base.bad_input import BadInput
from job import rank_hosts
from job.rank_hosts import HERE


class HostsOfWall(unittest.TestCase):
    def test_a_tile_without_a_host_is_drawn_here(self):
        self.assertEqual(rank_hosts.hosts_of_wall("-\nnode1\n-\n", "wall"), [HERE, "node1", HERE])

    def test_this_machine_is_known_by_its_name(self):
        name = socket.gethostname()
        self.assertEqual(rank_hosts.hosts_of_wall(f"{name}\nlocalhost\n127.0.0.1\n", "wall"), [HERE] * 3)

    def test_a_name_that_ssh_or_mpirun_would_misread_is_refused(self):
        for name in ("-oProxyCommand=x", "a,b", "a:2", "a/b", "a;b", "x" * 300):
            with self.assertRaisesRegex(BadInput, "wall.toml: '.*' is not a host name"):
                rank_hosts.hosts_of_wall(name, "wall.toml")


class ThisMachine(unittest.TestCase):
    """192.0.2.1 is an address for documentation. It is not one of this machine, unless a test says so with `own_address`."""

    def here(self, own, listed, address, own_address=None):
        def resolve(host, port, **kinds):
            if address is None:
                raise socket.gaierror(f"{host} is unknown")
            return [(socket.AF_INET, socket.SOCK_DGRAM, 17, "", (address, 0))]

        def is_own(found):
            return found[1][0] in ("127.0.0.1", "127.0.1.1", own_address)
        rank_hosts.addresses.cache_clear()
        with mock.patch("socket.gethostname", return_value=own), mock.patch("socket.getaddrinfo", resolve), \
                mock.patch("job.rank_hosts.is_own", is_own):
            return rank_hosts.is_here(listed)

    def test_short_and_full_names_are_this_machine(self):
        for own in ("node01", "node01.example.org", "NODE01"):
            for listed in ("node01", "node01.example.org", "NODE01", "Node01.Example.ORG.", "LocalHost", "localhost.localdomain"):
                for address in ("127.0.0.1", "127.0.1.1", None):
                    self.assertTrue(self.here(own, listed, address), (own, listed, address))

    def test_a_machine_of_another_domain_is_not_this_one(self):
        self.assertFalse(self.here("wall-node.1.example.org", "wall-node.2.example.org", None))
        self.assertFalse(self.here("wall-node.1.example.org", "wall-node.2.example.org", "127.0.0.1"))
        self.assertFalse(self.here("node01", "node01.example.com", "192.0.2.1"))
        self.assertFalse(self.here("node01.example.org", "node01", "192.0.2.1"))
        self.assertFalse(self.here("node01", "node02", "127.0.0.1"))
        self.assertFalse(self.here("node01", "node02", "192.0.2.1", own_address="192.0.2.7"))

    def test_an_address_of_this_machine_is_this_machine(self):
        for address in ("127.0.0.1", "127.0.1.1", "192.0.2.1"):
            self.assertTrue(self.here("node01", address, address, own_address="192.0.2.1"), address)
        self.assertFalse(self.here("node01", "192.0.2.1", "192.0.2.1"))

    def test_another_name_with_an_address_of_this_machine_is_this_machine(self):
        self.assertTrue(self.here("node01", "wall-head", "192.0.2.1", own_address="192.0.2.1"))

    def test_the_addresses_that_the_system_knows_are_found(self):
        self.assertTrue(all(rank_hosts.is_own(found) for found in rank_hosts.addresses("127.0.0.1")))
        self.assertFalse(any(rank_hosts.is_own(found) for found in rank_hosts.addresses("203.0.113.9")))


class HostsOfFile(unittest.TestCase):
    def hosts(self, text, ranks):
        with tempfile.NamedTemporaryFile("w", suffix=".hosts") as file:
            file.write(text)
            file.flush()
            try:
                return rank_hosts.hosts_of_file(file.name, ranks)
            except BadInput as complaint:
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

    def test_two_spellings_of_a_name_are_one_host(self):
        self.assertEqual(self.hosts("node02\nNODE02\nnode02.\nnode03\n", 4), ["node02", "node02", "node02", "node03"])

    def test_a_file_in_any_encoding_is_read(self):
        text = "# B\u00fcro\r\nnode01 slots=2\r\n"
        for encoding in ("utf-8", "utf-8-sig", "latin-1", "utf-16"):
            with tempfile.NamedTemporaryFile("wb", suffix=".hosts") as file:
                file.write(text.encode(encoding))
                file.flush()
                self.assertEqual(rank_hosts.hosts_of_file(file.name, 2), ["node01", "node01"], encoding)

    def test_a_file_that_is_no_text_is_refused_with_its_line(self):
        with tempfile.NamedTemporaryFile("wb", suffix=".hosts") as file:
            file.write(b"node01\n\0node02\n")
            file.flush()
            with self.assertRaisesRegex(BadInput, r"\.hosts:2: a byte 0 is inside the text"):
                rank_hosts.hosts_of_file(file.name, 1)

    def test_a_file_that_is_not_there_is_named(self):
        with self.assertRaisesRegex(BadInput, "--hosts /nowhere: cannot be read"):
            rank_hosts.hosts_of_file("/nowhere", 1)


class Network(unittest.TestCase):
    def test_a_network_is_written_as_mpirun_takes_it(self):
        self.assertEqual(rank_hosts.checked_network("10.1.2.3/24"), "10.1.2.0/24")

    def test_anything_else_is_refused(self):
        for text in ("", "10.0.0.1", "eth0", "10.0.0.0/33", "10.0.0/24", "10.0.0.0/24,lo"):
            with self.assertRaisesRegex(BadInput, f"--network: '{text}' is not a network"):
                rank_hosts.checked_network(text)


if __name__ == "__main__":
    unittest.main()
