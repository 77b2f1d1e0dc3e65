# SPDX-License-Identifier: Apache-2.0
"""Makes a scene of a raster, a picture or points, so that `try FILE` and `run --scene FILE` take them (docs/terrain.md)."""

import contextlib
import os
import pathlib
import re
import subprocess
from typing import NamedTuple

from base import checked_json, layout, session_folder
from base.bad_input import BadInput
from base.console import print_line
from base.temporary_folder import TemporaryFolder
from terrain import kinds

NAME = "made_scene.toml"  # in the session's folder
FIRST_LINE = "# Made by sandwall"  # another file of this name is never replaced
IMAGE_WIDTH, IMAGE_HEIGHT = 2.0, 0.3  # of a picture, from west to east and from black to white [scene unit]
RANGE = re.compile(r"a height of (-?[0-9.e+-]+) is beyond the range")
NO_PLACE = "has no position and no pixel size"
NO_RASTER = ": cannot be read as a raster: "


class MadeScene(NamedTuple):
    """The text of a scene, and the size of its terrain."""

    source: str
    text: str
    columns: int
    rows: int
    cell: float  # [scene unit]

    def print(self, path):
        """Prints the size of the terrain, the path of the scene, and the scene's lines."""
        print_line(f"{self.source}: {self.columns} x {self.rows} cells of {self.cell:g}; the scene made of it is {path}:")
        for line in self.text.splitlines()[1:]:
            if line:
                print_line(f"    {line}")

    def draft(self):
        """Returns a scope with the path of a temporary copy of the scene."""
        return draft(self.text)

    def write(self, out):
        """Writes the scene into the session's folder. Throws BadInput if it cannot be written, or if another file has its name."""
        path = pathlib.Path(out) / NAME
        try:
            if os.path.lexists(path) and not session_folder.read_text(path).startswith(FIRST_LINE):
                raise BadInput(f"{path}: is not a scene that sandwall made; move it, or choose another --out")
            session_folder.write_text(path, self.text)
        except (OSError, ValueError) as error:
            raise BadInput(f"{path}: cannot be written ({getattr(error, 'strerror', None) or error}); choose another --out") from None


def quoted(text):
    """Returns a text of TOML in quotes."""
    return '"' + text.replace("\\", "\\\\").replace('"', '\\"') + '"'


def line(key, value, comment):
    return f"{key} = {value}".ljust(24) + f"# {comment}"


def terrain_keys(kind, path, datum):
    """Returns the lines of [terrain], and of [tin] for points."""
    picture = kind in (kinds.IMAGE, kinds.PHOTO)
    lines = ["[terrain]", f'kind = "{kinds.IMAGE if picture else kind}"', f"file = {quoted(path)}"]
    if picture:
        lines += [line("width", IMAGE_WIDTH, "[scene unit]"), line("low", 0, "height of black [scene unit]"),
                  line("high", IMAGE_HEIGHT, "height of white [scene unit]")]
    if kind == kinds.PHOTO:
        lines.append(line("brightness", "true", "a photo's colours are not heights"))
    if kind == kinds.GSF:
        lines.append(line("width", IMAGE_WIDTH, "[scene unit]"))
    if datum:
        lines.append(line("datum", datum, "the height that becomes 0"))
    return lines + (["", "[tin]"] if kind == kinds.POINTS else [])


def text_of(kind, path, datum):
    """Returns a scene in TOML."""
    lines = [f"{FIRST_LINE} from {checked_json.one_line(os.path.basename(path))}. A copy can be changed and given to --scene.",
             f"name = {quoted(pathlib.Path(path).stem)}", "", *terrain_keys(kind, path, datum)]
    return "\n".join(lines) + "\n"


@contextlib.contextmanager
def draft(text):
    """Scope with the path of a temporary file that has the text of a scene."""
    with TemporaryFolder() as folder:
        path = pathlib.Path(folder) / NAME
        path.write_text(text, encoding="utf-8")
        yield path


def asked(path, text):
    """Returns (columns, rows, cell) of a scene, as sandwall-check prints them. Throws BadInput with its line, about `path`."""
    with draft(text) as file:
        checked = subprocess.run([layout.program("sandwall-check"), "--scene", str(file), "--cells"], stdin=subprocess.DEVNULL,
                                 capture_output=True, text=True, errors="replace")
    if checked.returncode != 0:
        why = checked.stderr.strip().removeprefix("sandwall-check: ") or f"{path}: sandwall-check failed"
        raise BadInput(re.sub(re.escape(str(file)) + "(:[0-9]+)?", lambda _: path, why).replace(f"{path}: {path}", path))
    columns, rows, cell = checked.stdout.split()
    return int(columns), int(rows), float(cell)


def of(named, kind):
    """Returns the MadeScene of a file of this kind of kinds.py. Throws BadInput if no sand can be made of it."""
    path = os.path.abspath(named)
    try:
        path.encode("utf-8")
    except UnicodeEncodeError:
        raise BadInput(f"{checked_json.one_line(named)}: a scene names files in UTF-8; rename this one") from None
    if re.search("[\0-\x1f\x7f]", path):
        raise BadInput(f"{checked_json.one_line(named)}: has a control character in its name; rename it")
    datum = 0
    while True:
        try:
            text = text_of(kind, path, datum)
            return MadeScene(named, text, *asked(path, text))
        except BadInput as complaint:
            why = str(complaint)
            if kind == kinds.DEM and NO_RASTER in why:
                raise kinds.unusable(named) from None
            if kind == kinds.DEM and NO_PLACE in why:
                kind = kinds.IMAGE
            elif (found := RANGE.search(why)) and not datum and kind not in (kinds.IMAGE, kinds.PHOTO):
                datum = round(float(found[1]))  # heights are counted from one that the raster has
            else:
                raise
