# SPDX-License-Identifier: Apache-2.0
"""Keeps the output of a job in files, shows it as it comes, and finds in it which process failed.

The programs of Sandwall report through events (docs/events.md). mpirun has no events, so its lines of text are parsed.
"""

import collections
import contextlib
import ctypes
import os
import pathlib
import re
import time

import checked_json
import console
import events
import session_folder
from console import say

KEPT_TRIES = 8
LAST_LINES = 16  # of each rank, for a report
LONGEST_LINE = 1 << 16  # bytes that are held back for the rest of a line
RESERVE = 1 << 18  # bytes of disk that are kept free for messages about a full disk
FALLOC_FL_KEEP_SIZE = 1

LIBC = ctypes.CDLL(None)  # loaded before any thread starts: a child between fork and exec must not wait for a lock
TAG = re.compile(rb"\[\d+,(\d{1,9})\]<std(?:out|err)>:")  # mpirun --tag-output writes it before every piece of a rank's output
BANNER = re.compile(rb"-{60,}")
# Lines that mpirun -q would not have printed.
MPIRUNS_OWN = re.compile(rb"\[[\w.-]+:\d+\]|mpirun: ")
SIGNALLED = re.compile(rb"process rank (\d{1,9}) with PID \d+ on node (\S+) exited on\s+signal (\d{1,9})")
EXITED = re.compile(rb"Process name: \[\[\d+,\d+\],(\d{1,9})\]\s+Exit code:\s+(\d{1,9})")
BACKTRACE = re.compile(rb"\[[\w.-]+:\d+\] \[ *\d+\] ")  # Open MPI prints it for a process that a signal ends


def new_file(path):
    """Makes a file for the output of a job and returns its descriptor. If the disk takes no file, the file is in memory."""
    path = pathlib.Path(path)
    try:
        return session_folder.new_file(path, os.O_RDWR | os.O_APPEND)
    except OSError as error:
        say(f"{path}: cannot be made ({error.strerror}); the output of this try is shown and not kept")
        return os.memfd_create(path.name)


class Stream:
    """One file of a job's output, which is read while it grows."""

    def __init__(self, path, shown):
        self.file = new_file(path)
        self.shown = shown
        self.offset = 0
        self.reserved = 0
        self.rank = None  # rank of the current piece; mpirun's own output has None
        self.held = collections.defaultdict(bytes)  # the unfinished line of each rank
        self.carried = b""  # the end of the last piece, if it may be the beginning of a tag
        self.in_banner = False
        self.reserve()

    def reserve(self):
        """Reserves room on the disk, so that messages about a full disk can still be written."""
        if self.reserved - self.offset < RESERVE // 2:
            length = ctypes.c_long(RESERVE)
            LIBC.fallocate(self.file, FALLOC_FL_KEEP_SIZE, ctypes.c_long(self.offset), length)
            self.reserved = self.offset + RESERVE

    def lines(self, ended):
        """Yields (rank, line) of every line completed since the last call. If `ended`, yields the unfinished lines too."""
        while piece := os.pread(self.file, 1 << 16, self.offset):
            self.offset += len(piece)
            yield from self.split(self.carried + piece)
        self.reserve()
        if ended:
            yield from self.split(self.carried, last=True)
            yield from ((rank, line) for rank, line in self.held.items() if line)

    def split(self, text, last=False):
        """Yields (rank, line) of `text`. mpirun writes a tag at the beginning of each line and of each piece that it reads."""
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
        """Returns whether a line is mpirun's explanation of a failure that a line of Sandwall already reports."""
        if rank is not None or self.shown is not console.ERROR:
            return False
        if BANNER.fullmatch(line):
            self.in_banner = not self.in_banner
            return True
        return self.in_banner or not line or MPIRUNS_OWN.match(line) is not None


class JobLog:
    """The output of one try of a session, OUT/log/try_N.out and .err.

    The output goes to files because a pipe would break if this launcher ended: SIGPIPE would kill the job before its
    journal is whole.
    """

    def __init__(self, folder, number):
        self.path = pathlib.Path(folder) / f"try_{number}"
        self.out = Stream(f"{self.path}.out", console.OUT)
        self.err = Stream(f"{self.path}.err", console.ERROR)
        self.said = collections.defaultdict(lambda: collections.deque(maxlen=LAST_LINES))  # last lines by rank; mpirun's own lines have the key None
        self.mpiruns = b""  # the last lines of mpirun itself on standard error
        self.ending = None  # `ranks` and `names` of the first event `waiting` that ends the job
        self.failure = None  # the content of the event `failure`, as events.failure_in() returns it
        self.frame = self.step = None  # the last frame and step that an event reported as shown
        self.told = 0.0  # time of that event by the monotonic clock [s]
        self.hand = None  # time [s] of the last linked hand; before the first link, of the first report without a server
        self.linked = None  # Unix time [s] of the last event about a hand that was linked or streams
        self.force = None  # share of the force that an operator has set in this try, 0 to 1
        self.refused = False  # whether the last attempt to link ended with a refusal by server or master

    def follow(self, ended=False):
        """Shows and reads the output since the last call."""
        for stream in (self.out, self.err):
            for rank, line in stream.lines(ended):
                if event := events.parse(line):
                    self.read_event(event)
                    if events.wanted():
                        stream.shown.line(line)
                    continue
                self.read(rank, line, stream)
                if not stream.hides(rank, line):
                    stream.shown.line(line)

    def read_event(self, event):
        """Takes what the launcher needs from an event. Leaves out a field that is not as the schema of events says."""
        name = event["event"]
        if name == "progress":
            frame, step = (checked_json.whole(event.get(key)) for key in ("frame", "step"))
            if frame is None or step is None:
                return
            self.frame, self.step = frame, step
            self.told = time.monotonic()
            if event.get("hand") in ("hand linked", "hand streams"):
                self.hand = time.monotonic()
                self.refused = False
        elif name == "link" and event.get("state") in ("linked", "streaming"):
            self.linked = time.time()
        elif name == "link" and event.get("state") == "refused":
            self.hand, self.refused = None, True  # the server answers, so it does not hang, and a restart would not help
        elif name == "without_hand" and event.get("reason") == "no_server":
            self.miss_hand()
        elif name == "waiting" and event.get("ends_job") is True and self.ending is None:
            ranks, names = event.get("ranks"), event.get("names")
            self.ending = {"ranks": [rank for rank in ranks if checked_json.whole(rank, 0, events.MOST_RANKS) is not None]
                           if isinstance(ranks, list) else [],
                           "names": checked_json.one_line(names, events.LONGEST_TEXT) if isinstance(names, str) else ""}
        elif name == "force":
            share = event.get("share")
            if isinstance(share, (int, float)) and 0 <= share <= 1:
                self.force = share
        elif name == "failure":
            self.failure = events.failure_in(event.get("failure"))

    def miss_hand(self):
        """Begins to count the time that a server without a link has been silent."""
        if self.hand is None and not self.refused:
            self.hand = time.monotonic()

    def read(self, rank, line, stream):
        if not BACKTRACE.match(line):  # a deep backtrace would leave no room for the lines before it
            self.said[rank].append(line.decode(errors="replace"))
        if stream is self.err and rank is None:
            self.mpiruns = (self.mpiruns + line + b"\n")[-LONGEST_LINE:]

    def signalled(self):
        """Returns (rank, signal) of the first process that a signal ended, from mpirun's lines, or None."""
        found = SIGNALLED.search(self.mpiruns)
        return (int(found[1]), int(found[3])) if found else None

    def exited(self):
        """Returns (rank, exit status) of the first process that ended with an error, from mpirun's lines, or None."""
        found = EXITED.search(self.mpiruns)
        return (int(found[1]), int(found[2])) if found else None

    def close(self):
        os.close(self.out.file)
        os.close(self.err.file)


def earlier_tries(folder):
    """Returns the numbers of the tries whose output still exists, in order."""
    return sorted({int(found[1]) for path in pathlib.Path(folder).glob("try_*")
                   if (found := re.fullmatch(r"try_(\d+)\.(?:out|err)", path.name))})


def forget_tries(folder, kept):
    """Removes the output of all tries except the newest `kept`."""
    tries = earlier_tries(folder)
    for number in tries[:max(0, len(tries) - kept)]:
        for ending in ("out", "err"):
            with contextlib.suppress(OSError):  # the output of an old try is not worth the end of a session
                (pathlib.Path(folder) / f"try_{number}.{ending}").unlink(missing_ok=True)
