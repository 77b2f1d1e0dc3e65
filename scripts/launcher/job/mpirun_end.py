# SPDX-License-Identifier: Apache-2.0
"""Finds an mpirun that does not end after the last of its processes has ended (docs/recovery.md)."""

import dataclasses
import os
import pathlib

STUCK_SECONDS = 10  # far longer than mpirun needs to end, because it counts only while mpirun sleeps
START_SECONDS = 120  # for mpirun to start its first process; it sleeps while it waits for daemons on other hosts
LOOK_SECONDS = 0.5
# mpirun may not notice that a process has ended in its first instant, and then sleeps without an end. Such a job has shown nothing.
BRIEF_LIFE = 3  # [s] for which its processes were seen, at most
BRIEF_SECONDS = 1  # in place of STUCK_SECONDS, if all processes run on this machine: mpirun then waits for no other host
BRIEF_LOOK_SECONDS = 0.2


@dataclasses.dataclass
class Process:
    """A line of /proc/PID/stat: the state as in proc(5), the parent's id, and the processor time in ticks.

    `faults` are the page faults of all children that have ended and for which the process has waited.
    """

    state: str
    parent: int
    ticks: int
    faults: int = 0

    def runs(self):
        return self.state not in "ZX"


def process(pid):
    """Returns the Process, or None if it does not exist."""
    try:
        # The program's name is in parentheses, and may itself have spaces and parentheses.
        fields = pathlib.Path("/proc", str(pid), "stat").read_text(errors="replace").rpartition(")")[2].split()
        return Process(fields[0], int(fields[1]), int(fields[11]) + int(fields[12]), int(fields[8]))
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
    mpirun sleeps without an end. An mpirun that could not write its temporary files may sleep before its first rank, without an end.
    `here` tells whether all ranks run on this machine.
    """

    def __init__(self, pid, seconds=STUCK_SECONDS, here=False):
        self.pid, self.seconds, self.here = pid, seconds, here
        self.next_look = 0
        self.child = None  # one of the running children, so that the others are looked for only after its end
        self.had_children = False
        self.seen_from = self.seen_to = None  # times at which a child was seen first and last [s]
        self.done = None  # ticks and faults of mpirun at the last look
        self.since = None  # time since which mpirun has slept without children [s]

    def stuck(self, now):
        """Returns whether mpirun has slept for too long without running children. `now` is monotonic [s]."""
        if now >= self.next_look:
            self.next_look = now + (min(LOOK_SECONDS, BRIEF_LOOK_SECONDS) if self.brief() else LOOK_SECONDS)
            self.look(now)
        return self.since is not None and now - self.since > self.limit()

    def limit(self):
        """Returns how long mpirun may sleep without children [s]."""
        if not self.had_children:
            return START_SECONDS
        return min(self.seconds, BRIEF_SECONDS) if self.brief() else self.seconds

    def brief(self):
        """Returns whether all ranks run here, and children were seen, but not for long.

        Children that nobody has seen may be commands of a script that starts mpirun. They are no sign of a failed start.
        """
        return self.here and self.seen_from is not None and self.seen_to - self.seen_from < BRIEF_LIFE

    def look(self, now):
        known = self.child and process(self.child)
        if not (known and known.runs()):
            self.child = running_child(self.pid)
        if self.child:
            self.had_children, self.since = True, None
            self.seen_from, self.seen_to = self.seen_from or now, now
            return
        own = process(self.pid)
        # Children may have ended between two looks.
        self.had_children = self.had_children or (own is not None and own.faults > 0)
        # On a busy machine, mpirun may need long. It then waits for a processor, or has used some time of it.
        done = own and (own.ticks, own.faults)
        sleeps = own is not None and own.state == "S" and done == self.done
        self.done = done
        if not sleeps:
            self.since = None
        elif self.since is None:
            self.since = now
