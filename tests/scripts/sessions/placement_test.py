#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests the hosts on which the real mpirun puts ranks. The other hosts are this machine under other names, reached
by a script in place of ssh."""

import pathlib
import re
import sys
import unittest
from unittest import mock

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
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

    def test_neither_a_default_file_of_hosts_nor_a_scheduler_takes_the_ranks_elsewhere(self):
        # The variables are those of a shell of salloc and of one of Grid Engine. away77 would answer no connection.
        (self.folder / ".openmpi").mkdir()
        self.write("hosts.default", "away77 slots=8\n")
        self.write(".openmpi/mca-params.conf", f"orte_default_hostfile = {self.folder}/hosts.default\norte_default_dash_host = away77\n")
        slurm = {"SLURM_JOBID": "7", "SLURM_JOB_ID": "7", "SLURM_NODELIST": "away[77-78]", "SLURM_JOB_NODELIST": "away[77-78]",
                 "SLURM_TASKS_PER_NODE": "2(x2)", "SLURM_JOB_NUM_NODES": "2"}
        grid_engine = {"SGE_ROOT": "/opt/sge", "ARC": "lx", "JOB_ID": "7", "PE_HOSTFILE": self.write("pe", "away77 8 all.q@away77 UNDEFINED\n")}
        for variables, hosts in (({"HOME": str(self.folder)}, ["-", "-"]), (slurm, ["-", "node1"]), (grid_engine, ["-", "node1"])):
            with self.subTest(variables), mock.patch.dict(self.environment, variables):
                (self.folder / "placed").unlink(missing_ok=True)
                ranks = self.ranks(hosts)
                self.assertEqual([ranks[rank][0] for rank in range(3)], ["here", *(host.replace("-", "here") for host in hosts)])


if __name__ == "__main__":
    unittest.main()
