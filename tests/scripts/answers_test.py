#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests the keys of a window and its answers in one session, on an X server in memory. xdotool types.

usage: answers_test.py   (SANDWALL_BIN: folder of the programs; SANDWALL_KEEP_PICTURES: folder for screenshots)
"""

import json
import pathlib
import struct
import subprocess
import time
import unittest
import zlib

import pointer_test
from pointer_test import PATIENCE

EDGE = (158, 128, 84)  # colour of the edge of answers and help (render_node/overlay/help.cpp)
SIZE = (640, 480)
# Longest time in which a key is answered, and in which an answer goes away, on a busy machine.
ANSWERED, GONE = 30, 60


class Screen:
    """Rows of pixels, from the top. A pixel is (red, green, blue)."""

    def __init__(self, rows):
        self.rows = rows

    @classmethod
    def of_server(cls, folder):
        """Reads the memory of Xvfb, which has the format of xwd."""
        data = (pathlib.Path(folder) / "Xvfb_screen0").read_bytes()
        header = struct.unpack(">25I", data[:100])
        begin, width, height, line = header[0] + 12 * header[19], header[4], header[5], header[12]
        rows = []
        for y in range(height):
            row = data[begin + y * line:begin + y * line + 4 * width]
            rows.append(list(zip(row[2::4], row[1::4], row[0::4])))
        return cls(rows)

    @classmethod
    def of_png(cls, file):
        """Reads a PNG file with 8 bits for each of three colours."""
        data, at, packed, width = file.read_bytes(), 8, b"", 0
        while at < len(data):
            length, kind = struct.unpack(">I4s", data[at:at + 8])
            body = data[at + 8:at + 8 + length]
            if kind == b"IHDR":
                width = struct.unpack(">I", body[:4])[0]
                assert body[8:10] == b"\x08\x02", "not 8-bit RGB"
            elif kind == b"IDAT":
                packed += body
            at += length + 12
        raw, line = zlib.decompress(packed), 3 * width
        rows, above = [], bytes(line)
        for begin in range(0, len(raw), line + 1):
            row = cls.unfiltered(raw[begin], bytearray(raw[begin + 1:begin + 1 + line]), above)
            rows.append(list(zip(row[0::3], row[1::3], row[2::3])))
            above = row
        return cls(rows)

    @staticmethod
    def unfiltered(kind, row, above):
        for i in range(len(row)):
            left, up, corner = (row[i - 3] if i >= 3 else 0), above[i], (above[i - 3] if i >= 3 else 0)
            if kind == 4:  # the neighbour that is nearest to left + up - corner
                guess = left + up - corner
                best = min((left, up, corner), key=lambda value: abs(guess - value))
            else:
                best = (0, left, up, (left + up) // 2)[kind]
            row[i] = (row[i] + best) & 255
        return row

    def panels(self):
        """Returns the lengths of the horizontal edges of answers and of the help, from the top."""
        found = []
        for row in self.rows:
            longest = run = 0
            for pixel in row:
                run = run + 1 if pixel == EDGE else 0
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
        return Screen.of_server(self.folder)

    def key(self, *keys):
        for name in keys:
            self.server.pointer("key", name)
            self.frames_pass(1)

    def wait_for_panels(self, wanted, seconds):
        deadline = time.monotonic() + seconds
        while not wanted(panels := self.screen().panels()):
            self.assertLess(time.monotonic(), deadline, panels)
            time.sleep(0.05)

    def answered(self, name=""):
        self.wait_for_panels(bool, ANSWERED)
        if name:
            self.keep_picture(name)

    def gone(self):
        self.wait_for_panels(lambda panels: not panels, GONE)

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
        self.wait_for_panels(lambda panels: SIZE[0] in panels, ANSWERED)
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
        self.assertEqual(Screen.of_png(capture).panels(), [])
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
