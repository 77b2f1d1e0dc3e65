#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Compares what an untouched wall costs with several builds: growth of its journal and log, bytes written, processor time.

Runs one session of each build after the other, without a hand. BIN is a build's folder of programs; the scripts/sandwall of its
own source folder starts them. Prints a table in Markdown. docs/figures.md has one.

usage: scripts/figures/sessions/rest_cost.py BIN [BIN ...] [--seconds 600] [--settle 5]
"""

import json
import os
import pathlib
import subprocess
import sys
import tempfile
import time

sys.dont_write_bytecode = True
sys.path[:0] = [str(pathlib.Path(__file__).resolve().parents[2] / room) for room in ("figures", "launcher")]
from base import events, layout
from base.command_line import above, at_least
from sessions.measured_session import ROOT, START_SECONDS, Failed, Parser, die_with_parent, processor

HERTZ = os.sysconf("SC_CLK_TCK")


def family_of(root):
    """Returns the process `root` and all processes below it."""
    parents = {}
    for folder in pathlib.Path("/proc").glob("[0-9]*"):
        try:
            parents[int(folder.name)] = int((folder / "stat").read_text().rsplit(")", 1)[1].split()[1])
        except OSError:
            continue  # the process has ended
    family = [root]
    for process in family:
        family += [child for child, parent in parents.items() if parent == process]
    return family


def counters(run, launcher, out):
    """Returns what the session has used until now: {name with unit: count}."""
    used = {"journal [byte]": sum(path.stat().st_size for path in out.glob("session.journal*")),
            "log [byte]": sum(path.stat().st_size for path in (out / "log").glob("*") if path.is_file()),
            "written to the disk [byte]": 0, "written by system calls [byte]": 0, "processor [s]": 0.0}
    for process in family_of(run.pid):
        try:
            folder = pathlib.Path("/proc") / str(process)
            io = dict(line.split(": ") for line in (folder / "io").read_text().splitlines())
            times = (folder / "stat").read_text().rsplit(")", 1)[1].split()
        except OSError:
            continue
        used["written to the disk [byte]"] += int(io["write_bytes"])
        used["written by system calls [byte]"] += int(io["wchar"])
        used["processor [s]"] += (int(times[11]) + int(times[12])) / HERTZ
    status = json.loads(subprocess.run([launcher, "ctl", out, "status"], capture_output=True, text=True, check=True).stdout)
    return {**used, "frames": status["frame"], "steps": status["step"]}


def measure(programs, folder, args):
    """Returns the growth of the counters of a session with this build while it rests."""
    launcher, out, log = programs.parents[2] / "scripts" / "sandwall", folder / "out", folder / "log.txt"
    command = [launcher, "run", "--here", "--wall", args.wall, "--scene", args.scene, "--device", "none", "--no-pictures",
               "--gl", layout.in_memory(), "--out", out]
    with log.open("w") as said:
        run = subprocess.Popen([str(word) for word in command], stdin=subprocess.PIPE, stdout=said, stderr=subprocess.STDOUT, text=True,
                               env=dict(os.environ, SANDWALL_BIN=str(programs), **{events.VARIABLE: "1"}), preexec_fn=die_with_parent)
    try:
        if events.wait_for(log, "progress", START_SECONDS, lambda: run.poll() is None) is None:
            raise Failed(f"{programs}: no frame was shown: {log.read_text(errors='replace').strip()[-300:]}")
        time.sleep(args.settle)
        before = counters(run, launcher, out)
        time.sleep(args.seconds)
        after = counters(run, launcher, out)
        run.communicate("stop\n", timeout=START_SECONDS)
        if run.returncode != 0:
            raise Failed(f"{programs}: the session failed: {log.read_text(errors='replace').strip()[-300:]}")
    finally:
        if run.poll() is None:
            run.terminate()
            run.wait(timeout=START_SECONDS)
    return {what: after[what] - before[what] for what in after}


def text_of(value):
    return f"{value:.2f}" if isinstance(value, float) else str(value)


def main():
    parser = Parser(prog="rest_cost.py", description=__doc__.splitlines()[0])
    parser.add_argument("programs", nargs="+", type=pathlib.Path, metavar="BIN", help="a build's folder of programs")
    parser.add_argument("--seconds", type=above(float, 0), default=600, help="seconds of rest that are measured (default: 600)")
    parser.add_argument("--settle", type=at_least(float, 0), default=5, help="seconds before them (default: 5)")
    parser.add_argument("--scene", default=ROOT / "scenes" / "writing.toml", help="scene file (default: scenes/writing.toml)")
    parser.add_argument("--wall", default="desktop", help="wall: a sample's name or a file (default: desktop)")
    parser.add_argument("--folder", type=pathlib.Path, help="folder for the sessions, on the disk to be measured (default: a temporary one)")
    args = parser.parse_args()
    load, rows = os.getloadavg()[0], []
    try:
        for programs in args.programs:
            with tempfile.TemporaryDirectory(prefix="sandwall-rest-", dir=args.folder) as name:
                rows.append(measure(programs.resolve(), pathlib.Path(name), args))
    except Failed as complaint:
        print(f"rest_cost.py: {complaint}", file=sys.stderr)
        return 1
    print(f"| {args.seconds:g} s of rest |" + "".join(f" {programs} |" for programs in args.programs) + "\n|---|" + "---|" * len(rows))
    for what in rows[0]:
        print(f"| {what} |" + "".join(f" {text_of(row[what])} |" for row in rows))
    print(f"\n- machine: {processor()}, {len(os.sched_getaffinity(0))} cores; load average {load:.1f} before and {os.getloadavg()[0]:.1f} after")
    return 0


if __name__ == "__main__":
    sys.exit(main())
