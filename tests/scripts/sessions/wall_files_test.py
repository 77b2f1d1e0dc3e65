#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests that a wall file cannot start a program, and can only open the trace of [tracking] source (docs/wall_files.md).

A folder with a program is watched by inotify, while programs read walls that have its path in each text. The kernel reports
every open, by whatever call and in whatever process, also the one that starts a program.
"""

import ctypes
import os
import pathlib
import re
import struct
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from launcher_fixture import ROOT

BIN = pathlib.Path(os.environ.get("SANDWALL_BIN", ROOT / "build" / "release" / "bin"))
IN_OPEN = 0x20
WALL = """name = {name}
[viewer]
eye = [0.0, 1.6, 3.0]
[stereo]
mode = {mode}
{tracking}
[grid]
rows = 1
columns = 1
tile_size = [1.024, 0.768]
tile_pixels = [64, 48]
lower_left = [-0.5, 1.2, 0.0]
[clip]
near = 0.1
far = 50.0
[stage]
centre = [0.0, 1.5, -0.5]
width = 1.0
[[screen]]
name = {screen}
lower_left = [2.0, 1.2, 0.0]
lower_right = [3.0, 1.2, 0.0]
upper_left = [2.0, 1.95, 0.0]
pixels = [64, 48]
{overlaps}
[[place]]
tiles = {tiles}
{host}
{display}
{monitors}
"""
PLAIN = {"name": '"a wall"', "mode": '"mono"', "tracking": "", "screen": '"side"', "overlaps": "", "tiles": '"all"', "host": "", "display": "",
         "monitors": ""}
# Each text of a wall file, with its place in the file. %s is the text.
KEYS = {"name": "%s", "mode": "%s", "tracking": "[tracking]\nsource = %s", "screen": "%s", "overlaps": "overlaps = [%s]", "tiles": "[%s]",
        "host": "host = %s", "display": "display = %s", "monitors": "monitors = [%s]"}
FORMS = ("%s", "|%s", "%s|", "$(%s)", "`%s`", ";%s", "-oProxyCommand=%s", "file://%s", "unix:%s", "trace:%s", "%s.so", "../../../../..%s")
# A member function of one of these names, such as Surface::clone(), starts nothing.
STARTS_A_PROGRAM = re.compile(r"(?<![.>])\b(?:system|popen|execl|execlp|execle|execv|execvp|execve|execvpe|posix_spawnp?|v?fork|clone)\s*\(")


class Watch:
    """Reports the files of a folder that any process opens."""

    def __init__(self, folder):
        libc = ctypes.CDLL(None, use_errno=True)
        self.descriptor = libc.inotify_init1(os.O_NONBLOCK | os.O_CLOEXEC)
        if self.descriptor < 0 or libc.inotify_add_watch(self.descriptor, os.fsencode(folder), IN_OPEN) < 0:
            raise OSError(ctypes.get_errno(), "inotify")

    def opened(self):
        """Returns the names of the files that were opened since the last call."""
        names = set()
        try:
            while events := os.read(self.descriptor, 1 << 16):
                at = 0
                while at < len(events):
                    length = struct.unpack_from("iIII", events, at)[3]
                    names.add(events[at + 16:at + 16 + length].rstrip(b"\0").decode())
                    at += 16 + length
        except BlockingIOError:
            pass
        return names - {""}

    def close(self):
        os.close(self.descriptor)


class WallFiles(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory(prefix="sandwall-walls-")
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name)
        watched = self.folder / "w"  # a short path, because texts of a wall file have at most so many characters
        watched.mkdir()
        self.program = watched / "p"
        self.program.write_text(f"#!/bin/sh\ntouch {self.folder}/ran\nexit 255\n")
        self.program.chmod(0o755)
        (watched / "p.so").write_bytes(self.program.read_bytes())
        agent = self.folder / "agent"
        agent.write_text("#!/bin/sh\nexit 255\n")
        agent.chmod(0o755)
        self.environment = {**os.environ, "SANDWALL_BIN": str(BIN), "OMPI_MCA_plm_rsh_agent": str(agent)}
        self.environment.pop("DISPLAY", None)
        self.watch = Watch(watched)
        self.addCleanup(self.watch.close)

    def wall(self, key, form):
        """Returns a wall file with the path of the program, in this form, as one of its texts."""
        text = '"' + (form % self.program if "%s" in form else form) + '"'
        path = self.folder / "wall.toml"
        path.write_text(WALL.format(**{**PLAIN, key: KEYS[key] % text}))
        return path

    def status(self, *command, stdin=subprocess.DEVNULL, **environment):
        return subprocess.run([str(word) for word in command], env={**self.environment, **environment}, stdin=stdin, stdout=subprocess.DEVNULL,
                              stderr=subprocess.DEVNULL, timeout=120).returncode

    def nothing_happened(self, what):
        self.assertEqual(self.watch.opened(), set(), what)
        self.assertFalse((self.folder / "ran").exists(), what)

    def test_the_plain_wall_is_one(self):
        path = self.folder / "wall.toml"
        path.write_text(WALL.format(**PLAIN))
        self.assertEqual(self.status(BIN / "sandwall-check", path), 0)

    def test_the_watch_sees_an_open_and_a_start(self):
        self.status(self.program)
        self.assertEqual(self.watch.opened(), {"p"})
        self.assertTrue((self.folder / "ran").exists())
        self.assertEqual(self.watch.opened(), set())

    def run_on_another_host(self, form, **environment):
        """Runs the launcher on a wall whose host is the path of the program, in this form."""
        self.status(ROOT / "scripts" / "sandwall", "run", "--wall", self.wall("host", form), "--scene", ROOT / "scenes" / "dunes.toml",
                    "--out", self.folder / "out", "--frames", "1", **environment)

    def probe(self, key, form, gl, **environment):
        with open(self.wall(key, form), "rb") as wall:
            self.status(BIN / "sandwall-render-node", "--probe", "1", "--gl", gl, stdin=wall, **environment)

    def test_the_watch_sees_a_program_that_the_launcher_starts(self):
        self.run_on_another_host("elsewhere", OMPI_MCA_plm_rsh_agent=str(self.program))
        self.assertEqual(self.watch.opened(), {"p"}, "the launcher asks the hosts of a wall through this agent")
        self.assertTrue((self.folder / "ran").exists())

    def test_the_watch_sees_a_file_that_a_render_rank_opens(self):
        self.probe("display", "%s", "osmesa", LD_PRELOAD=f"{self.program}.so")
        self.assertEqual(self.watch.opened(), {"p.so"}, "the loader of the rank opens it")

    def test_no_text_is_opened_or_started_by_the_check(self):
        for key in KEYS:
            for form in FORMS:
                self.status(BIN / "sandwall-check", self.wall(key, form))
                self.nothing_happened((key, form))

    def test_no_text_is_opened_or_started_by_the_launcher(self):
        for form in FORMS:
            self.run_on_another_host(form)
            self.nothing_happened(form)

    def test_no_text_is_opened_or_started_by_a_render_rank(self):
        for key in ("display", "monitors"):
            for form in FORMS:
                for gl in ("glfw", "egl", "osmesa"):
                    self.probe(key, form, gl)
                    self.nothing_happened((key, form, gl))

    def test_a_source_of_tracking_opens_the_file_of_a_trace_alone(self):
        for form in FORMS:
            self.status(BIN / "sandwall-track", f"--listen={form % self.program}", "--seconds", "0.01")
            if form == "trace:%s":
                self.assertEqual(self.watch.opened(), {"p"}, "docs/head_tracking.md names this file")
                self.assertFalse((self.folder / "ran").exists(), "it is read and not started")
            else:
                self.nothing_happened(form)

    def test_no_source_that_reads_or_uses_a_wall_can_start_a_program(self):
        files = [file for folder in ("base", "host", "walls", "tracking", "pictures", "lockstep", "render_node")
                 for ending in ("cpp", "hpp") for file in (ROOT / folder).glob(f"**/*.{ending}")]
        self.assertGreater(len(files), 100)
        for file in files:
            code = re.sub(r"//[^\n]*|\"(?:[^\"\\\n]|\\.)*\"", "", file.read_text())
            self.assertIsNone(STARTS_A_PROGRAM.search(code), file)


if __name__ == "__main__":
    unittest.main()
