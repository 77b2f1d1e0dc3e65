#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Ends a process of a session in each phase of the start, and tests that the session then ends, or continues without the server.

Makes a raster and measures an undisturbed start. Then each row of CASES sends each of its signals to its process, at each of
MOMENTS. The session must end with a line from a process that is left. It must leave nothing behind: no process, no temporary
folder, no shared memory. Prints a line for each try, with the time from the signal to the last end. The exit status is 0 if all
of this holds, at least one try was made, and no end took longer than --limit, else 1. docs/recovery.md
"""

import os
import pathlib
import secrets
import signal
import subprocess
import sys
import tempfile
import time

sys.dont_write_bytecode = True
sys.path[:0] = [str(pathlib.Path(__file__).resolve().parents[1] / room) for room in ("figures", "launcher")]
from base import events, layout
from base.command_line import Parser, above, at_least
from base.process_marks import marked
from job import open_mpi, processes
from sessions.raster_session import make_scene

ROOT = pathlib.Path(__file__).resolve().parents[2]
PATIENCE = 180  # [s], for a start on a busy machine
MARK = "SANDWALL_KILL_STARTS"
PROGRAMS = {"server": "sandwall-haptic-server", "mpirun": "mpirun", "master": "sandwall-master", "rank": "sandwall-render-node"}
MPIRUNS = ("mpirun", "orterun", "prterun", "prte")
# (process, signals, --restarts, whether the session ends)
CASES = [("launcher", ("INT", "TERM", "KILL"), 3, True), ("launcher", ("INT", "KILL"), 0, True),
         ("server", ("TERM", "KILL"), 0, False), ("mpirun", ("TERM", "KILL"), 0, True),
         ("master", ("INT", "TERM", "KILL"), 0, True), ("rank", ("INT", "TERM", "KILL"), 0, True)]
# The first moment at which a program runs, or a part of the time of an undisturbed start.
MOMENTS = ("server", "mpirun", "rank", 0.5, 0.75, 0.95)


class Violation(Exception):
    """A result that the test forbids."""


class Start:
    """A session that starts. All its processes have a mark in their environment."""

    def __init__(self, args, folder, scene, restarts):
        self.mark = f"{MARK}={secrets.token_hex(8)}"
        self.out, self.log = folder / "out", folder / "log"
        self.temporary = folder / "temporary"
        self.temporary.mkdir()
        self.jobs = set()  # ids of MPI jobs, in the names of Open MPI's shared memory
        name, _, value = self.mark.partition("=")
        command = [ROOT / "scripts" / "sandwall", "run", "--here", "--wall", args.wall, "--scene", scene, "--device", "script:gis",
                   "--no-pictures", "--gl", layout.in_memory(), "--restarts", restarts, "--out", self.out]
        with self.log.open("w") as said:
            self.launcher = subprocess.Popen([str(word) for word in command], stdin=subprocess.DEVNULL, stdout=said, stderr=said,
                                             env={**os.environ, events.VARIABLE: "1", name: value, "TMPDIR": str(self.temporary)},
                                             preexec_fn=processes.die_with(os.getpid()))
        self.began = time.monotonic()

    def running(self):
        return [pid for pid in marked(self.mark.encode()) if pathlib.Path("/proc", str(pid), "exe").exists()]

    def find(self, name):
        """Returns the id of a process by its name in PROGRAMS, or None. A rank is the last one that has started."""
        if name == "launcher":
            return self.launcher.pid if self.launcher.poll() is None else None
        wanted = MPIRUNS if name == "mpirun" else (PROGRAMS[name],)
        found = []
        for pid in self.running():
            try:
                program = pathlib.Path(os.readlink(f"/proc/{pid}/exe")).name
                asks = b"--version" in pathlib.Path("/proc", str(pid), "cmdline").read_bytes()
            except OSError:
                continue
            if program in wanted and not asks:
                found.append(pid)
        return max(found, default=None)

    def frame(self):
        return any(event["event"] == "progress" for event in events.read(self.log))

    def wait(self, condition, what, seconds=PATIENCE):
        deadline = time.monotonic() + seconds
        while not condition():
            if time.monotonic() > deadline:
                raise Violation(f"{what} within {seconds} s: {self.said()[-500:]}")
            time.sleep(0.005)

    def wait_for_moment(self, moment, whole):
        """Waits for one of MOMENTS. `whole` is the time of an undisturbed start [s]."""
        if isinstance(moment, float):
            time.sleep(max(0, self.began + moment * whole - time.monotonic()))
        else:
            self.wait(lambda: self.find(moment) or self.launcher.poll() is not None, f"no {moment}")

    def said(self):
        """Returns what the session has printed for a person."""
        return "\n".join(line for line in self.log.read_text(errors="replace").splitlines() if line.strip() and "@sandwall " not in line)

    def note_jobs(self):
        self.jobs |= {job for pid in self.running() if (job := open_mpi.job_id_of(pid))}

    def require_nothing_left(self):
        left = [str(path.relative_to(self.temporary)) for path in self.temporary.rglob("*")]
        left += [f"/dev/shm/{name}" for name in sorted(os.listdir("/dev/shm")) if any(f".{job}." in name for job in self.jobs)]
        if left:
            raise Violation(f"left behind: {', '.join(left[:8])}")

    def end(self):
        """Kills what is left, the launcher first."""
        self.launcher.kill()
        self.launcher.wait()
        for pid in self.running():
            try:
                os.kill(pid, signal.SIGKILL)
            except ProcessLookupError:
                pass


def undisturbed(args, folder, scene):
    """Returns the time to the first frame of a session [s], and stops the session."""
    start = Start(args, folder, scene, 0)
    try:
        start.wait(lambda: start.frame() or start.launcher.poll() is not None, "no frame")
        if not start.frame():
            raise Violation(f"an undisturbed start has failed: {start.said()}")
        whole = time.monotonic() - start.began
        start.launcher.send_signal(signal.SIGINT)
        start.wait(lambda: not start.running(), "no end")
        return whole
    finally:
        start.end()


def one(args, folder, scene, whole, case):
    """Makes one try. Returns (time to the end [s], exit status, last line), or None if there is no such process at this moment."""
    name, number, restarts, ends, moment = case
    start = Start(args, folder, scene, restarts)
    try:
        start.wait_for_moment(moment, whole)
        victim = start.find(name)
        if victim is None or start.frame():
            return None
        before = start.said()
        start.note_jobs()
        try:
            os.kill(victim, getattr(signal, f"SIG{number}"))
        except ProcessLookupError:
            return None
        signalled = time.monotonic()
        if not ends:
            start.wait(lambda: start.frame() or start.launcher.poll() is not None, "neither a frame nor an end")
            if start.launcher.poll() is None:
                signalled = time.monotonic()
                start.launcher.send_signal(signal.SIGINT)
        start.wait(lambda: start.launcher.poll() is not None and not start.running(), "no end", args.limit + 60)
        seconds = time.monotonic() - signalled
        start.require_nothing_left()
        line = start.said().removeprefix(before).strip().rpartition("\n")[2]
        killed = (name, number) == ("launcher", "KILL")  # its job may end without a line
        if not line and not killed:
            raise Violation("no line says what has happened")
        return seconds, start.launcher.returncode, line
    finally:
        start.end()


def tries_of(args):
    """Returns (process, signal, --restarts, whether the session ends, moment) of each try that the options ask for."""
    return [(process, number, restarts, ends, moment) for process, numbers, restarts, ends in CASES for number in numbers
            for moment in MOMENTS if process in args.processes and number in args.signals and str(moment) in args.moments]


def result_of(bad, made):
    """Returns the exit status. A check without a try has shown nothing."""
    if made == 0:
        print("kill_starts.py: no try was made; ask for other --processes, --signals or --moments, or for a larger --side", file=sys.stderr)
        return 1
    return 1 if bad else 0


def main():
    parser = Parser(prog="kill_starts.py", description=__doc__.splitlines()[0])
    parser.add_argument("--side", type=at_least(int, 64), default=3601, help="side of the raster [pixel] (default: 3601)")
    parser.add_argument("--wall", default="desktop", help="wall: a sample's name or a file (default: desktop)")
    parser.add_argument("--limit", type=above(float, 0), default=2, help="longest time from a signal to the end [s] (default: 2)")
    parser.add_argument("--processes", nargs="+", choices=["launcher", *PROGRAMS], default=["launcher", *PROGRAMS], help="processes that get signals (default: all)")
    parser.add_argument("--signals", nargs="+", choices=["INT", "TERM", "KILL"], default=["INT", "TERM", "KILL"], help="signals (default: all)")
    parser.add_argument("--moments", nargs="+", choices=[str(moment) for moment in MOMENTS], default=[str(moment) for moment in MOMENTS],
                        help="moments at which they get them: the start of a program, or a part of the start (default: all)")
    parser.add_argument("--rounds", type=at_least(int, 1), default=1, help="how often each try is made (default: 1)")
    args = parser.parse_args()
    bad = made = 0
    with tempfile.TemporaryDirectory(prefix="sandwall-kills-") as name:
        folder = pathlib.Path(name)
        scene = make_scene(folder, args.side, rough=False)
        (folder / "first").mkdir()
        try:
            whole = undisturbed(args, folder / "first", scene)
        except Violation as why:
            print(f"kill_starts.py: {why}", file=sys.stderr)
            return 1
        print(f"an undisturbed start takes {whole:.1f} s", flush=True)
        tries = args.rounds * tries_of(args)
        for index, case in enumerate(tries):
            process, number, restarts, ends, moment = case
            words = f"{process:8} SIG{number:4} --restarts {restarts} at {moment!s:6}"
            try:
                (folder / str(index)).mkdir()
                found = one(args, folder / str(index), scene, whole, case)
                if found is None:
                    continue
                made += 1
                seconds, status, line = found
                good = seconds <= args.limit or not ends
                print(f"{'ok ' if good else 'BAD'} {words} {seconds:6.2f} s  status {status:4}  {line}", flush=True)
                bad += 0 if good else 1
            except Violation as why:
                print(f"BAD {words} {why}", flush=True)
                bad, made = bad + 1, made + 1
    print(f"{bad} of {made} bad; {len(tries) - made} of {len(tries)} tries found no process to end, or a session with a frame")
    return result_of(bad, made)


if __name__ == "__main__":
    sys.exit(main())
