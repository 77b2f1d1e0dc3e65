# SPDX-License-Identifier: Apache-2.0
"""Finds an mpirun that does not end after the last of its processes has ended (docs/recovery.md)."""

import dataclasses
import os
import pathlib

STUCK_SECONDS = 10  # far longer than mpirun needs to end, because it counts only while mpirun sleeps
START_SECONDS = 120  # for mpirun to start its first process; it sleeps while it waits for daemons on other hosts
LOOK_SECONDS = 0.5


@dataclasses.dataclass
class Process:
    """A line of /proc/PID/stat: the state as in proc(5), the parent's id, and the processor time in ticks."""

    state: str
    parent: int
    ticks: int

    def runs(self):
        return self.state not in "ZX"


def process(pid):
    """Returns the Process, or None if it does not exist."""
    try:
        # The name of the program stands in parentheses and may itself hold spaces and parentheses.
        fields = pathlib.Path("/proc", str(pid), "stat").read_text(errors="replace").rpartition(")")[2].split()
        return Process(fields[0], int(fields[1]), int(fields[11]) + int(fields[12]))
    except (OSError, IndexError, ValueError):
        return None


def running_child(parent):
    """Returns the id of a running child of `parent`, or None if it has none."""
    for entry in os.listdir("/proc"):
        if entry.isdigit() and (found := process(entry)) and found.parent == parent and found.runs():
            return int(entry)
    return None


class EndWatch:
    """Watches an mpirun for the deadlock that Open MPI 4.1 sometimes has when it ends after a rank has failed.

    The thread that frees PMIx then waits for another one, which waits for a lock of the first. All ranks have ended, and
    mpirun sleeps for ever. An mpirun that could not write its temporary files may sleep before its first rank, without an end.
    """

    def __init__(self, pid, seconds=STUCK_SECONDS):
        self.pid, self.seconds = pid, seconds
        self.next_look = 0
        self.child = None  # one of the running children, so that the others are looked for only after its end
        self.had_children = False
        self.ticks = None
        self.since = None  # time since which mpirun has slept without children [s]

    def stuck(self, now):
        """Returns whether mpirun has slept for too long without running children. `now` is monotonic [s]."""
        if now >= self.next_look:
            self.next_look = now + LOOK_SECONDS
            self.look(now)
        return self.since is not None and now - self.since > (self.seconds if self.had_children else START_SECONDS)

    def look(self, now):
        known = self.child and process(self.child)
        if not (known and known.runs()):
            self.child = running_child(self.pid)
        if self.child:
            self.had_children, self.since = True, None
            return
        own = process(self.pid)
        # On a busy machine, mpirun may need long. It then waits for a processor, or has used some time of it.
        sleeps = own is not None and own.state == "S" and own.ticks == self.ticks
        self.ticks = own and own.ticks
        if not sleeps:
            self.since = None
        elif self.since is None:
            self.since = now
