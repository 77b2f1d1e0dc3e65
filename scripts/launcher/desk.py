# SPDX-License-Identifier: Apache-2.0
"""Shows a whole wall on one desktop: one window for each tile, side by side (docs/pointer.md)."""

import subprocess

import checked_json
import layout
from rank_hosts import BadInput


def complaint_of(ended):
    lines = ended.stderr.strip().splitlines() or [f"the check of the display ended with status {ended.returncode}"]
    return lines[-1].removeprefix("sandwall-render-node: ")


def work_area(render_node):
    """Returns the desktop's area for windows as WIDTHxHEIGHT+X+Y. Throws BadInput in one line if no window can be opened."""
    probed = subprocess.run([render_node, "--probe", "0", "--gl", "glfw", "--json"], stdin=subprocess.DEVNULL, capture_output=True,
                            text=True, errors="replace", check=False)
    if probed.returncode != 0:
        raise BadInput(complaint_of(probed))
    try:
        area = checked_json.parse(probed.stdout)["work_area"]
        return "{width:d}x{height:d}+{x:d}+{y:d}".format(**area)
    except (ValueError, KeyError, TypeError):
        raise BadInput("the render node names no area of the desktop; " + layout.MEND) from None


def words_for(wall, render_node, check):
    """Returns the options of `run` with which this desktop shows the wall.

    A wall of one tile is shown with one eye if its stereo needs two outputs. The tiles of other walls are placed on the desktop,
    unless the wall file places their windows. `check(wall, *question)` returns the answer of sandwall-check.
    """
    outputs, placed = map(int, check(wall, "--outputs").split())
    if outputs == 1 or placed > 0:
        return []
    if check(wall, "--ranks").strip() == "1":
        return ["--stereo", "mono"]
    area = work_area(render_node)
    check(wall, "--desk", area, "--ranks")  # throws before anything starts
    return ["--desk", area]
