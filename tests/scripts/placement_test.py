#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests the hosts on which the real mpirun puts ranks. The other hosts are this machine under other names, reached
by a script in place of ssh."""

import re
import unittest

from launcher_fixture import LauncherTest


# Each rank adds a line to one file, because Open MPI 5 does not bring the output of other hosts to the launcher.
SAY = """#!/bin/sh
echo "rank $OMPI_COMM_WORLD_RANK on ${MADE_UP_HOST:-here} threads $LP_NUM_THREADS: ${0##*/}" >> "${0%/*}/../placed"
"""


class Placement(LauncherTest):
    def ranks(self, hosts, *options):
        for name in ("sandwall-master", "sandwall-render-node"):
            self.script(name, SAY)
        ended = self.start(hosts, *options)
        self.assertEqual(ended.returncode, 0, ended.stdout + ended.stderr)
        lines = re.findall(r"rank (\d+) on (\S+) threads (\S+): (\S+)", (self.folder / "placed").read_text())
        self.assertEqual(len(lines), len(hosts) + 1, ended.stdout + ended.stderr)
        return {int(rank): words for rank, *words in lines}

    def test_every_rank_is_on_its_host(self):
        hosts = ["node1", "node1", "-", "node2", "node1", "-"]
        ranks = self.ranks(hosts, "--gl-threads", "5")
        self.assertEqual(ranks[0], ["here", "5", "sandwall-master"])
        for rank, host in enumerate(hosts, start=1):
            self.assertEqual(ranks[rank], [host.replace("-", "here"), "5", "sandwall-render-node"])

    def test_here_is_here(self):
        ranks = self.ranks(["node1", "node2"], "--here")
        self.assertEqual([ranks[rank][0] for rank in range(3)], ["here"] * 3)


if __name__ == "__main__":
    unittest.main()
