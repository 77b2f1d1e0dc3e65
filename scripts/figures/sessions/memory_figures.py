#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Compares the memory of a session's processes with the figures that sandwall-check states for them.

Runs a session on each field. On random heights all sand moves, while a hand digs and checkpoints are written. On dunes a hand
digs, and the sand then rests. Prints a table in Markdown with the resident memory of each process and the stated figure.
docs/figures.md has one.

usage: scripts/figures/sessions/memory_figures.py [--sides 2048 4096] [--kinds moving smooth rough] [--seconds 60]
"""

import argparse
import array
import pathlib
import random
import subprocess
import sys
import tempfile
import time

sys.dont_write_bytecode = True
sys.path[:0] = [str(pathlib.Path(__file__).resolve().parents[2] / room) for room in ("figures", "launcher")]
from base import layout
from base.command_line import at_least
from sessions import raster_session
from sessions.measured_session import Failed, Parser
from sessions.raster_session import RasterSession, print_table
from hosts import session_memory

KINDS = ("moving", "smooth", "rough")
STROKES = "speed 2\ndepth 0.5\ntravel 8\n" + "stroke\npoint -0.3 0\npoint -0.28 0.02\n" * 100  # later strokes begin while all sand moves
NAMES = {"sandwall-haptic-server": "haptic server", "sandwall-master": "master", "sandwall-render-node": "rank"}
FLOAT_HEADER = raster_session.HEADER.replace("NBITS 16\nPIXELTYPE SIGNEDINT", "NBITS 32\nPIXELTYPE FLOAT").replace("XDIM 30\nYDIM 30", "XDIM 1\nYDIM 1")


def make_moving(folder, side):
    """Writes a scene of random heights that cannot be compressed, so that all sand moves. Returns its file."""
    noise = random.Random(1)
    with (folder / "start.bil").open("wb") as file:
        for _ in range(side):
            array.array("f", (noise.uniform(-1500, 1500) for _ in range(side))).tofile(file)
    (folder / "start.hdr").write_text(FLOAT_HEADER.format(order="I" if sys.byteorder == "little" else "M", side=side))
    (folder / "start.toml").write_text(raster_session.SCENE.replace("datum = 400", "datum = 0").replace("radius = 400", "radius = 13"))
    (folder / "once.strokes").write_text(STROKES)
    return folder / "start.toml"


def measure(scene, out, args, checkpoint):
    """Returns the memory of each process at the end, and the largest during the session: {program: (now, peak)} [byte]."""
    with RasterSession(scene, out, args.wall, "--checkpoint", checkpoint) as session:
        session.wait_for("link", state="linked")
        time.sleep(args.seconds)
        memory = session.memory()
        session.stop()
        return memory


def stated(scene, args):
    """Returns the figures that sandwall-check states: {program: (at rest, at the start, all moves)} [byte]."""
    lines = subprocess.run([layout.program("sandwall-check"), layout.found("walls", args.wall), "--memory", "--scene", str(scene)], check=True, capture_output=True, text=True).stdout
    found = {match[1]: tuple(map(int, match.groups()[1:4])) for match in map(session_memory.LINE.fullmatch, lines.splitlines())}
    return {"sandwall-haptic-server": found["server"], "sandwall-master": found["master"], "sandwall-render-node": found["1"]}


def rows_of(kind, side, args):
    """Returns the rows of a session on a field of this kind."""
    with tempfile.TemporaryDirectory(prefix="sandwall-memory-") as name:
        folder, moving = pathlib.Path(name), kind == "moving"
        scene = make_moving(folder, side) if moving else raster_session.make_scene(folder, side, kind == "rough")
        memory, figures = measure(scene, folder / "out", args, 3 if moving else 10), stated(scene, args)
    rows = []
    for program, (now, peak) in memory.items():
        rest, start, moves = figures[program]
        pairs = [("all moves", moves, peak)] if moving else [("at rest", rest, now), ("start", start, peak)]
        rows += [[f"{side}²", kind, NAMES[program], when, f"{there / 1e6:.0f}", f"{figure / 1e6:.0f}", f"{100 * (figure / there - 1):+.0f} %"]
                 for when, figure, there in pairs]
    return rows


def main():
    parser = Parser(prog="memory_figures.py", description=__doc__.splitlines()[0], formatter_class=argparse.ArgumentDefaultsHelpFormatter)
    parser.add_argument("--sides", nargs="+", type=at_least(int, 64), default=[2048, 4096], help="sides of the fields [cell]")
    parser.add_argument("--kinds", nargs="+", choices=KINDS, default=list(KINDS), help="heights of the fields")
    parser.add_argument("--seconds", type=at_least(int, 1), default=60, help="time of a session after the hand is linked [s]")
    parser.add_argument("--wall", default="desktop", help="wall: a sample's name or a file")
    args = parser.parse_args()
    rows = []
    try:
        for side in args.sides:
            for kind in args.kinds:
                rows += rows_of(kind, side, args)
    except Failed as complaint:
        print(f"memory_figures.py: {complaint}", file=sys.stderr)
        return 1
    print_table(["field", "heights", "process", "when", "measured [MB]", "stated [MB]", "stated above"], rows)
    return 0


if __name__ == "__main__":
    sys.exit(main())
