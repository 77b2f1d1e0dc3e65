#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What scripts/sandwall run does when something dies, with made-up programs that die as they are told."""

import json
import os
import pathlib
import re
import signal
import socket
import subprocess
import time
import unittest

from launcher_fixture import LauncherTest

# Writes down its command, and does in its n-th start what try_n says.
MPIRUN = """#!/bin/bash
folder=$(dirname "$0")/..
n=$(($(cat "$folder/tries" 2>/dev/null || echo 0) + 1)); echo $n > "$folder/tries"
echo "$*" >> "$folder/commands"
say() { echo "[1,$1]<stdout>:$2"; }
complain() { echo "[1,$1]<stderr>:$2" >&2; }
progress() { mkdir -p "$folder/out"; echo "$n" > "$folder/out/session.journal"; say 0 "frame $1  step $2  60.0 fps"; }
line=--------------------------------------------------------------------------
banner() { printf '%s\\n' $line "$@" $line >&2; }
dies() { banner "Primary job  terminated normally"; banner "mpirun noticed that process rank $1 with PID 0 on node $2 exited on signal $3 (Made Up)."; exit $((128 + $3)); }
ends() { banner "mpirun detected that one or more processes exited" "" "  Process name: [[5156,1],$1]" "  Exit code:    $2"; exit $2; }
told() { mkdir -p "$folder/out"; echo "$1" > "$folder/out/failure.json"; }
. "$folder/try_$n"
"""
HOST = socket.gethostname()


class Supervised(LauncherTest):
    def setUp(self):
        super().setUp()
        self.script("mpirun", MPIRUN)

    def tries(self, *texts):
        """What mpirun does at its first, second, ... start."""
        for number, text in enumerate(texts, start=1):
            self.write(f"try_{number}", text)

    def commands(self):
        return (self.folder / "commands").read_text().splitlines()

    def ended(self, hosts, *options):
        ended = self.start(hosts, *options)
        return ended.returncode, ended.stdout, ended.stderr.replace(str(self.folder) + "/", "")

    def wait_for(self, what, condition):
        deadline = time.monotonic() + 60
        while not condition():
            self.assertLess(time.monotonic(), deadline, f"no {what}")
            time.sleep(0.01)

    def begin(self, hosts, *options):
        process = subprocess.Popen(self.command(hosts, *options), env=self.environment, stdin=subprocess.DEVNULL,
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.addCleanup(process.stderr.close)
        self.addCleanup(process.stdout.close)
        self.addCleanup(process.kill)
        return process


class Restarts(Supervised):
    def test_a_rank_that_dies_is_named_and_the_session_goes_on(self):
        self.tries("progress 7 6; complain 2 'last words'; dies 2 host 11", "progress 9 8; exit 0")
        before = time.time()
        status, printed, error = self.ended(["-", "-"])
        self.assertEqual((status, printed), (0, "frame 7  step 6  60.0 fps\nframe 9  step 8  60.0 fps\n"))
        self.assertEqual(error, f"last words\nsandwall: rank 2 on {HOST} died of SIGSEGV; "
                         "starting again (1 of --restarts 3 in --restart-window 60)\n")
        first, second = self.commands()
        self.assertNotIn("--resume", first)
        found = re.search(rf" --resume --failed-at (\S+) --failure rank 2 on {HOST} died of SIGSEGV : -n 2 ", second)
        self.assertTrue(before <= float(found[1]) <= time.time(), second)

    def test_the_master_is_called_so(self):
        self.tries("progress 7 6; dies 0 host 9", "exit 0")
        self.assertIn("sandwall: the master died of SIGKILL; starting again", self.ended(["-"])[2])

    def test_a_rank_that_ends_by_itself_is_named_with_its_status(self):
        self.tries("progress 7 6; ends 1 3", "exit 0")
        self.assertIn(f"sandwall: rank 1 on {HOST} ended with status 3; starting again", self.ended(["-"])[2])

    def test_who_hung_is_told_by_the_last_words_of_the_watchdog(self):
        words = "for 3.0 s; the limit is 3 s, ending the job"
        self.tries(f"progress 7 6; complain 0 'sandwall: frame 8 waits for rank 2 (tile b) on x {words}'; ends 0 1",
                   f"progress 9 8; complain 1 'sandwall: rank 1 waits for the master after frame 9 {words}'; ends 1 1", "exit 0")
        error = self.ended(["-", "-"])[2]
        self.assertIn("sandwall: rank 2 (tile b) on x hung; starting again", error)
        self.assertIn("sandwall: the master hung; starting again", error)

    def test_an_mpirun_that_waits_for_a_host_that_has_gone_is_killed(self):
        self.tries("""progress 7 6; trap '' TERM
complain 0 'sandwall: frame 8 waits for rank 2 (tile b) on x for 3.0 s; the limit is 3 s, ending the job'; while :; do sleep 0.1; done""", "exit 0")
        status, _, error = self.ended(["-", "-"])
        self.assertEqual(status, 0, error)
        self.assertIn("sandwall: rank 2 (tile b) on x hung; starting again", error)

    def test_what_the_master_has_written_down_goes_before_what_mpirun_noticed(self):
        self.tries("""progress 7 6; told '{"what": "hung", "rank": 1, "message": "frame 8 waits for rank 1 (tile a) on x for 2.1 s; the limit is 2 s, ending the job"}'; ends 0 1""", "exit 0")
        self.assertIn("sandwall: rank 1 (tile a) on x hung; starting again", self.ended(["-"])[2])
        self.assertFalse((self.folder / "out" / "failure.json").exists(), "it would be found again")

    def test_a_killed_mpirun_is_named(self):
        self.tries("progress 7 6; kill -KILL $$", "exit 0")
        self.assertIn("sandwall: mpirun died of SIGKILL; starting again", self.ended(["-"])[2])

    def test_an_orderly_end_and_bad_input_are_ends(self):
        for status in (0, 2):
            self.tries(f"complain 0 'that was it'; exit {status}")
            self.assertEqual(self.ended(["-"]), (status, "", "that was it\n"))
            (self.folder / "tries").unlink()

    def test_without_restarts_the_first_failure_is_the_end(self):
        self.tries("echo said; dies 1 host 11")
        status, printed, _ = self.ended(["-"], "--restarts", "0")
        self.assertEqual((status, printed), (139, "said\n"))
        self.assertIn("-q --oversubscribe", self.commands()[0])
        self.assertFalse((self.folder / "out" / "log").exists())

    def test_a_journal_of_another_session_is_not_gone_on_with(self):
        (self.folder / "out").mkdir()
        (self.folder / "out" / "session.journal").write_text("yesterday's")
        self.tries("dies 1 host 9", "exit 0")
        self.assertEqual(self.ended(["-"])[0], 0)
        self.assertNotIn("--resume", self.commands()[1])

    def test_a_session_is_resumed_by_hand(self):
        self.tries("dies 1 host 9", "exit 0")
        self.assertEqual(self.ended(["-"], "--resume")[0], 0)
        first, second = self.commands()
        self.assertRegex(first, r"--resume : ")
        self.assertRegex(second, r"--resume --failed-at ")

    def test_a_scene_is_needed_but_for_what_the_journal_tells(self):
        self.tries("exit 0")
        command = self.command(["-"], "--resume")
        at = command.index("--scene")
        command[at:at + 2] = []
        self.assertEqual(subprocess.run(command, env=self.environment, timeout=120, stdin=subprocess.DEVNULL).returncode, 0)
        self.assertNotIn("--scene", self.commands()[0])
        refused = subprocess.run([*command, "--device", "script:gis"], env=self.environment, timeout=120, text=True,
                                 capture_output=True, stdin=subprocess.DEVNULL)
        self.assertEqual((refused.returncode, refused.stderr), (2, "--scene: name one; only with --resume and without "
                                                                "--device the journal's will do\n"))


class GivenUp(Supervised):
    def test_the_report_names_who_died_of_what_where_and_when_with_last_words(self):
        text = "progress {0}7 {0}6; complain 1 'words of try {0}'; dies 1 host 6"
        self.tries(*(text.format(number) for number in (1, 2, 3)))
        status, _, error = self.ended(["-"], "--restarts", "2", "--restart-window", "600")
        self.assertEqual((status, len(self.commands())), (1, 3))
        report = error[error.index("sandwall: the session is given up"):]
        self.assertIn("more failures than --restarts 2 in --restart-window 600 allows", report)
        for number in (1, 2, 3):
            self.assertRegex(report, rf"\d\d:\d\d:\d\d  rank 1 on {HOST} died of SIGABRT; shown: frame {number}7, step {number}6\n"
                             rf" +\| words of try {number}\n")
        self.assertEqual(report, (self.folder / "out/log/report.txt").read_text().replace(str(self.folder) + "/", ""))
        self.assertIn("words of try 2", (self.folder / "out/log/try_2.err").read_text())

    def test_tries_without_a_frame_are_counted_whatever_the_window(self):
        self.tries(*["sleep 0.3; dies 1 host 6"] * 3)
        status, _, error = self.ended(["-"], "--restarts", "1", "--restart-window", "0.1")
        self.assertEqual((status, len(self.commands())), (1, 2), error)

    def test_failures_far_apart_are_not_counted_together(self):
        self.tries(*["progress 2 1; sleep 0.3; dies 1 host 6"] * 3, "exit 0")
        status, _, error = self.ended(["-"], "--restarts", "1", "--restart-window", "0.1")
        self.assertEqual((status, len(self.commands())), (0, 4), error)

    def test_only_so_many_logs_are_kept(self):
        self.tries(*["progress 2 1; dies 1 host 6"] * 11, "exit 0")
        self.assertEqual(self.ended(["-"], "--restarts", "20", "--restart-window", "0.001")[0], 0)
        kept = sorted(int(path.stem[4:]) for path in (self.folder / "out/log").glob("try_*.err"))
        self.assertEqual(kept, list(range(5, 13)))


class Output(Supervised):
    def test_tags_and_banners_are_not_shown(self):
        self.tries("""
printf '[1,0]<stdout>:half a [1,1]<stdout>:whole of 1\\n[1,0]<stdout>:line\\n'
printf '[1,1]<stderr>:a [1,1]<std'; sleep 0.3; printf 'err>:tag in pieces\\n' >&1
printf '[1,1]<stderr>:' >&2; sleep 0.3; echo 'to stderr' >&2
banner 'a word of mpirun' 'and another'
echo '[host:12] 1 more process has sent a help message' >&2
echo 'ssh says something' >&2
printf '[1,0]<stdout>:no end'
exit 0""")
        self.assertEqual(self.ended(["-"]), (0, "whole of 1\nhalf a line\na tag in pieces\nno end\n", "to stderr\nssh says something\n"))

    def test_a_launcher_without_a_reader_goes_on(self):
        self.tries("for n in 1 2 3; do progress $n $n; sleep 0.2; done; touch $folder/done; exit 0")
        process = subprocess.Popen(self.command(["-"]), env=self.environment, stdin=subprocess.DEVNULL,
                                   stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
        process.stdout.close()
        self.assertEqual(process.wait(60), 0)
        self.assertTrue((self.folder / "done").exists())

    def test_where_no_log_can_be_written_the_master_has_the_word(self):
        (self.folder / "out").write_text("a file")
        self.tries("complain 0 'out: is no folder'; exit 2")
        self.assertEqual(self.ended(["-"]), (2, "", "out: is no folder\n"))


class Stopping(Supervised):
    def test_a_session_that_fails_while_it_is_stopped_is_not_started_again(self):
        self.tries("progress 1 1; read -r line; dies 1 host 9")
        process = self.begin(["-"])
        self.wait_for("journal", (self.folder / "out/session.journal").exists)
        process.send_signal(signal.SIGINT)
        process.communicate(timeout=60)
        self.assertEqual((process.returncode, len(self.commands())), (137, 1))

    def test_ctrl_c_ends_a_wait_between_two_tries(self):
        # From the second on, a restart waits.
        self.tries(*["progress 1 1; dies 1 host 9"] * 9)
        process = self.begin(["-"], "--restarts", "9")
        while "(5 of --restarts 9" not in process.stderr.readline():
            self.assertIsNone(process.poll())
        process.send_signal(signal.SIGINT)
        error = process.communicate(timeout=60)[1]
        self.assertEqual((process.returncode, len(self.commands())), (1, 5), error)
        self.assertIn("sandwall: stopped between two tries", error)

    def test_a_killed_launcher_leaves_nothing(self):
        self.tries("progress 1 1; read -r line; exit 1")
        process = self.begin(["-"])
        self.wait_for("journal", (self.folder / "out/session.journal").exists)
        process.kill()
        process.wait(60)
        # Its input has ended, and nobody starts it again.
        self.wait_for("end", lambda: not any(f"SANDWALL_JOB={process.pid}-" in text for text in environments()))
        self.assertEqual(len(self.commands()), 1)


SERVER = """#!/bin/bash
folder=$(dirname "$0")/..
echo "$*" >> "$folder/servers"
while [ "$1" != --port-file ]; do [ "$1" = --listen ] && listen=$2; shift; done
port=${listen##*:}; [ "$port" = 0 ] && port=4711
echo $$ > "$folder/server.pid"
echo $port > "$2.new"; mv "$2.new" "$2"
trap 'exit 0' TERM
while :; do sleep 0.05; done
"""


class Server(Supervised):
    def setUp(self):
        super().setUp()
        self.script("sandwall-haptic-server", SERVER)

    def servers(self):
        path = self.folder / "servers"
        return path.read_text().splitlines() if path.exists() else []

    def test_it_is_started_again_on_its_port_while_the_wall_goes_on(self):
        self.tries("""progress 1 1; kill -SEGV $(cat "$folder/server.pid")
until [ $(wc -l < "$folder/servers") = 2 ]; do sleep 0.05; done; exit 0""")
        status, _, error = self.ended(["-"], "--device", "script:gis", "--record", str(self.folder / "ticks.csv"))
        self.assertEqual((status, len(self.commands())), (0, 1), error)
        first, second = self.servers()
        self.assertIn("--listen 127.0.0.1:0 ", first)
        self.assertIn("--listen 127.0.0.1:4711 ", second)
        self.assertIn("/ticks.csv ", first)
        self.assertIn("/ticks_2.csv ", second)
        self.assertIn("sandwall: the haptic server died of SIGSEGV; starting again (1 of ", error)

    def test_a_job_that_is_started_again_finds_the_same_server(self):
        self.tries("progress 1 1; dies 1 host 9", "exit 0")
        self.assertEqual(self.ended(["-"], "--device", "script:gis")[0], 0)
        self.assertEqual(len(self.servers()), 1)
        for command in self.commands():
            self.assertIn("--haptic 127.0.0.1:4711 ", command)

    def test_one_that_dies_too_often_ends_the_session_in_order(self):
        self.tries("""progress 5 4; until read -t 0.1 -r line; do kill -KILL $(cat "$folder/server.pid"); done
echo "told: $line"; exit 0""")
        status, printed, error = self.ended(["-"], "--device", "script:gis", "--restarts", "2", "--restart-window", "600")
        self.assertEqual((status, len(self.servers()), printed.splitlines()[-1]), (1, 3, "told: stop"), error)
        self.assertIn("sandwall: the session is given up", error)
        self.assertEqual(error.count("the haptic server died of SIGKILL; shown: frame 5, step 4"), 3, error)


def environments():
    for entry in pathlib.Path("/proc").iterdir():
        if entry.name.isdigit():
            try:
                yield (entry / "environ").read_bytes().decode(errors="replace")
            except OSError:
                pass


class Spares(Supervised):
    def hosts(self, *lines):
        return ["--hosts", self.write("hosts", "\n".join(lines) + "\n")]

    def placed(self):
        """On which host each try had its ranks."""
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
        self.assertIn("rank 2 on node2 died of SIGKILL", error)

    def test_spares_draw_nothing_while_all_is_well(self):
        self.assertEqual(self.printed(["-"] * 2, *self.hosts("node1 spare", "node2 slots=2")),
                         self.printed(["-"] * 2, *self.hosts("node2 slots=2")))


if __name__ == "__main__":
    unittest.main()
