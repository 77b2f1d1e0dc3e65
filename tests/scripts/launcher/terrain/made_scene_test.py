#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests the scenes that `try FILE` and `run --scene FILE` make of rasters, pictures and points, and which files they refuse."""

import contextlib
import os
import pathlib
import re
import shlex
import subprocess
import sys
import tempfile
import tomllib
import unittest
from unittest import mock

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "support"))
import picture_files
from launcher_fixture import BIN, ROOT, LauncherTest
from base.bad_input import BadInput
from terrain import kinds, made_scene

GRID = "ncols {columns}\nnrows {rows}\nxllcorner {west}\nyllcorner 5000000\ncellsize {cell}\n{heights}\n"
POINTS = "x,y,z\n" + "".join(f"{x},{y},{x * y % 7 / 10}\n" for x in range(0, 41, 4) for y in range(0, 81, 4))


def grid(columns=120, rows=80, cell=10, west=500000, height=1200, relief=0.1):
    """Returns an ESRI ASCII grid of ripples, `relief` times seven cells high."""
    heights = "\n".join(" ".join(str(height + (x * y) % 7 * cell * relief) for x in range(columns)) for y in range(rows))
    return GRID.format(columns=columns, rows=rows, cell=cell, west=west, heights=heights)


def picture(width=200, height=100):
    return picture_files.Picture(width, height, [bytes(value % 256 for x in range(width) for value in (x, y, 0)) for y in range(height)])


class MadeTest(unittest.TestCase):
    """Makes scenes with the sandwall-check of this build, in a folder of its own."""

    def setUp(self):
        folder = self.enterContext(tempfile.TemporaryDirectory(prefix="sandwall-terrain-"))
        self.enterContext(contextlib.chdir(folder))
        self.enterContext(mock.patch.dict(os.environ, {"SANDWALL_BIN": str(BIN)}))

    def write(self, name, content):
        pathlib.Path(name).write_bytes(content if isinstance(content, bytes) else content.encode())
        return name

    def made(self, name):
        """Returns (the MadeScene of a file, its tables), after the check of this build has read the scene."""
        made = made_scene.of(name, kinds.kind_of(name))
        self.assertEqual(made_scene.asked(name, made.text), (made.columns, made.rows, made.cell))
        return made, tomllib.loads(made.text)

    def refusal(self, name, as_heights=False):
        with self.assertRaises(BadInput) as refused:
            kinds.require_photo(name, kinds.kind_of(name), as_heights)
            made_scene.of(name, kinds.kind_of(name))
        self.assertNotIn("made_scene.toml", str(refused.exception), "a file that the user does not know")
        return str(refused.exception)


class Made(MadeTest):
    def test_a_raster_keeps_its_units_and_gets_the_usual_tool(self):
        made, scene = self.made(self.write("my valley.asc", grid()))
        self.assertEqual(scene, {"name": "my valley", "terrain": {"kind": "dem", "file": os.path.abspath("my valley.asc")}})
        self.assertEqual(made[2:], (120, 80, 10))

    def test_a_geotiff_is_not_taken_for_a_text(self):
        self.write("valley.asc", grid())
        subprocess.run([BIN / "sandwall-relax", "valley.asc", "valley.tif", "--talus", "80"], check=True, capture_output=True, timeout=60)
        made, scene = self.made("valley.tif")
        self.assertEqual((made[2:], scene["terrain"]["kind"]), ((120, 80, 10), "dem"))

    def test_heights_beyond_the_range_of_cells_are_counted_from_a_height_of_the_raster(self):
        for height in (5000, -5000):
            _, scene = self.made(self.write("peak.asc", grid(12, 8, 1, height=height)))
            self.assertLess(abs(scene["terrain"]["datum"] - height), 4096)

    def test_a_grey_picture_becomes_heights(self):
        picture_files.write_png(picture_files.Picture(200, 100, [bytes((x + y) % 256 for x in range(200)) for y in range(100)]), "grey.png")
        made, scene = self.made("grey.png")
        self.assertEqual(scene["terrain"], {"kind": "image", "file": os.path.abspath("grey.png"), "width": 2.0, "low": 0, "high": 0.3})
        self.assertEqual(made[2:], (200, 100, 0.01))

    def test_points_become_a_tin(self):
        _, scene = self.made(self.write("survey.csv", POINTS))
        self.assertEqual((scene["terrain"]["kind"], scene["tin"]), ("points", {}))

    def test_a_photo_is_taken_only_if_asked_for(self):
        picture_files.write_png(picture(), "photo.png")
        self.assertEqual(self.refusal("photo.png"), "photo.png: is a photo, whose colours are not heights; --as-heights takes bright for high "
                                                    "and dark for low")
        self.assertIs(self.made("photo.png")[1]["terrain"]["brightness"], True)
        kinds.require_photo("photo.png", kinds.kind_of("photo.png"), True)
        self.assertEqual(kinds.kind_of(self.write("p.jpg", b"\xff\xd8\xff\xe0" + bytes(9))), kinds.PHOTO)

    def test_a_scene_stays_a_scene(self):
        for name, text in (("a.toml", "no scene at all"), ("a.txt", "# of sand\n\n[terrain]\nheight = 1\n"), ("b.txt", 'name = "x"\n'), ("c", ""),
                           ("d", "name = 'utf-16'\n".encode("utf-16"))):
            self.assertEqual(kinds.kind_of(self.write(name, text)), kinds.SCENE, name)
        for missing in ("none.tif", ".", "/dev/zero"):
            self.assertEqual(kinds.kind_of(missing), kinds.SCENE, missing)

    def test_points_and_grids_are_known_in_the_forms_that_people_have(self):
        for text in ("1 2 3\n4 5 6\n", "# survey\n1;2,5;3\n", "\ufeffEasting,Northing,Height\n1,2,3\n", "1\t2\t3\r\n", "1e3, -2, +.5\n"):
            self.assertEqual(kinds.kind_of(self.write("p", text)), kinds.POINTS, text)
        for text in ("NCOLS 3\n", "dx 1\n", grid().encode("utf-16")):
            self.assertEqual(kinds.kind_of(self.write("g", text)), kinds.DEM, text)


class Refused(MadeTest):
    def test_a_raster_in_degrees_is_refused_with_its_own_line(self):
        line = self.refusal(self.write("degrees.asc", grid(cell=0.0002777, west=10, relief=1e4).replace("5000000", "47")))
        self.assertRegex(line, "^/.*/degrees.asc: its lengths seem to be degrees: .* gdalwarp -s_srs EPSG:4326 -t_srs EPSG:32632")

    def test_a_file_of_another_kind_is_one_line_with_what_can_be_used(self):
        for name, content in (("x.zip", b"PK\3\4" + bytes(300)), ("notes.md", "# Notes\n\nwords\n"), ("song", bytes(range(256)) * 9),
                              ("table.csv", "name,age\nann,7\n")):
            self.assertEqual(self.refusal(self.write(name, content)), f"{name}: is neither a scene nor a terrain; {kinds.USABLE}")

    def test_a_damaged_raster_is_refused_in_the_words_of_its_reader(self):
        line = self.refusal(self.write("cut.asc", grid()[:4000]))
        self.assertIn("cut.asc", line)
        self.assertNotIn("save it as UTF-8", line)

    def test_an_option_for_photos_needs_one(self):
        self.assertEqual(self.refusal(self.write("valley.asc", grid()), as_heights=True), "--as-heights: valley.asc is not a photo; leave it out")

    def test_a_name_that_a_scene_cannot_hold_is_one_line(self):
        for name, why in (("a\nb.asc", "has a control character in its name; rename it"), ("a\udcff.asc", "a scene names files in UTF-8; rename this one")):
            pathlib.Path(name).write_text(grid())
            self.assertTrue(self.refusal(name).endswith(why))
        _, scene = self.made(self.write('a"b\\c #1.asc', grid()))
        self.assertEqual(scene["name"], 'a"b\\c #1')


class Written(MadeTest):
    def test_it_is_written_beside_the_session_and_replaces_no_file_of_a_person(self):
        made, _ = self.made(self.write("valley.asc", grid()))
        for _ in range(2):
            made.write(".")
            self.assertEqual(pathlib.Path("made_scene.toml").read_text(), made.text)
        self.write("made_scene.toml", "[terrain]\n")
        with self.assertRaisesRegex(BadInput, "^made_scene.toml: is not a scene that sandwall made; move it, or choose another --out$"):
            made.write(".")
        self.assertEqual(pathlib.Path("made_scene.toml").read_text(), "[terrain]\n")
        with self.assertRaisesRegex(BadInput, r"^none/made_scene.toml: cannot be written \(No such file or directory\); choose another --out$"):
            made.write("none")

    def test_its_lines_are_printed(self):
        made, _ = self.made(self.write("valley.asc", grid()))
        with mock.patch.object(made_scene, "print_line") as said:
            made.print("out/made_scene.toml")
        lines = [call.args[0] for call in said.call_args_list]
        self.assertEqual(lines[0], "valley.asc: 120 x 80 cells of 10; the scene made of it is out/made_scene.toml:")
        self.assertEqual(tomllib.loads("\n".join(lines[1:])), tomllib.loads(made.text))


class Run(LauncherTest):
    """`run` with made-up programs."""

    def setUp(self):
        super().setUp()
        self.script("mpirun", '#!/bin/sh\necho "mpirun $*"\n')
        self.script("sandwall-check", (self.folder / "bin" / "sandwall-check").read_text().replace(
            "#!/bin/sh\n", '#!/bin/sh\n[ "$1 $3" = "--scene --cells" ] && { cat "$2" >&2; echo 120 80 10; exit; }\n'))
        self.write("scene.toml", grid())  # the terrain: its ending says scene
        (self.folder / "scene.toml").rename(self.folder / "valley.asc")

    def command(self, hosts, *options):
        return [word.replace("scene.toml", "valley.asc") for word in super().command(hosts, *options)]

    def test_server_and_master_get_the_scene_that_is_written_beside_the_session(self):
        for options in ((), ("--resume",)):
            ended = self.start(["-"], *options)
            self.assertEqual(ended.returncode, 0, ended.stderr)
            self.assertIn(f"--scene {self.folder}/out/made_scene.toml", ended.stdout)
            self.assertEqual(tomllib.loads((self.folder / "out" / "made_scene.toml").read_text())["terrain"]["kind"], "dem")
            self.assertIn('sandwall:     kind = "dem"', ended.stderr)

    def test_printed_commands_make_the_scene(self):
        lines = self.printed(["-"], "--device", "script:gis").splitlines()
        self.assertEqual(len(lines), 3)
        self.assertRegex(lines[0], "^mkdir -p out && printf '%s.n' .* > out/made_scene.toml$")
        self.assertIn("--scene out/made_scene.toml", lines[1])
        self.assertIn("--scene out/made_scene.toml", lines[2])
        self.assertFalse((self.folder / "out").exists())

    def test_check_names_the_command_for_terrain(self):
        ended = subprocess.run([str(ROOT / "scripts" / "sandwall"), "check", "--scene", "valley.asc"], cwd=self.folder, env=self.environment,
                               capture_output=True, text=True, timeout=60)
        self.assertEqual(ended.returncode, 2)
        found = re.fullmatch("sandwall: check: valley.asc is terrain, and check reads scenes; `(.*)` prints the scene made of it\n", ended.stderr)
        self.assertIsNotNone(found, ended.stderr)
        named = subprocess.run(shlex.split(found[1]), cwd=self.folder, env=self.environment, capture_output=True, text=True, timeout=60)
        self.assertEqual((named.returncode, named.stderr), (0, ""))
        self.assertIn("made_scene.toml", named.stdout)

    def test_a_photo_is_one_line(self):
        picture_files.write_png(picture(), self.folder / "valley.asc")
        self.assertEqual(self.refused(["-"]), "sandwall: valley.asc: is a photo, whose colours are not heights; --as-heights takes bright "
                         "for high and dark for low\n")


if __name__ == "__main__":
    unittest.main()
