#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Kills processes of a session at random times, and tests that no shown step is lost and the sand stays the same.

Each kill ends a render rank, the master or the haptic server with a random signal; STOP makes it hang. The session must
continue each time without losing a step that was shown. Its last state hash must equal that of an undisturbed replay of its
journal. The exit status is 0 if all of this holds, else 1. docs/recovery.md
"""

import json
import os
import pathlib
import random
import re
import signal
import statistics
import subprocess
import sys
import time

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "launcher"))
from ask import session_control, session_report, session_results, session_rules
from ask.session_lines import BAD
from base import events, layout
from base.bad_input import BadInput
from base.command_line import Parser, above
from job import processes

ROOT = pathlib.Path(__file__).resolve().parents[2]
SIGNALS = ("KILL", "SEGV", "ABRT", "TERM", "BUS", "STOP")
PROGRAMS = {"rank": "sandwall-render-node", "master": "sandwall-master", "server": "sandwall-haptic-server"}
PATIENCE_SECONDS = 180
LONGEST_CALM = 2.5  # seconds of frames between two kills


class Violation(Exception):
    """A result that the test forbids."""


class Session:
    """A session that scripts/sandwall supervises."""

    def __init__(self, args):
        self.out = pathlib.Path(args.out)
        self.out.mkdir(parents=True, exist_ok=True)
        self.log = open(self.out / "random_kills.log", "wb")
        self.command = [str(ROOT / "scripts" / "sandwall"), "run", "--wall", args.wall, "--scene", args.scene, "--out", args.out,
                        "--device", "script:gis", "--gl", layout.in_memory(), "--no-pictures",
                        "--restarts", "100000", "--restart-window", "0.001", *args.options]
        if args.frame_timeout is not None:
            self.command += ["--frame-timeout", str(args.frame_timeout)]
        self.launcher = None

    def start(self, *more):
        self.launcher = subprocess.Popen([*self.command, *more], stdin=subprocess.DEVNULL, stdout=self.log, stderr=self.log,
                                         env={**os.environ, events.VARIABLE: "1"},
                                         preexec_fn=processes.die_with(os.getpid()))

    def status(self):
        """Returns the answer to `ctl status`, or None while no master answers."""
        try:
            found = json.loads(session_control.ask(self.out, "status", patience=5))
            return found if found.get("ok") else None
        except (BadInput, ValueError, OSError):
            return None

    def wait(self, what, condition):
        """Waits until `condition(status)` is true, and returns its value. Throws Violation after PATIENCE_SECONDS."""
        deadline = time.monotonic() + PATIENCE_SECONDS
        while time.monotonic() < deadline:
            if self.launcher.poll() is not None:
                raise Violation(f"the session has ended with status {self.launcher.returncode}; see {self.log.name}")
            if (status := self.status()) and (found := condition(status)):
                return found
            time.sleep(0.01)
        raise Violation(f"{what}: not within {PATIENCE_SECONDS} s; see {self.log.name}")

    def recoveries(self):
        """Returns the recoveries that the master has recorded. It records each one after its first frame.

        Leaves out those of the haptic server, which the launcher records.
        """
        try:
            lines = (self.out / "recoveries.jsonl").read_text().splitlines()
            return [found for found in map(json.loads, lines) if found["state_hash"] is not None]
        except FileNotFoundError:
            return []

    def links(self):
        """Returns how often the master was linked to a haptic server."""
        return sum(event["event"] == "link" and event["state"] == "linked" for event in events.read(self.log.name))

    def processes(self, which):
        """Returns {rank: process id} of the render ranks, the master or the haptic server, whose key is 0."""
        found = {}
        for entry in pathlib.Path("/proc").iterdir():
            try:
                command = (entry / "cmdline").read_bytes().split(b"\0")[0].decode() if entry.name.isdigit() else ""
                if command.endswith("/" + PROGRAMS[which]) and self.owns(entry):
                    rank = re.search(rb"\0OMPI_COMM_WORLD_RANK=(\d+)\0", (entry / "environ").read_bytes())
                    found[int(rank[1]) if rank else 0] = int(entry.name)
            except OSError:
                pass  # the process has ended
        return found

    def owns(self, entry):
        parent = (entry / "stat").read_text().rpartition(")")[2].split()[1]
        return int(parent) == self.launcher.pid or f"{processes.MARK}={self.launcher.pid}-".encode() in (entry / "environ").read_bytes()

    def end(self):
        """Ends the session in order and returns its exit status."""
        self.launcher.send_signal(signal.SIGINT)
        return self.launcher.wait(PATIENCE_SECONDS)


def strike(session, which, name, chance):
    """Kills a process, waits until the wall continues, and prints a line. Returns the time until then [s]."""
    victims = session.processes(which)
    if not victims:
        raise Violation(f"no {which} runs")
    victim = chance.choice(sorted(victims))
    before, links = len(session.recoveries()), session.links()
    shown = session.wait("status", lambda status: status)
    began = time.monotonic()
    os.kill(victims[victim], signal.Signals["SIG" + name])
    who = f"rank {victim}" if which == "rank" else which
    if which == "server":
        session.wait("a hand", lambda _: session.links() > links)
        seconds, then = time.monotonic() - began, "hand linked again"
    else:
        session.wait("frames again", lambda _: len(session.recoveries()) > before)
        seconds = time.monotonic() - began
        recovery = session.recoveries()[before]
        resumed = recovery["checkpoint_step"] + recovery["replayed_steps"]
        if resumed < shown["step"]:
            raise Violation(f"step {shown['step']} was shown, but the session resumed at step {resumed}")
        named = (victim, "hung" if name == "STOP" else f"SIG{name}")  # the master is rank 0
        if (recovery["failed_rank"], recovery["failed_how"]) != named:
            raise Violation(f"{who} was ended by SIG{name}, but the report is: {recovery['failure']}")
        then = (f"resumed at step {resumed} (checkpoint {recovery['checkpoint_step']}), "
                f"{recovery['seconds_to_next_frame']:.2f} s from its detection to the next frame")
    print(f"{who:8} SIG{name:4}  shown: frame {shown['frame']}, step {shown['step']}; {seconds:6.2f} s  {then}", flush=True)
    return seconds


def check_end(session, status):
    """Throws Violation if the session failed, or if its last hash differs from that of an undisturbed replay."""
    if status not in (0, session_report.NOT_GOOD):
        raise Violation(f"the session ended with status {status}; see {session.log.name}")
    summary = session_results.read_summary(session.out)
    # Without steps the hand has no force, and each restart is a time without steps.
    if bad := [f"{name}: {words}" for mark, name, words in session_rules.lines_of(summary) if mark == BAD and name != "force"]:
        raise Violation(f"the session is not good: {'; '.join(bad)}")
    replayed = subprocess.run([layout.bin_folder() / "sandwall-replay", session.out / "session.journal", "--hash"], capture_output=True, text=True)
    found = (replayed.stdout.split() or [""])[-1]
    if replayed.returncode != 0 or found != summary["state_hash"]:
        raise Violation(f"the wall ended with {summary['state_hash']}, an undisturbed replay with '{found}' "
                        f"(status {replayed.returncode}) {replayed.stderr.strip()}")
    print(f"{summary['steps']} steps: {summary['state_hash']} on the wall and of an undisturbed replay; "
          f"{summary['divergences']} divergences, {len(session.recoveries())} recoveries")


def times(name, seconds):
    if seconds:
        print(f"{len(seconds):3} {name}: median {statistics.median(seconds):.2f} s, worst {max(seconds):.2f} s")


def main():
    parser = Parser(description=__doc__)
    parser.add_argument("--kills", type=int, default=5)
    parser.add_argument("--seed", type=int, default=None, help="seed of victims, signals and times (default: a random one, which is printed)")
    parser.add_argument("--wall", default=str(ROOT / "walls/configs/desktop.toml"))
    parser.add_argument("--scene", default=str(ROOT / "scenes/sandbox.toml"))
    parser.add_argument("--out", required=True)
    parser.add_argument("--victims", default="rank,master,server", help="programs to kill, separated by commas (default: rank,master,server)")
    parser.add_argument("--signals", default=",".join(SIGNALS))
    parser.add_argument("--frame-timeout", type=above(float, 0), default=3, help="seconds after which a hung rank is given up (default: 3)")
    parser.add_argument("options", nargs="*", help="after --: more options of sandwall run")
    args = parser.parse_args()
    seed = args.seed if args.seed is not None else random.randrange(1 << 32)
    print(f"seed {seed}", flush=True)
    chance = random.Random(seed)
    session = Session(args)
    frames, hands = [], []
    try:
        session.start()
        for _ in range(args.kills):
            session.wait("a hand", lambda status: status["linked"])
            time.sleep(chance.uniform(0, LONGEST_CALM))
            which, name = chance.choice(args.victims.split(",")), chance.choice(args.signals.split(","))
            if (which, name) == ("master", "TERM"):
                name = "KILL"  # TERM would end the session in order
            (hands if which == "server" else frames).append(strike(session, which, name, chance))
        check_end(session, session.end())
    except Violation as violation:
        print(f"random_kills.py: seed {seed}: {violation}", file=sys.stderr)
        return 1
    finally:
        if session.launcher and session.launcher.poll() is None:
            session.launcher.send_signal(signal.SIGINT)
            session.launcher.send_signal(signal.SIGINT)
            session.launcher.wait(PATIENCE_SECONDS)
    times("kills of the job, to the next frame", frames)
    times("kills of the haptic server, to the next linked hand", hands)
    return 0


if __name__ == "__main__":
    sys.exit(main())
