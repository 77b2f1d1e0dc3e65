#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Compares the time of sweeps with two builds. The builds run in turns on one core, because the speed of a machine changes.

Prints three tables. The first has the time of a sweep, for each code path of this processor. Its cells are: time per cell of
the field before and after, the same in copies of one number per cell, and the ratio of the times with the least and the most
of all rounds. A code path that the build BEFORE lacks is compared with the fastest one that it has. The second table has steps
of digging. The third table has what two threads gain, with both cores.

usage: scripts/figures/compare_sweeps.py BEFORE AFTER [--table sweeps|digging|threads] [--sizes 256,512,2048,4096]
           [--rounds 9] [--core 0]
"""

import json
import pathlib
import statistics
import subprocess
import sys
import tempfile

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "launcher"))
from base.command_line import BAD_INPUT, Parser, at_least, within
from report.report_data import Table

PATHS = ("baseline", "x86-64-v3", "x86-64-v4")
SAND = {"G": "all moves", "G band": "all moves, band", "G lumps": "lumps", "G lumps band": "lumps, band"}
THREADS = ("G", "G 2 threads", "loop", "loop 2 threads")


def sizes(text):
    return [within(int, 8, 4096)(side) for side in text.split(",")]


def throughput(folder, side, runs, rows, path=None, core=None):
    """Measures rows of `sandwall-bench throughput` with a build. Returns a Table, or None if it does not have the path."""
    with tempfile.NamedTemporaryFile(suffix=".csv") as file:
        command = [] if core is None else ["taskset", "-c", str(core)]
        command += [folder / "sandwall-bench", "throughput", "--sizes", str(side), "--runs", str(runs), "--rows", ",".join(rows),
                    "--out", file.name] + ([] if path is None else ["--path", path])
        ran = subprocess.run(command, capture_output=True, text=True)
        if ran.returncode == BAD_INPUT and "--path" in ran.stderr:
            return None
        if ran.returncode != 0:
            sys.exit(f"{folder}: {ran.stderr.strip()}")
        return Table(file.name)


def ratio(before, after):
    """Returns the median ratio of two lists of times that were measured in turns, with the least and the most."""
    ratios = sorted(b / a for a, b in zip(before, after))
    return f"{statistics.median(ratios):.2f} ({ratios[0]:.2f} to {ratios[-1]:.2f})"


def in_turns(rounds, measures):
    """Calls each of `measures` once in a round, in the other order in every second round. Returns their lists of values."""
    values = [[] for _ in measures]
    for number in range(rounds):
        for which in sorted(range(len(measures)), reverse=number % 2 == 1):
            values[which].append(measures[which]())
    return values


def sweep_rows(before, after, args):
    """Yields the header of the table of sweeps, and its rows."""
    has = [[path for path in PATHS if throughput(build, 8, 1, ["copy"], path)] for build in (before, after)]
    ways = [(before, path) for path in has[0]] + [(after, path) for path in has[1]]
    pairs = [(path, ways.index((before, path if path in has[0] else has[0][-1])), ways.index((after, path))) for path in has[1]]
    yield ["N", "sand"] + [path if ways[b][1] == path else f"{path} after {ways[b][1]}" for path, b, _ in pairs]
    for side in args.sizes:
        tables = in_turns(args.rounds, [lambda way=way: throughput(way[0], side, args.runs, SAND, way[1], args.core) for way in ways])
        for row, name in SAND.items():
            def times(which, column):
                return [table.one(column, variant=row) for table in tables[which]]
            cells = []
            for _, b, a in pairs:
                ns, copies = ([statistics.median(times(which, column)) for which in (b, a)]
                              for column in ("ns_per_cell_median", "times_copy"))
                cells.append(f"{ns[0]:.3g} → {ns[1]:.3g} ns, {copies[0]:.3g} → {copies[1]:.3g} copies, "
                             f"{ratio(times(b, 'ns_per_cell_median'), times(a, 'ns_per_cell_median'))}")
            yield [str(side), name] + cells


def digging(folder, core):
    """Returns the time of a step of digging for each tool [ms]."""
    command = ["taskset", "-c", str(core), folder / "sand_bench", "--benchmark_filter=^dig/", "--benchmark_format=json"]
    rows = json.loads(subprocess.run(command, capture_output=True, text=True, check=True).stdout)["benchmarks"]
    return {row["name"].split("/")[1]: row["cpu_time"] for row in rows}


def dig_rows(before, after, args):
    yield ["a step of digging", "before [ms]", "after [ms]", "ratio"]
    both = in_turns(args.rounds, [lambda: digging(before, args.core), lambda: digging(after, args.core)])
    for name in both[1][0]:
        times = [[run[name] for run in runs] for runs in both]
        yield [name.replace("_", " "), *(f"{statistics.median(values):.3g}" for values in times), ratio(*times)]


def thread_rows(before, after, args):
    yield ["N", "build", "two threads, G", "two threads, loop without memory"]
    for side in args.sizes:
        both = in_turns(args.rounds, [lambda build=build: throughput(build, side, args.runs, THREADS) for build in (before, after)])
        for name, tables in zip(("before", "after"), both):
            times = [[table.one("ns_per_cell_median", variant=row) for table in tables] for row in THREADS]
            yield [str(side), name, f"{ratio(times[1], times[0])} ×", f"{ratio(times[3], times[2])} ×"]


TABLES = {"sweeps": sweep_rows, "digging": dig_rows, "threads": thread_rows}


def main():
    parser = Parser(description=__doc__.splitlines()[0])
    parser.add_argument("before", type=pathlib.Path, metavar="BEFORE", help="folder of programs of a build")
    parser.add_argument("after", type=pathlib.Path, metavar="AFTER", help="folder of programs of the other build")
    parser.add_argument("--table", choices=TABLES, help="measure only this table")
    parser.add_argument("--sizes", type=sizes, default=[256, 512, 2048, 4096], help="sides of the fields [cell], separated by commas")
    parser.add_argument("--rounds", type=at_least(int, 1), default=9, help="number of turns of both builds (default: 9)")
    parser.add_argument("--runs", type=at_least(int, 1), default=1, help="number of runs of a row in a turn (default: 1)")
    parser.add_argument("--core", type=at_least(int, 0), default=0, help="core for the first two tables (default: 0)")
    args = parser.parse_args()
    before, after = args.before.resolve(), args.after.resolve()
    for program in (folder / name for folder in (before, after) for name in ("sandwall-bench", "sand_bench")):
        if not program.is_file():
            parser.error(f"{program} is missing; build it (sand_bench: --target benchmarks)")
    for table in [TABLES[args.table]] if args.table else TABLES.values():
        rows = table(before, after, args)
        header = next(rows)
        print(f"| {' | '.join(header)} |\n|{'---|' * len(header)}", flush=True)
        for row in rows:
            print(f"| {' | '.join(row)} |", flush=True)
        print()
    return 0


if __name__ == "__main__":
    sys.exit(main())
