#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests films that people mark in a running session, with the programs of this build.

usage: marked_films_test.py   (SANDWALL_BIN: folder of the programs)
"""

import json
import pathlib
import re
import subprocess
import sys
import tempfile
import time
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[3]
LAUNCHER = str(ROOT / "scripts" / "sandwall")
PATIENCE = 120
SCENE = """name = "small"
[field]
columns = 48
rows = 48
width = 2.0
[terrain]
kind = "flat"
height = 0.2
[tool]
radius = 0.1
"""


class MarkedFilms(unittest.TestCase):
    def setUp(self):
        self.kept = tempfile.TemporaryDirectory()
        self.addCleanup(self.kept.cleanup)
        self.folder = pathlib.Path(self.kept.name)
        self.out = self.folder / "out"
        desktop = (ROOT / "walls" / "configs" / "desktop.toml").read_text()
        self.wall = self.folder / "wall.toml"
        self.wall.write_text(desktop.replace("[1280, 720]", "[160, 90]"))
        self.scene = self.folder / "small.toml"
        self.scene.write_text(SCENE)

    def launch(self, *words):
        return [LAUNCHER, *words]

    def start(self):
        self.printed = self.folder / "printed"
        with self.printed.open("w") as output:
            session = subprocess.Popen(self.launch("run", "--wall", self.wall, "--scene", self.scene, "--device", "script:gis", "--gl", "osmesa",
                                                   "--out", self.out), stdin=subprocess.DEVNULL, stdout=output, stderr=subprocess.STDOUT)
        self.addCleanup(lambda: session.poll() is None and (session.terminate(), session.wait(PATIENCE)))
        return session

    def ctl(self, verb):
        """Returns the answer to a verb, or None if the session is not there yet."""
        ended = subprocess.run(self.launch("ctl", self.out, verb), capture_output=True, text=True, timeout=PATIENCE, stdin=subprocess.DEVNULL)
        return json.loads(ended.stdout) if ended.returncode == 0 else None

    def await_step(self, step):
        deadline = time.monotonic() + PATIENCE
        while time.monotonic() < deadline:
            if (status := self.ctl("status")) and status["step"] >= step:
                return
            time.sleep(0.1)
        self.fail(f"step {step} was not shown: {self.printed.read_text()}")

    def pictures(self, folder):
        """Returns the pictures of a film; a video has taken their place if this machine has ffmpeg."""
        return sorted(folder.glob("frame_*.png"))

    def count(self, folder):
        """Returns how many pictures the launcher says that the film has."""
        said = re.search(rf"(?:(\d+) pictures in {folder}|{folder}/film.mp4: (\d+) frames)", self.printed.read_text())
        self.assertIsNotNone(said, self.printed.read_text())
        return int(said[1] or said[2])

    def test_films_show_what_was_marked_and_from_where(self):
        session = self.start()
        self.await_step(20)
        begins, = [self.ctl("film")]
        self.assertEqual((begins["ok"], begins["film"]), (True, "begins"))
        self.await_step(begins["step"] + 40)
        ends = self.ctl("film")
        self.assertEqual((ends["film"], ends["folder"], ends["from"]), ("ends", "film_001", begins["step"]))
        self.assertGreaterEqual(ends["to"], begins["step"] + 40)
        second = self.ctl("film")  # ends with the session
        self.await_step(second["step"] + 20)
        self.assertEqual(self.ctl("stop"), {"ok": True})
        self.assertEqual(session.wait(2 * PATIENCE), 0, self.printed.read_text())
        last = json.loads((self.out / "summary.json").read_text())["steps"]
        self.assertEqual(self.count(self.out / "film_001"), -(-(ends["to"] - ends["from"]) * 30 // 60))
        self.assertEqual(self.count(self.out / "film_002"), -(-(last - second["step"]) * 30 // 60))

        # The view of the film is that of the session: its last picture is the session's last one.
        def film(name, *words):
            made = subprocess.run(self.launch("film", self.out, "--wall", self.wall, "--from", str(last - 4), "--to", str(last), "--out",
                                              self.folder / name, *words), capture_output=True, text=True, timeout=PATIENCE, stdin=subprocess.DEVNULL)
            self.assertEqual(made.returncode, 0, made.stderr)
            found = self.pictures(self.folder / name)
            self.assertEqual(len(found), 2, made.stdout)
            return found[-1].read_bytes()

        here = (self.out / "wall.png").read_bytes()
        self.assertEqual(film("same", "--view", ends["view"]), here)
        self.assertNotEqual(film("turned", "--view", "1,90,0,0,0,0"), here)

    def test_a_signal_leaves_a_film_with_its_command(self):
        session = self.start()
        self.await_step(20)
        self.ctl("film")
        self.await_step(80)
        session.terminate()
        self.assertEqual(session.wait(PATIENCE), 0, self.printed.read_text())
        line = re.search(rf"{self.out}/film_001: the film is not ready; `(.*)` makes it", self.printed.read_text())
        self.assertIsNotNone(line, self.printed.read_text())
        self.assertIn(f"film {self.out} --wall {self.wall} --from ", line[1])

    def test_a_span_outside_the_session_is_refused_in_one_line(self):
        subprocess.run(self.launch("run", "--wall", self.wall, "--scene", self.scene, "--gl", "osmesa", "--pace", "fast", "--steps", "30", "--out", self.out),
                       check=True, capture_output=True, timeout=PATIENCE, stdin=subprocess.DEVNULL)
        made = subprocess.run(self.launch("film", self.out, "--wall", self.wall, "--to", "31", "--out", self.folder / "film"),
                              capture_output=True, text=True, timeout=PATIENCE, stdin=subprocess.DEVNULL)
        self.assertEqual(made.returncode, 2)
        self.assertIn("holds steps 1 to 30, and the film is to begin behind step 0 and to end at step 31; give --from a smaller step than --to",
                      made.stderr)


if __name__ == "__main__":
    unittest.main()
