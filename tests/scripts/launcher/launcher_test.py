#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests the programs that scripts/sandwall starts, and the input that it refuses."""

import os
import pathlib
import re
import shlex
import subprocess
import sys
import unittest
from unittest import mock

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from display_fixture import DisplayTest
from launcher_fixture import LauncherTest
import pointer
from base import environment
from base.bad_input import BadInput

MPIRUN = """#!/bin/sh
echo "mpirun $*"
"""


class PrintedCommands(DisplayTest):
    def test_one_machine_talks_through_shared_memory(self):
        command = self.printed(["-", "-"])
        self.assertIn("mpirun -q --oversubscribe --bind-to none ", command)
        self.assertIn(" --mca btl self,vader --mca oob_tcp_if_include lo -n 1 sandwall-master ", command)
        self.assertTrue(command.endswith(" : -n 2 sandwall-render-node --gl auto\n"), command)

    def test_the_hosts_of_the_wall_file_are_taken(self):
        command = self.printed(["node1", "node1", "node2", "-"])
        self.assertIn("--mca btl self,vader,tcp ", command)
        self.assertIn(" -n 1 --host localhost sandwall-master ", command)
        self.assertTrue(command.endswith(" : -n 2 --host node1:2 sandwall-render-node --gl auto : -n 1 --host node2:1 "
                                         "sandwall-render-node --gl auto : -n 1 --host localhost:1 "
                                         "sandwall-render-node --gl auto\n"), command)

    def test_here_puts_every_rank_on_this_machine(self):
        self.assertEqual(self.printed(["node1", "node2"], "--here"), self.printed(["-", "-"]))

    def test_a_file_of_hosts_goes_before_the_wall_file(self):
        hosts = self.write("hosts", "other slots=2\n")
        self.assertEqual(self.printed(["node1", "node2"], "--hosts", hosts), self.printed(["other", "other"]))

    def test_a_network_is_for_ranks_and_daemons(self):
        self.assertIn("--mca btl_tcp_if_include 10.0.0.0/24 --mca oob_tcp_if_include 10.0.0.0/24",
                      self.printed(["node1"], "--network", "10.0.0.7/24"))

    def test_what_is_shown_is_for_the_master(self):
        command = self.printed(["-"], "--stereo", "anaglyph-dubois", "--track", "opentrack:4242 origin=0,1,0",
                               "--pattern", "grid")
        master, node = command.split(" : ")
        self.assertIn(" --stereo anaglyph-dubois --track 'opentrack:4242 origin=0,1,0' --pattern grid", master)
        self.assertEqual(node, "-n 1 sandwall-render-node --gl auto\n")

    def test_every_fault_on_purpose_is_for_the_master(self):
        master, node = self.printed(["-"], "--inject", "slow:rank=1,ms=30", "--inject", "slow:rank=1,ms=5,frame=9").split(" : ")
        self.assertIn(" --inject slow:rank=1,ms=30 --inject slow:rank=1,ms=5,frame=9", master)
        self.assertEqual(node, "-n 1 sandwall-render-node --gl auto\n")

    def test_mono_is_a_stereo_mode(self):
        self.assertEqual(self.printed(["-"], "--mono"), self.printed(["-"], "--stereo", "mono"))

    def test_nothing_is_said_that_was_not_asked_for(self):
        command = self.printed(["-"])
        for option in ("--stereo", "--track", "--pattern", "--inject", "--host ", "btl_tcp_if_include"):
            self.assertNotIn(option, command)

    def test_every_backend_can_be_asked_for(self):
        for gl in ("auto", "osmesa", "egl", "glfw"):
            self.assertIn(f"sandwall-render-node --gl {gl}", self.printed(["-"], "--gl", gl))

    def test_a_small_wall_opens_windows_where_a_display_is(self):
        self.environment["DISPLAY"] = self.display()
        for outputs in ("1 0", "2 0"):
            self.environment["MADE_UP_OUTPUTS"] = outputs
            self.assertIn("sandwall-render-node --gl glfw", self.printed(["-"]))
            self.assertIn("sandwall-render-node --gl osmesa", self.printed(["-"], "--gl", "osmesa"))
        for hosts, outputs in ((["-"], "3 0"), (["-"], "2 1"), (["node1"], "1 0")):
            self.environment["MADE_UP_OUTPUTS"] = outputs
            self.assertIn("sandwall-render-node --gl auto", self.printed(hosts))

    def test_a_display_that_accepts_no_connection_is_needed_only_for_windows_that_open_by_themselves(self):
        self.environment["DISPLAY"] = ":64999"
        for gl in ("osmesa", "egl", "glfw"):
            self.assertIn(f"sandwall-render-node --gl {gl}", self.printed(["-"], "--gl", gl))
        self.environment["MADE_UP_OUTPUTS"] = "2 1"
        self.assertIn("sandwall-render-node --gl auto", self.printed(["-"]), "each rank follows the wall file")
        self.assertIn("sandwall-render-node --gl auto", self.printed(["node1"]), "the display is that of another machine")

    def test_a_display_may_be_spelt_in_every_way_that_x_knows(self):
        number = self.display().removeprefix(":")
        for display in (f":{number}", f":{number}.0", f"unix:{number}", f"unix/:{number}", f"local/:{number}.1", f":0{number}"):
            self.environment["DISPLAY"] = display
            self.assertIn("sandwall-render-node --gl glfw", self.printed(["-"]), display)

    def test_a_device_needs_a_server_started_before(self):
        server, job = self.printed(["-"], "--device", "script:gis").splitlines()
        self.assertEqual(server, "sandwall-haptic-server --scene scene.toml --device script:gis "
                         "--listen 127.0.0.1:7750 --force-until-ctl --pace realtime")
        self.assertIn(" --haptic 127.0.0.1:7750 ", job)

    def test_what_a_hand_feels_is_for_the_server(self):
        server, job = self.printed(["-"], "--device", "sim:touch,path=gis", "--guards", "literal", "--force", "off",
                                   "--force-scale", "0").splitlines()
        self.assertTrue(server.endswith(" --force off --force-scale 0 --guards literal"), server)
        for option in ("--guards", "--force"):
            self.assertNotIn(option, job)
        self.assertNotIn("--guards", self.printed(["-"], "--device", "script:gis"))

    def test_ranks_that_share_a_host_share_its_cores(self):
        cores = len(os.sched_getaffinity(0))
        self.assertIn(f"LP_NUM_THREADS={cores} ", self.printed(["node1", "node2"]))
        self.assertIn(f"LP_NUM_THREADS={max(cores // 2, min(cores, 2))} ", self.printed(["node1", "node2", "node1"]))
        self.assertIn(f"LP_NUM_THREADS={min(cores, 2)} ", self.printed(["node1"] * (2 * cores)))
        self.assertIn("LP_NUM_THREADS=3 ", self.printed(["node1", "node2", "node1"], "--gl-threads", "3"))

    def test_variables_are_for_every_rank(self):
        self.environment["B"] = "inherited"
        command = self.printed(["node1"], "--env", "XAUTHORITY=/home/wall/.Xauthority", "--env", "A=", "--env", "B", "--env", "C=a b;c",
                               "--env", "LP_NUM_THREADS=7")
        self.assertIn(" LP_NUM_THREADS=7 XAUTHORITY=/home/wall/.Xauthority A='' C='a b;c' mpirun ", command)
        self.assertIn(" -x XAUTHORITY -x A -x B -x C -n 1 ", command)
        self.assertNotIn("inherited", command)

    def test_a_printed_command_can_be_pasted(self):
        self.script("mpirun", '#!/bin/sh\necho "$A"\n')
        command = self.printed(["-"], "--env", "A=two words; echo three")
        ran = subprocess.run(["sh", "-c", command], env=self.environment, capture_output=True, text=True)
        self.assertEqual(ran.stdout, "two words; echo three\n")

    def test_nothing_is_started(self):
        self.script("mpirun", "#!/bin/sh\ntouch " + str(self.folder / "started"))
        self.printed(["away1"])
        self.assertFalse((self.folder / "started").exists())


class Values(LauncherTest):
    def test_no_process_that_the_launcher_starts_shows_the_value_of_a_variable(self):
        # Each rank lists the arguments of all processes. A daemon of mpirun starts one of them by way of a made-up ssh.
        listing = '#!/bin/sh\nfor file in /proc/[0-9]*/cmdline; do tr "\\0" " " < "$file"; echo; done > "$LISTED.$OMPI_COMM_WORLD_RANK" 2>&1\n' \
            'echo "$GIVEN $TAKEN" > "$LISTED.values.$OMPI_COMM_WORLD_RANK"\n'
        for name in ("sandwall-master", "sandwall-render-node"):
            self.script(name, listing)
        self.environment.update(TAKEN="taken-5c1f09", LISTED=str(self.folder / "listed"))
        ended = self.start(["-", "node1"], "--env", "TAKEN", "--env", "GIVEN=given-77aa31", "--env", "LISTED")
        self.assertEqual(ended.returncode, 0, ended.stderr)
        for rank in range(3):
            self.assertEqual((self.folder / f"listed.values.{rank}").read_text(), "given-77aa31 taken-5c1f09\n")
            lines = (self.folder / f"listed.{rank}").read_text(errors="replace").splitlines()
            self.assertTrue(any(re.search("orted|prted", line) for line in lines), "the daemon of node1 is not in the list")
            self.assertFalse([line for line in lines if "taken-5c1f09" in line])
            self.assertTrue(all("scripts/sandwall run" in line for line in lines if "given-77aa31" in line))


class ShownCommands(unittest.TestCase):
    def test_the_command_of_try_can_be_pasted_whatever_its_files_are_called(self):
        for out, wall in (("out/try", "desktop.toml"), ("my out; echo x", "a wall's.toml"), ("$(touch x)", "w`x`.toml")):
            with mock.patch("pointer.print_line") as said:
                pointer.print_journal(out, wall)
            command = said.call_args[0][0].partition("session.journal; `")[2]
            self.assertEqual(shlex.split(command.removesuffix("` makes a film of it"))[1:],
                             ["film", out, "--wall", wall, "--out", "film"])


class LargeWall(DisplayTest):
    def test_a_large_wall_tells_that_it_is_drawn_in_memory(self):
        self.script("mpirun", "#!/bin/sh\n")
        self.environment.update(DISPLAY=self.display(), MADE_UP_OUTPUTS="24 0")
        line = ("sandwall: draws the wall's 24 outputs in memory, because only up to 2 open windows by themselves; --gl glfw opens "
                "windows\n")
        self.assertEqual(self.start(["-"]).stderr, line)
        self.assertEqual(self.start(["-"], "--gl", "osmesa").stderr, "")

    def test_a_large_wall_needs_no_display_that_answers(self):
        self.script("mpirun", "#!/bin/sh\n")
        self.environment.update(DISPLAY=":64999", MADE_UP_OUTPUTS="24 0")
        self.assertIn("draws the wall's 24 outputs in memory", self.start(["-"]).stderr)


class Refusals(LauncherTest):
    def test_a_display_that_does_not_answer_is_refused_because_nobody_would_see_the_wall(self):
        for display, status in ((":64999", 75), ("unix:64999", 75), ("no display", 2), (":99999999", 2), ("127.0.0.1:59999", 75),
                                ("[::1]:59999", 75), ("tcp/localhost:59999", 75)):
            self.environment["DISPLAY"] = display
            self.assertEqual(self.refused(["-"], status=status), f"sandwall: --gl auto: no X server accepts connections at DISPLAY={display}; start it, or "
                             "correct or unset DISPLAY; --gl osmesa draws in memory\n")

    def test_a_wayland_desktop_without_xwayland_is_refused(self):
        self.environment["WAYLAND_DISPLAY"] = "wayland-0"
        line = self.refused(["-"])
        self.assertIn("--gl auto: no X display (DISPLAY is not set); on this Wayland desktop windows need Xwayland: install Xwayland", line)
        self.assertTrue(line.endswith("; --gl osmesa draws in memory\n"), line)
        self.script("mpirun", "#!/bin/sh\n")
        self.assertEqual(self.start(["-"], "--gl", "osmesa").stderr, "")

    def test_a_wall_that_does_not_pass_the_check_is_refused_in_its_words(self):
        self.script("sandwall-check", "#!/bin/sh\necho 'sandwall-check: wall.toml:3: no' >&2; exit 2\n")
        self.assertEqual(self.refused(["-"]), "sandwall: wall.toml:3: no\n")

    def test_a_host_that_cannot_be_reached_is_named_with_its_rank(self):
        self.assertEqual(self.refused(["-", "away1"], status=75), "sandwall: away1 (rank 2): cannot be reached: ssh: connect to host "
                         "away1 port 22: No route to host; docs/hosts.md\n")

    def test_a_host_without_the_programs_is_named_with_its_rank(self):
        line = self.refused(["-", "-", "bare1"], status=75)
        self.assertIn("bare1 (rank 3): has no ", line)
        self.assertIn("sandwall-render-node; install the same build at the same path on every host", line)

    def test_an_agent_that_is_not_there_is_named(self):
        self.environment["OMPI_MCA_plm_rsh_agent"] = "/nowhere/ssh"
        self.assertIn("/nowhere/ssh: cannot be run", self.refused(["node1"]))

    def test_a_network_without_other_hosts_is_refused(self):
        self.assertIn("--network: every rank runs on this machine", self.refused(["-"], "--network", "10.0.0.0/24"))

    def test_a_network_that_is_none_is_refused(self):
        self.assertIn("--network: 'eth0' is not a network", self.refused(["node1"], "--print-command", "--network", "eth0"))

    def test_a_variable_that_cannot_be_given_is_refused_without_its_value(self):
        for word, line in (("NOWHERE", "NOWHERE: is not set here; export it, or write NOWHERE=VALUE"),
                           ("1A=secret", "1A: write NAME, or NAME=VALUE in one line"),
                           ("A=secret\n", "A: write NAME, or NAME=VALUE in one line"),
                           ("OMPI_MCA_x=secret", "OMPI_MCA_x: belongs to Open MPI, which shows its value in command lines; export it instead"),
                           ("SANDWALL_EVENTS=2", "SANDWALL_EVENTS: must be 0 or 1, got '2'")):
            with self.assertRaises(BadInput) as refused:
                environment.for_ranks([word])
            self.assertEqual(str(refused.exception), f"--env {line}")
        self.assertEqual(self.refused(["-"], "--env", "NOWHERE"), "sandwall: --env NOWHERE: is not set here; export it, or write NOWHERE=VALUE\n")

    def test_a_variable_of_sandwall_is_checked_like_an_option(self):
        for name, values, allowed in (("SANDWALL_START_TIMEOUT", ("abc", "0", "-5", "nan", "inf", "3601", "20s", " 20"),
                                       "a number from 1 to 3600 [s], got '{}'; unset it for 120 s"),
                                      ("SANDWALL_EVENTS", ("yes", "2", "01"), "0 or 1, got '{}'")):
            for value in values:
                self.assertEqual(environment.why_bad({name: value}), f"{name}: must be {allowed.format(value)}")
        for good in ({}, {"SANDWALL_START_TIMEOUT": "20.5", "SANDWALL_EVENTS": ""}, {"SANDWALL_START_TIMEOUT": "", "SANDWALL_EVENTS": "0"}):
            self.assertIsNone(environment.why_bad(good))
        self.environment["SANDWALL_START_TIMEOUT"] = "abc"
        self.assertEqual(self.refused(["-"]), f"sandwall: {environment.why_bad(self.environment)}\n")

    def test_too_few_slots_are_refused(self):
        hosts = self.write("hosts", "node1\n")
        self.assertIn("hosts: 1 slots are too few for the wall's 2 render ranks",
                      self.refused(["-", "-"], "--hosts", hosts))

    def test_here_and_hosts_exclude_each_other(self):
        self.assertIn("--hosts: not allowed with argument --here", self.refused(["-"], "--here", "--hosts", "x"))
        self.assertIn("not allowed with argument", self.refused(["-"], "--mono", "--stereo", "mono"))

    def test_a_number_that_is_none_or_too_small_is_refused(self):
        for option, value, bounds in (("--restarts", "-1", "0 or more"), ("--restart-window", "-5", "0 or more"),
                                      ("--checkpoint", "-0.1", "from 0 to 86400")):
            self.assertEqual(self.refused(["-"], option, value),
                             f"sandwall run: argument {option}: {value} must be {bounds}; try --help\n")

    def test_a_folder_that_cannot_be_made_is_refused_before_a_program_starts(self):
        self.script("mpirun", MPIRUN)
        file = self.write("file", "")
        for out, why in (("/proc/x", "cannot be made (No such file or directory); choose another --out"),
                         (f"{file}/x", "cannot be made (Not a directory); choose another --out"),
                         (file, "is not a folder, and --out must be one; choose another")):
            for options in ((), ("--json",), ("--device", "script:gis")):
                ended = self.start(["-"], *options, "--out", out)
                self.assertEqual((ended.returncode, ended.stdout, ended.stderr), (2, "", f"sandwall: {out}: {why}\n"))

    def test_an_unknown_device_is_refused_before_the_session_has_a_folder(self):
        for device in ("nosuch", "sim", "pointer:1", ""):
            ended = self.start(["-"], "--device", device)
            self.assertEqual((ended.returncode, ended.stdout), (2, ""))
            self.assertEqual(ended.stderr, f"sandwall: --device {device}: unknown device; give script:gis, script:FILE, trace:FILE.csv, "
                             "driver:FILE.so, sim:PRESET, spacenav, pointer or none\n")

    def test_a_secret_without_a_link_is_refused(self):
        self.assertIn("--secret-file: needs a haptic link", self.refused(["-"], "--secret-file", "none"))

    def test_what_only_a_device_can_do_needs_one(self):
        for option, value in (("--guards", "literal"), ("--force", "off"), ("--force-scale", "0"), ("--record", "t.csv"),
                              ("--map", "scale=1")):
            for hand in ((), ("--haptic", "127.0.0.1:7750")):
                self.assertEqual(self.refused(["-"], option, value, *hand),
                                 f"sandwall: {option}: needs --device; with --haptic, give it to the haptic server itself\n")
        self.assertIn("--guards: invalid choice: 'off'", self.refused(["-"], "--device", "sim:desktop", "--guards", "off"))


if __name__ == "__main__":
    unittest.main()
