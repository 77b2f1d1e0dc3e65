#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests whole sessions whose hand is the pointer, on an X server in memory. xdotool moves the pointer.

usage: pointer_test.py   (SANDWALL_BIN: folder of the programs; SANDWALL_KEEP_PICTURES: folder for screenshots)
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
import unittest.mock

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "scripts" / room) for room in ("figures", "launcher")]
import desk  # noqa: E402
import events  # noqa: E402
import picture_files  # noqa: E402
import session_control  # noqa: E402
import x_server  # noqa: E402

BIN = pathlib.Path(os.environ.get("SANDWALL_BIN", ROOT / "build" / "release" / "bin"))
PATIENCE = 120  # seconds for work that takes a few seconds on an idle machine
PROBE_PER_CELL = 256

# Four windows without gaps on one display, of 160 x 120 pixels each. The bezels between the screens are wider than the
# gaps of the windows, which are 0. The wall is seen from far away, straight from the front. It shows the whole field, so
# that the first view is that of the wall file.
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
""" + "".join(f"[[place]]\ntiles = [\"{tile}\"]\nwindows = [[{x}, {y}]]\n"
              for tile, x, y in (("r1c1", 0, 0), ("r1c2", 160, 0), ("r2c1", 0, 120), ("r2c2", 160, 120)))
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


class Display(x_server.XServer):
    """A display with a pointer and keys."""

    def pointer(self, *words):
        """Moves the pointer, presses buttons or types keys, as xdotool's command line says it."""
        subprocess.run(["xdotool", *map(str, words)], env=self.environment, check=True, timeout=PATIENCE)

    def picture(self, file):
        subprocess.run(["import", "-window", "root", str(file)], env=self.environment, check=True, timeout=PATIENCE)


class PointerSession(unittest.TestCase):
    def setUp(self):
        for tool in ("Xvfb", "xdotool"):
            self.assertIsNotNone(shutil.which(tool), f"{tool} is missing; run scripts/install_dependencies.sh --with-tests")
        temporary = tempfile.TemporaryDirectory(prefix="sandwall-pointer-")
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name)
        self.wall, self.scene, self.out = self.folder / "wall.toml", self.folder / "scene.toml", self.folder / "out"
        self.wall.write_text(WALL)
        self.scene.write_text(SCENE)
        self.server = Display("320x240")
        self.addCleanup(self.server.end)

    def start(self, *words):
        """Starts a session, and returns it when it shows frames."""
        self.log = self.folder / "log.txt"
        environment = {**os.environ, "DISPLAY": self.server.display, "SANDWALL_BIN": str(BIN), events.VARIABLE: "1"}
        with self.log.open("w") as log:
            session = subprocess.Popen([str(ROOT / "scripts" / "sandwall"), *map(str, words)], env=environment, stdin=subprocess.DEVNULL,
                                       stdout=log, stderr=subprocess.STDOUT, start_new_session=True)
        self.addCleanup(self.stop, session)
        self.assertIsNotNone(events.wait_for(self.log, "progress", PATIENCE, lambda: session.poll() is None), self.log.read_text())
        return session

    def run_session(self, *words):
        return self.start("run", "--wall", self.wall, "--scene", self.scene, "--device", "pointer", "--out", self.out,
                          "--restarts", 0, "--no-pictures", *words)

    def stop(self, session):
        if session.poll() is None:
            session.terminate()
            session.wait(PATIENCE)

    def status(self):
        return json.loads(session_control.ask(self.out, "status"))

    def wait_for_status(self, wanted):
        """Waits until the session's status fulfils `wanted`."""
        deadline = time.monotonic() + PATIENCE
        while not wanted(now := self.status()):
            self.assertLess(time.monotonic(), deadline, now)
            time.sleep(0.05)

    def frames_pass(self, count=3):
        """Waits until so many more frames are shown, so that the windows have read the pointer."""
        frame = self.status()["frame"]
        self.wait_for_status(lambda now: now["frame"] >= frame + count)

    def drag(self, places, button=1):
        """Drags the pointer through places [pixel of the screen]. Waits for frames, because a slow wall must not skip one."""
        self.server.pointer("mousemove", *places[0])
        self.frames_pass()
        self.server.pointer("mousedown", button)
        self.frames_pass()
        for place in places[1:]:
            self.server.pointer("mousemove", *place)
            self.frames_pass()
        self.server.pointer("mouseup", button)
        self.frames_pass()

    def quit(self, session):
        self.server.pointer("key", "Escape")
        self.assertEqual(session.wait(PATIENCE), 0, self.log.read_text())

    def replay(self, *words):
        ran = subprocess.run([str(BIN / "sandwall-replay"), str(self.out / "session.journal"), *map(str, words)],
                             capture_output=True, text=True, timeout=PATIENCE)
        self.assertEqual(ran.returncode, 0, ran.stderr)
        return ran.stdout.strip()

    def steps(self):
        self.replay("--export", self.folder / "steps.csv")
        with open(self.folder / "steps.csv", newline="") as file:
            return list(csv.DictReader(line for line in file if not line.startswith("#")))

    def heights_changed(self):
        """Returns how much higher the sand is than at the start, by row from the north [scene unit]."""
        self.replay("--difference", self.folder / "difference.asc")
        rows = [line.split() for line in (self.folder / "difference.asc").read_text().splitlines()]
        return [[float(word) for word in row] for row in rows if len(row) == 128]

    def keep_picture(self, name):
        folder = os.environ.get("SANDWALL_KEEP_PICTURES")
        if folder and shutil.which("import"):
            self.server.picture(pathlib.Path(folder) / name)

    def cell(self, x, y):
        """Returns row and column of the cell under a pixel of the screen. The wall is 3.3 m wide, as the field is."""
        def metres(pixel, tile_pixels, tile_metres, bezel):
            return pixel * tile_metres / tile_pixels + (bezel if pixel >= tile_pixels else 0)
        east = metres(x, 160, 1.6, 0.1)
        south = metres(y, 120, 1.2, 0.1) - 0.0125  # the wall is 2.5 m high, and the field 2.475 m
        return int(south / 3.3 * 128), int(east / 3.3 * 128)

    def test_a_stroke_goes_from_window_to_window_and_the_journal_has_it(self):
        session = self.run_session()
        path = [(40, 60), (80, 60), (120, 60), (155, 60), (165, 60), (200, 60), (240, 60)]
        self.drag(path)
        self.keep_picture("pointer_four_windows.png")
        self.quit(session)
        summary = json.loads((self.out / "summary.json").read_text())
        self.assertEqual(self.replay("--hash"), summary["state_hash"])
        self.assertEqual(summary["divergences"], 0)
        changed = self.heights_changed()
        for place in [*path, (159, 60)]:
            row, column = self.cell(*place)
            self.assertLess(changed[row][column], -0.005, f"the sand under {place} is not dug")
        for place in ((40, 90), (240, 20), (40, 180), (280, 200)):
            row, column = self.cell(*place)
            self.assertEqual(changed[row][column], 0, f"the sand at {place} has moved")
        # The furrow continues behind the bezel, although no window shows that sand.
        row, first = self.cell(159, 60)
        for column in range(first, self.cell(161, 60)[1]):
            self.assertLess(changed[row][column], -0.005, f"column {column}")

    def test_of_two_pointers_the_first_that_touches_is_the_hand(self):
        other = Display("320x240")
        self.addCleanup(other.end)
        # Two tiles side by side, each on a display of its own.
        head = WALL.split("[[place]]")[0].replace("rows = 2", "rows = 1").replace("-1.25, 0.0]", "-0.6, 0.0]")
        self.scene.write_text(SCENE.replace("rows = 96", "rows = 40"))
        self.wall.write_text(head + "".join(f"[[place]]\ntiles = [\"{tile}\"]\ndisplay = \"{server.display}\"\nwindows = [[0, 0]]\n"
                                            for tile, server in (("r1c1", self.server), ("r1c2", other))))
        session = self.run_session()
        self.server.pointer("mousemove", 40, 60, "mousedown", 1)
        self.wait_for_status(lambda now: now["can_undo"])
        other.pointer("mousemove", 40, 60, "mousedown", 1)
        self.frames_pass()
        other.pointer("mousemove", 120, 60)
        self.frames_pass()
        self.server.pointer("mousemove", 60, 60)
        self.frames_pass()
        self.server.pointer("mouseup", 1)
        self.frames_pass()
        other.pointer("mousemove", 100, 60)
        self.frames_pass()
        other.pointer("mouseup", 1)
        self.frames_pass()
        self.server.pointer("key", "Escape")
        self.assertEqual(session.wait(PATIENCE), 0, self.log.read_text())
        self.assertEqual(self.replay("--hash"), json.loads((self.out / "summary.json").read_text())["state_hash"])
        # The first display shows the west of the field, the second its east; the middle is at 1.
        east = [float(point.split()[0]) > 1 for step in self.steps() if step["engaged"] == "1" for point in step["path"].split(";") if point]
        self.assertIn(False, east)
        self.assertIn(True, east, "the second pointer digs when the first has released")
        self.assertEqual(east, sorted(east), "the second pointer has waited for the first")

    def test_a_pointer_beside_the_sand_moves_nothing(self):
        text = WALL.replace("width = 3.3", "width = 1.0")  # the outer part of every window shows no sand
        self.wall.write_text(text)
        session = self.run_session()
        self.drag([(20, 20), (40, 20), (60, 20)])
        self.quit(session)
        self.assertTrue(all(value == 0 for row in self.heights_changed() for value in row))

    def test_keys_are_commands_and_the_right_button_turns_the_view_alone(self):
        session = self.run_session()
        self.drag([(40, 60), (80, 60)])
        self.wait_for_status(lambda now: now["can_undo"])
        self.server.pointer("mousemove", 100, 60, "key", "3")
        self.wait_for_status(lambda now: now["tool_shape"] == "rectangle")
        self.server.pointer("key", "w")
        self.wait_for_status(lambda now: now["material"]["humidity"] > 0)
        self.server.pointer("key", "u")
        self.wait_for_status(lambda now: not now["can_undo"])
        undone = self.status()["state_hash"]
        self.drag([(100, 60), (140, 90)], button=3)
        self.keep_picture("pointer_turned.png")
        self.wait_for_status(lambda now: now["divergences"] == 0)
        self.quit(session)
        self.assertNotEqual(undone, "")
        self.assertTrue(all(value == 0 for row in self.heights_changed() for value in row))

    def test_a_hand_in_memory_is_refused_in_one_line(self):
        ran = subprocess.run([str(ROOT / "scripts" / "sandwall"), "run", "--wall", str(self.wall), "--scene", str(self.scene), "--device", "pointer",
                              "--gl", "osmesa", "--out", str(self.out)], capture_output=True, text=True, timeout=PATIENCE,
                             env={**os.environ, "SANDWALL_BIN": str(BIN)})
        self.assertEqual((ran.returncode, ran.stderr.count("\n")), (2, 1), ran.stderr)
        self.assertIn("--gl osmesa", ran.stderr)

    def test_try_shows_sand_and_names_its_journal(self):
        self.server.end()
        self.server = Display("1280x720")
        self.addCleanup(self.server.end)
        session = self.start("try", "--out", self.out)
        self.drag([(400, 400), (500, 410), (600, 400)])
        self.keep_picture("try.png")
        self.quit(session)
        said = self.log.read_text()
        self.assertIn(str(self.out / "session.journal"), said)
        self.assertIn("dig with the left mouse button", said)
        self.assertNotIn("hashes agree", said, "a line for an operator")
        self.assertEqual(self.replay("--hash"), json.loads((self.out / "summary.json").read_text())["state_hash"])
        self.assertTrue(any(step["engaged"] == "1" for step in self.steps()))

    def test_a_whole_wall_is_placed_on_the_desktop(self):
        """The map of the FLEX is 2560 x 1536 pixels large, so that a desktop of 640 x 400 shows it at a quarter of its size."""
        self.server.end()
        frames = self.folder / "frames"
        frames.mkdir()
        self.server = Display("640x400", "-fbdir", frames)
        self.addCleanup(self.server.end)
        session = self.start("try", "--wall", "flex_cave", "--scene", self.scene, "--out", self.out)
        windows = {"left": (0, 8, 192, 192), "front": (192, 8, 256, 192), "right": (448, 8, 192, 192), "floor": (192, 200, 256, 192)}
        self.drag([(320, 130), (320, 160), (320, 190), (320, 205), (320, 230), (320, 260)])
        self.assertEqual(self.status()["stereo"], "mono")
        picture = picture_files.read_screen(frames / "Xvfb_screen0")
        self.keep_picture("wall_on_a_desk.png")
        for name, (x, y, width, height) in windows.items():
            for place in ((x, y), (x + width - 1, y), (x, y + height - 1), (x + width - 1, y + height - 1)):
                self.assertNotEqual(picture.pixel(*place), (0, 0, 0), f"{place} of {name}")
        for place in ((0, 7), (639, 7), (320, 7), (191, 200), (448, 200), (320, 392), (0, 399)):
            self.assertEqual(picture.pixel(*place), (0, 0, 0), f"{place} is beside all windows")
        self.quit(session)
        summary = json.loads((self.out / "summary.json").read_text())
        self.assertEqual(summary["ranks"], 4)
        self.assertEqual(self.replay("--hash"), summary["state_hash"])
        # One furrow runs south, from the sand behind the front screen to that above the floor.
        dug = [any(value < -0.005 for value in row) for row in self.heights_changed()]
        first, last = dug.index(True), len(dug) - 1 - dug[::-1].index(True)
        self.assertTrue(all(dug[first:last + 1]), dug)
        self.assertGreater(last - first, 20)


class WallOnADesk(unittest.TestCase):
    """Which windows a wall gets."""

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
    def test_a_wall_with_more_tiles_than_the_desktop_has_pixels_is_refused_in_one_line(self):
        server = Display("3x200")
        self.addCleanup(server.end)
        self.assertIn("12 tiles do not fit on a desktop of 3x200 pixels", self.tried("--wall", "tiled_3x4", DISPLAY=server.display))

    def test_a_session_without_a_display_is_not_told_to_draw_in_memory(self):
        with tempfile.TemporaryDirectory() as folder:
            ran = subprocess.run([str(ROOT / "scripts" / "sandwall"), "run", "--wall", "desktop", "--scene", "writing", "--device", "pointer",
                                  "--out", folder], capture_output=True, text=True, timeout=PATIENCE,
                                 env={**os.environ, "SANDWALL_BIN": str(BIN), "DISPLAY": ""})
        self.assertEqual((ran.returncode, ran.stderr.count("\n")), (2, 1), ran.stderr)
        self.assertIn("no X display", ran.stderr)
        self.assertIn("choose another --device", ran.stderr)

    def tried(self, *words, **environment):
        ran = subprocess.run([str(ROOT / "scripts" / "sandwall"), "try", *words], capture_output=True, text=True, timeout=PATIENCE,
                             env={**os.environ, "SANDWALL_BIN": str(BIN), **environment})
        self.assertEqual((ran.returncode, ran.stdout, ran.stderr.count("\n")), (2, "", 1), ran.stderr)
        return ran.stderr

    def test_try_without_a_display_names_the_alternatives(self):
        line = self.tried(DISPLAY="", WAYLAND_DISPLAY="")
        self.assertIn("DISPLAY", line)
        self.assertIn("--gl osmesa", line)

    def test_try_on_wayland_without_xwayland_names_what_to_install(self):
        self.assertIn("install Xwayland", self.tried(DISPLAY="", WAYLAND_DISPLAY="wayland-0"))

    def test_try_on_a_display_that_is_gone_names_the_alternatives(self):
        line = self.tried(DISPLAY=":987")
        self.assertIn("no X server accepts connections at DISPLAY=:987; ", line)
        self.assertIn("--gl osmesa", line)

    def test_unknown_names_list_the_known_ones(self):
        self.assertIn("dunes, ellipses", self.tried("--scene", "nowhere"))
        self.assertIn("desktop, fish_tank", self.tried("--wall", "nowhere"))


if __name__ == "__main__":
    unittest.main()
