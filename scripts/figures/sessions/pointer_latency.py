#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Measures the time from the pointer to the picture on one screen, while the pointer digs (docs/pointer.md).

Starts a desktop wall in a window of an X server in memory, and moves the pressed pointer in circles with xdotool. With --rest
the pointer rests before each touch. --compare measures several builds by turns.
"""

import json
import math
import os
import pathlib
import shutil
import statistics
import subprocess
import sys
import tempfile
import time

sys.dont_write_bytecode = True
sys.path[:0] = [str(pathlib.Path(__file__).resolve().parents[2] / room) for room in ("figures", "launcher")]
from ask import session_results
from base import events
from base.command_line import above, at_least
from sessions.latency import pm
from sessions.measured_session import BIN, ROOT, START_SECONDS, Failed, Parser, die_with_parent, processor
from sessions.x_server import XServer

SIZE = (1280, 720)  # pixels of walls/configs/desktop.toml
SCREEN = (1600, 900)  # the first size of a window is at most 90 % of its screen
FULL_HD = (1920, 1080)
MOTIONS = 125  # a second, as a usual mouse sends them
STILL_SECONDS = 1.5  # after a touch, until the sand has slid and has rested for a second
REFRESH = 60  # Hz


def start_mover(display, words):
    """Starts xdotool with these commands."""
    mover = subprocess.Popen(["xdotool", "-"], stdin=subprocess.PIPE, env=display.environment, text=True, preexec_fn=die_with_parent)
    mover.stdin.write("\n".join(words) + "\n")
    mover.stdin.close()
    return mover


def touches(display, size, rest, count):
    """Starts a process that presses or releases the left button `count` times. Before each time nothing has moved for `rest` seconds,
    and a second more, in which a session still makes steps. Returns the process and its duration [s]."""
    pause = rest + STILL_SECONDS
    words = [f"mousemove {size[0] // 2} {round(0.458 * size[1])}"]
    for i in range(count):
        words += [f"sleep {pause}", f"mouse{'up' if i % 2 else 'down'} 1"]
    return start_mover(display, words), count * pause


def circles(display, size, seconds):
    """Starts a process that presses the left button and moves the pointer in circles for so long, on a picture of this size."""
    across, down = size[0] // 2, round(0.458 * size[1])
    words = [f"mousemove {across} {down}", "mousedown 1"]
    for i in range(round(seconds * MOTIONS)):
        angle = 2 * math.pi * i / MOTIONS  # one circle a second
        radius = (0.208 + 0.083 * math.sin(angle / 7)) * size[1]
        words += [f"mousemove {across + radius * math.cos(angle):.0f} {down + 0.6 * radius * math.sin(angle):.0f}", f"sleep {1 / MOTIONS}"]
    words.append("mouseup 1")
    return start_mover(display, words)


def measure(args, programs=BIN):
    """Returns the summary of a session of this build in which the pointer digs all the time, or touches after rests."""
    launcher = (ROOT if programs == BIN else programs.parents[2]) / "scripts" / "sandwall"
    full, size = args.full_hd, FULL_HD if args.full_hd else SIZE
    with tempfile.TemporaryDirectory(prefix="sandwall-pointer-") as name, XServer("{}x{}".format(*(FULL_HD if full else SCREEN))) as display:
        folder = pathlib.Path(name)
        log, out = folder / "log.txt", folder / "out"
        desk = ["--desk", f"{size[0]}x{size[1]}+0+0"] if args.on_desk else []
        command = [launcher, "run", "--here", "--wall", args.wall, *desk, "--scene", args.scene,
                   "--device", "pointer", "--no-pictures", "--out", out, "--refresh", REFRESH, "--warm-up", round(args.warm_up * REFRESH)]
        with log.open("w") as said:
            run = subprocess.Popen([str(word) for word in command], stdin=subprocess.PIPE, stdout=said, stderr=subprocess.STDOUT, text=True,
                                   env={**display.environment, "SANDWALL_BIN": str(programs), events.VARIABLE: "1"}, preexec_fn=die_with_parent)
        try:
            if events.wait_for(log, "progress", START_SECONDS, lambda: run.poll() is None) is None:
                raise Failed(f"no frame was shown: {log.read_text(errors='replace').strip()[-300:]}")
            if full and not desk:
                subprocess.run(["xdotool", "mousemove", "200", "200", "key", "F11"], env=display.environment, check=True, timeout=START_SECONDS)
            if args.rest is None:
                mover, seconds = circles(display, size, args.warm_up + args.seconds), args.warm_up + args.seconds
            else:
                mover, seconds = touches(display, size, args.rest, args.touches)
            time.sleep(seconds + 1)
            run.stdin.write("stop\n")
            run.stdin.flush()
            if run.wait(timeout=START_SECONDS) != 0:
                raise Failed(f"the session failed: {log.read_text(errors='replace').strip()[-300:]}")
            mover.terminate()
            mover.wait()
        finally:
            if run.poll() is None:
                run.terminate()
                run.wait(timeout=START_SECONDS)
        # The summary of another build may lack fields of this one.
        return session_results.read_summary(out) if programs == BIN else json.loads((out / "summary.json").read_text())


def compare(args):
    """Measures the builds of --compare by turns, and returns a table in Markdown of each turn and of the medians of all."""
    lines = ["| turn | build | steps | event to picture, p50 [ms] | p99 [ms] |", "|---|---|---|---|---|"]
    found = {programs: [] for programs in args.compare}
    for turn in range(1, args.turns + 1):
        for programs in args.compare:
            summary = measure(args, programs.resolve())
            figures = summary["latency_ms"]
            found[programs].append(figures)
            lines.append(f"| {turn} | {programs} | {summary['steps']} | {figures['p50']:.1f} | {figures['p99']:.1f} |")
    for programs, all_of in found.items():
        middle = [statistics.median(figures[key] for figures in all_of) for key in ("p50", "p99")]
        lines.append(f"| median | {programs} | | {middle[0]:.1f} | {middle[1]:.1f} |")
    return "\n".join(lines)


def machine(before):
    return (f"- machine: {processor()}, {len(os.sched_getaffinity(0))} cores for X server, master, rank and llvmpipe; load average "
            f"{before:.1f} before and {os.getloadavg()[0]:.1f} after")


def row(name, figures):
    return f"| {name} | {pm(figures['mean'], figures['stddev'])} | {figures['p50']:.1f} | {figures['p99']:.1f} |"


def report(summary, before, size):
    """Returns the table in Markdown, and notes."""
    legs = summary["latency_legs_ms"]
    lines = ["| leg | mean ± standard deviation [ms] | p50 | p99 |", "|---|---|---|---|",
             row("event to master", legs["to_master"]), row("waits for the next frame", legs["queued"]), row("drawn", legs["drawn"]),
             row("swapped", legs["swapped"]), row("**event to picture**", summary["latency_ms"])]
    frames = summary["frame_ms"]
    lines += ["", f"- {1000 / frames['mean']:.1f} frames a second while digging at {size[0]} × {size[1]}: frame p50 {frames['p50']:.1f} ms, p99 "
              f"{frames['p99']:.1f} ms; two frames at {REFRESH} Hz are {2000 / REFRESH:.1f} ms",
              machine(before)]
    return "\n".join(lines)


def main():
    parser = Parser(prog="pointer_latency.py", description=__doc__)
    parser.add_argument("--seconds", type=above(float, 0), default=20, help="seconds of the session after its warm-up (default: 20)")
    parser.add_argument("--warm-up", type=at_least(float, 0), default=5, help="seconds at the start that do not count as frames (default: 5)")
    parser.add_argument("--scene", default=ROOT / "scenes" / "writing.toml", help="scene file (default: scenes/writing.toml)")
    parser.add_argument("--wall", default=ROOT / "walls" / "configs" / "desktop.toml", help="wall: a sample's name or a file (default: desktop)")
    parser.add_argument("--on-desk", action="store_true", help="place all tiles of the wall side by side")
    parser.add_argument("--full-hd", action="store_true", help="fill 1920 × 1080 pixels instead of 1280 × 720")
    parser.add_argument("--json", action="store_true", help="print the session's summary as JSON")
    parser.add_argument("--rest", type=at_least(float, 0), metavar="SECONDS",
                        help="press or release the button once, after a rest of so long, in place of digging")
    parser.add_argument("--touches", type=at_least(int, 1), default=40, help="number of these touches (default: 40)")
    parser.add_argument("--compare", type=pathlib.Path, nargs="+", metavar="BIN",
                        help="folders of programs of several builds, each in its source folder; measures them by turns")
    parser.add_argument("--turns", type=at_least(int, 1), default=3, help="number of sessions of each of these builds (default: 3)")
    args = parser.parse_args()
    for program in ("Xvfb", "xdotool"):
        if shutil.which(program) is None:
            parser.error(f"{program} is missing; run scripts/install_dependencies.sh --with-tests")
    before = os.getloadavg()[0]
    try:
        if args.compare:
            print(compare(args) + "\n\n" + machine(before))
            return 0
        summary = measure(args)
    except Failed as complaint:
        print(f"pointer_latency.py: {complaint}", file=sys.stderr)
        return 1
    print(json.dumps(summary) if args.json else report(summary, before, FULL_HD if args.full_hd else SIZE))
    return 0


if __name__ == "__main__":
    sys.exit(main())
