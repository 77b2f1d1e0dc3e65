#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Compares how long several builds take to start a session on a raster, and the memory of its processes.

Makes a raster of each side, and runs one session of each build after the other, with a hand that digs and then rests. BIN is a
build's folder of programs; the scripts/sandwall of its own source folder starts them. Prints a table in Markdown.
docs/figures.md has one.

usage: scripts/figures/sessions/start_cost.py BIN [BIN ...] [--sides 512 3601 10012] [--rounds 2] [--rough] [--busy N]
"""

import os
import pathlib
import statistics
import sys
import tempfile
import time

sys.dont_write_bytecode = True
sys.path[:0] = [str(pathlib.Path(__file__).resolve().parents[2] / room) for room in ("figures", "launcher")]
from base.command_line import at_least
from sessions.measured_session import Failed, Parser
from sessions.raster_session import PROGRAMS, RasterSession, busy_processes, make_scene, print_table

REST = 6  # [s] after the stroke; by then the memory of sand at rest has been given back


def measure(programs, scene, out, args):
    """Returns the time to the first frame, to the linked hand and of the end [s], and memory_of() at rest."""
    with RasterSession(scene, out, args.wall, launcher=programs.parents[2] / "scripts" / "sandwall", programs=programs) as session:
        times = [session.wait_for("progress"), session.wait_for("link", state="linked")]
        time.sleep(3 + REST)
        memory = session.memory()
        times.append(session.stop())
        return times, memory


def row_of(side, programs, runs):
    """Returns the cells of a row: medians of times, and the largest memory in bytes a cell."""
    times = [f"{statistics.median(column):.1f}" for column in zip(*(run[0] for run in runs))]
    cells = []
    for program in PROGRAMS:
        now, peak = (max(run[1][program][i] for run in runs) / side ** 2 for i in (0, 1))
        cells.append(f"{now:.1f} ({peak:.1f})")
    return [f"{side}²", str(programs), *times, *cells]


def main():
    parser = Parser(prog="start_cost.py", description=__doc__.splitlines()[0])
    parser.add_argument("programs", nargs="+", type=pathlib.Path, metavar="BIN", help="a build's folder of programs")
    parser.add_argument("--sides", nargs="+", type=at_least(int, 64), default=[512, 3601, 10012], help="sides of the rasters [pixel]")
    parser.add_argument("--rounds", type=at_least(int, 1), default=2, help="sessions of each build and side (default: 2)")
    parser.add_argument("--rough", action="store_true", help="adds noise to the heights")
    parser.add_argument("--busy", type=at_least(int, 0), default=0, help="processes that are busy beside the sessions (default: 0)")
    parser.add_argument("--wall", default="desktop", help="wall: a sample's name or a file (default: desktop)")
    args = parser.parse_args()
    load, rows = os.getloadavg()[0], []
    try:
        for side in args.sides:
            with busy_processes(args.busy), tempfile.TemporaryDirectory(prefix="sandwall-start-") as name:
                folder = pathlib.Path(name)
                scene = make_scene(folder, side, args.rough)
                runs = {programs: [] for programs in args.programs}
                for number in range(args.rounds):
                    for index, programs in enumerate(args.programs):
                        runs[programs].append(measure(programs.resolve(), scene, folder / f"out_{number}_{index}", args))
                rows += [row_of(side, programs, runs[programs]) for programs in args.programs]
    except Failed as complaint:
        print(f"start_cost.py: {complaint}", file=sys.stderr)
        return 1
    print_table(["field", "build", "first frame [s]", "linked [s]", "end [s]", "server (peak) [byte/cell]", "master", "rank"], rows,
                f"; {args.busy} busy processes; load average {load:.1f} before and {os.getloadavg()[0]:.1f} after")
    return 0


if __name__ == "__main__":
    sys.exit(main())
