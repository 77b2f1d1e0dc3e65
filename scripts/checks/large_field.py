#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs a session on a large field through all that an operator and a failure can do to it, with all limits at their defaults.

Makes a raster of --side cells a side. Digs --steps steps, saves, undoes, loads, waits for a checkpoint, kills a rank and the
haptic server, ends the session in order, and resumes it. The last state hash must equal that of an undisturbed replay of the
journal. Prints a line for each phase, with its time and the largest memory of each program. --busy N runs N busy processes
beside. The exit status is 0 if all of this holds, else 1. docs/recovery.md
"""

import array
import contextlib
import json
import math
import os
import pathlib
import random
import signal
import subprocess
import sys
import tempfile
import time

sys.dont_write_bytecode = True
sys.path[:0] = [str(pathlib.Path(__file__).resolve().parents[1] / room) for room in ("checks", "figures", "launcher")]
import random_kills
from ask import session_control, session_results
from base import events
from base.command_line import Parser, at_least
from random_kills import Session, Violation, check_end, strike
from sessions.raster_session import HEADER, busy_processes, make_scene, memory_of
from sessions.session_cost import WALL

ROOT = pathlib.Path(__file__).resolve().parents[2]
PATIENCE = 600  # [s], of a phase on a busy machine
NOISE = 1.25  # largest ratio of two times that may be equal


def make_rough(folder, side):
    """Writes a scene with a raster that can hardly be compressed, and whose sand rests. Returns its file."""
    scene, noise = make_scene(folder, 64, rough=False), random.Random(1)
    # The upper half of a float from 256 to 512 has steps of 2 m. The lower half is noise.
    upper = array.array("H", (0x4380 + round(60 + 40 * math.sin(x / 300) + 12 * math.sin(x / 70)) for x in range(side + 2000)))
    row = array.array("H", bytes(4 * side))
    with (folder / "start.bil").open("wb") as file:
        for y in range(side):
            shift = round(400 * (1 + math.sin(y / 260)))
            row[0::2], row[1::2] = array.array("H", noise.randbytes(2 * side)), upper[shift:shift + side]
            file.write(row.tobytes())
    (folder / "start.hdr").write_text(HEADER.replace("NBITS 16", "NBITS 32").replace("SIGNEDINT", "FLOAT").format(order="I", side=side))
    return scene


class Phases:
    """Prints a line for each phase: its time, and the largest memory of each program so far."""

    def __init__(self, session, cells):
        self.session, self.cells, self.began = session, cells, time.monotonic()

    def done(self, name):
        """Returns the time of the phase that ends now [s]."""
        seconds = time.monotonic() - self.began
        peaks = memory_of(self.session.launcher.pid)
        print(f"{name:36} {seconds:7.1f} s   byte/cell now (peak): "
              + ", ".join(f"{program.removeprefix('sandwall-')} {now / self.cells:.1f} ({peak / self.cells:.1f})" for program, (now, peak) in peaks.items()),
              flush=True)
        self.began = time.monotonic()
        return seconds


def ask(session, command):
    """Sends a command to the session, and returns its answer. Throws Violation if it is refused."""
    answer = json.loads(session_control.ask(session.out, command, patience=PATIENCE))
    if not answer.get("ok"):
        raise Violation(f"{command}: {answer}")
    return answer


def wait_for_event(session, name, **fields):
    if events.wait_for(session.log.name, name, PATIENCE, lambda: session.launcher.poll() is None, **fields) is None:
        raise Violation(f"no event {name} {fields}; see {session.log.name}")


def checkpoints_of(session):
    return list((session.out / "checkpoints").glob("*")) if (session.out / "checkpoints").is_dir() else []


def first_life(session, phases, args):
    """Starts the session, and does all that an operator does. Returns the time of the start [s]."""
    session.start(*(["--inject", f"diverge:rank=1,frame={args.steps}"] if args.ranks > 1 else []))
    wait_for_event(session, "progress")
    started = phases.done("start to the first frame")
    session.wait("a hand", lambda status: status["linked"])
    session.wait("steps", lambda status: status["step"] >= args.steps)
    phases.done(f"{args.steps} steps of digging")
    for command in ("save checked", "undo", "load checked"):
        ask(session, command)
        phases.done(command)
    session.wait("a checkpoint", lambda _: checkpoints_of(session))
    phases.done("a checkpoint is written")
    return started


def resumed_life(session, phases, started):
    """Resumes the session. Throws Violation if that takes clearly longer than the start did."""
    session.log.flush()
    session.log = open(session.out / "resumed.log", "wb")
    phases.began = time.monotonic()
    session.start("--resume")
    wait_for_event(session, "progress")
    again = phases.done("resumed to the first frame")
    if again > NOISE * started:
        raise Violation(f"the session resumed in {again:.1f} s, but started in {started:.1f} s")


def lives(session, args):
    cells, chance = args.side ** 2, random.Random(1)
    phases = Phases(session, cells)
    started = first_life(session, phases, args)
    for which in ("rank", "server"):
        session.wait("a hand", lambda status: status["linked"])
        time.sleep(1)  # its event may come after the status
        strike(session, which, "KILL", chance)
        phases.done(f"killed a {which}, and continued")
    check_end(session, session.end())
    if args.ranks > 1 and not session_results.read_summary(session.out)["divergences"]:
        raise Violation("no rank was healed")
    phases.began = time.monotonic()
    resumed_life(session, phases, started)
    session.wait("a hand", lambda status: status["linked"])
    check_end(session, session.end())


def main():
    parser = Parser(prog="large_field.py", description=__doc__.splitlines()[0])
    parser.add_argument("--side", type=at_least(int, 64), default=10012, help="side of the raster [pixel] (default: 10012)")
    parser.add_argument("--steps", type=at_least(int, 1), default=300, help="steps of digging (default: 300)")
    parser.add_argument("--ranks", type=at_least(int, 1), default=1, help="render ranks; with 2, one of them is healed (default: 1)")
    parser.add_argument("--smooth", action="store_true", help="leaves out the noise of the heights")
    parser.add_argument("--busy", type=at_least(int, 0), default=0, help="processes that are busy beside the session (default: 0)")
    parser.add_argument("--out", required=True, help="folder for the session, which has some gigabytes")
    args = parser.parse_args()
    if sys.byteorder != "little":
        parser.error("the raster is made on little-endian machines only")
    random_kills.PATIENCE_SECONDS = PATIENCE
    session = None
    try:
        with busy_processes(args.busy), tempfile.TemporaryDirectory(prefix="sandwall-large-") as name:
            folder = pathlib.Path(name)
            (folder / "wall.toml").write_text(WALL.replace("columns = 2", f"columns = {args.ranks}"))
            args.scene, args.wall = str(make_scene(folder, args.side, rough=False) if args.smooth else make_rough(folder, args.side)), str(folder / "wall.toml")
            args.options, args.frame_timeout = ["--here"], None
            session = Session(args)
            lives(session, args)
    except Violation as violation:
        print(f"large_field.py: {violation}", file=sys.stderr)
        return 1
    finally:
        if session and session.launcher and session.launcher.poll() is None:
            session.launcher.send_signal(signal.SIGTERM)
            with contextlib.suppress(subprocess.TimeoutExpired):
                session.launcher.wait(60)
    print(f"all of it held, {args.busy} busy processes beside, load average {os.getloadavg()[0]:.1f}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
