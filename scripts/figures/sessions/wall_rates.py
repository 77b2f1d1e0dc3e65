#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Measures the frame rate of a whole wall on this machine alone: 12 ranks, 24 views of 1024 x 768, drawn by the processor.

Runs sessions one after another and prints a table: a still wall, digging with the tool of Dorjgotov et al. 2007 and one of 12
cells, a head that moves so that every view is drawn anew, the same on 2048 x 2048 cells, and a bare redraw beside it.
With --tin: digs in a height field and in TINs in turns. The first rows are frames per second at a display's pace. They are
of a wall of one tile, whose rank has a core as on a cluster, and of the whole wall. The other rows are times of a frame. One
is the processor time of a rank for the sand and the busiest tile. The other is of a session as fast as the machine can.

usage: scripts/figures/sessions/wall_rates.py [--tin] [--seconds S]   (takes six minutes, or fifteen with --tin; the machine should be idle otherwise)
"""

import json
import math
import os
import pathlib
import re
import statistics
import subprocess
import sys
import tempfile

sys.dont_write_bytecode = True
sys.path[:0] = [str(pathlib.Path(__file__).resolve().parents[2] / room) for room in ("figures", "launcher")]
from ask import session_results
from base import layout
from base.command_line import Parser, above

ROOT = pathlib.Path(__file__).resolve().parents[3]
BIN = ROOT / "build" / "release" / "bin"
WALL = ROOT / "walls" / "configs" / "tiled_3x4.toml"
WARM_UP = 5  # time at the start that does not count, because shaders are compiled and frame times settle [s]

SCENE = """name = "{cells} cells a side, tool of {radius} cells"
[field]
columns = {cells}
rows = {cells}
width = 2.0
[terrain]
kind = "{kind}"
{height}
[material]
talus_deg = {talus}
settling_time = 0.1
[tool]
radius = {scene_radius}
"""


def scene(folder, cells, radius, kind="flat", talus=34):
    """Writes a scene file whose tool has a radius of `radius` cells, and returns its path."""
    file = folder / f"{kind}_{cells}_{radius}.toml"
    height = "height = 0.2" if kind == "flat" else ""
    file.write_text(SCENE.format(cells=cells, radius=radius, kind=kind, height=height, talus=talus, scene_radius=radius * 2.0 / cells))
    return file


def circles(folder, seconds, centre=(0, 0), largest=0.6):
    """Writes a stroke list of rings that lasts at least `seconds`, at 2 cells of 512 per step. Lengths are in half sides."""
    file = folder / f"circles_{largest}.strokes"
    x, y = centre
    lines = ["speed 0.5", "depth 0.5", "stroke", f"point {x + largest} {y}"]
    lasts, ring = 0.0, 0
    while lasts < seconds:
        radius = largest * (1 - ring % 13 / 15)
        lines.append(f"arc {x} {y} {radius:.3f} {radius:.3f} 0 360")
        lasts += 2 * math.pi * radius / 0.5  # s
        ring += 1
    file.write_text("\n".join(lines) + "\n")
    return file


def swaying_head(folder, seconds):
    """Writes a trace of a head that never rests."""
    file = folder / "head.csv"
    rows = ["time,x,y,z"]
    for i in range(int(60 * seconds)):
        t = i / 60
        rows.append(f"{t:.4f},{0.2 * math.sin(2 * t):.5f},{1.6 + 0.03 * math.sin(3 * t):.5f},{3 + 0.1 * math.cos(t):.5f}")
    file.write_text("\n".join(rows) + "\n")
    return file


def one_tile(folder):
    """Writes a wall file with one tile from the middle of the tiled wall, and returns its path.

    The tile shows the sand from -0.77 to 0 and from -0.57 to 0.15 half sides.
    """
    text = WALL.read_text()
    (left, bottom), (across, up) = (tuple(map(float, re.search(rf"^{name} = \[([-.0-9]+), ([-.0-9]+)", text, re.MULTILINE).groups()))
                                    for name in ("lower_left", "tile_size"))
    text = re.sub(r"^rows = \d+", "rows = 1", text, flags=re.MULTILINE)
    text = re.sub(r"^columns = \d+", "columns = 1", text, flags=re.MULTILINE)
    file = folder / "one_tile.toml"
    file.write_text(re.sub(r"^lower_left = .*", f"lower_left = [{left + across + 0.01:.3f}, {bottom + up + 0.01:.3f}, 0.0]", text, flags=re.MULTILINE))
    return file


def session(out, scene_file, *more, wall=WALL):
    """Runs a session and returns its summary."""
    command = [ROOT / "scripts" / "sandwall", "run", "--wall", wall, "--scene", scene_file, "--gl", layout.in_memory(), "--out", out,
               "--no-pictures", *map(str, more)]
    ran = subprocess.run(command, capture_output=True, text=True)
    if ran.returncode != 0:
        sys.exit(f"{' '.join(map(str, command))}: {ran.stderr.strip() or ran.stdout.strip()}")
    return session_results.read_summary(out)


def views(summary, *kinds):
    return sum(rank["views"][kind] for rank in summary["per_rank"] for kind in kinds)


def still_row(out, scene_file, seconds):
    frames = int(60 * seconds)
    summary = session(out, scene_file, "--frames", frames)
    first = 2 * summary["ranks"]
    drawn = views(summary, "in_part", "whole") - first
    return "settled, nothing moves", f"{drawn} of {views(summary, 'skipped', 'in_part', 'whole') - first} views drawn", \
        f"{frames / summary['seconds']:.1f} frames a second; apart from the first frame's {first}"


def dig_row(out, scene_file, strokes, seconds, rate, bare_ms, what):
    frames = int(rate * (seconds + WARM_UP))
    summary = session(out, scene_file, "--device", f"script:{strokes}", "--refresh", rate, "--frames", frames,
                      "--warm-up", WARM_UP * rate)
    late = summary["late_frames"]
    share = 100 * late / summary["frame_ms"]["count"]
    skipped = views(summary, "skipped") / views(summary, "skipped", "in_part", "whole")
    frame = summary["frame_ms"]
    return (what, f"{1e3 / frame['mean']:.1f} frames a second, {share:.1f} % late",
            f"wanted {rate}; p50 {frame['p50'] / bare_ms:.2f}, p99 {frame['p99'] / bare_ms:.2f} × a bare redraw; "
            f"{100 * skipped:.0f} % of views not drawn")


def head_row(out, scene_file, head, frames, what):
    summary = session(out, scene_file, "--track", f"trace:{head}", "--pace", "fast", "--frames", frames, "--warm-up", 10)
    whole = views(summary, "whole") / views(summary, "skipped", "in_part", "whole")
    median = summary["frame_ms"]["p50"]
    return (what, f"{median:.0f} ms a frame", f"{100 * whole:.0f} % of views drawn whole"), median


def bare_redraw(scene_file):
    """Returns the processor time of drawing all views in one process [ms]: barely, and as sand."""
    environment = dict(os.environ, LP_NUM_THREADS="0")
    found = json.loads(subprocess.run([BIN / "wall_bench", "--wall", WALL, "--scene", scene_file, "--json"], capture_output=True,
                                      text=True, check=True, env=environment).stdout)
    return found["bare_ms"], found["sand_ms"]


TIN = """[tin]
max_error = 0.0005
widest = {widest}
"""


def as_tin(file, widest):
    """Writes the scene of `file` with a TIN in place of the height field, and returns its path.

    The points of the TIN are `widest` cells apart at the start, and one cell apart where the hand digs.
    """
    tin = file.with_name(f"tin_{widest}_{file.name}")
    tin.write_text(file.read_text() + TIN.format(widest=widest * 2.0 / 512))
    return tin


def digging_ms(out, scene_file, strokes, frames):
    """Returns the median time of a frame of digging, with up to four steps per frame [ms]."""
    summary = session(out, scene_file, "--device", f"script:{strokes}", "--pace", "fast", "--frames", frames, "--warm-up", 20)
    return summary["frame_ms"]["p50"]


def rank_ms(scene_file):
    """Returns the processor time of a frame with one step [ms]: the sand's and the drawing of the busiest tile."""
    environment = dict(os.environ, LP_NUM_THREADS="0")
    found = json.loads(subprocess.run([BIN / "redraw_bench", "--wall", WALL, "--scene", scene_file, "--rate", "60", "--frames", "100",
                                       "--json"], capture_output=True, text=True, check=True, env=environment).stdout)
    return found["step_ms"] + found["busiest_tile_ms"]


def tin_rates(folder, seconds):
    """Yields rows of frames per second at a display's pace, for digging in a height field and in TINs."""
    everywhere, seen = circles(folder, 2 * (seconds + WARM_UP)), circles(folder, 2 * (seconds + WARM_UP), (-0.38, -0.2), 0.3)
    tile = one_tile(folder)
    ways = ((tile, seen, "one tile that sees all of it", 2.56, 60), (tile, seen, "one tile that sees all of it", 12, 60),
            (WALL, everywhere, "all twelve ranks here", 2.56, 60))
    for wall, strokes, what, radius, rate in ways:
        grid = scene(folder, 512, radius)
        files = {"cells": grid} | {f"… as a TIN of points {widest} cells apart": as_tin(grid, widest) for widest in (16, 2, 1)}
        for name, file in files.items():
            summary = session(folder / "out", file, "--device", f"script:{strokes}", "--refresh", rate, "--frames",
                              int(rate * (seconds + WARM_UP)), "--warm-up", WARM_UP * rate, wall=wall)
            shown, late = 1e3 / summary["frame_ms"]["mean"], 100 * summary["late_frames"] / summary["frame_ms"]["count"]
            if name == "cells":
                of_grid = shown
                yield f"digging, 512², R = {radius} cells; {what}", f"{shown:.1f} frames a second, {late:.1f} % late", f"wanted {rate}"
            else:
                yield name, f"{shown:.1f} frames a second, {late:.1f} % late", f"the grid's are {of_grid / shown:.2f} × as many"


def tin_rows(folder, seconds, runs, frames):
    """Yields rows that compare TINs with the grid. One hand digs in both, in turns."""
    yield from tin_rates(folder, seconds)
    out, strokes = folder / "out", circles(folder, 1000)
    ways = {"one rank on a core": (rank_ms, "processor time"),
            "all here": (lambda file: digging_ms(out, file, strokes, frames), f"sessions of {frames} frames")}
    for way, (measured, how) in ways.items():
        for radius in (2.56, 12):
            grid = scene(folder, 512, radius)
            files = {"grid": grid, "16": as_tin(grid, 16), "2": as_tin(grid, 2), "1": as_tin(grid, 1)}
            times = {name: [] for name in files}
            for _ in range(runs):
                for name, file in files.items():
                    times[name].append(measured(file))
            median = {name: statistics.median(values) for name, values in times.items()}
            yield f"digging, 512², R = {radius} cells; {way}", f"{median['grid']:.1f} ms a frame", f"median of {runs}, {how}"
            for name in list(files)[1:]:
                spread = sorted(t / g for t, g in zip(times[name], times["grid"]))
                yield (f"… as a TIN of points {name} cells apart", f"{median[name]:.1f} ms a frame",
                       f"{median[name] / median['grid']:.2f} × ({spread[0]:.2f} to {spread[-1]:.2f})")


def measure(folder, seconds):
    cores = os.cpu_count()
    out = folder / "out"
    strokes = circles(folder, 2 * (seconds + WARM_UP))
    head = swaying_head(folder, 120)
    paper, broad = scene(folder, 512, 2.56), scene(folder, 512, 12)
    # The talus of 60 degrees keeps the dunes at rest. With 34 degrees, 2048 x 2048 cells of dunes slide for longer than this
    # measurement takes.
    dunes, large = (scene(folder, cells, 12, "dunes", talus=60) for cells in (512, 2048))
    bare, sand = bare_redraw(dunes)
    bare_ms = bare / cores
    yield "a bare redraw of all views", f"{bare_ms:.0f} ms", f"{bare:.0f} ms of processor on {cores} cores; as sand {sand / bare:.2f} ×"
    yield still_row(out, broad, min(seconds, 10))
    yield dig_row(out, paper, strokes, seconds, 60, bare_ms, "digging, 512², R = 2.56 cells")
    yield dig_row(out, broad, strokes, seconds, 30, bare_ms, "digging, 512², R = 12 cells")
    yield dig_row(out, scene(folder, 2048, 12), strokes, min(seconds, 20), 30, bare_ms, "digging, 2048², R = 12 cells")
    row, median = head_row(out, dunes, head, 60, "head moving, 512² of dunes")
    beside = bare_redraw(dunes)[0] / cores  # measured again, because a shared machine's speed changes from minute to minute
    yield row[0], row[1], f"{row[2]}; {median / beside:.2f} × a bare redraw, {beside:.0f} ms then"
    row, large_median = head_row(out, large, head, 60, "head moving, 2048² of dunes")
    yield row[0], row[1], f"{row[2]}; {large_median / median:.2f} × 512²"


def main():
    parser = Parser(description=__doc__.splitlines()[0])
    parser.add_argument("--seconds", type=above(float, 0), help="seconds of each digging session after the warm-up (default: 60; with --tin 12)")
    parser.add_argument("--tin", action="store_true", help="compare TINs with a height field, and measure nothing else")
    parser.add_argument("--runs", type=int, default=3, help="number of runs of each scene with --tin (default: 3)")
    parser.add_argument("--frames", type=int, default=240, help="number of frames of each run with --tin (default: 240)")
    args = parser.parse_args()
    for program in ("wall_bench", "redraw_bench"):
        if not (BIN / program).is_file():
            print(f"{BIN}/{program}: not built yet; run cmake --build build/release --target benchmarks", file=sys.stderr)
            return 2
    print("| 12 ranks, 24 views of 1024×768 on one machine | | |\n|---|---|---|", flush=True)
    with tempfile.TemporaryDirectory(prefix="sandwall-rates-") as folder:
        path = pathlib.Path(folder)
        rows = (tin_rows(path, args.seconds or 12, args.runs, args.frames) if args.tin
                else measure(path, args.seconds or 60))
        for what, figure, beside in rows:
            print(f"| {what} | {figure} | {beside} |", flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
