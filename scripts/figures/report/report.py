#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Measures the sand, draws the curves and writes docs/report: README.md, pictures, and their tables.

scripts/report.sh runs this script with Debian's own interpreter.
"""

import fcntl
import importlib.util
import os
import pathlib
import subprocess
import sys

sys.dont_write_bytecode = True
sys.path[:0] = [str(pathlib.Path(__file__).resolve().parents[2] / room) for room in ("figures", "launcher")]
from base.command_line import BAD_INPUT, Parser
from report.report_check import check
from report.report_measure import Measuring, expected, minutes, state_of, total
from report.report_page import write_page
from report.report_parts import PARTS, PRESETS, ROOT, release
from report.report_text import SECTIONS

INTERRUPTED = 130


def options(arguments):
    parser = Parser(prog="report.sh", description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="smaller fields and fewer runs, into out/report unless --out names another folder")
    what = parser.add_mutually_exclusive_group()
    what.add_argument("--list", action="store_true", help="only print the parts, whether their tables are those of the present sources, and the time that they take")
    what.add_argument("--check", action="store_true", help="measure the smallest N of each table again, and compare errors, sweeps and hashes; at most two minutes for each, after building")
    what.add_argument("--draw", action="store_true", help="only draw the pictures and write the text, from the tables that exist")
    parser.add_argument("--out", type=pathlib.Path, metavar="DIR", help="folder of the report (default: docs/report)")
    args = parser.parse_args(arguments)
    args.out = args.out or ROOT / ("out/report" if args.quick else "docs/report")
    return args


def build(parts, programs):
    """Builds the programs of `parts`: the paths `programs`. Returns why this failed, or None."""
    commands = [["scripts/install_dependencies.sh"], ["cmake", "--preset", "release"]]
    sessions = {"ranks", "latency"} & {part.name for part in parts}  # these need all programs
    targets = [] if sessions else ["--target", "sandwall_bench", "detail_bench"]
    commands.append(["cmake", "--build", "build/release", "--parallel", *targets])
    for preset in (preset for preset in PRESETS[1:] if any(program.startswith(f"build/{preset}/") for program in programs)):
        commands += [["cmake", "--preset", preset], ["cmake", "--build", f"build/{preset}", "--parallel", "--target", "sandwall_bench"]]
    for command in commands:
        ran = subprocess.run(command, cwd=ROOT, stdout=subprocess.DEVNULL if "--preset" in command else None)
        if ran.returncode != 0:
            return f"`{' '.join(command)}` failed"
    return None


def print_list(parts, data, quick, root):
    waiting = []
    for part in parts:
        why = state_of(part, data, quick, root)
        waiting += [part] if why else []
        print(f"{part.name:22} {minutes(expected(part, data, quick)):>7}  {str(why or 'valid').removeprefix(part.name + '.csv: ')}")
    cores = len(os.sched_getaffinity(0))
    print(f"all {len(parts)} parts take about {minutes(total(parts, data, quick, cores))}; "
          f"{len(waiting)} to measure, about {minutes(total(waiting, data, quick, cores) if waiting else 0)}, without building")


def lock(data):
    """Locks the folder. Returns its descriptor, which holds the lock, or None if another report holds it."""
    folder = os.open(data, os.O_RDONLY)
    try:
        fcntl.flock(folder, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        os.close(folder)
        return None
    return folder


def run(arguments, parts=PARTS, sections=SECTIONS, prepare=build, root=ROOT):
    """Runs the script. Tests pass made-up parts. Returns the exit status."""
    args = options(arguments)
    data = args.out / "data"
    parts = [part for part in parts if part.options(args.quick) is not None]
    if args.list:
        print_list(parts, data, args.quick, root)
        return 0
    if args.check:
        if why := prepare(parts, {part.check_program or part.program for part in parts}):
            print(f"report.sh: {why}", file=sys.stderr)
            return 1
        return 1 if check(parts, data, args.quick, root, len(os.sched_getaffinity(0))) else 0
    if importlib.util.find_spec("matplotlib") is None and any(section.figure for section in sections):
        print("report.sh: Debian's python3-matplotlib is missing; run scripts/install_dependencies.sh --with-report", file=sys.stderr)
        return BAD_INPUT
    try:
        data.mkdir(parents=True, exist_ok=True)
        held = lock(data)
    except OSError as error:
        print(f"report.sh: {error.filename}: cannot be written ({error.strerror}); choose another --out", file=sys.stderr)
        return BAD_INPUT
    if held is None:
        print(f"report.sh: another report.sh measures into {args.out}; wait for it, or choose another --out", file=sys.stderr)
        return BAD_INPUT
    failures, status = {}, 0
    try:
        if not args.draw:
            waiting = [part for part in parts if state_of(part, data, args.quick, root)]
            if waiting and (why := prepare(waiting, {part.program for part in waiting})):
                print(f"report.sh: {why}", file=sys.stderr)
                return 1
            measuring = Measuring(parts, data, args.quick, root)
            failures = measuring.failures
            measuring.run()
    except KeyboardInterrupt:
        print("report.sh: interrupted; the tables that are whole are kept, and the next call measures the others", file=sys.stderr)
        status = INTERRUPTED
    old = {part.name: why for part in parts if (why := state_of(part, data, args.quick, root))}
    complaints = write_page(args.out, sections, parts, {**old, **failures}, release(root))
    for complaint in [*complaints, *(why for why in failures.values() if not any(why in line for line in complaints))]:
        print(f"report.sh: {complaint}", file=sys.stderr)
    print(f"the report: {args.out}/README.md")
    return status or (1 if complaints or failures else 0)


if __name__ == "__main__":
    sys.exit(run(sys.argv[1:]))
