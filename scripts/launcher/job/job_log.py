# SPDX-License-Identifier: Apache-2.0
"""Keeps the output of a job in files, shows it as it comes, and finds in it which process failed.

The programs of Sandwall report through events (docs/events.md). mpirun has no events, so its lines of text are parsed.
"""

import collections
import contextlib
import os
import pathlib
import re
import resource
import time

from base import checked_json, console, events
from base.console import print_line
from job import job_outlet, job_stream

KEPT_TRIES = 8
MOST_HELD = 1000  # lines
LAST_LINES = 16  # of each rank, for a report
LONGEST_LINE = 1 << 16  # bytes of mpirun's own lines that are kept
BACKTRACE = re.compile(rb"\[[\w.-]+:\d+\] \[ *\d+\] ")  # Open MPI prints it for a process that a signal ends
RANK_LOG = b"@log "  # begins the line in which a rank on another host names the file of its output


class JobLog:
    """The output of one try of a session, OUT/log/try_N.out and .err.

    The output of mpirun goes through pipes, so that a full disk or a limit of file size cannot hinder it. The logs keep the
    first and the newest lines (bounded_log.py).

    `mpi` is one of open_mpi.py. If it lets ranks write files of their own, `ranks` are those on this machine, whose files are
    OUT/log/try_N.rank_R.out and .err. With `held`, lines are shown from the first frame on, or by release().
    """

    def __init__(self, folder, number, mpi, ranks=(), held=False):
        self.path = pathlib.Path(folder) / f"try_{number}"
        self.mpi = mpi
        self.out = job_stream.Stream(f"{self.path}.out", console.OUT, mpi)
        self.err = job_stream.Stream(f"{self.path}.err", console.ERROR, mpi)
        self.streams = [self.out, self.err, *self.open_ranks(ranks if mpi.keeps_output else ())]
        self.pump = job_outlet.Pump([self.out.outlet, self.err.outlet])
        self.hosts_file = None
        # Lines that are not shown yet, because the wall may be incomplete; None: each line is shown at once.
        self.held = collections.deque(maxlen=MOST_HELD) if held else None
        self.rank_logs = {}  # HOST:PATH of the output of ranks on other hosts
        self.last_by_rank = collections.defaultdict(lambda: collections.deque(maxlen=LAST_LINES))  # last lines by rank; mpirun's own lines have the key None
        self.mpiruns = b""  # the last lines of mpirun itself on standard error
        self.ending = None  # `ranks` and `names` of the first event `waiting` that ends the job
        self.films = []  # events `film` that the supervisor still has to take
        self.failure = None  # the content of the event `failure`, as events.failure_in() returns it
        self.frame = self.step = None  # the last frame and step that an event reported as shown
        self.shown_at = 0.0  # time of that event by the monotonic clock [s]
        self.hand = None  # time [s] of the last linked hand; before the first link, of the first report without a server
        self.linked = None  # time by the monotonic clock [s] of the last event about a hand that was linked or streams
        self.force = None  # share of the force that an operator has set in this try, 0 to 1
        self.loads = False  # whether the server reads its scene, as the master has heard
        self.loaded = 0.0  # the largest part of its scene that the server has read, 0 to 1
        self.refused = False  # whether the last attempt to link ended with a refusal by server or master

    def open_ranks(self, ranks):
        """Returns the streams of these ranks, and makes their files."""
        needed = 2 * len(ranks) + 64
        soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
        if soft != resource.RLIM_INFINITY and soft < needed:
            resource.setrlimit(resource.RLIMIT_NOFILE, (needed if hard == resource.RLIM_INFINITY else min(needed, hard), hard))
        return [job_stream.RankStream(f"{self.path}.rank_{rank}.{ending}", shown, self.mpi, rank)
                for rank in ranks for ending, shown in (("out", console.OUT), ("err", console.ERROR))]

    def write_hosts(self, text):
        """Writes a file of hosts for mpirun beside the output, and returns its path."""
        path = f"{self.path}.hosts"
        self.hosts_file = job_stream.new_file(path)
        os.write(self.hosts_file, text.encode())
        return job_stream.path_of(self.hosts_file, path)

    def outlets(self):
        """Returns the ends of the pipes from which the output of mpirun is read."""
        return [self.out.outlet.reading, self.err.outlet.reading]

    def follow(self, ended=False):
        """Shows and reads the output since the last call."""
        for stream in self.streams:
            for rank, line in stream.lines(ended):
                if rank is not None and line.startswith(RANK_LOG):
                    self.rank_logs[rank] = checked_json.one_line(line[len(RANK_LOG):].decode(errors="replace"), events.LONGEST_TEXT)
                    continue
                if event := events.parse(line):
                    self.read_event(event)
                    if events.wanted():
                        self.show(stream, line)
                    continue
                self.read(rank, line, stream)
                if not stream.hides(rank, line):
                    self.show(stream, line)
        if ended and (damaged := self.out.damaged + self.err.damaged):
            print_line(f"{damaged} damaged pieces of the output of ranks on other hosts are left out")

    def show(self, stream, line):
        if self.held is None:
            stream.shown.line(line)
        else:
            self.held.append((stream, line))

    def release(self):
        """Shows the lines that were held, and from now on each line at once."""
        held, self.held = self.held or (), None
        for stream, line in held:
            stream.shown.line(line)

    def read_event(self, event):
        """Takes what the launcher needs from an event. Leaves out a field that is not as the schema of events says."""
        name = event["event"]
        if name == "progress":
            frame, step = (checked_json.whole(event.get(key)) for key in ("frame", "step"))
            if frame is None or step is None:
                return
            self.frame, self.step = frame, step
            self.release()
            self.shown_at = time.monotonic()
            if event.get("hand") in ("hand linked", "hand streams"):
                self.hand = time.monotonic()
                self.refused = False
        elif name == "link" and event.get("state") in ("linked", "streaming"):
            self.linked = time.monotonic()
        elif name == "link" and event.get("state") == "loading":
            self.loads = True
            share = event.get("share")
            if isinstance(share, (int, float)) and self.loaded < share <= 1:  # only progress counts
                self.loaded, self.hand = share, None
        elif name == "link" and self.loads and event.get("state") in ("connecting", "lost"):
            self.loads = False
            self.miss_hand()
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
        elif name == "film":
            self.films.append(event)
        elif name == "failure":
            self.failure = events.failure_in(event.get("failure"))

    def miss_hand(self):
        """Begins to count the time that a server without a link has been silent."""
        if self.hand is None and not self.refused:
            self.hand = time.monotonic()

    def read(self, rank, line, stream):
        if not BACKTRACE.match(line):  # a deep backtrace would leave no room for the lines before it
            self.last_by_rank[rank].append(line.decode(errors="replace"))
        if stream is self.err and rank is None:
            self.mpiruns = (self.mpiruns + line + b"\n")[-LONGEST_LINE:]

    def signalled(self):
        """Returns (rank, signal) of the first process that a signal ended, from mpirun's lines, or None."""
        found = self.mpi.signalled.search(self.mpiruns)
        return (int(found[1]), int(found[3])) if found else None

    def exited(self):
        """Returns (rank, exit status) of the first process that ended with an error, from mpirun's lines, or None."""
        found = self.mpi.exited.search(self.mpiruns)
        return (int(found[1]), int(found[2])) if found else None

    def close(self):
        if self.pump is None:
            return
        self.pump.stop()
        self.pump = None
        for stream in self.streams:
            stream.close()
        if self.hosts_file is not None:
            os.close(self.hosts_file)


def earlier_tries(folder):
    """Returns the numbers of the tries whose output still exists, in order."""
    return sorted({int(found[1]) for path in pathlib.Path(folder).glob("try_*")
                   if (found := re.fullmatch(r"try_(\d+)\.(?:out|err)", path.name))})


def forget_tries(folder, kept):
    """Removes the output of all tries except the newest `kept`."""
    tries = earlier_tries(folder)
    for number in tries[:max(0, len(tries) - kept)]:
        for path in pathlib.Path(folder).glob(f"try_{number}.*"):
            with contextlib.suppress(OSError):  # the output of an old try is not worth the end of a session
                path.unlink(missing_ok=True)
