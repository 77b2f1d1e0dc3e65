#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Measures how punctual the force loop is while sand erodes on the other core.

Runs the haptic server and a wall of one small tile for a minute, while the hand digs without end. Prints histograms of the
period between two ticks and of the time of one force, and the share of missed deadlines.

usage: scripts/figures/sessions/loop_timings.py [--seconds 60] [--scene scenes/sandbox.toml]   (leave the machine alone meanwhile)
"""

import csv
import os
import pathlib
import sys
import tempfile

sys.dont_write_bytecode = True  # writes no files into the project's folder
sys.path[:0] = [str(pathlib.Path(__file__).resolve().parents[2] / room) for room in ("figures", "launcher")]
from base.command_line import Parser, above
from sessions import measured_session
from sessions.latency import WALLS

# Edges of the histogram of periods between two ticks [us]; the target is 1000.
PERIODS = [0, 500, 900, 990, 1010, 1100, 1500, 2000, 5000, 20000]
FORCES = [0, 1, 2, 5, 10, 20, 50, 100, 1000]
TICK = 1000  # [us]


def read(file):
    """Returns {name of a measurement: [(shortest duration of the bin [us], count)]}."""
    found = {}
    with open(file, encoding="utf-8") as stream:
        for row in csv.DictReader(stream):
            found.setdefault(row["what"], []).append((float(row["from_us"]), int(row["count"])))
    return found


def binned(buckets, edges):
    """Returns the number of durations from each edge to the next."""
    counts = [0] * len(edges)
    for lowest, count in buckets:
        counts[max(i for i, edge in enumerate(edges) if lowest >= edge)] += count
    return counts


def spans(edges):
    return [f"{low} – {high}" for low, high in zip(edges, edges[1:])] + [f"{edges[-1]} and more"]


def table(what, buckets, edges):
    counts = binned(buckets, edges)
    total = sum(counts)
    lines = [f"| {what} [µs] | times | per mille |", "|---|---|---|"]
    lines += [f"| {span} | {count} | {1000 * count / total:.2f} |" for span, count in zip(spans(edges), counts) if count > 0]
    return "\n".join(lines)


def missed(buckets):
    """Returns the deadlines that passed before the tick of the deadline before them had come [per mille of all]."""
    passed = sum(count * (int(lowest // TICK) - 1) for lowest, count in buckets if lowest >= 2 * TICK)
    return 1000 * passed / sum(count for _, count in buckets)


def run(args):
    wall, load = WALLS[0], measured_session.Load("digging", 16, False, True)
    with tempfile.TemporaryDirectory(prefix="sandwall-loop-") as name:
        folder = pathlib.Path(name)
        strokes, timings = folder / "hand.strokes", folder / "timings.csv"
        strokes.write_text(measured_session.circles(args.seconds + measured_session.START_SECONDS))
        wall_file, _ = measured_session.smaller(folder, wall, load)
        with measured_session.Helper(measured_session.BIN / "sandwall-haptic-server", "--scene", args.scene, "--device", f"script:{strokes}",
                            "--listen", "127.0.0.1:0", "--timings", timings, "--die-with-parent") as server:
            summary = measured_session.session(folder, wall_file, load, server.address, args, args.scene)
        return summary, read(timings)


def main():
    parser = Parser(description=__doc__.splitlines()[0])
    parser.add_argument("--seconds", type=above(float, 0), default=60, help="seconds of digging (default: 60)")
    parser.add_argument("--scene", type=pathlib.Path, default=measured_session.SCENE, help="scene file (default: scenes/sandbox.toml)")
    args = parser.parse_args()
    args.warm_up = 0
    before = os.getloadavg()[0]
    measured_session.stop_on_signals()
    try:
        summary, found = run(args)
    except measured_session.Failed as complaint:
        print(f"loop_timings.py: {complaint}", file=sys.stderr)
        return 1
    print(table("period of the force loop", found["period"], PERIODS))
    print("\n" + table("one force evaluation, by the clock", found["force"], FORCES))
    ticks = sum(count for _, count in found["period"])
    print(f"\n- {missed(found['period']):.2f} per mille of {ticks} deadlines missed: the deadline passed before the tick before it had come")
    print(f"- {measured_session.processor()}, {len(os.sched_getaffinity(0))} cores shared by the haptic server (force loop, sand), the master and a render rank; "
          f"load average {before:.1f} before and {os.getloadavg()[0]:.1f} after; {summary['steps']} steps of sand dug by the tool of Dorjgotov et al. 2007")
    return 0


if __name__ == "__main__":
    sys.exit(main())
