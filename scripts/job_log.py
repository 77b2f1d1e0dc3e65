# SPDX-License-Identifier: Apache-2.0
"""The output of a job: kept in files, shown as it comes, and read for what failed.

Our programs are read through their events (docs/events.md). mpirun has no such contract: its own lines are parsed.
"""

import collections
import ctypes
import os
import pathlib
import re
import sys
import time

import events

KEPT_TRIES = 8
LAST_LINES = 16  # of each rank, for a report
LONGEST_LINE = 1 << 16  # bytes that are held back for the rest of a line
RESERVE = 1 << 18  # bytes of disk for what is said when the disk is full
FALLOC_FL_KEEP_SIZE = 1

LIBC = ctypes.CDLL(None)  # loaded before there are threads: a child between fork and exec must not wait for a lock
TAG = re.compile(rb"\[\d+,(\d+)\]<std(?:out|err)>:")  # of mpirun --tag-output, before every piece of a rank's output
BANNER = re.compile(rb"-{60,}")
# What mpirun -q would have kept to itself.
MPIRUNS_OWN = re.compile(rb"\[[\w.-]+:\d+\]|mpirun: ")
SIGNALLED = re.compile(rb"process rank (\d+) with PID \d+ on node (\S+) exited on\s+signal (\d+)")
EXITED = re.compile(rb"Process name: \[\[\d+,\d+\],(\d+)\]\s+Exit code:\s+(\d+)")
BACKTRACE = re.compile(rb"\[[\w.-]+:\d+\] \[ *\d+\] ")  # of Open MPI, for a process that a signal ends


class Stream:
    """One file of a job's output, followed as it grows."""

    def __init__(self, path, shown):
        self.file = os.open(path, os.O_RDWR | os.O_CREAT | os.O_TRUNC | os.O_APPEND | os.O_CLOEXEC, 0o644)
        self.shown = shown
        self.offset = 0
        self.reserved = 0
        self.rank = None  # of the piece at hand; None: mpirun itself
        self.held = collections.defaultdict(bytes)  # the begun line of each rank
        self.carried = b""  # what may be the beginning of a tag
        self.in_banner = False
        self.reserve()

    def reserve(self):
        """Keeps room on the disk: what is said of a full disk must find some."""
        if self.reserved - self.offset < RESERVE // 2:
            length = ctypes.c_long(RESERVE)
            LIBC.fallocate(self.file, FALLOC_FL_KEEP_SIZE, ctypes.c_long(self.offset), length)
            self.reserved = self.offset + RESERVE

    def lines(self, ended):
        """(rank, line) of every line that has become whole since; at the end also those that never will."""
        while piece := os.pread(self.file, 1 << 16, self.offset):
            self.offset += len(piece)
            yield from self.split(self.carried + piece)
        self.reserve()
        if ended:
            yield from self.split(self.carried, last=True)
            yield from ((rank, line) for rank, line in self.held.items() if line)

    def split(self, text, last=False):
        """Tags stand at the beginning of lines, and wherever mpirun happened to read a piece of one."""
        self.carried = b""
        if not last and (cut := re.search(rb"\[[\d,]{0,12}\]?(?:<[a-z]{0,6}>?)?$", text)):
            text, self.carried = text[:cut.start()], text[cut.start():]
        at = 0
        for tag in [*TAG.finditer(text), None]:
            yield from self.add(text[at:tag.start() if tag else len(text)])
            if tag:
                self.rank, at = int(tag[1]), tag.end()

    def add(self, text):
        while text:
            piece, end, text = text.partition(b"\n")
            line = self.held[self.rank] + piece
            if end or len(line) > LONGEST_LINE:
                self.held[self.rank] = b""
                yield self.rank, line
            else:
                self.held[self.rank] = line
            if end:
                self.rank = None  # a line without a tag is mpirun's own

    def hides(self, rank, line):
        """Whether a line is mpirun's explanation of what a line of ours says already."""
        if rank is not None or self.shown is not sys.stderr:
            return False
        if BANNER.fullmatch(line):
            self.in_banner = not self.in_banner
            return True
        return self.in_banner or not line or MPIRUNS_OWN.match(line) is not None

    def show(self, line):
        try:
            self.shown.buffer.write(line + b"\n")
            self.shown.buffer.flush()
        except (BrokenPipeError, ValueError):
            pass  # nobody looks; the file has it


class JobLog:
    """The output of one try of a session, OUT/log/try_N.out and .err.

    A file and not a pipe: the death of this launcher would kill the job with SIGPIPE before its journal is whole.
    """

    def __init__(self, folder, number):
        self.path = pathlib.Path(folder) / f"try_{number}"
        self.out = Stream(f"{self.path}.out", sys.stdout)
        self.err = Stream(f"{self.path}.err", sys.stderr)
        self.said = collections.defaultdict(lambda: collections.deque(maxlen=LAST_LINES))  # by rank; None: mpirun
        self.mpiruns = b""  # everything that mpirun itself said
        self.ending = None  # the first event `waiting` that ends the job
        self.failure = None  # the content of the event `failure`
        self.frame = self.step = None  # shown last, as far as was said
        self.told = 0.0  # when, by the monotonic clock
        self.hand = None  # when a hand was linked last; before the first link, when the server was first missed
        self.refused = False  # whether the last answer of the server was a refusal, its own or the master's

    def follow(self, ended=False):
        """Shows and reads what has been said since."""
        for stream in (self.out, self.err):
            for rank, line in stream.lines(ended):
                if event := events.parse(line):
                    self.read_event(event)
                    if events.wanted():
                        stream.show(line)
                    continue
                self.read(rank, line, stream)
                if not stream.hides(rank, line):
                    stream.show(line)

    def read_event(self, event):
        name = event.get("event")
        if name == "progress":
            self.frame, self.step = event["frame"], event["step"]
            self.told = time.monotonic()
            if event["hand"] in ("hand linked", "hand streams"):
                self.hand = time.monotonic()
                self.refused = False
        elif name == "link" and event["state"] == "refused":
            self.hand, self.refused = None, True  # it answers, so it does not hang; a restarted one would answer the same
        elif name == "without_hand" and event["reason"] == "no_server":
            self.miss_hand()
        elif name == "waiting" and event["ends_job"] and self.ending is None:
            self.ending = event
        elif name == "failure":
            self.failure = event["failure"]

    def miss_hand(self):
        """Begins to count the time that a server without a link has been silent."""
        if self.hand is None and not self.refused:
            self.hand = time.monotonic()

    def read(self, rank, line, stream):
        if not BACKTRACE.match(line):  # a deep one would leave no room for what was said before
            self.said[rank].append(line.decode(errors="replace"))
        if stream is self.err and rank is None:
            self.mpiruns = (self.mpiruns + line + b"\n")[-LONGEST_LINE:]

    def signalled(self):
        """(rank, signal) of the process that a signal ended first, as mpirun has it."""
        found = SIGNALLED.search(self.mpiruns)
        return (int(found[1]), int(found[3])) if found else None

    def exited(self):
        """(rank, status) of the process that ended first, not in order but by itself."""
        found = EXITED.search(self.mpiruns)
        return (int(found[1]), int(found[2])) if found else None

    def close(self):
        os.close(self.out.file)
        os.close(self.err.file)


def earlier_tries(folder):
    """Numbers of the tries whose output is still there, in order."""
    return sorted({int(found[1]) for path in pathlib.Path(folder).glob("try_*")
                   if (found := re.fullmatch(r"try_(\d+)\.(?:out|err)", path.name))})


def forget_tries(folder, kept):
    """Removes all but the newest `kept`."""
    tries = earlier_tries(folder)
    for number in tries[:max(0, len(tries) - kept)]:
        for ending in ("out", "err"):
            (pathlib.Path(folder) / f"try_{number}.{ending}").unlink(missing_ok=True)
