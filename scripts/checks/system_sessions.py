#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs the sessions in which systems and versions of Open MPI differ, and checks each (docs/testing.md).

A rank is killed, and the session continues by itself. It is ended and resumed. Then the doctor examines an emulated cluster
in which each host comes several times, and a session runs there. In another emulated cluster, a spare takes the place of a
host that is cut off. Each rank must run on its host, and the hash must equal that of a replay of the journal. The exit status
is 0 if all of this holds, else 1.
"""

import json
import os
import pathlib
import signal
import subprocess
import sys
import time

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "launcher"))
from base import events, layout
from base.command_line import Parser
from job import processes

ROOT = pathlib.Path(__file__).resolve().parents[2]
PATIENCE_SECONDS = 300
HOSTS = 4  # of the emulated cluster, for 12 ranks
WALL = ("--wall", str(ROOT / "walls/configs/tiled_3x4.toml"), "--scene", str(ROOT / "scenes/writing.toml"))
HAND = ("--device", "script:gis", "--pace", "fast")


class Violation(Exception):
    """A result that this test forbids."""


def replayed(out):
    ended = subprocess.run([layout.program("sandwall-replay"), str(out / "session.journal"), "--hash"], capture_output=True, text=True)
    if ended.returncode != 0:
        raise Violation(f"the journal cannot be replayed: {ended.stderr.strip()}")
    return ended.stdout.split()[-1]


def check(out, hosts=None):
    """Returns the hash of a session that has ended. Throws Violation if it is not that of the replay, or if a rank ran elsewhere.

    `hosts` are the names of the ranks' machines, or None if all ranks run here.
    """
    summary = json.loads((out / "summary.json").read_text())
    if summary["state_hash"] != replayed(out):
        raise Violation(f"{out}: the hash is {summary['state_hash']}, and that of the replay is {replayed(out)}")
    ran = [rank["host"] for rank in summary["per_rank"]]
    if ran != (hosts or [os.uname().nodename] * len(ran)):
        raise Violation(f"{out}: the ranks ran on {' '.join(ran)}")
    return summary["state_hash"]


def run(command, log):
    """Runs a session to its end. Its output goes into the file `log`."""
    with open(log, "wb") as file:
        try:
            ended = subprocess.run(command, stdin=subprocess.DEVNULL, stdout=file, stderr=file, timeout=PATIENCE_SECONDS,
                                   env={**os.environ, events.VARIABLE: "1"})
        except subprocess.TimeoutExpired:
            raise Violation(f"still runs after {PATIENCE_SECONDS} s; see {log}") from None
    if ended.returncode != 0:
        raise Violation(f"ended with status {ended.returncode}; see {log}")


def rank_of(launcher, wanted):
    """Returns the process id of a rank of this launcher's session."""
    for entry in pathlib.Path("/proc").iterdir():
        try:
            if entry.name.isdigit() and (entry / "cmdline").read_bytes().split(b"\0")[0].endswith(b"/sandwall-render-node"):
                variables = (entry / "environ").read_bytes().split(b"\0")
                ours = any(word.startswith(f"{processes.MARK}={launcher.pid}-".encode()) for word in variables)
                if ours and f"OMPI_COMM_WORLD_RANK={wanted}".encode() in variables:
                    return int(entry.name)
        except OSError:
            pass  # the process has ended
    raise Violation(f"rank {wanted} does not run")


def kill_and_resume(out):
    """Kills a rank, lets the session continue, ends it, and resumes it."""
    command = [str(ROOT / "scripts/sandwall"), "run", *WALL, *HAND, "--gl", layout.in_memory(), "--no-pictures", "--out", str(out)]
    log = out.with_suffix(".log")
    with open(log, "wb") as file:
        launcher = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=file, stderr=file, env={**os.environ, events.VARIABLE: "1"},
                                    preexec_fn=processes.die_with(os.getpid()))
    if events.wait_for(log, "progress", PATIENCE_SECONDS, lambda: launcher.poll() is None) is None:
        raise Violation(f"no frame; see {log}")
    os.kill(rank_of(launcher, 5), signal.SIGKILL)
    restart = events.wait_for(log, "restart", PATIENCE_SECONDS, lambda: launcher.poll() is None)
    if restart is None or (restart["rank"], restart["how"]) != (5, "SIGKILL"):
        raise Violation(f"the launcher names the failure {restart}; see {log}")
    resumed = events.wait_for(log, "resumed", PATIENCE_SECONDS, lambda: launcher.poll() is None)
    time.sleep(3)
    launcher.send_signal(signal.SIGINT)
    if launcher.wait(PATIENCE_SECONDS) != 0 or resumed is None:
        raise Violation(f"ended with status {launcher.returncode}; see {log}")
    before = json.loads((out / "summary.json").read_text())["steps"]
    check(out)
    run([*command, "--resume", "--steps", str(before + 60)], out.with_suffix(".resumed.log"))
    return check(out)


def emulated(out, options, words, hosts):
    run([str(ROOT / "scripts/checks/emulate_cluster.sh"), "--out", str(out), *WALL, "--hosts", str(HOSTS), *options, "--", *HAND, *words],
        out.with_suffix(".log"))
    return check(out, hosts)


def dealt(names):
    return [names[rank % len(names)] for rank in range(12)]


def main():
    parser = Parser(description="Runs the sessions in which systems differ: a kill and a resume, and emulated clusters.")
    parser.add_argument("--out", default="out/system_sessions", help="folder for the sessions (default: out/system_sessions)")
    out = pathlib.Path(parser.parse_args().out)
    out.mkdir(parents=True, exist_ok=True)
    names = [f"node{number:02d}" for number in range(1, HOSTS + 1)]
    tests = {"kill_and_resume": lambda folder: kill_and_resume(folder),
             "hosts_that_come_again": lambda folder: emulated(folder, ["--doctor"], ["--steps", "60"], dealt(names)),
             "a_host_is_cut_off": lambda folder: emulated(folder, ["--spares", "1", "--cut", "node02@4"], ["--steps", "1500"],
                                                          dealt(["node01", f"node{HOSTS + 1:02d}", *names[2:]]))}
    failed = 0
    for name, test in tests.items():
        began = time.monotonic()
        try:
            print(f"ok     {name}: hash {test(out / name)}, {time.monotonic() - began:.0f} s", flush=True)
        except Violation as violation:
            failed += 1
            print(f"FAILED {name}: {violation}", flush=True)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
