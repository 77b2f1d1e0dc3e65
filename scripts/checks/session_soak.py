#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs a session at full rate for minutes or hours, and tests that nothing grows, leaks or gets lost.

Samples resident memory, file descriptors and threads of every process, and ends the session in order. Compares the wall's
last state hash and steps with a replay of the journal. Prints a table in Markdown. The exit status is 1 if descriptors or
threads change after the warm-up, if memory grows, or if sand or steps differ. docs/recovery.md
"""

import os
import pathlib
import re
import signal
import statistics
import subprocess
import sys
import time

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "launcher"))
from ask import session_results
from base import layout
from base.command_line import Parser, above, at_least
from job import processes

ROOT = pathlib.Path(__file__).resolve().parents[2]
NAMES = ("mpirun", "prterun", "sandwall-master", "sandwall-render-node", "sandwall-haptic-server")
MOST_GROWTH = 1.0  # largest growth of a process [MiB per hour]
START_SECONDS = 120


def family(launcher):
    """Returns {process id: name} of the session's programs."""
    found = {}
    for entry in pathlib.Path("/proc").iterdir():
        try:
            name = pathlib.Path((entry / "cmdline").read_bytes().split(b"\0")[0].decode()).name if entry.name.isdigit() else ""
            if name in NAMES:
                parent = int((entry / "stat").read_text().rpartition(")")[2].split()[1])
                environment = (entry / "environ").read_bytes()
                if parent == launcher or f"{processes.MARK}={launcher}-".encode() in environment:
                    rank = re.search(rb"\0OMPI_COMM_WORLD_RANK=(\d+)\0", environment)
                    found[int(entry.name)] = f"{name} (rank {int(rank[1])})" if rank else name
        except OSError:
            pass  # the process has ended
    return found


def sample(process):
    """Returns (resident memory [MiB], file descriptors, threads) of a process."""
    status = pathlib.Path(f"/proc/{process}/status").read_text()
    return (int(re.search(r"VmRSS:\s+(\d+) kB", status)[1]) / 1024, len(os.listdir(f"/proc/{process}/fd")),
            int(re.search(r"Threads:\s+(\d+)", status)[1]))


def slope(times, values):
    """Returns the slope of the straight line through the points (time, value), by least squares."""
    middle, mean = sum(times) / len(times), sum(values) / len(values)
    spread = sum((time - middle) ** 2 for time in times)
    return sum((time - middle) * (value - mean) for time, value in zip(times, values)) / spread if spread else 0.0


class Track:
    """The samples of one process after the warm-up."""

    def __init__(self, name):
        self.name, self.times, self.samples = name, [], []

    def add(self, now, values):
        self.times.append(now)
        self.samples.append(values)

    def row(self):
        memory, descriptors, threads = zip(*self.samples)
        self.medians = [statistics.median(part) for part in quarters(memory)]
        self.growth = 3600 * slope(self.times, memory)
        # A checkpoint has its own short thread, so threads are compared by their medians.
        self.constant = len(set(descriptors)) == 1 and len({statistics.median(part) for part in quarters(threads)}) == 1
        return (f"| {self.name} | {' | '.join(f'{median:.1f}' for median in self.medians)} | {max(memory):.1f} | "
                f"{self.growth:+.2f} | {span(descriptors)} | {span(threads)} |")

    def grows(self):
        """Returns whether memory grows by more than MOST_GROWTH from the second quarter of the samples to the last.

        Compares medians, because a few samples also hold the copy of the sand from which a checkpoint is written.
        """
        hours = (self.times[-1] - self.times[0]) / 3600
        return self.medians[3] - self.medians[1] > MOST_GROWTH * max(hours, 1) / 2


def quarters(values):
    """Returns a list of four or more values in four parts of equal length."""
    return [values[len(values) * part // 4:len(values) * (part + 1) // 4] or values[-1:] for part in range(4)]


def span(values):
    return str(values[0]) if len(set(values)) == 1 else f"{min(values)} to {max(values)}"


def follow(launcher, minutes, period, warm_up):
    """Samples all processes for `minutes`. Returns a Track for each process."""
    tracks = {}
    deadline = time.monotonic() + START_SECONDS
    while len(members := family(launcher.pid)) < 4 and time.monotonic() < deadline and launcher.poll() is None:
        time.sleep(0.5)
    began = time.monotonic()
    while (now := time.monotonic() - began) < 60 * minutes:
        if launcher.poll() is not None:
            raise SystemExit(f"session_soak.py: the session has ended after {now:.0f} s with status {launcher.returncode}")
        members = family(launcher.pid) if now < warm_up else members
        if now >= warm_up:
            for process, name in members.items():
                tracks.setdefault(process, Track(name)).add(now, sample(process))
        time.sleep(period)
    return sorted(tracks.values(), key=lambda track: track.name)


def replayed(out):
    ran = subprocess.run([layout.bin_folder() / "sandwall-replay", out / "session.journal", "--hash"], capture_output=True, text=True)
    return (ran.stdout.split() or [ran.stderr.strip() or "nothing"])[-1]


def main():
    parser = Parser(description=__doc__)
    parser.add_argument("--minutes", type=above(float, 0), default=60)
    parser.add_argument("--wall", default=str(ROOT / "walls/configs/desktop.toml"))
    parser.add_argument("--scene", default=str(ROOT / "scenes/sandbox.toml"))
    parser.add_argument("--device", default="script:gis")
    parser.add_argument("--out", required=True)
    parser.add_argument("--period", type=above(float, 0), default=5, help="seconds between two samples (default: 5)")
    parser.add_argument("--warm-up", type=at_least(float, 0), default=None, help="seconds before the first sample that counts (default: a quarter of the time, at most 120)")
    parser.add_argument("options", nargs="*", help="after --: more options of sandwall run")
    args = parser.parse_args()
    warm_up = min(120, 15 * args.minutes) if args.warm_up is None else args.warm_up
    out = pathlib.Path(args.out)
    out.mkdir(parents=True, exist_ok=True)
    command = [str(ROOT / "scripts/sandwall"), "run", "--wall", args.wall, "--scene", args.scene, "--device", args.device,
               "--gl", layout.in_memory(), "--out", args.out, "--restarts", "0", "--no-pictures", *args.options]
    with open(out / "session_soak.log", "wb") as log:
        launcher = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=log, stderr=log, preexec_fn=processes.die_with(os.getpid()))
        try:
            tracks = follow(launcher, args.minutes, args.period, warm_up)
        finally:
            launcher.send_signal(signal.SIGINT)
            status = launcher.wait(300)
    summary = session_results.read_summary(out)
    print(f"{args.minutes:g} minutes, a sample every {args.period:g} s after {warm_up:g} s of warm-up\n")
    print("Resident memory: medians of the four quarters of the time, and the largest sample.\n")
    print("| process | 1st [MiB] | 2nd | 3rd | 4th | most | slope [MiB/h] | file descriptors | threads |")
    print("|---|---|---|---|---|---|---|---|---|")
    for track in tracks:
        print(track.row())
    found = replayed(out)
    link = summary["haptic"]
    print(f"\n| session | |\n|---|---|\n| frames, steps | {summary['frames']}, {summary['steps']} |\n"
          f"| frames a second | {summary['fps']:.2f} |\n| late frames | {summary['late_frames']} ({100 * summary['late_frames'] / summary['frames']:.2f} %) |\n"
          f"| reconnections of the haptic link | {link['reconnects']} |\n| divergences of ranks, of the haptic server | {summary['divergences']}, {summary['server_divergences']} |\n"
          f"| state hash on the wall, of a replay of the journal | {summary['state_hash']}, {found} |")
    complaints = [f"{track.name}: descriptors or threads change" for track in tracks if not track.constant]
    complaints += [f"{track.name}: memory grows" for track in tracks if track.grows()]
    # The server counts the steps and hashes its own sand after each. The master compares the hashes, so a lost step shows.
    complaints += ["steps were lost: the server's sand differs"] if summary["server_divergences"] else []
    complaints += ["ranks differed"] if summary["divergences"] else []
    complaints += ["a replay of the journal differs"] if found != summary["state_hash"] else []
    complaints += [f"the session ended with status {status}"] if status else []
    for complaint in complaints:
        print(f"session_soak.py: {complaint}", file=sys.stderr)
    return 1 if complaints else 0


if __name__ == "__main__":
    sys.exit(main())
