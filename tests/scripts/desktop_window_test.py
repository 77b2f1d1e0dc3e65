#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests the window of `sandwall try` with a window manager, on an X server in memory, as a person uses it (docs/pointer.md).

xdotool moves the pointer, presses keys and asks the window manager. One session has all tests, in their order.

usage: desktop_window_test.py   (SANDWALL_BIN: folder of the programs)
"""

import csv
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time
import unittest

import picture_files

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "scripts" / room) for room in ("figures", "launcher")]
import events  # noqa: E402
import session_control  # noqa: E402
import x_server  # noqa: E402

BIN = pathlib.Path(os.environ.get("SANDWALL_BIN", ROOT / "build" / "release" / "bin"))
PATIENCE = 120  # seconds for work that takes a few seconds on an idle machine
GONE = 30  # [s], longest time in which a hint or an answer goes away
SCREEN = (1024, 768)
CURSOR = 24  # [pixel], more than the cursor's part right of and below its place
RESIZES = 200
LAST_SIZE = (601, 403)
CELLS, WIDTH = 96, 2.0  # of the field

# A mountain whose summit is above the screen at the stage of walls/configs/desktop.toml.
SCENE = """name = "mountain"
[field]
columns = 96
[terrain]
kind = "function"
z = "0.2 + 1.0*exp(-8*((x-1)^2 + (y-1.7)^2))"
x = [0.0, 2.0]
y = [0.0, 2.0]
[material]
talus_deg = 80  # the mountain does not slide
[tool]
radius = 0.05
"""


class Desktop(x_server.XServer):
    """An X server with a window manager, whose screen can be read."""

    def __init__(self, folder):
        self.folder = folder
        super().__init__("x".join(map(str, SCREEN)), "-fbdir", str(folder))
        self.manager = subprocess.Popen(["openbox"], env=self.environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

    def do(self, *words):
        """Runs xdotool with these words, and returns what it prints."""
        return subprocess.run(["xdotool", *map(str, words)], env=self.environment, check=True, timeout=PATIENCE, capture_output=True, text=True).stdout

    def screen(self):
        return picture_files.read_screen(self.folder / "Xvfb_screen0")

    def end(self):
        self.manager.terminate()
        self.manager.wait(PATIENCE)
        super().end()


class DesktopWindow(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        for tool in ("Xvfb", "xdotool", "openbox"):
            if shutil.which(tool) is None:
                raise AssertionError(f"{tool} is missing; run scripts/install_dependencies.sh --with-tests")
        temporary = tempfile.TemporaryDirectory(prefix="sandwall-desktop-")
        cls.addClassCleanup(temporary.cleanup)
        cls.folder = pathlib.Path(temporary.name)
        cls.out, cls.log = cls.folder / "out", cls.folder / "log.txt"
        (cls.folder / "mountain.toml").write_text(SCENE)
        cls.desktop = Desktop(cls.folder)
        cls.addClassCleanup(cls.desktop.end)
        environment = {**cls.desktop.environment, "SANDWALL_BIN": str(BIN), events.VARIABLE: "1"}
        with cls.log.open("w") as log:
            cls.session = subprocess.Popen([str(ROOT / "scripts" / "sandwall"), "try", "--scene", str(cls.folder / "mountain.toml"), "--out", str(cls.out)],
                                           env=environment, stdin=subprocess.DEVNULL, stdout=log, stderr=subprocess.STDOUT, start_new_session=True)
        cls.addClassCleanup(cls.stop)
        if events.wait_for(cls.log, "progress", PATIENCE, lambda: cls.session.poll() is None) is None:
            raise AssertionError(cls.log.read_text())
        cls.window = cls.desktop.do("search", "--sync", "--onlyvisible", "--name", "Sandwall").split()[0]

    @classmethod
    def stop(cls):
        if cls.session.poll() is None:
            cls.session.terminate()
            cls.session.wait(PATIENCE)

    def status(self):
        self.assertIsNone(self.session.poll(), self.log.read_text())
        return json.loads(session_control.ask(self.out, "status"))

    def frames_pass(self, count=4):
        """Waits until so many more frames are shown, so that the window has read its events."""
        wanted = self.status()["frame"] + count
        deadline = time.monotonic() + PATIENCE
        while self.status()["frame"] < wanted:
            self.assertLess(time.monotonic(), deadline)
            time.sleep(0.02)

    def place(self):
        """Returns x, y, width and height of the window on the screen, without its frame. Moves the pointer to its corner."""
        # The place of getwindowgeometry counts the frame twice.
        said = self.desktop.do("getwindowgeometry", "--shell", self.window, "mousemove", "--window", self.window, 0, 0, "getmouselocation", "--shell")
        words = dict(line.split("=") for line in said.split())
        return tuple(int(words[key]) for key in ("X", "Y", "WIDTH", "HEIGHT"))

    def comes_to(self, width, height):
        """Waits until the window has this size, and the wall has shown it."""
        deadline = time.monotonic() + PATIENCE
        while self.place()[2:] != (width, height):
            self.assertLess(time.monotonic(), deadline, f"the window has {self.place()} instead of {width} x {height}")
            time.sleep(0.05)
        self.frames_pass()

    def resize(self, width, height):
        self.desktop.do("windowsize", self.window, width, height)
        self.comes_to(width, height)

    def expect_whole(self):
        """Captures the wall, and expects that the window shows every pixel of it, when hint and answers have gone and sand rests."""
        x, y, width, height = self.place()
        self.desktop.do("mousemove", 1, 1)  # the server draws the cursor into its screen
        end, differing = time.monotonic() + GONE, [None]
        while differing and time.monotonic() < end:
            self.frames_pass()
            captured = json.loads(session_control.ask(self.out, "capture"))
            picture = picture_files.read_png(self.out / captured["folder"] / "wall.png")
            self.assertEqual((picture.width, picture.height), (width, height), "the size of a capture")
            shown = self.desktop.screen().part(x, y, width, height)
            differing = [row for row in range(height) if self.beside_cursor(shown, x, y, row) != self.beside_cursor(picture, x, y, row)]
        self.assertEqual(differing, [], "rows of the window that differ from the capture")
        return picture

    @staticmethod
    def beside_cursor(picture, x, y, row):
        """Returns a row of a picture at x, y of the screen, without the pixels that the cursor at the screen's corner may cover."""
        return picture.rows[row][3 * max(0, CURSOR - x):] if y + row < CURSOR else picture.rows[row]

    def drag(self, begin, end, *keys, button=1):
        """Drags from a place in the window to another one, while keys are held."""
        x, y = self.place()[:2]
        for key in keys:
            self.desktop.do("keydown", key)
        self.desktop.do("mousemove", x + begin[0], y + begin[1], "mousedown", button)
        self.frames_pass()
        self.desktop.do("mousemove", x + end[0], y + end[1])
        self.frames_pass()
        self.desktop.do("mouseup", button)
        for key in keys:
            self.desktop.do("keyup", key)
        self.frames_pass()

    def dig(self, *places):
        """Digs at places in the window, one after the other. Returns where the tool was in the sand [cell]."""
        first = len(self.strokes())
        x, y = self.place()[:2]
        for place in places:
            self.desktop.do("mousemove", x + place[0], y + place[1])
            self.frames_pass()
            self.desktop.do("mousedown", 1)
            self.frames_pass()
            self.desktop.do("mouseup", 1)
            self.frames_pass()
        strokes = self.strokes()[first:]
        self.assertEqual(len(strokes), len(places), "strokes in the journal")
        return strokes

    def strokes(self):
        """Returns where each stroke of the journal began [cell]."""
        steps = self.folder / "steps.csv"
        ran = subprocess.run([str(BIN / "sandwall-replay"), str(self.out / "session.journal"), "--export", str(steps)], capture_output=True, text=True,
                             timeout=PATIENCE)
        self.assertEqual(ran.returncode, 0, ran.stderr)
        begun, engaged = [], False
        with steps.open(newline="") as file:
            for step in csv.DictReader(line for line in file if not line.startswith("#")):
                if step["engaged"] == "1" and not engaged:
                    x, y = step["path"].split(";")[0].split()[:2]
                    begun.append((float(x) / WIDTH * CELLS, float(y) / WIDTH * CELLS))
                engaged = step["engaged"] == "1"
        return begun

    def expect_near(self, got, want, cells=2.0):
        self.assertLess(max(abs(a - b) for a, b in zip(got, want)), cells, f"{got} instead of {want}")

    def test_1_the_first_window_fits_the_screen_and_has_a_frame_and_a_title(self):
        x, y, width, height = self.place()
        self.assertLessEqual((width, height), (0.9 * SCREEN[0], 0.9 * SCREEN[1]))
        self.assertAlmostEqual(width / height, 1280 / 720, delta=0.01)
        self.assertGreater(width, 0.8 * SCREEN[0])
        self.assertEqual(self.desktop.do("getwindowname", self.window).strip(), "mountain, tile r1c1, middle eye - Sandwall")
        self.desktop.do("mousemove", 1, 1)
        bar = self.desktop.screen().part(x, y - 10, width, 1)
        self.assertNotEqual(set(bar.rows[0]), {0}, "a title bar above the window")
        self.expect_whole()

    def test_2_the_first_view_shows_the_summit(self):
        picture = self.expect_whole()
        background = picture.pixel(2, 2)
        top = next(y for y in range(picture.height) if any(picture.pixel(x, y) != background for x in range(picture.width)))
        self.assertGreater(top, 0, "background above the summit")
        self.assertLess(top, picture.height // 4, "not smaller than needed")

    def test_3_the_wheel_zooms_to_the_pointer_and_drags_move_and_turn_the_sand(self):
        width, height = self.place()[2:]
        here, there = (width // 3, height * 2 // 3), (width // 2, height // 2)
        before, = self.dig(here)
        x, y = self.place()[:2]
        self.desktop.do("mousemove", x + here[0], y + here[1], "click", "--repeat", 6, 4)
        self.frames_pass()
        zoomed, beside = self.dig(here, (here[0] + 60, here[1]))
        self.expect_near(zoomed, before)
        self.assertLess(beside[0] - zoomed[0], 8, "60 pixels are fewer cells than before")
        self.drag(here, there, button=2)
        self.expect_near(self.dig(there)[0], before)
        self.drag(there, here, "shift", button=3)
        self.expect_near(self.dig(here)[0], before)
        self.drag(here, there, button=3)
        turned, = self.dig(here)
        self.assertGreater(max(abs(a - b) for a, b in zip(turned, before)), 4, "the right button has turned the sand")
        # The same sand in the same view has the same place under the pointer.
        self.desktop.do("key", "shift+r", "key", "Home")
        self.frames_pass()
        self.expect_near(self.dig(here)[0], before, 0.1)
        self.expect_whole()

    def test_4_the_picture_follows_the_window(self):
        for size in ((700, 500), (300, 600), (900, 200)):
            self.resize(*size)
            picture = self.expect_whole()
            self.assertNotEqual(picture.pixel(picture.width // 2, picture.height // 2), picture.pixel(2, 2), "sand in the middle")

    def test_5_full_screen_and_back(self):
        self.resize(640, 400)
        self.desktop.do("key", "F11")
        self.comes_to(*SCREEN)
        self.assertEqual(self.place()[:2], (0, 0))
        self.expect_whole()
        self.desktop.do("key", "F11")
        self.comes_to(640, 400)
        self.expect_whole()

    def test_6_the_title_bar_maximises_the_window(self):
        self.resize(640, 400)
        x, y, width = self.place()[:3]
        self.desktop.do("mousemove", x + width // 2, y - 8, "click", "--repeat", 2, "--delay", 50, 1)
        deadline = time.monotonic() + PATIENCE
        while self.place()[2] < 0.97 * SCREEN[0]:
            self.assertLess(time.monotonic(), deadline, self.place())
            time.sleep(0.05)
        self.frames_pass()
        self.expect_whole()
        x, y, width = self.place()[:3]
        self.desktop.do("mousemove", x + width // 2, y - 8, "click", "--repeat", 2, "--delay", 50, 1)
        self.comes_to(640, 400)

    def test_7_a_window_of_one_pixel_is_no_end(self):
        self.desktop.do("windowsize", self.window, 1, 1)
        self.frames_pass(10)
        self.resize(640, 400)
        self.expect_whole()

    def test_8_wet_sand_is_darker(self):
        dry = self.expect_whole()
        self.desktop.do("key", "--delay", 100, *"wwwww")
        self.frames_pass()
        self.assertAlmostEqual(self.status()["material"]["humidity"], 0.5)
        wet = self.expect_whole()
        background, middle = (2, 2), (320, 200)
        self.assertEqual(wet.pixel(*background), dry.pixel(*background))
        self.assertLess(sum(wet.pixel(*middle)), 0.9 * sum(dry.pixel(*middle)))
        self.desktop.do("key", "0")
        self.frames_pass()
        self.assertEqual(self.expect_whole(), dry, "the humidity of the scene is back")

    def test_9_many_sizes_while_digging(self):
        """Compares what was drawn while digging with a fresh drawing, which each change of the size begins."""
        self.desktop.do("windowmove", self.window, 100, 100)
        self.frames_pass()
        x, y = self.place()[:2]
        for part in range(2):
            words = ["mousemove", x + 200, y + 150, "mousedown", 1]
            for i in range(part * RESIZES // 2, (part + 1) * RESIZES // 2):
                words += ["windowsize", self.window, 400 + 37 * i % 401, 300 + 53 * i % 203,
                          "mousemove", x + 150 + 11 * i % 120, y + 120 + 7 * i % 60, "sleep", 0.02]
            self.desktop.do(*words)
            self.resize(*LAST_SIZE)
            for i in range(5):
                self.desktop.do("mousemove", x + 160 + 30 * i, y + 130 + 20 * part)
                self.frames_pass(2)
            self.desktop.do("mouseup", 1)
            dug = self.expect_whole()
            self.resize(LAST_SIZE[0] - 100, LAST_SIZE[1])
            self.resize(*LAST_SIZE)
            self.assertEqual(self.expect_whole(), dug)
        status = self.status()
        self.assertEqual((status["divergences"], status["healed"]), (0, 0))
        self.assertTrue(status["can_undo"])

    def test_a_closing_the_window_ends_the_session(self):
        self.desktop.do("windowactivate", "--sync", self.window, "key", "alt+F4")
        self.assertEqual(self.session.wait(PATIENCE), 0, self.log.read_text())
        summary = json.loads((self.out / "summary.json").read_text())
        self.assertEqual(summary["divergences"], 0)
        replayed = subprocess.run([str(BIN / "sandwall-replay"), str(self.out / "session.journal"), "--hash"], capture_output=True, text=True,
                                  timeout=PATIENCE, check=True)
        self.assertEqual(replayed.stdout.strip(), summary["state_hash"])
        picture = picture_files.read_png(self.out / "wall.png")
        self.assertEqual((picture.width, picture.height), LAST_SIZE, "the last picture has the size of the window")


if __name__ == "__main__":
    unittest.main()
