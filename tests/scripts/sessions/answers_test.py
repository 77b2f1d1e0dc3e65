#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests the keys of a window and its answers. desktop_window_test.py runs these tests first, in its own session.

usage: answers_test.py   (SANDWALL_BIN: folder of the programs; SANDWALL_KEEP_PICTURES: folder for screenshots)
"""

import pathlib
import subprocess
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import picture_files
import pointer_fixture
import window_fixture
from window_fixture import CELLS, WIDTH


class Answers(window_fixture.WindowOfTry):
    """These tests leave the sand, the tool and the view as they were at the beginning."""

    def setUp(self):
        # The place is in the middle of the level sand, above the help.
        self.hover, = self.on_screen((self.place()[2] // 2, self.place()[3] // 2))
        self.desktop.do("mousemove", *self.hover)

    def key(self, *keys):
        for name in keys:
            self.desktop.do("key", name)
            self.session.frames_pass(1)

    def stroke(self):
        """Digs to and fro, and returns the largest depth of the furrow [scene unit]."""
        x, y = self.hover
        self.session.drag([(x - 60, y), (x + 60, y)])
        self.session.wait_for_status(lambda now: now["can_undo"])
        return -min(min(row) for row in self.session.heights_changed())

    def undo(self):
        """Undoes the stroke, and humidity that an earlier test has changed."""
        while left := self.session.status()["undo_left"]:
            self.key("ctrl+z")
            self.session.wait_for_status(lambda now: now["undo_left"] < left)

    def test_1_a_session_begins_with_a_hint(self):
        self.answered("hint.png")

    def test_2_keys_set_the_tool_and_the_humidity(self):
        session = self.session
        self.key("3")
        session.wait_for_status(lambda now: now["tool_shape"] == "rectangle")
        self.key("comma", "comma", "period", "w")
        session.wait_for_status(lambda now: abs(now["tool_heading"] - 5) < 0.1 and abs(now["material"]["humidity"] - 0.1) < 1e-9)
        self.desktop.do("key", *["minus"] * 12)
        cell = WIDTH / CELLS
        session.wait_for_status(lambda now: abs(now["tool_radius"] - cell) < 0.01 * cell)
        session.frames_pass(16)  # a frame takes one key, and a later key would make the tool smaller again
        self.desktop.do("keydown", "ctrl", "click", 4, "keyup", "ctrl")
        session.wait_for_status(lambda now: abs(now["tool_radius"] - 1.25 * cell) < 0.01 * cell)
        self.key("0")
        session.wait_for_status(lambda now: now["tool_shape"] == "sphere" and abs(now["tool_radius"] - 0.05) < 0.001 and now["material"]["humidity"] == 0)

    def test_3_undo_is_the_key_that_types_a_z(self):
        for layout in ("de", "fr", "us"):  # a German keyboard has the z at the place of the y
            subprocess.run(["setxkbmap", layout], env=self.desktop.environment, check=True, timeout=pointer_fixture.PATIENCE)
            self.stroke()
            self.undo()
        self.key("ctrl+z")
        self.answered("nothing_to_undo.png")

    def test_4_space_pauses_and_resumes(self):
        self.key("space")
        self.session.wait_for_status(lambda now: now["paused"])
        self.key("space")
        self.session.wait_for_status(lambda now: not now["paused"])

    def test_5_ctrl_s_saves_the_sand(self):
        self.key("ctrl+s")
        self.session.until((self.session.out / "saves" / "save_001.sand").exists, "no saved sand")

    def test_6_the_wheel_with_shift_sets_the_depth(self):
        usual = self.stroke()
        self.undo()
        self.desktop.do("keydown", "shift", "click", "--repeat", 8, 5, "keyup", "shift")
        self.answered("depth.png")
        deep = self.stroke()
        self.undo()
        self.key("0")
        self.assertGreater(usual, 0.005)
        self.assertGreater(deep, 1.5 * usual, "eight notches make the tool more than twice as deep")

    def test_7_answers_and_help_leave_nothing_behind(self):
        self.gone()
        still = self.desktop.screen().rows
        self.key("g", "g")
        self.answered("answer.png")
        self.key("F1")
        self.session.until(lambda: self.place()[2] in self.edges(), "no help")
        self.desktop.do("mousemove", *self.hover)
        self.desktop.keep("help.png")
        self.key("question")
        self.gone()
        self.assertEqual(self.desktop.screen().rows, still, "the screen is as if no answer had been there")

    def test_8_a_captured_frame_shows_no_answer(self):
        self.key("3")
        self.answered()
        self.key("F12")
        capture = self.session.out / "capture_001" / "wall.png"
        self.session.until(lambda: capture.exists() and capture.read_bytes().endswith(picture_files.END), "no capture")
        self.answered("captured.png")
        self.assertEqual(pointer_fixture.edges(picture_files.read_png(capture)), [])
        self.session.wait_for_status(lambda now: now["tool_shape"] == "rectangle")
        self.key("0")


if __name__ == "__main__":
    unittest.main()
