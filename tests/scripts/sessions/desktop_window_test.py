#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests the window of `sandwall try` with a window manager, on an X server in memory, as a person uses it (docs/pointer.md).

One session has all tests, in their order. Those of answers_test.py come first, so that the hint of ten seconds costs no time.

usage: desktop_window_test.py   (SANDWALL_BIN: folder of the programs)
"""

import pathlib
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import picture_files
import answers_test
import window_fixture
from window_fixture import FULL_SCREEN, SCREEN

RESIZES = 200
LAST_SIZE = (601, 403)


class DesktopWindow(window_fixture.WindowOfTry):
    def test_1_the_first_window_fits_the_screen_and_has_a_frame_and_a_title(self):
        x, y, width, height = self.place()
        self.assertLessEqual(width, 0.8 * SCREEN[0])
        self.assertLessEqual(height, 0.8 * SCREEN[1])
        self.assertAlmostEqual(width / height, 1280 / 720, delta=0.01)
        self.assertGreater(width, 0.7 * SCREEN[0])
        self.assertEqual(self.desktop.do("getwindowname", self.window).strip(), "Sandwall – mountain")
        self.desktop.do("mousemove", 1, 1)
        bar = self.desktop.screen().part(x, y - 10, width, 1)
        self.assertNotEqual(set(bar.rows[0]), {0}, "a title bar above the window")

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
        self.session.act("mousemove", *self.on_screen(here)[0], "click", "--repeat", 6, 4)
        zoomed, beside = self.dig(here, (here[0] + 60, here[1]))
        self.expect_near(zoomed, before)
        self.assertLess(beside[0] - zoomed[0], 8, "60 pixels are fewer cells than before")
        self.session.drag(self.on_screen(here, there), button=2)
        self.expect_near(self.dig(there)[0], before)
        self.session.drag(self.on_screen(there, here), button=3, keys=["shift"])
        self.expect_near(self.dig(here)[0], before)
        self.session.drag(self.on_screen(here, there), button=3)
        turned, = self.dig(here)
        self.assertGreater(max(abs(a - b) for a, b in zip(turned, before)), 4, "the right button has turned the sand")
        # The same sand in the same view has the same place under the pointer.
        self.desktop.do("key", "shift+r", "key", "Home")
        self.session.until(lambda: any(step["edit"] == "reset" for step in self.session.steps()), "the sand is not reset")
        self.session.frames_pass()
        self.expect_near(self.dig(here)[0], before, 0.1)
        self.expect_whole()

    def test_4_the_picture_follows_the_window(self):
        for size in ((700, 500), (300, 600), (900, 200)):
            self.resize(*size)
            picture = self.expect_whole()
            self.assertNotEqual(picture.pixel(picture.width // 2, picture.height // 2), picture.pixel(2, 2), "sand in the middle")

    def test_5_full_screen_and_back(self):
        self.resize(640, 400)
        for key in ("F11", FULL_SCREEN):
            self.desktop.do("key", key)
            self.comes_to(*SCREEN)
            self.assertEqual(self.place()[:2], (0, 0), key)
            self.expect_whole()
            self.desktop.do("key", key)
            self.comes_to(640, 400)
            self.expect_whole()

    def test_6_the_title_bar_maximises_the_window(self):
        def double_click():
            x, y, width = self.place()[:3]
            self.desktop.do("mousemove", x + width // 2, y - 8, "click", "--repeat", 2, "--delay", 50, 1)

        double_click()
        self.session.until(lambda: self.place()[2] > 0.97 * SCREEN[0], "the window is not maximised")
        self.session.frames_pass()
        self.expect_whole()
        double_click()
        self.comes_to(640, 400)

    def test_7_a_window_of_one_pixel_is_no_end(self):
        self.desktop.do("windowsize", self.window, 1, 1)
        self.session.frames_pass(10)
        self.resize(640, 400)
        self.expect_whole()

    def test_8_wet_sand_is_darker(self):
        dry = self.expect_whole()
        self.desktop.do("key", "--delay", 100, *"wwwww")
        self.session.wait_for_status(lambda now: abs(now["material"]["humidity"] - 0.5) < 1e-9)
        wet = self.expect_whole()
        background, middle = (2, 2), (320, 200)
        self.assertEqual(wet.pixel(*background), dry.pixel(*background))
        self.assertLess(sum(wet.pixel(*middle)), 0.9 * sum(dry.pixel(*middle)))
        self.session.act("key", "0")
        self.assertEqual(self.expect_whole(), dry, "the humidity of the scene is back")

    def test_9_many_sizes_while_digging(self):
        """Compares what was drawn while digging with a fresh drawing, which each change of the size begins."""
        self.session.act("windowmove", self.window, 100, 100)
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
                self.session.frames_pass(2)
            self.desktop.do("mouseup", 1)
            dug = self.expect_whole()
            self.resize(LAST_SIZE[0] - 100, LAST_SIZE[1])
            self.resize(*LAST_SIZE)
            self.assertEqual(self.expect_whole(), dug)
        status = self.session.status()
        self.assertEqual((status["divergences"], status["healed"]), (0, 0))
        self.assertTrue(status["can_undo"])

    def test_a_closing_the_window_ends_the_session(self):
        self.session.end("windowactivate", "--sync", self.window, "key", "alt+F4")
        picture = picture_files.read_png(self.session.out / "wall.png")
        self.assertEqual((picture.width, picture.height), LAST_SIZE, "the last picture has the size of the window")
        said = self.session.log.read_text()
        self.assertIn(str(self.session.out / "session.journal"), said)
        self.assertIn("dig with the left mouse button", said)
        self.assertNotIn("hashes agree", said, "a line for an operator")


def load_tests(loader, _tests, _pattern):
    return unittest.TestSuite(map(loader.loadTestsFromTestCase, (answers_test.Answers, DesktopWindow)))


if __name__ == "__main__":
    unittest.main()
