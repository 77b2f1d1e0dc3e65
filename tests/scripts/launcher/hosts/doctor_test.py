#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests of scripts/sandwall doctor with made-up hosts. Each is this machine under another name, reached by a script
in place of ssh."""

import json
import os
import pathlib
import pty
import re
import socket
import subprocess
import sys
import time
import unittest
from unittest import mock

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "support"))
from launcher_fixture import ROOT, LauncherTest
from hosts import examined_host, first_frame

# Every host is this machine. The name of a host selects its fault.
AGENT = """#!/bin/sh
host=$1; shift
case $host in
    away*) echo "ssh: connect to host $host port 22: No route to host" >&2; exit 255 ;;
    old*) export MADE_UP_BUILD=00000000000000ff ;;
    small*) export MADE_UP_MEMORY=2097152 ;;
    bare*) export MADE_UP_NO_CHECK=1 ;;
    blind*) export MADE_UP_DISPLAY=none ;;
    narrow*) export MADE_UP_DISPLAY=narrow ;;
    late*) export MADE_UP_SHIFT=3600 ;;
    greets*) echo "Good morning"; printf '%010000d' 7; echo "last login yesterday" >&2 ;;
    walled*) export SSH_CONNECTION="127.0.0.1 1 127.0.0.1 22"; export MADE_UP_FIREWALL=1 ;;
    silent*) echo asked >> "${0%/*}/asked"; until [ -e "${0%/*}/speaks" ]; do sleep 0.05; done ;;
    *) export SSH_CONNECTION="127.0.0.1 1 127.0.0.1 22" ;;
esac
exec sh -c "$*"
"""
NODE = """#!/bin/sh
[ "$1" = --version ] && { echo "{\\"version\\": \\"1.2.3\\", \\"build\\": \\"${MADE_UP_BUILD:-0123456789abcdef}\\"}"; exit 0; }
[ "$2" = 0 ] || grep -q . || { echo "no wall on standard input" >&2; exit 2; }
[ "$MADE_UP_DISPLAY" = none ] && { echo "display :0 cannot be opened" >&2; exit 2; }
[ "$5" = --json ] || { echo "asked for no JSON: $*" >&2; exit 2; }
[ -z "$MADE_UP_DISPLAY" ] || short='"output a: its window lies partly off the screen"'
echo "{\\"backend\\": \\"$4\\", \\"renderer\\": \\"made-up renderer\\", \\"shortcomings\\": [$short]}"
"""
DATE = """#!/bin/sh
exec /bin/date -d "@$(($(/bin/date +%s) + ${MADE_UP_SHIFT:-0}))" "$@"
"""
CHECK = """#!/bin/sh
[ "$1" = --free-memory ] || exec "$0.of_walls" "$@"
[ -z "$MADE_UP_NO_CHECK" ] || { echo "sandwall-check: cannot execute" >&2; exit 126; }
echo "free ${MADE_UP_MEMORY:-8589934592}"
"""
BASH = """#!/bin/sh
[ -z "$MADE_UP_FIREWALL" ] || exit 1
exec /bin/bash "$@"
"""


class Doctor(LauncherTest):
    def setUp(self):
        super().setUp()
        self.script("agent", AGENT)
        self.script("sandwall-render-node", NODE)
        self.script("sandwall-master", NODE)
        self.script("mpirun", "#!/bin/sh\necho \"$*\" >\"${0%/*}/started\"\n[ -z \"$MPI_FAULT\" ] || { echo \"$MPI_FAULT\" >&2; exit 1; }\n")
        for name, text in (("date", DATE), ("bash", BASH)):
            self.script(name, text)
        bin = self.folder / "bin"
        (bin / "sandwall-check").rename(bin / "sandwall-check.of_walls")
        self.script("sandwall-check", CHECK)
        self.name = socket.gethostname()

    def arguments(self, hosts, *options):
        wall = self.write("wall.toml", "\n".join(hosts) + "\n")
        return [str(ROOT / "scripts" / "sandwall"), "doctor", wall, "--out", str(self.folder), *options]

    def examine(self, hosts, *options):
        """Runs the doctor on a wall with these hosts. Returns (exit status, {(host, check): (mark, words)})."""
        ended = subprocess.run(self.arguments(hosts, *options), env=self.environment, text=True, capture_output=True,
                               timeout=200, stdin=subprocess.DEVNULL)
        self.assertEqual(ended.stderr, "")
        *lines, last = ended.stdout.splitlines()
        found = {}
        for line in lines:
            host, mark, check, words = re.fullmatch(r"(\S+) +(ok|RED) +(\S+) +(.*)", line).groups()
            self.assertNotIn((host, check), found)
            found[host, check] = (mark, words.replace(str(self.folder) + "/", ""))
        self.assertEqual(last, f"{self.reds(found)} red" if self.reds(found) else "all green")
        return ended.returncode, found

    @staticmethod
    def reds(found):
        return sum(mark == "RED" for mark, _ in found.values())

    def only_red(self, host, check):
        """Returns the words of the only red line, on a wall with this host and a sound one."""
        status, found = self.examine(["-", "sound1", host])
        self.assertEqual(status, 1)
        self.assertEqual([where for where, (mark, _) in found.items() if mark == "RED"], [(host, check)], found)
        return found[host, check][1]

    def test_a_sound_wall_is_green_all_over(self):
        status, found = self.examine(["sound1", "-", "sound1", "sound1"])
        self.assertEqual((status, self.reds(found)), (0, 0), found)
        self.assertEqual([check for host, check in found if host == self.name],
                         ["master", "disk", "lo", "shm", "limit", "tmp", "build", "mpi", "memory", "gl", "start"])
        self.assertEqual(found[self.name, "start"][1], "a session shows a frame on 4 ranks")
        self.assertEqual([check for host, check in found if host == "sound1"],
                         ["ssh", "build", "mpi", "memory", "shm", "tmp", "clock", "ports", "gl"])
        self.assertEqual(found["sound1", "build"][1], "0123456789abcdef")
        self.assertEqual(found["sound1", "memory"][1], "8192 MiB free, 3 ranks may take 768")
        self.assertEqual(found["sound1", "gl"][1], "ranks 1, 3-4: auto: made-up renderer")
        self.assertEqual(found[self.name, "gl"][1], "rank 2: auto: made-up renderer")
        self.assertRegex(found["sound1", "ports"][1], r"connects to this machine at 127\.0\.0\.1, port \d+")

    def test_a_login_that_prints_lines_changes_nothing(self):
        status, found = self.examine(["greets1", "-", "greets1"])
        self.assertEqual((status, self.reds(found)), (0, 0), found)
        self.assertEqual(found["greets1", "mpi"][1], "mpirun (Open MPI) 4.1.4")

    def test_a_host_that_is_silent_and_then_answers_is_green(self):
        with subprocess.Popen(self.arguments(["silent1", "-"]), env=self.environment, text=True, stdout=subprocess.PIPE,
                              stderr=subprocess.PIPE, stdin=subprocess.DEVNULL) as process:
            while not (self.folder / "bin" / "asked").exists() and process.poll() is None:
                time.sleep(0.01)
            self.script("speaks", "")
            said, complained = process.communicate(timeout=200)
        self.assertEqual((process.returncode, said.splitlines()[-1], complained), (0, "all green", ""), said)

    def test_a_session_on_other_hosts_has_time_for_two_silent_logins(self):
        limits = []

        def run(command, timeout, **_):
            limits.append(timeout)
            return subprocess.CompletedProcess(command, 0, "", "")
        with mock.patch("subprocess.run", run):
            for hosts in (["localhost", "localhost"], ["silent1", "localhost"]):
                first_frame.check_hosts(examined_host.Host("localhost"), hosts, "wall.toml", "osmesa", ())
        self.assertGreaterEqual(limits[1] - limits[0], 60, "each may take half a minute")

    def test_hosts_on_which_no_session_starts_are_red_at_the_end(self):
        self.environment["MPI_FAULT"] = "no daemon on sound1"
        status, found = self.examine(["sound1", "-"])
        self.assertEqual((status, self.reds(found)), (1, 1), found)
        self.assertEqual(found[self.name, "start"], ("RED", "no daemon on sound1"))

    def test_the_session_that_is_tried_has_the_hosts_and_options_of_the_coming_one(self):
        self.assertEqual(self.examine(["sound1", "-", "sound1"], "--network", "127.0.0.0/8", "--env", "MADE_UP_NAME=1")[0], 0)
        started = (self.folder / "bin" / "started").read_text()
        self.assertRegex(started, r"btl_tcp_if_include 127\.0\.0\.0/8 .*-x MADE_UP_NAME ")
        self.assertRegex(started, r"--host sound1:1 .* : -n 1 --host localhost:1 .* : -n 1 --host sound1:1 ")
        self.assertIn(" --frames 1 ", started)
        self.assertNotIn("--resume", started)

    def test_no_session_is_tried_where_another_check_is_red(self):
        self.only_red("narrow1", "screen")
        self.assertFalse((self.folder / "bin" / "started").exists())

    def test_one_machine_needs_no_ssh(self):
        self.environment["OMPI_MCA_plm_rsh_agent"] = "/nowhere/ssh"
        self.assertEqual(self.examine(["-", "-"])[0], 0)

    def test_a_host_that_does_not_answer_is_asked_nothing_more(self):
        self.assertEqual(self.only_red("away1", "ssh"),
                         "cannot be reached: ssh: connect to host away1 port 22: No route to host; "
                         "`ssh -o BatchMode=yes away1 true` must end with status 0 (docs/hosts.md)")

    def test_another_build_is_named_with_ours(self):
        self.assertEqual(self.only_red("old1", "build"), "00000000000000ff, here it is 0123456789abcdef; "
                         "install the same build at the same path everywhere")

    def test_too_little_memory_is_red(self):
        self.assertEqual(self.only_red("small1", "memory"), "2 MiB free, 1 rank may take 256; "
                         "end other programs or spread the ranks")

    def test_a_host_without_the_program_that_tells_its_memory_is_red(self):
        self.assertEqual(self.only_red("bare1", "memory"), "bin/sandwall-check does not answer (sandwall-check: cannot execute); "
                         "install the same build at the same path everywhere")

    def test_a_clock_of_another_hour_is_red(self):
        words = self.only_red("late1", "clock")
        self.assertRegex(words, r"^3[56]\d{5}\.\d ms ahead of this machine's, give or take .* ms; set it")

    def test_a_host_behind_a_firewall_is_red(self):
        self.assertRegex(self.only_red("walled1", "ports"), "^cannot connect to this machine at 127.0.0.1, port .*; "
                         "open the firewalls between the hosts for all TCP ports$")

    def test_a_display_that_cannot_be_opened_is_red(self):
        self.assertEqual(self.only_red("blind1", "gl"), "rank 3: display :0 cannot be opened; docs/backends.md")

    def test_a_window_that_is_not_as_wished_is_red(self):
        self.assertEqual(self.only_red("narrow1", "screen"),
                         "rank 3: output a: its window lies partly off the screen; docs/backends.md")

    def test_a_master_of_another_build_is_red(self):
        self.script("sandwall-master", "#!/bin/sh\necho '{\"build\": \"00000000000000ff\"}'\n")
        status, found = self.examine(["-"])
        self.assertEqual(status, 1)
        self.assertEqual(found[self.name, "master"], ("RED", "build 00000000000000ff, the ranks have 0123456789abcdef; "
                                                      "cmake --build build/release"))

    def test_a_folder_that_cannot_be_written_is_red_for_that_reason(self):
        # Even root can make no file in these places. Both report 0 bytes free, which is not the reason. Other users own
        # only the first place.
        closed = self.folder / "closed"
        closed.mkdir(mode=0o555)
        for out in ("/proc/self/fdinfo", "/sys/kernel" if os.geteuid() == 0 else closed):
            ended = subprocess.run([*self.arguments(["-"]), "--out", out], env=self.environment, text=True, capture_output=True,
                                   timeout=200, stdin=subprocess.DEVNULL)
            self.assertRegex(ended.stdout, rf"(?m)RED +disk +{out}: cannot be written \(.*\); choose another --out$")

    def test_a_folder_to_which_others_may_write_is_red(self):
        shared = self.folder / "shared"
        shared.mkdir()
        shared.chmod(0o777)
        ended = subprocess.run([*self.arguments(["-"]), "--out", str(shared)], env=self.environment, text=True, capture_output=True,
                               timeout=200, stdin=subprocess.DEVNULL)
        self.assertRegex(ended.stdout, r"(?m)RED +disk +.*/shared: other users may write to it; run chmod go-w on it")

    def test_a_list_of_hosts_is_tried_without_a_wall(self):
        hosts = self.write("hosts", "sound1 slots=2\nnarrow1\n")
        ended = subprocess.run([str(ROOT / "scripts" / "sandwall"), "doctor", hosts, "--out", str(self.folder)],
                               env=self.environment, text=True, capture_output=True, timeout=200, stdin=subprocess.DEVNULL)
        self.assertEqual(ended.stderr, "")
        self.assertRegex(ended.stdout, r"(?m)^sound1 +ok +memory +8192 MiB free, 2 ranks may take 512$")
        self.assertRegex(ended.stdout, r"(?m)^sound1 +ok +gl +auto: made-up renderer$")
        self.assertEqual(ended.returncode, 1)

    def test_programs_get_an_object(self):
        ended = subprocess.run(self.arguments(["-", "narrow1", "narrow1"], "--json"), env=self.environment, text=True,
                               capture_output=True, timeout=200, stdin=subprocess.DEVNULL)
        found = json.loads(ended.stdout)
        self.assertEqual((ended.returncode, ended.stderr, found["red"]), (1, "", 1))
        for finding in found["findings"]:
            self.assertEqual(finding["good"], finding["check"] != "screen", finding)
        gl = [finding for finding in found["findings"] if finding["check"] == "gl"]
        self.assertEqual([(finding["host"], finding["ranks"], finding["backend"], finding["renderer"]) for finding in gl],
                         [(self.name, [1], "auto", "made-up renderer"), ("narrow1", [2, 3], "auto", "made-up renderer")])
        self.assertEqual(gl[1]["shortcomings"], ["output a: its window lies partly off the screen"])

    def test_a_probe_that_prints_no_object_is_red(self):
        self.script("sandwall-render-node", NODE.partition("[ \"$2\" = 0 ]")[0] + "echo made-up renderer\n")
        status, found = self.examine(["-"])
        self.assertEqual((status, found[self.name, "gl"][0]), (1, "RED"))

    def test_only_a_terminal_is_coloured(self):
        ours, theirs = pty.openpty()
        self.addCleanup(os.close, ours)
        environment = {name: value for name, value in self.environment.items() if name != "NO_COLOR"}
        ended = subprocess.run(self.arguments(["-"]), env=environment, stdout=theirs, timeout=200, stdin=subprocess.DEVNULL)
        os.close(theirs)
        self.assertEqual(ended.returncode, 0)
        self.assertIn(b"\033[32mok \033[0m  master", os.read(ours, 65536))


class Refusals(LauncherTest):
    def refusal(self, which):
        ended = subprocess.run([str(ROOT / "scripts" / "sandwall"), "doctor", which], env=self.environment, text=True,
                               capture_output=True, timeout=120, stdin=subprocess.DEVNULL)
        self.assertEqual((ended.returncode, ended.stdout, ended.stderr.count("\n")), (2, "", 1), ended.stderr)
        return ended.stderr.replace(str(self.folder) + "/", "")

    def test_bad_input_is_one_line(self):
        self.assertEqual(self.refusal(str(self.folder / "no-file")), "sandwall: no-file: cannot be read; check the path\n")
        self.assertRegex(self.refusal("desktopp"), "^sandwall: desktopp: no file and no known name; walls .*, desktop, ")
        self.assertEqual(self.refusal(self.write("empty", "# nobody\n")),
                         "sandwall: empty: names no host; write one per line, as ssh knows it\n")
        self.assertEqual(self.refusal(self.write("hosts", "a\n-oX\n")),
                         "sandwall: hosts:2: '-oX' is not a host name; write one as ssh knows it, such as node01\n")
        self.script("sandwall-check", "#!/bin/sh\necho 'sandwall-check: wall.toml:3: no' >&2; exit 2\n")
        self.assertEqual(self.refusal(self.write("wall.toml", "")), "sandwall: wall.toml:3: no\n")


if __name__ == "__main__":
    unittest.main()
