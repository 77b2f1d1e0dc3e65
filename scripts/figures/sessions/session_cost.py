#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Compares the cost of one short session with several builds: time from start to end, processor time and memory.

Runs sessions of each build in turns, with a wall of two ranks and a recorded hand. Prints a table of medians. BIN is a
build's folder of programs; the scripts/sandwall of its own source folder starts them.

usage: scripts/figures/sessions/session_cost.py BIN [BIN ...] [--scene FILE] [--steps 60] [--runs 5]
"""

import os
import pathlib
import resource
import statistics
import subprocess
import sys
import tempfile
import time

sys.dont_write_bytecode = True
sys.path[:0] = [str(pathlib.Path(__file__).resolve().parents[2] / room) for room in ("figures", "launcher")]
from ask import session_results
from base import layout
from base.command_line import Parser

ROOT = pathlib.Path(__file__).resolve().parents[3]
PROGRAMS = {"sandwall-render-node": "rank", "sandwall-master": "master", "sandwall-haptic-server": "haptic server"}
POLL = 0.02  # s
WALL = """[viewer]
eye = [0.0, 1.6, 2.0]
[stereo]
mode = "passive"
[grid]
rows = 1
columns = 2
tile_size = [1.024, 0.768]
tile_pixels = [512, 384]
lower_left = [-1.024, 0.9, 0.0]
[stage]
centre = [0.0, 1.25, -0.3]
width = 1.6
tilt_deg = 40
"""


def peaks_of(root, peaks):
    """Updates `peaks` with the highest resident memory of each program below the process `root` [MB]."""
    parents, names = {}, {}
    for folder in pathlib.Path("/proc").glob("[0-9]*"):
        try:
            status = dict(line.split(":\t", 1) for line in (folder / "status").read_text().splitlines() if ":\t" in line)
            name = os.path.basename((folder / "cmdline").read_bytes().split(b"\0")[0].decode())
            parents[int(folder.name)] = int(status["PPid"])
            names[int(folder.name)] = name, int(status["VmHWM"].split()[0]) / 1024
        except (OSError, KeyError, ValueError):
            continue  # the process has ended, or is a thread of the kernel
    for process, (name, peak) in names.items():
        ancestor = process
        while ancestor in parents and ancestor != root:
            ancestor = parents[ancestor]
        if ancestor == root and name in PROGRAMS:
            key = f"{PROGRAMS[name]}, peak [MB]"
            peaks[key] = max(peaks.get(key, 0), peak)


def session(folder, programs, scene, steps):
    """Runs one session. Returns {name with unit: cost}."""
    launcher = programs.parent.parent.parent / "scripts" / "sandwall"
    command = [launcher, "run", "--wall", folder / "wall.toml", "--scene", scene, "--device", "script:gis", "--pace", "fast",
               "--steps", str(steps), "--gl", layout.in_memory(), "--out", folder / "out", "--no-pictures"]
    before, begin, result = resource.getrusage(resource.RUSAGE_CHILDREN), time.monotonic(), {}
    with open(folder / "said.txt", "w") as said:
        running = subprocess.Popen(command, env=dict(os.environ, SANDWALL_BIN=str(programs)), stdout=said, stderr=said)
        while running.poll() is None:
            peaks_of(running.pid, result)
            time.sleep(POLL)
    if running.returncode != 0:
        sys.exit(f"{programs}: {(folder / 'said.txt').read_text()}")
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    result["begin to end [s]"] = time.monotonic() - begin
    result["processor [s]"] = used.ru_utime + used.ru_stime - before.ru_utime - before.ru_stime
    summary = session_results.read_summary(folder / "out")
    result["rank, at its end [MB]"] = max(rank["memory_bytes"] for rank in summary["per_rank"]) / 2**20
    result["master, at its end [MB]"] = summary["master_memory_bytes"] / 2**20
    return result


def main():
    parser = Parser(description=__doc__.splitlines()[0])
    parser.add_argument("programs", nargs="+", type=pathlib.Path, metavar="BIN", help="a build's folder of programs")
    parser.add_argument("--scene", type=pathlib.Path, default=ROOT / "scenes" / "writing.toml")
    parser.add_argument("--steps", type=int, default=60)
    parser.add_argument("--runs", type=int, default=5, help="number of sessions of each build (default: 5)")
    args = parser.parse_args()
    rows = [[] for _ in args.programs]
    with tempfile.TemporaryDirectory(prefix="sandwall-cost-") as name:
        folder = pathlib.Path(name)
        (folder / "wall.toml").write_text(WALL)
        for _ in range(args.runs):
            for programs, row in zip(args.programs, rows):
                row.append(session(folder, programs.resolve(), args.scene.resolve(), args.steps))
    print("| |" + "".join(f" {programs} |" for programs in args.programs) + "\n|---|" + "---|" * len(rows))
    for what in rows[0][0]:
        cells = []
        for row in rows:
            values = sorted(run[what] for run in row)
            cells.append(f" {statistics.median(values):.2f} ({values[0]:.2f} to {values[-1]:.2f}) |")
        print(f"| {what} |" + "".join(cells))
    return 0


if __name__ == "__main__":
    sys.exit(main())
