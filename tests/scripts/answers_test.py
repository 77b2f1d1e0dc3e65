#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests the keys of a window and its answers in one session, on an X server in memory. xdotool types.

usage: answers_test.py   (SANDWALL_BIN: folder of the programs; SANDWALL_KEEP_PICTURES: folder for screenshots)
"""

import json
import subprocess
import time
import unittest

import picture_files
import pointer_test
from pointer_test import PATIENCE

EDGE = bytes((158, 128, 84))  # colour of the edge of answers and help (render_node/overlay/help.cpp)
SIZE = (640, 480)
# Longest time in which a key is answered, and in which an answer goes away, on a busy machine.
ANSWERED, GONE = 30, 60


def panels(picture):
    """Returns the lengths of the horizontal edges of answers and of the help in a picture [pixel], from the top."""
    found = []
    for row in picture.rows:
        longest = run = 0
        for at in range(0, len(row), 3):
            run = run + 1 if row[at:at + 3] == EDGE else 0
            longest = max(longest, run)
        if longest >= 40:  # sand has no such line
            found.append(longest)
    return found


class Keys(pointer_test.PointerSession):
    def setUp(self):
        super().setUp()
        self.server.end()
        self.server = pointer_test.Display(f"{SIZE[0]}x{SIZE[1]}", "-fbdir", self.folder)
        self.addCleanup(self.server.end)
        wall = (pointer_test.ROOT / "walls" / "configs" / "desktop.toml").read_text()
        # The wall places its window, so that the window has the size of the tile and no frame.
        wall = wall.replace("tile_pixels = [1280, 720]", f"tile_pixels = [{SIZE[0]}, {SIZE[1]}]")
        self.wall.write_text(wall.replace("tile_size = [0.531, 0.299]", "tile_size = [0.532, 0.399]") +
                             '\n[[place]]\ntiles = ["r1c1"]\nwindows = [[0, 0]]\n')

    def screen(self):
        return picture_files.read_screen(self.folder / "Xvfb_screen0")

    def key(self, *keys):
        for name in keys:
            self.server.pointer("key", name)
            self.frames_pass(1)

    def wait_for_panels(self, wanted, seconds):
        deadline = time.monotonic() + seconds
        while not wanted(found := panels(self.screen())):
            self.assertLess(time.monotonic(), deadline, found)
            time.sleep(0.05)

    def answered(self, name=""):
        self.wait_for_panels(bool, ANSWERED)
        if name:
            self.keep_picture(name)

    def gone(self):
        self.wait_for_panels(lambda found: not found, GONE)

    def stroke(self, y):
        self.drag([(220, y), (320, y), (420, y)])

    def deepest(self, first, last):
        """Returns the lowest height of the rows from `first` to `last` of the field, counted from the north."""
        return min(min(row) for row in self.heights_changed()[first:last])

    def test_keys_act_and_are_answered_in_their_window(self):
        session = self.run_session()
        self.server.pointer("mousemove", 320, 200)  # above the help, because the server draws the cursor into its screen
        self.answered("hint.png")
        self.gone()
        still = self.screen().rows

        # The answers and the help leave nothing behind.
        self.key("g", "g")
        self.answered("answer.png")
        self.key("F1")
        self.wait_for_panels(lambda found: SIZE[0] in found, ANSWERED)
        self.keep_picture("help.png")
        self.key("question")
        self.gone()
        self.assertEqual(self.screen().rows, still, "the sand is as if no answer had been there")

        # A captured frame shows no answer. The window does.
        self.key("3")
        self.answered()
        self.key("F12")
        capture = self.out / "capture_001" / "wall.png"
        self.wait_for_file(capture)
        self.answered("captured.png")
        self.assertEqual(panels(picture_files.read_png(capture)), [])
        self.wait_for_status(lambda now: now["tool_shape"] == "rectangle")

        # The tool's size, heading and humidity, and back to the scene.
        self.key("comma", "comma", "period", "w")
        self.wait_for_status(lambda now: abs(now["tool_heading"] - 5) < 0.1 and abs(now["material"]["humidity"] - 0.1) < 1e-9)
        for _ in range(12):
            self.server.pointer("key", "minus")
        cell = 2.0 / 128
        self.wait_for_status(lambda now: abs(now["tool_radius"] - cell) < 0.01 * cell)
        self.server.pointer("keydown", "ctrl", "click", 4, "keyup", "ctrl")
        self.wait_for_status(lambda now: abs(now["tool_radius"] - 1.25 * cell) < 0.01 * cell)
        self.key("0")
        self.wait_for_status(lambda now: now["tool_shape"] == "sphere" and abs(now["tool_radius"] - 0.05) < 0.001 and now["material"]["humidity"] == 0)

        # Undo by the key that types a z, also where it is at the place of the y.
        for layout in ("us", "de", "fr"):
            subprocess.run(["setxkbmap", layout], env=self.server.environment, check=True, timeout=PATIENCE)
            self.stroke(200)
            self.wait_for_status(lambda now: now["can_undo"])
            self.key("ctrl+z")
            self.wait_for_status(lambda now: not now["can_undo"])
        self.key("ctrl+z")  # nothing to undo
        self.answered("nothing_to_undo.png")

        # Pause and resume; save.
        self.key("space")
        self.wait_for_status(lambda now: now["paused"])
        self.key("space")
        self.wait_for_status(lambda now: not now["paused"])
        self.key("ctrl+s")
        self.wait_for_file(self.out / "saves" / "save_001.sand")

        # The depth, by a furrow of the usual depth in the north and a deep one in the south.
        self.stroke(220)
        self.server.pointer("keydown", "shift", "click", "--repeat", 8, 5, "keyup", "shift")
        self.answered("depth.png")
        self.stroke(340)
        self.server.pointer("key", "ctrl+q")
        self.assertEqual(session.wait(PATIENCE), 0, self.log.read_text())
        summary = json.loads((self.out / "summary.json").read_text())
        self.assertEqual(self.replay("--hash"), summary["state_hash"])
        self.assertEqual(summary["divergences"], 0)
        north, south = self.deepest(0, 48), self.deepest(48, 96)
        self.assertLess(north, -0.005)
        self.assertLess(south, 1.5 * north, "eight notches make the tool more than twice as deep")

    def wait_for_file(self, file):
        deadline = time.monotonic() + PATIENCE
        while not file.exists():
            self.assertLess(time.monotonic(), deadline, f"{file} is missing")
            time.sleep(0.05)


def load_tests(loader, _tests, _pattern):
    """Leaves out the tests of the class that Keys is derived from."""
    return unittest.TestSuite([Keys("test_keys_act_and_are_answered_in_their_window")])


if __name__ == "__main__":
    unittest.main()
