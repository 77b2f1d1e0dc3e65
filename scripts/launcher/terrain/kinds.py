# SPDX-License-Identifier: Apache-2.0
"""Finds out from the first bytes of a file whether it is a scene, or terrain that can become one."""

import os
import re

from base import session_folder, text_file
from base.bad_input import BadInput

SCENE, DEM, IMAGE, PHOTO, GSF, POINTS = "scene", "dem", "image", "photo", "gsf", "points"
BEGIN = 1 << 16  # [byte]
PNG, JPEG, GWYDDION = b"\x89PNG\r\n\x1a\n", b"\xff\xd8\xff", b"Gwyddion Simple Field"
PNG_COLOUR = 25  # place of the type of colours in a PNG [byte]
PNG_GREYS = (0, 4)  # types of colours without colour
# Words with which the header of an ESRI ASCII grid or of a Surfer text begins.
GRID_WORDS = {"ncols", "nrows", "cellsize", "dx", "dy", "xllcorner", "xllcenter", "yllcorner", "yllcenter", "nodata_value", "dsaa"}
GRID_ENDINGS = {".asc", ".grd", ".dem", ".ers", ".bt", ".tif", ".tiff", ".img", ".hgt", ".flt", ".bil", ".nc", ".dt0", ".dt1", ".dt2"}
NUMBERS = re.compile(r"[-+0-9.,;eE\s]+")
TOML = re.compile(r"\s*(\[\[?[\w. -]+\]\]?|[\w.\"-]+\s*=)")
USABLE = ("give a scene, a GeoTIFF or another raster of heights, a grey PNG, an ESRI ASCII grid, a Gwyddion field (.gsf), or points "
          "x, y, z; docs/terrain.md")


def unusable(path):
    """Returns the error of a file that is neither a scene nor a terrain."""
    return BadInput(f"{path}: is neither a scene nor a terrain; {USABLE}")


def require_photo(named, kind, as_heights):
    """Throws BadInput unless --as-heights is given for a photo, and only for a picture."""
    if kind == PHOTO and not as_heights:
        raise BadInput(f"{named}: is a photo, whose colours are not heights; --as-heights takes bright for high and dark for low")
    if as_heights and kind not in (PHOTO, IMAGE):
        raise BadInput(f"--as-heights: {named} is not a photo; leave it out")


def kind_of(path):
    """Returns the kind of a file by its first bytes. A file that cannot be read counts as a scene, so that the programs report it.

    Throws BadInput for a text that is neither a scene nor a terrain. Only GDAL can tell whether it reads a binary file of the
    kind DEM.
    """
    try:
        file = session_folder.open_regular(path, os.O_RDONLY, links=True)
    except OSError:
        return SCENE
    try:
        begin = os.pread(file, BEGIN, 0)
    except OSError:
        return SCENE
    finally:
        os.close(file)
    ending = os.path.splitext(path)[1].lower()
    if ending == ".toml":
        return SCENE
    if begin.startswith(PNG):
        return IMAGE if begin[PNG_COLOUR:PNG_COLOUR + 1] in map(lambda colour: bytes([colour]), PNG_GREYS) else PHOTO
    if begin.startswith(JPEG):
        return PHOTO
    if begin.startswith(GWYDDION):
        return GSF
    text = text_of(begin)
    if text is None or ending in GRID_ENDINGS:
        return DEM
    return kind_of_text(path, text)


def text_of(begin):
    """Returns the text of the first bytes of a file, or None for a binary file."""
    try:
        text = text_file.characters_of(begin[:len(begin) // 4 * 4] if len(begin) == BEGIN else begin)
    except text_file.NotText:
        return None
    text = text.removeprefix("\ufeff").rstrip("\0\x1a")
    return None if re.search("[\0-\x08\x0e-\x1a\x1c-\x1f]", text) else text


def kind_of_text(path, text):
    if not text.strip():
        return SCENE  # of an empty file the programs report that it lacks a terrain
    if text.split()[0].lower() in GRID_WORDS:
        return DEM
    lines = [line for line in re.split("[\r\n]+", text) if line.strip() and not line.lstrip().startswith("#")]
    # The first line of points may be a title.
    if any(NUMBERS.fullmatch(line) and len(re.findall("[0-9][0-9.]*", line)) >= 3 for line in lines[:2]):
        return POINTS
    if not lines or TOML.match(lines[0]):
        return SCENE
    raise unusable(path)
