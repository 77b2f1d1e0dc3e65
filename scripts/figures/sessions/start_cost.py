#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Compares how long several builds take to start a session on a raster, and the memory of its processes.

Makes a raster of each side, and runs one session of each build after the other, with a hand that digs and then rests. BIN is a
build's folder of programs; the scripts/sandwall of its own source folder starts them. Prints a table in Markdown.
docs/figures.md has one.

usage: scripts/figures/sessions/start_cost.py BIN [BIN ...] [--sides 512 3601 10012] [--rounds 2] [--rough] [--busy N]
"""

import array
import contextlib
import math
import os
import pathlib
import random
import re
import statistics
import subprocess
import sys
import tempfile
import time

sys.dont_write_bytecode = True
sys.path[:0] = [str(pathlib.Path(__file__).resolve().parents[2] / room) for room in ("figures", "launcher")]
from base import events, layout
from base.command_line import at_least
from sessions.measured_session import Failed, Parser, die_with_parent, processor
from sessions.rest_cost import family_of

LONGEST_START = 900  # [s]
REST = 6  # [s] after the stroke; by then the memory of sand at rest has been given back
STROKES = "speed 0.5\ndepth 0.5\nstroke\npoint -0.3 0\npoint 0.3 0.2\n"  # takes some two seconds
PROGRAMS = ("sandwall-haptic-server", "sandwall-master", "sandwall-render-node")
HEADER = """BYTEORDER {order}
LAYOUT BIL
NROWS {side}
NCOLS {side}
NBANDS 1
NBITS 16
PIXELTYPE SIGNEDINT
ULXMAP 0
ULYMAP 0
XDIM 30
YDIM 30
"""
SCENE = """name = "start"
[terrain]
kind = "dem"
file = "start.bil"
lengths = true
datum = 400
[tool]
radius = 400
[material]
talus_deg = 34
"""


def make_scene(folder, side, rough):
    """Writes a scene with a raster of dunes, with noise of ±3 m if `rough`. Returns its file."""
    noise = random.Random(1)
    profile = array.array("h", (round(400 + 200 * math.sin(x / 300) + 60 * math.sin(x / 70)) + (noise.randint(-3, 3) if rough else 0)
                                for x in range(side + 2000)))
    with (folder / "start.bil").open("wb") as file:
        for row in range(side):
            shift = (noise.randrange(1000) if rough else 0) + round(400 * (1 + math.sin(row / 260)))
            file.write(profile[shift:shift + side].tobytes())
    (folder / "start.hdr").write_text(HEADER.format(order="I" if sys.byteorder == "little" else "M", side=side))
    (folder / "start.toml").write_text(SCENE)
    (folder / "once.strokes").write_text(STROKES)
    return folder / "start.toml"


def memory_of(root):
    """Returns the resident memory and its peak of each program below the process `root`: {program: (now, peak)} [byte]."""
    found = {}
    for process in family_of(root):
        with contextlib.suppress(OSError):
            folder = pathlib.Path("/proc") / str(process)
            name = pathlib.Path(os.readlink(folder / "exe")).name
            status = (folder / "status").read_text()
            if name in PROGRAMS:
                found[name] = tuple(1024 * int(re.search(rf"^{key}:\s+(\d+)", status, re.MULTILINE)[1]) for key in ("VmRSS", "VmHWM"))
    return found


def measure(programs, scene, out, args):
    """Returns the time to the first frame, to the linked hand and of the end [s], and memory_of() at rest."""
    launcher, log = programs.parents[2] / "scripts" / "sandwall", out.with_suffix(".log")
    command = [launcher, "run", "--here", "--wall", args.wall, "--scene", scene, "--device", f"script:{scene.parent / 'once.strokes'}",
               "--no-pictures", "--gl", layout.in_memory(), "--out", out]
    began = time.monotonic()
    with log.open("w") as said:
        run = subprocess.Popen([str(word) for word in command], stdin=subprocess.PIPE, stdout=said, stderr=subprocess.STDOUT, text=True,
                               env=dict(os.environ, SANDWALL_BIN=str(programs), **{events.VARIABLE: "1"}), preexec_fn=die_with_parent)
    try:
        times = []
        for event, fields in (("progress", {}), ("link", {"state": "linked"})):
            if events.wait_for(log, event, LONGEST_START, lambda: run.poll() is None, **fields) is None:
                raise Failed(f"{programs}: no {event}: {log.read_text(errors='replace').strip()[-300:]}")
            times.append(time.monotonic() - began)
        time.sleep(3 + REST)
        memory = memory_of(run.pid)
        stopped = time.monotonic()
        run.communicate("stop\n", timeout=LONGEST_START)
        times.append(time.monotonic() - stopped)
        if run.returncode != 0:
            raise Failed(f"{programs}: the session failed: {log.read_text(errors='replace').strip()[-300:]}")
        return times, memory
    finally:
        if run.poll() is None:
            run.terminate()
            run.wait(timeout=LONGEST_START)


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
    busy = [subprocess.Popen([sys.executable, "-c", "while True: pass"], preexec_fn=die_with_parent) for _ in range(args.busy)]
    try:
        for side in args.sides:
            with tempfile.TemporaryDirectory(prefix="sandwall-start-") as name:
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
    finally:
        for process in busy:
            process.kill()
    print("| field | build | first frame [s] | linked [s] | end [s] | server (peak) [byte/cell] | master | rank |\n|---|---|---|---|---|---|---|---|")
    for cells in rows:
        print("| " + " | ".join(cells) + " |")
    print(f"\n- machine: {processor()}, {len(os.sched_getaffinity(0))} cores; {args.busy} busy processes; load average {load:.1f} before and {os.getloadavg()[0]:.1f} after")
    return 0


if __name__ == "__main__":
    sys.exit(main())
