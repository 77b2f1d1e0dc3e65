#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Measures latency as Dorjgotov et al. 2007 did, on this machine alone: half of the round trip of a test message.

Runs whole sessions for that paper's three walls, directly and over a link that replaces a wireless one, and prints a table
in Markdown. `sandwall-bench latency` runs this script; docs/latency.md explains the table.
"""

import json
import os
import pathlib
import subprocess
import sys
import tempfile
from dataclasses import dataclass

sys.dont_write_bytecode = True
sys.path[:0] = [str(pathlib.Path(__file__).resolve().parents[2] / room) for room in ("figures", "launcher")]
from base.command_line import within
from job import open_mpi, rank_hosts
from sessions.measured_session import (BIN, REFRESH, SCENE, START_SECONDS, Failed, Helper, Load, Parser, circles, processor,
                                       session, smaller, stop_on_signals, write_csv)

PROGRAMS = ("sandwall-haptic-server", "sandwall-master", "sandwall-render-node", "sandwall-check", "sandwall-impaired-link",
            "sandwall-latency-floor")
FLOOR_SECONDS = 3  # longest measurement of a floor
TESTS_PER_SECOND = 20
# Replaces a wireless network: a piece takes 3 to 9 ms, and one in fifty is lost and sent again.
WIRELESS = {"delay": 3, "jitter": 6, "loss": 0.02, "stall": 40}


@dataclass
class Wall:
    name: str
    file: str
    nodes: int  # in Dorjgotov et al. 2007
    paper: dict  # by link: mean and standard deviation [ms]


WALLS = [Wall("portable", "portable.toml", 1, {"wired": (16.2, 9.8), "wireless": (24.9, 14.8)}),
         Wall("FLEX", "flex_cave.toml", 4, {"wired": (9.7, 5.6), "wireless": (16.0, 12.3)}),
         Wall("tiled wall", "tiled_3x4.toml", 13, {"wired": (13.6, 9.8), "wireless": (16.2, 14.0)})]
LOADS = [Load("digging", 2, True, True), Load("still", 16, False, False)]
LINKS = {"direct": "wired", "impaired": "wireless"}  # link here: link of the paper that it replaces


def impaired(address, seed):
    """Starts a link to `address` that replaces a wireless one."""
    options = [word for key, value in WIRELESS.items() for word in ("--" + key, value)]
    return Helper(BIN / "sandwall-impaired-link", "--to", address, "--seed", seed, "--die-with-parent", *options)


class Through:
    """The address of a program, or of an impaired link to it if `link` is "impaired"."""

    def __init__(self, link, address, seed):
        self.helper = impaired(address, seed) if link == "impaired" else None
        self.address = self.helper.address if self.helper else address

    def __enter__(self):
        return self.address

    def __exit__(self, *_):
        if self.helper:
            self.helper.stop()


def floor(*words):
    command = " ".join(map(str, words))
    try:
        said = subprocess.run([str(word) for word in words], capture_output=True, text=True, timeout=START_SECONDS,
                              env=dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1",
                                       OMPI_MCA_mpi_yield_when_idle="1", HWLOC_COMPONENTS="-gl"))
    except subprocess.TimeoutExpired:
        raise Failed(f"{command}: not done after {START_SECONDS} s") from None
    except OSError as error:
        raise Failed(f"{command}: cannot be run ({error.strerror})") from None
    if said.returncode != 0:
        raise Failed(f"{command}: {said.stderr.strip()[-300:]}")
    try:
        return json.loads(said.stdout.splitlines()[-1])
    except (IndexError, ValueError):
        raise Failed(f"{command}: printed no result: {said.stdout.strip()[-300:]}") from None


def message_floor(link, size, args):
    with Helper(BIN / "sandwall-latency-floor", "echo") as echo, Through(link, echo.address, args.seed) as address:
        return floor(BIN / "sandwall-latency-floor", "message", "--to", address, "--bytes", size,
                     "--seconds", min(FLOOR_SECONDS, args.seconds), "--seed", args.seed)


def frame_floor(ranks, size, args):
    program = [str(word) for word in (BIN / "sandwall-latency-floor", "frame", "--bytes", size, "--seconds", min(FLOOR_SECONDS, args.seconds))]
    return floor(*open_mpi.Question().answer().command(open_mpi.Job(program, program, [rank_hosts.HERE] * ranks)))


def measure(wall, link, load, args):
    """Returns one row of the table: a session, then the floor with messages and frames as long as the session's."""
    with tempfile.TemporaryDirectory(prefix="sandwall-latency-") as name:
        folder = pathlib.Path(name)
        strokes = folder / "hand.strokes"
        # Strokes without end; or a single point, after which the hand hovers.
        strokes.write_text(circles(args.warm_up + args.seconds + START_SECONDS) if load.digs else "stroke\npoint 0 0\n")
        wall_file, pixels = smaller(folder, wall, load)
        with Helper(BIN / "sandwall-haptic-server", "--scene", SCENE, "--device", f"script:{strokes}", "--listen", "127.0.0.1:0",
                    "--timing-tests", TESTS_PER_SECOND, "--timing-after", args.warm_up, "--timing-seed", args.seed,
                    "--die-with-parent") as server, Through(link, server.address, args.seed) as haptic:
            summary = session(folder, wall_file, load, haptic, args)
    haptic = summary["haptic"]
    if not haptic or "half_round_trip_ms" not in haptic or haptic["half_round_trip_ms"]["count"] == 0:
        raise Failed(f"{wall.name}: no timing test was answered")
    message = message_floor(link, round(haptic["step_message_bytes"]), args)
    frame = frame_floor(summary["ranks"], round(summary["broadcast_bytes"]["p50"]), args)
    return {"wall": wall.name, "nodes": wall.nodes, "ranks": summary["ranks"], "link": link, "load": load.name,
            "eye_pixels": f"{pixels[0]}x{pixels[1]}", "paper_mean": wall.paper[LINKS[link]][0], "paper_stddev": wall.paper[LINKS[link]][1],
            **spread("wall", haptic["half_round_trip_ms"]), **spread("master", haptic["half_round_trip_to_master_ms"]),
            "floor_message_mean": message["mean_ms"], "floor_message_stddev": message["stddev_ms"], "floor_message_p50": message["p50_ms"],
            "floor_frame_mean": frame["mean_ms"], "floor_frame_stddev": frame["stddev_ms"], "floor_frame_p50": frame["p50_ms"],
            "floor_p50": message["p50_ms"] + frame["p50_ms"] / 2, "frame_mean": summary["frame_ms"]["mean"],
            "step_bytes": haptic["step_message_bytes"], "reconnects": haptic["reconnects"],
            "divergences": summary["divergences"] + summary["server_divergences"]}


def spread(leg, trip):
    return {f"{leg}_mean": trip["mean"], f"{leg}_stddev": trip["stddev"], f"{leg}_p50": trip["p50"], f"{leg}_p99": trip["p99"],
            f"{leg}_count": trip["count"]}


def pm(mean, deviation, digits=1):
    return f"{mean:.{digits}f} ± {deviation:.{digits}f}"


HEADER = ["wall, nodes in Dorjgotov et al. 2007", "link", "shows", "Dorjgotov et al. 2007", "wall has swapped", "master has it",
          "floor: message", "floor: broadcast + barrier", "floor: sum, medians", "frame", "tests"]


def cells(row):
    stands_for = {"direct": "direct (wired)", "impaired": "impaired (replaces wireless)"}[row["link"]]
    return [f"{row['wall']}, {row['nodes']}", stands_for, f"{row['load']}, {row['eye_pixels'].replace('x', ' × ')}",
            pm(row["paper_mean"], row["paper_stddev"]), pm(row["wall_mean"], row["wall_stddev"]),
            pm(row["master_mean"], row["master_stddev"], 2), pm(row["floor_message_mean"], row["floor_message_stddev"], 2),
            pm(row["floor_frame_mean"], row["floor_frame_stddev"], 3), f"{row['floor_p50']:.2f}", f"{row['frame_mean']:.1f}",
            str(row["wall_count"])]


def notes(args, before):
    cores = len(os.sched_getaffinity(0))
    return [f"machine: {processor()}, {cores} cores that the haptic server, the master and all render ranks share; OSMesa draws on the "
            f"same cores; load average {before:.1f} before and {os.getloadavg()[0]:.1f} after",
            f"All figures are in ms, mean ± standard deviation. {TESTS_PER_SECOND} test messages a second were sent at random (Poisson) times "
            f"from seed {args.seed}, for {args.seconds:g} s after {args.warm_up:g} s of warm-up. Walls ran at {REFRESH} frames a second.",
            "Impaired link: every piece takes {delay} to {late} ms. {loss:.0%} of the pieces take {stall} ms more, and all pieces behind them wait. ".format(
                late=WIRELESS["delay"] + WIRELESS["jitter"], **WIRELESS) + f"The seed is {args.seed}. This link replaces a wireless network, and is not one.",
            "Digging: that paper's tool on 512² cells, both eyes. Still: settled sand, one eye, so that hardly anything is drawn. Pixels are those of one eye."]


def parse():
    parser = Parser(prog="sandwall-bench latency", description=__doc__)
    parser.add_argument("--seconds", type=within(float, 1, 3600), default=20, help="seconds of each session after its warm-up (default: 20)")
    parser.add_argument("--seed", type=within(int, 0, 2**32 - 1), default=7, help="seed of the random times and of the impaired link (default: 7)")
    parser.add_argument("--warm-up", type=within(float, 0, 3600), default=5, help="seconds at the start of each session that do not count (default: 5)")
    parser.add_argument("--walls", default="portable,FLEX,tiled wall", help="names of walls, separated by commas (default: portable,FLEX,tiled wall)")
    parser.add_argument("--links", default="direct,impaired", help="names of links, separated by commas (default: direct,impaired)")
    parser.add_argument("--loads", default="digging,still", help="names of loads, separated by commas (default: digging,still)")
    parser.add_argument("--out", type=pathlib.Path, help="CSV file to write with the same table")
    args = parser.parse_args()
    args.walls = parser.chosen("--walls", args.walls, {wall.name: wall for wall in WALLS})
    args.links = parser.chosen("--links", args.links, {link: link for link in LINKS})
    args.loads = parser.chosen("--loads", args.loads, {load.name: load for load in LOADS})
    if args.out and not args.out.parent.is_dir():
        parser.error(f"--out {args.out}: its folder does not exist; create it first")
    for program in PROGRAMS:
        if not (BIN / program).is_file():
            parser.error(f"{BIN / program}: not built yet; run cmake --build build/release")
    return args


def main():
    args = parse()
    stop_on_signals()
    before = os.getloadavg()[0]
    rows = []
    print("| " + " | ".join(HEADER) + " |\n|" + "---|" * len(HEADER), flush=True)
    try:
        for load in args.loads:
            for wall in args.walls:
                for link in args.links:
                    rows.append(measure(wall, link, load, args))
                    print("| " + " | ".join(cells(rows[-1])) + " |", flush=True)
    except Failed as complaint:
        print(f"sandwall-bench latency: {complaint}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        return 130
    said = notes(args, before)
    print("\n" + "\n".join(f"- {line}" for line in said))
    return write_csv(args.out, rows, said, "sandwall-bench latency") if args.out else 0


if __name__ == "__main__":
    sys.exit(main())
