#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests sessions with several windows whose hand is the pointer, and what is refused without windows.

usage: pointer_test.py   (SANDWALL_BIN: folder of the programs; SANDWALL_KEEP_PICTURES: folder for screenshots)
"""

import pathlib
import tempfile
import unittest
import unittest.mock

import pointer_fixture
from pointer_fixture import launch

import desk  # noqa: E402  (its folder is named by pointer_fixture)
from job.rank_hosts import BadInput  # noqa: E402

TILE = (160, 120)  # [pixel]
# Four windows. Three are without gaps on one display, and that in the south-east is on a display of its own. The bezels
# between the screens are wider than the gaps of the windows, which are 0. The wall is seen from far away, straight from
# the front. It shows the whole field, so that the first view is that of the wall file.
WALL = """name = "four windows"
[viewer]
eye = [0.0, 0.0, 40.0]
[stereo]
mode = "mono"
[grid]
rows = 2
columns = 2
tile_size = [1.6, 1.2]
bezel = [0.1, 0.1]
tile_pixels = [160, 120]
lower_left = [-1.65, -1.25, 0.0]
[clip]
near = 0.1
far = 100.0
[stage]
centre = [0.0, 0.0, 0.0]
width = 3.3
tilt_deg = 90.0
"""
PLACE = """[[place]]
tiles = ["{}"]
display = "{}"
windows = [[{}, {}]]
"""
COLUMNS = 128  # cells of the field
SCENE = """name = "level"
[field]
columns = 128
rows = 96
width = 2.0
[terrain]
height = 0.2
[material]
[tool]
radius = 0.05
"""
DUG = -0.005  # [scene unit], a change of height that only digging makes


def cell(x, y):
    """Returns row and column of the cell under a pixel of the four windows. The wall is 3.3 m wide, as the field is."""
    def metres(pixel, tile_pixels, tile_metres, bezel):
        return pixel * tile_metres / tile_pixels + (bezel if pixel >= tile_pixels else 0)
    east = metres(x, TILE[0], 1.6, 0.1)
    south = metres(y, TILE[1], 1.2, 0.1) - 0.0125  # the wall is 2.5 m high, and the field 2.475 m
    return int(south / 3.3 * COLUMNS), int(east / 3.3 * COLUMNS)


class FourWindows(pointer_fixture.WindowTest):
    @classmethod
    def setUpClass(cls):
        cls.prepare()
        cls.first, cls.second = cls.display_of(2 * TILE[0], 2 * TILE[1]), cls.display_of(*TILE)
        places = (("r1c1", cls.first, 0, 0), ("r1c2", cls.first, TILE[0], 0), ("r2c1", cls.first, 0, TILE[1]), ("r2c2", cls.second, 0, 0))
        (cls.folder / "wall.toml").write_text(WALL + "".join(PLACE.format(tile, on.display, x, y) for tile, on, x, y in places))
        (cls.folder / "scene.toml").write_text(SCENE)
        cls.begin(cls.first, "run", "--wall", cls.folder / "wall.toml", "--scene", cls.folder / "scene.toml", "--device", "pointer", "--restarts", 0,
                  "--no-pictures")

    def test_1_a_stroke_goes_from_window_to_window_and_the_journal_has_it(self):
        path = [(40, 60), (80, 60), (120, 60), (155, 60), (165, 60), (200, 60), (240, 60)]
        self.session.drag(path)
        self.first.keep("pointer_four_windows.png")
        self.assertTrue(self.session.status()["can_undo"])
        changed = self.session.heights_changed()
        for place in [*path, (159, 60)]:
            row, column = cell(*place)
            self.assertLess(changed[row][column], DUG, f"the sand under {place} is not dug")
        for place in ((40, 90), (240, 20), (40, 180), (280, 200)):
            row, column = cell(*place)
            self.assertEqual(changed[row][column], 0, f"the sand at {place} has moved")
        # The furrow continues behind the bezel, although no window shows that sand.
        row, first = cell(159, 60)
        for column in range(first, cell(161, 60)[1]):
            self.assertLess(changed[row][column], DUG, f"column {column}")

    def test_2_keys_are_commands_and_the_right_button_turns_the_view_alone(self):
        session = self.session
        self.first.do("mousemove", 100, 60, "key", "3")
        session.wait_for_status(lambda now: now["tool_shape"] == "rectangle")
        self.first.do("key", "w")
        session.wait_for_status(lambda now: now["material"]["humidity"] > 0)
        for left in (1, 0):  # the humidity and the stroke
            self.first.do("key", "u")
            session.wait_for_status(lambda now: now["undo_left"] == left)
        session.drag([(100, 60), (140, 90)], button=3)
        self.first.keep("pointer_turned.png")
        self.assertEqual(session.status()["divergences"], 0)
        self.assertTrue(all(value == 0 for row in session.heights_changed() for value in row))

    def test_3_of_two_pointers_the_first_that_touches_is_the_hand(self):
        session, first, second = self.session, self.first, self.second
        session.act("key", "Home")
        before = session.status()["step"]
        first.do("mousemove", 40, 60, "mousedown", 1)
        session.wait_for_status(lambda now: now["can_undo"])
        session.act("mousemove", 40, 60, "mousedown", 1, display=second)
        session.act("mousemove", 120, 60, display=second)
        session.act("mousemove", 60, 60)
        session.act("mouseup", 1)
        session.act("mousemove", 100, 60, display=second)
        session.act("mouseup", 1, display=second)
        # The first display shows the west of the field, the second its east; the middle is at 1.
        east = [float(point.split()[0]) > 1 for step in session.steps(before) if step["engaged"] == "1" for point in step["path"].split(";") if point]
        self.assertIn(False, east)
        self.assertIn(True, east, "the second pointer digs when the first has released")
        self.assertEqual(east, sorted(east), "the second pointer has waited for the first")

    def test_4_a_pointer_beside_the_sand_moves_nothing(self):
        # Eight notches make the sand four times as small. It then lies around the middle of the wall.
        self.session.act("mousemove", TILE[0] - 1, TILE[1] - 1, "click", "--repeat", 8, 5)
        before = self.session.heights_changed()
        self.session.drag([(20, 20), (40, 20), (60, 20)])
        self.assertEqual(self.session.heights_changed(), before)

    def test_5_escape_ends_the_session(self):
        self.session.end("key", "ctrl+q")


class WallOnADesktop(pointer_fixture.WindowTest):
    """The map of the FLEX is 2560 x 1536 pixels large, so that a desktop of 640 x 400 shows it at a quarter of its size."""

    def test_a_whole_wall_is_placed_on_the_desktop(self):
        self.prepare()
        (self.folder / "scene.toml").write_text(SCENE)
        display = self.display_of(640, 400)
        self.begin(display, "try", "--wall", "flex_cave", "--scene", self.folder / "scene.toml")
        windows = {"left": (0, 8, 192, 192), "front": (192, 8, 256, 192), "right": (448, 8, 192, 192), "floor": (192, 200, 256, 192)}
        self.session.drag([(320, 130), (320, 160), (320, 190), (320, 205), (320, 230), (320, 260)])
        self.assertEqual(self.session.status()["stereo"], "mono")
        picture = display.screen()
        display.keep("wall_on_a_desk.png")
        for name, (x, y, width, height) in windows.items():
            for place in ((x, y), (x + width - 1, y), (x, y + height - 1), (x + width - 1, y + height - 1)):
                self.assertNotEqual(picture.pixel(*place), (0, 0, 0), f"{place} of {name}")
        for place in ((0, 7), (639, 7), (320, 7), (191, 200), (448, 200), (320, 392), (0, 399)):
            self.assertEqual(picture.pixel(*place), (0, 0, 0), f"{place} is beside all windows")
        self.assertEqual(self.session.end("key", "ctrl+q")["ranks"], 4)
        # One furrow runs south, from the sand behind the front screen to that above the floor.
        dug = [any(value < DUG for value in row) for row in self.session.heights_changed()]
        first, last = dug.index(True), len(dug) - 1 - dug[::-1].index(True)
        self.assertTrue(all(dug[first:last + 1]), dug)
        self.assertGreater(last - first, 20)


class SandOfTry(pointer_fixture.WindowTest):
    def test_a_raster_is_dug_with_a_tool_of_its_size_and_the_next_try_continues_with_the_sand(self):
        self.prepare()
        (self.folder / "valley.asc").write_text("ncols 128\nnrows 96\nxllcorner 500000\nyllcorner 5000000\ncellsize 10\n" + "1200 " * (128 * 96))
        display = self.display_of(640, 480)
        self.begin(display, "try", self.folder / "valley.asc")
        self.assertAlmostEqual(self.session.status()["tool_radius"], 24, delta=0.1)  # 1/40 of 960
        display.keep("try_of_a_raster.png")
        self.session.drag([(250, 180), (300, 180)])
        first = self.session.end("key", "ctrl+q")
        self.begin(display, "try", self.folder / "valley.asc")
        self.assertGreaterEqual(self.session.status()["step"], first["steps"])
        self.session.drag([(250, 120), (300, 120)])
        self.session.end("key", "ctrl+q")
        log = self.session.log.read_text()
        self.assertIn("continues with your sand of ", log)
        self.assertIn("` continues with this sand, and another --out begins with new sand", log)
        begun = [step["path"] for step, before in zip(self.session.steps(1), self.session.steps()) if (step["engaged"], before["engaged"]) == ("1", "0")]
        self.assertEqual(len(begun), 2, "the journal has the strokes of both")


class WindowsOfAWall(unittest.TestCase):
    """A wall gets the windows for which sandwall-check has places."""

    def words(self, answers):
        with unittest.mock.patch.object(desk, "work_area", return_value="800x600+0+0"):
            return desk.words_for("WALL", "NODE", lambda wall, *question: answers[" ".join(question)])

    def test_one_output_is_one_window(self):
        self.assertEqual(self.words({"--outputs": "1 0"}), [])

    def test_windows_of_the_wall_file_stay_where_they_are(self):
        self.assertEqual(self.words({"--outputs": "24 24"}), [])

    def test_one_tile_for_both_eyes_is_one_window(self):
        self.assertEqual(self.words({"--outputs": "2 0", "--ranks": "1\n"}), ["--stereo", "mono"])

    def test_tiles_are_placed_on_the_desktop(self):
        self.assertEqual(self.words({"--outputs": "24 0", "--ranks": "12\n", "--desk 800x600+0+0 --ranks": "12\n"}),
                         ["--desk", "800x600+0+0"])


class Refused(unittest.TestCase):
    def refused(self, *words, **environment):
        """Returns the line with which a command is refused."""
        with tempfile.TemporaryDirectory() as folder:
            ran = launch([*words, "--out", folder], env=environment)
        self.assertEqual((ran.returncode, ran.stdout, ran.stderr.count("\n")), (2, "", 1), ran.stderr)
        return ran.stderr

    def test_a_hand_in_memory(self):
        self.assertIn("--gl osmesa", self.refused("run", "--wall", "desktop", "--scene", "writing", "--device", "pointer", "--gl", "osmesa"))

    def test_a_wall_with_more_tiles_than_the_desktop_has_pixels(self):
        server = pointer_fixture.Display(3, 200)
        self.addCleanup(server.end)
        self.assertIn("12 tiles do not fit on a desktop of 3x200 pixels", self.refused("try", "--wall", "tiled_3x4", DISPLAY=server.display))

    def test_a_session_without_a_display_is_not_told_to_draw_in_memory(self):
        line = self.refused("run", "--wall", "desktop", "--scene", "writing", "--device", "pointer", DISPLAY="")
        self.assertIn("no X display", line)
        self.assertIn("choose another --device", line)

    def test_try_without_a_display_names_the_alternatives(self):
        line = self.refused("try", DISPLAY="", WAYLAND_DISPLAY="")
        self.assertIn("DISPLAY", line)
        self.assertIn("--gl osmesa", line)

    def test_try_on_wayland_without_xwayland_names_what_to_install(self):
        self.assertIn("install Xwayland", self.refused("try", DISPLAY="", WAYLAND_DISPLAY="wayland-0"))

    def test_try_on_a_display_that_is_not_there_yet_names_the_alternatives(self):
        line = self.refused("try", DISPLAY=":987")
        self.assertIn("no X server accepts connections at DISPLAY=:987; ", line)
        self.assertIn("--gl osmesa", line)

    def test_a_desktop_that_shows_no_window_is_not_awaited_without_end(self):
        with tempfile.TemporaryDirectory() as folder, unittest.mock.patch.object(desk, "LONGEST_PROBE", 0.2):
            node = pathlib.Path(folder) / "node"
            node.write_text("#!/bin/sh\nexec sleep 100\n")
            node.chmod(0o755)
            with self.assertRaisesRegex(BadInput, "has shown no window for 0.2 s; look whether its window manager runs"):
                desk.probe(node, "1")

    def test_unknown_names_list_the_known_ones(self):
        self.assertIn("dunes, ellipses", self.refused("try", "--scene", "nowhere"))
        self.assertIn("desktop, fish_tank", self.refused("try", "--wall", "nowhere"))


if __name__ == "__main__":
    unittest.main()
