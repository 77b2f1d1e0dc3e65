#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests what the launcher knows about mpirun of Open MPI 4.1 and 5: versions, commands and output."""

import os
import pathlib
import socket
import subprocess
import sys
import tempfile
import time
import unittest
import zlib
from unittest import mock

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "support"))
import launcher_fixture  # finds scripts/
from launcher_fixture import LauncherTest
from base.bad_input import BadInput
from job import job_log, job_stream, open_mpi
from job.rank_hosts import HERE

FOUR, FIVE = open_mpi.OpenMpi4("4.1.4"), open_mpi.OpenMpi5("5.0.7")


def relayed(rank, text):
    """Returns a line as host::relayedLine() writes it."""
    return b"@rank %d %d %08x %s" % (rank, len(text), zlib.crc32(b"%d " % rank + text), text)


class Relayed(unittest.TestCase):
    def test_a_line_that_a_program_has_written_is_read(self):
        self.assertEqual(job_stream.relayed(b"@rank 3 5 f379341c hello"), ([(3, b"hello")], False))  # of rank_output_test.cpp


class Versions(unittest.TestCase):
    def test_each_supported_version_is_known(self):
        for text, kind in (("4.1.4", open_mpi.OpenMpi4), ("4.1.6rc1", open_mpi.OpenMpi4), ("5.0.7", open_mpi.OpenMpi5), ("5.1.0a1", open_mpi.OpenMpi5)):
            found = open_mpi.kind_of(f"mpirun (Open MPI) {text}\n\nReport bugs to https://www.open-mpi.org/community/help/\n")
            self.assertEqual((type(found), found.version), (kind, text))

    def test_lines_of_a_wrapper_before_the_version_do_no_harm(self):
        self.assertEqual(open_mpi.kind_of("loading the module openmpi\nmpirun (Open MPI) 5.0.7\n").version, "5.0.7")

    def test_any_other_is_refused_with_what_was_found_and_what_is_supported(self):
        for said, found in (("HYDRA build details:\n    Version: 4.0.2\n", "'HYDRA build details:'"), ("", "''"), ("slurm: no\n", "'slurm: no'"),
                            ("mpirun (Open MPI) 4.0.3\n", "Open MPI 4.0.3"), ("mpirun (Open MPI) 3.1.0\n", "Open MPI 3.1.0"),
                            ("mpirun (Open MPI) 6.0.0\n", "Open MPI 6.0.0"), ("mpirun (Open MPI)\n", "'mpirun (Open MPI)'")):
            with self.assertRaises(BadInput) as refusal:
                open_mpi.kind_of(said)
            self.assertIn(found, str(refusal.exception))
            self.assertIn("supports Open MPI 4.1 and 5", str(refusal.exception))


class Commands(unittest.TestCase):
    def command(self, mpi, hosts, **more):
        return " ".join(mpi.command(open_mpi.Job(["master"], ["node", "a b"], hosts, **more)))

    def test_version_4_starts_a_program_for_every_change_of_host(self):
        # It numbers ranks program by program. So rank r must be on the r-th host of the list.
        self.assertTrue(self.command(FOUR, ["a", "a", HERE, "b", "a"]).endswith(
            " -n 1 --host localhost master : -n 2 --host a:2 node a b : -n 1 --host localhost:1 node a b : "
            "-n 1 --host b:1 node a b : -n 1 --host a:1 node a b"))
        self.assertTrue(self.command(FOUR, [HERE] * 3).endswith(" -n 1 master : -n 3 node a b"))

    def test_the_launcher_and_no_file_or_scheduler_chooses_the_hosts(self):
        for hosts in ([HERE] * 2, ["a", HERE]):
            command = self.command(FOUR, hosts)
            for words in ("orte_default_hostfile none", "orte_default_dash_host none", "ras ^slurm,gridengine,", "plm ^slurm,", "plm_rsh_disable_qrsh 1"):
                self.assertIn(f"--mca {words}", command)
        self.assertEqual(FIVE.variables({})["PRTE_MCA_prte_default_hostfile"], "none")
        for name in open_mpi.SCHEDULERS:
            found = FIVE.variables({name: "7"})
            self.assertEqual((found["PRTE_MCA_plm"], found["PRTE_MCA_ras"]), ("ssh", "^slurm,pbs,lsf,gridengine,flux"))
        self.assertNotIn("PRTE_MCA_plm", FIVE.variables({"SLURM_JOB_ID": ""}))

    def test_version_4_keeps_what_is_behind_the_first_dot_of_a_name(self):
        self.assertIn("--mca orte_keep_fqdn_hostnames 1", self.command(FOUR, ["wall-node.1.example.org", "wall-node.2.example.org"]))

    def test_version_5_starts_one_program_with_a_line_of_the_file_per_rank(self):
        command = self.command(FIVE, ["a", "b", "a", HERE], hosts_path="/out/hosts")
        self.assertTrue(command.startswith("mpirun --bind-to none --mca btl self,sm,tcp --mca mpi_yield_when_idle 1 "), command)
        self.assertIn(" --hostfile /out/hosts --map-by seq:OVERSUBSCRIBE -n 5 sh -c ", command)
        self.assertEqual(FIVE.hosts_file(open_mpi.Job([], [], ["a", "b", "a", HERE])), "localhost\na\nb\na\nlocalhost\n")
        for option in (" : ", "--host ", "vader", " -q", "oob_tcp"):
            self.assertNotIn(option, command)

    def test_version_5_refuses_names_that_it_takes_for_one_machine(self):
        for hosts in (["wall-node.1.x", "wall-node.2.x"], ["a", "b", "a.example.org"]):
            with self.assertRaisesRegex(BadInput, rf"^{hosts[0]}, {hosts[-1]}: mpirun .* takes hosts with the same name up to the first dot"):
                FIVE.hosts_file(open_mpi.Job([], [], hosts))
        good = ["10.0.0.1", "10.0.0.2", "a.x", "b.x", "a.x", HERE]
        self.assertEqual(FIVE.hosts_file(open_mpi.Job([], [], good)).split()[1:], good)

    def test_version_5_on_one_machine_needs_no_file_of_hosts(self):
        command = self.command(FIVE, [HERE] * 3)
        self.assertIn(" --mca btl self,sm --pmixmca ptl_tcp_if_include lo --oversubscribe -n 4 sh -c ", command)
        self.assertIsNone(FIVE.hosts_file(open_mpi.Job([], [], [HERE] * 3)))

    def test_version_5_gives_the_network_to_ranks_and_daemons(self):
        command = self.command(FIVE, ["a"], hosts_path="hosts", network="10.0.0.0/24")
        self.assertIn("--mca btl_tcp_if_include 10.0.0.0/24 --prtemca prte_if_include 10.0.0.0/24 --pmixmca ptl_tcp_if_include 10.0.0.0/24", command)

    def test_a_variable_is_given_once(self):
        for mpi in (FOUR, FIVE):
            command = self.command(mpi, ["a"], hosts_path="hosts", variables=["SANDWALL_EVENTS=1", "A", "LP_NUM_THREADS", "SANDWALL_EVENTS", "A"])
            self.assertEqual([command.count(f"-x {name}") for name in ("SANDWALL_EVENTS", "A", "LP_NUM_THREADS")], [1, 1, 1], command)

    def test_the_program_in_place_of_ssh_is_passed_on_to_version_5(self):
        self.assertEqual(FIVE.variables({"OMPI_MCA_plm_rsh_agent": "/a"})["PRTE_MCA_plm_ssh_agent"], "/a")
        self.assertNotIn("PRTE_MCA_plm_ssh_agent", FIVE.variables({}))
        self.assertEqual(FOUR.variables({"OMPI_MCA_plm_rsh_agent": "/a"}), {})
        for name in open_mpi.AGENTS:
            self.assertEqual(open_mpi.remote_shell({name: "/a -v:/b"}), ["/a", "-v"])


class Program(unittest.TestCase):
    """The program of all ranks of version 5, run by sh."""

    def setUp(self):
        temporary = tempfile.TemporaryDirectory(prefix="sandwall-open-mpi-")
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name)

    def run_rank(self, rank, output, **variables):
        say = 'echo "$0 $*"; echo "error of $0" >&2; [ -z "$SANDWALL_RELAY" ] || echo "relayed $SANDWALL_RANK_LOG" >&9'
        job = open_mpi.Job(["sh", "-c", say, "master", "it's"], ["sh", "-c", say, "node"], [HERE, "a"], output=output)
        environment = {**os.environ, "PMIX_RANK": str(rank), "TMPDIR": str(self.folder), **variables}
        ended = subprocess.run(["sh", "-c", FIVE.script(job)], env=environment, capture_output=True, text=True, timeout=60)
        self.assertEqual(ended.returncode, 0, ended.stderr)
        return ended.stdout, ended.stderr

    def test_rank_0_is_the_master_and_all_others_are_render_ranks(self):
        self.assertEqual(self.run_rank(0, None), ("master it's\n", "error of master\n"))
        self.assertEqual(self.run_rank(1, None), ("node \n", "error of node\n"))

    def test_a_rank_writes_into_the_files_that_the_launcher_has_made(self):
        for ending in ("out", "err"):
            (self.folder / f"it's.rank_1.{ending}").touch()
        self.assertEqual(self.run_rank(1, f"{self.folder}/it's"), ("", ""))
        self.assertEqual((self.folder / "it's.rank_1.out").read_text(), "node \n")
        self.assertEqual((self.folder / "it's.rank_1.err").read_text(), "error of node\n")

    def test_a_rank_keeps_an_output_of_mpirun_open(self):
        # mpirun would end the input of the master, and with it the session.
        for ending in ("out", "err"):
            (self.folder / f"log.rank_0.{ending}").touch()
        job = open_mpi.Job(["sh", "-c", "ls -l /proc/self/fd >&2"], ["node"], [HERE], output=f"{self.folder}/log")
        process = subprocess.run(["sh", "-c", FIVE.script(job)], env={**os.environ, "PMIX_RANK": "0"}, stderr=subprocess.PIPE, timeout=60)
        self.assertEqual((process.returncode, process.stderr), (0, b""))
        self.assertRegex((self.folder / "log.rank_0.err").read_text(), r"9 -> pipe:")

    def test_a_rank_without_such_files_makes_one_that_only_its_user_can_read(self):
        out, err = self.run_rank(12, f"{self.folder}/none")
        self.assertRegex(err, f"^relayed {self.folder}/sandwall-rank-12\\.[A-Za-z0-9]{{6}}\n$")
        path = pathlib.Path(err.split()[1])
        self.assertEqual((out, path.read_text(), path.stat().st_mode & 0o777), ("", "node \nerror of node\n", 0o600))

    def test_a_rank_that_can_make_no_file_runs_without_one(self):
        self.assertEqual(self.run_rank(1, f"{self.folder}/none", TMPDIR="/nowhere")[1].splitlines()[-1], "relayed ")


class Output(unittest.TestCase):
    """The launcher reads the output of a job under version 5."""

    def setUp(self):
        temporary = tempfile.TemporaryDirectory(prefix="sandwall-open-mpi-")
        self.addCleanup(temporary.cleanup)
        self.log = job_log.JobLog(temporary.name, 1, FIVE, [0, 2])
        self.addCleanup(self.log.close)
        self.shown = []
        for stream in self.log.streams:
            stream.shown = mock.Mock(line=self.shown.append)
        for mocked in (mock.patch("base.console.ERROR", self.log.err.shown), mock.patch("job.job_log.print_line")):
            self.said = mocked.start()
            self.addCleanup(mocked.stop)

    def follow(self, text, ended=False):
        os.write(self.log.err.file, text)
        self.log.follow(ended)
        return self.shown

    def test_whole_lines_of_ranks_on_other_hosts_are_taken(self):
        text = b"[1,1]<stderr>: " + relayed(1, b"sandwall-render-node: hello") + b"\n"
        for i in range(len(text)):
            self.follow(text[i:i + 1])
        self.assertEqual((self.shown, self.log.err.damaged), ([b"sandwall-render-node: hello"], 0))
        self.assertEqual(list(self.log.last_by_rank[1]), ["sandwall-render-node: hello"])

    def test_damaged_lines_are_left_out_and_counted(self):
        whole = relayed(3, b"good")
        for damaged in (whole.replace(b"good", b"goad"), whole.replace(b"@rank 3", b"@rank 4"), whole[:-1], b"half of a li", whole + b"more"):
            before = self.log.err.damaged
            self.shown.clear()
            self.follow(b"[1,3]<stderr>: " + damaged + b"\n")
            self.assertEqual((self.shown, self.log.err.damaged - before), ([b"good"] if damaged.endswith(b"more") else [], 1), damaged)
        self.follow(b"", ended=True)
        self.assertIn("5 damaged pieces", self.said.call_args[0][0])

    def test_an_explanation_of_open_mpi_is_no_damaged_line(self):
        self.follow(b"[1,4]<stderr>: [node04:00000] *** An error occurred in Socket closed\n", ended=True)
        self.assertEqual((self.shown, self.log.err.damaged), ([], 0))

    def test_the_banner_of_an_abort_is_no_damaged_line(self):
        for line in (b"-" * 74, b"MPI_ABORT was invoked on rank 0 in communicator MPI_COMM_WORLD", b"  Errorcode: 1", b"-" * 74, relayed(3, b"kept")):
            self.follow(b"[1,0]<stderr>: " + line + b"\n")
        self.follow(b"[1,0]<stderr>: damaged\n", ended=True)
        self.assertEqual((self.shown, self.log.err.damaged), ([b"kept"], 1))

    def test_a_zero_byte_of_mpirun_damages_no_line(self):
        self.follow(b"[1,2]<stderr>: \0" + relayed(2, b"text") + b"\n", ended=True)
        self.assertEqual((self.shown, self.log.err.damaged), ([b"text"], 0))

    def test_a_whole_line_behind_the_rest_of_another_is_found(self):
        # mpirun holds an unfinished piece back for all ranks, and prints it before the next line of any rank.
        self.follow(b"[1,3]<stderr>: " + relayed(3, b"lost line")[:-4] + relayed(5, b"kept") + b"\n")
        self.assertEqual((self.shown, list(self.log.last_by_rank[5]), self.log.err.damaged), ([b"kept"], ["kept"], 1))

    def test_a_wrong_tag_does_not_name_the_rank(self):
        self.follow(b"[1,7]<stderr>: " + relayed(2, b'@sandwall {"event":"progress","frame":9,"step":8}') + b"\n")
        self.assertEqual(self.log.frame, 9)
        self.follow(b"[1,7]<stderr>: " + relayed(4, b"text") + b"\n")
        self.assertEqual(list(self.log.last_by_rank), [4])

    def test_ranks_on_this_machine_are_read_from_their_files(self):
        self.assertEqual(sorted(path.name for path in self.log.path.parent.glob("*.rank_*")),
                         [f"try_1.rank_{rank}.{ending}" for rank in (0, 2) for ending in ("err", "out")])
        with open(f"{self.log.path}.rank_2.err", "ab", buffering=0) as file:
            file.write(b"first\nsec")
            self.log.follow()
            file.write(b"ond\nlast without an end")
            self.log.follow(ended=True)
        self.assertEqual(self.shown, [b"first", b"second", b"last without an end"])
        self.assertEqual(list(self.log.last_by_rank[2]), ["first", "second", "last without an end"])

    def test_the_file_of_a_rank_on_another_host_is_noted(self):
        self.follow(b"[1,3]<stderr>: " + relayed(3, b"@log node2:/tmp/sandwall-rank-3.abc") + b"\n")
        self.assertEqual((self.shown, self.log.rank_logs), ([], {3: "node2:/tmp/sandwall-rank-3.abc"}))

    def test_the_ended_rank_is_read_from_mpiruns_lines(self):
        self.follow(b"-" * 74 + b"\nprterun detected that one or more processes exited\n\n  Process name: [prterun-host-20411@1,2]\n"
                    b"  Exit code:    3\n" + b"-" * 74 + b"\n")
        self.assertEqual((self.log.exited(), self.shown), ((2, 3), []))
        self.follow(b"prterun noticed that process rank 4 with PID 77 on node host exited on\nsignal 9 (Killed).\n")
        self.assertEqual(self.log.signalled(), (4, 9))

    def test_the_files_of_all_ranks_are_removed_with_their_try(self):
        self.log.write_hosts("localhost\n")
        self.assertTrue(pathlib.Path(f"{self.log.path}.hosts").exists())
        job_log.forget_tries(self.log.path.parent, 0)
        self.assertEqual(list(self.log.path.parent.iterdir()), [])


class Launcher(LauncherTest):
    def test_another_mpirun_is_refused_in_one_line(self):
        self.script("mpirun", "#!/bin/sh\n")
        self.environment["MADE_UP_MPI"] = "3.1"
        self.assertIn("sandwall: mpirun: is of Open MPI 3.1; Sandwall supports Open MPI 4.1 and 5", self.refused(["-"]))
        path = self.folder / "bin" / "mpirun"
        path.write_text("#!/bin/sh\necho 'HYDRA build details:'\n")
        self.assertIn("sandwall: mpirun: `mpirun --version` prints 'HYDRA build details:'; Sandwall supports", self.refused(["-"]))

    def test_a_session_inside_a_job_of_mpirun_is_refused_in_one_line(self):
        self.script("mpirun", "#!/bin/sh\n")
        for name in ("OMPI_COMM_WORLD_RANK", "OMPI_UNIVERSE_SIZE"):
            with mock.patch.dict(self.environment, {name: "0"}):
                self.assertIn(f"sandwall: {name}: is set, because mpirun has started this command", self.refused(["-"]))

    def test_hosts_with_another_version_are_refused(self):
        self.script("mpirun", "#!/bin/sh\n")
        away = pathlib.Path(self.script("agent", "#!/bin/sh\nshift\nMADE_UP_MPI=5.0.7 exec sh -c \"$*\"\n"))
        self.environment["OMPI_MCA_plm_rsh_agent"] = str(away)
        self.assertIn("node1 (rank 2): has mpirun (Open MPI) 5.0.7, and this machine 4.1.4", self.refused(["-", "node1"]))

    def test_what_prterun_leaves_behind_is_removed(self):
        with tempfile.TemporaryDirectory() as folder, mock.patch("tempfile.gettempdir", return_value=folder):
            for name in ("prterun.host.12.0", "prterun.host.123.0"):
                (pathlib.Path(folder) / name / "more").mkdir(parents=True)
            os.symlink("/etc", pathlib.Path(folder) / "prterun.other.12.0")
            FIVE.tidy(12)
            self.assertEqual(sorted(os.listdir(folder)), ["prterun.host.123.0", "prterun.other.12.0"])

    def test_what_an_mpirun_of_version_4_leaves_behind_is_removed(self):
        host = socket.gethostname().partition(".")[0]
        with tempfile.TemporaryDirectory() as folder, mock.patch("tempfile.gettempdir", return_value=folder):
            both, one, other = (pathlib.Path(folder, name) for name in (f"ompi.{host}.{os.geteuid()}", f"ompi.{host}.site.{os.geteuid()}", "ompi.else.0"))
            longer = pathlib.Path(folder, f"ompi.{host}0.{os.geteuid()}")  # as node10 beside node1, in a folder that hosts share
            for path in (both / "pid.12", both / "pid.123", one / "pid.12", other / "pid.12", longer / "pid.12"):
                (path / "more").mkdir(parents=True)
            elsewhere = pathlib.Path(folder, "elsewhere")
            (elsewhere / "pid.12").mkdir(parents=True)
            link = pathlib.Path(folder, f"ompi.{host}.y.{os.geteuid()}")
            link.symlink_to(elsewhere)
            open_mpi.tidy_after(12)
            self.assertEqual(sorted(os.listdir(both)), ["pid.123"])
            self.assertFalse(one.exists(), "an empty folder goes, too")
            self.assertTrue((other / "pid.12").exists(), "another machine's")
            self.assertTrue((longer / "pid.12").exists(), "another machine's, whose name begins alike")
            self.assertTrue((elsewhere / "pid.12").exists(), "no link is followed")

    def test_the_memory_of_a_job_is_removed_and_no_other_file(self):
        uid = os.geteuid()
        with tempfile.TemporaryDirectory() as folder, mock.patch.object(open_mpi, "SHARED_MEMORY", folder):
            names = [f"vader_segment.host.{uid}.2fcc0001.{rank}" for rank in (0, 1)]
            others = [f"vader_segment.host.{uid}.12fcc0001.0", f"vader_segment.host.{uid + 1}.2fcc0001.0", "other.2fcc0001.0"]
            for name in names + others:
                pathlib.Path(folder, name).write_text("")
            os.symlink("/etc/hostname", pathlib.Path(folder, f"vader_segment.link.{uid}.2fcc0001.0"))
            open_mpi.forget_memory(None)
            self.assertEqual(len(os.listdir(folder)), 6)
            open_mpi.forget_memory("2fcc0001")
            self.assertEqual(sorted(os.listdir(folder)), sorted([*others, f"vader_segment.link.{uid}.2fcc0001.0"]))

    def test_a_rank_tells_the_id_of_its_job(self):
        for text, job_id in (("801898497", "2fcc0001"), ("word", None), ("", None)):
            with subprocess.Popen(["sleep", "1000"], env={**os.environ, "OMPI_MCA_ess_base_jobid": text}) as rank:
                try:
                    while not pathlib.Path(f"/proc/{rank.pid}/environ").read_bytes():
                        time.sleep(0.001)  # a program that has just begun has no environment yet
                    self.assertEqual(open_mpi.job_id_of(rank.pid), job_id)
                finally:
                    rank.kill()
        self.assertIsNone(open_mpi.job_id_of(rank.pid))


if __name__ == "__main__":
    unittest.main()
