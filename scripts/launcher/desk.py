# SPDX-License-Identifier: Apache-2.0
"""Shows a whole wall on one desktop: one window for each tile, side by side (docs/pointer.md)."""

import subprocess

from base import checked_json, layout, marked_answer
from base.bad_input import BadInput


LONGEST_PROBE = 60  # [s], of a render node that opens one window


def probe(render_node, rank, *words, stdin=subprocess.DEVNULL):
    """Returns the output of the render node's check of this desktop. Throws BadInput in one line if no window can be opened."""
    try:
        probed = subprocess.run([render_node, "--probe", rank, "--gl", "glfw", *words], stdin=stdin, capture_output=True, text=True,
                                errors="replace", timeout=LONGEST_PROBE, check=False)
    except subprocess.TimeoutExpired:
        # GLFW waits without end for a window that a window manager has not shown, for example while it starts.
        raise BadInput(f"the desktop has shown no window for {LONGEST_PROBE} s; look whether its window manager runs, and try again") from None
    if probed.returncode != 0:
        why = marked_answer.own_line(probed.stderr) or f"the check of the display ended with status {probed.returncode}"
        raise BadInput(why.removeprefix("sandwall-render-node: "))
    return probed.stdout


def work_area(render_node):
    """Returns the desktop's area for windows as WIDTHxHEIGHT+X+Y. Throws BadInput in one line if no window can be opened."""
    said = probe(render_node, "0", "--json")
    try:
        area = checked_json.parse(said)["work_area"]
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
