# SPDX-License-Identifier: Apache-2.0
"""Reads the files of a job's output while they grow: that of mpirun, and those of ranks that write files of their own."""

import collections
import ctypes
import os
import pathlib
import re
import zlib

from base import console, session_folder
from base.console import print_line
from job import bounded_log, job_outlet

LONGEST_LINE = 1 << 16  # bytes that are held back for the rest of a line
RESERVE = 1 << 18  # bytes of disk that are kept free for messages about a full disk
FALLOC_FL_KEEP_SIZE, FALLOC_FL_PUNCH_HOLE = 1, 2
TOO_FAST = "output came faster than it can be shown; some lines are not shown"
BANNER = re.compile(rb"-{60,}")
# A line that a rank on another host sends through mpirun: rank, length of the text, CRC-32 of rank and text
# (host/rank_output.cpp writes it).
RELAYED = re.compile(rb"@rank (\d{1,9}) (\d{1,7}) ([0-9a-f]{8}) ")

LIBC = ctypes.CDLL(None)  # loaded before any thread starts: a child between fork and exec must not wait for a lock


def new_file(path, complain=print_line):
    """Makes a file for the output of a job and returns its descriptor. If the disk takes no file, the file is in memory."""
    path = pathlib.Path(path)
    try:
        return session_folder.new_file(path, os.O_RDWR | os.O_APPEND)
    except OSError as error:
        complain(f"{path}: cannot be made ({error.strerror}); the output of this try is shown and not kept")
        return os.memfd_create(path.name)


def new_log(path, complain=print_line):
    """Makes a file for a log and returns its descriptor, or None if the disk takes no file."""
    try:
        return session_folder.new_file(path, os.O_RDWR | os.O_APPEND)
    except OSError as error:
        complain(f"{path}: cannot be made ({error.strerror}); the output of this try is shown and not kept")
        return None


def path_of(descriptor, path):
    """Returns the path by which another process of this user opens the file of new_file(), also if it is in memory."""
    try:
        if os.path.samestat(os.fstat(descriptor), os.lstat(path)):
            return str(path)
    except OSError:
        pass
    return f"/proc/{os.getpid()}/fd/{descriptor}"


def relayed(line):
    """Returns ([(rank, text)], damaged): the relayed lines in a piece of mpirun's output, and whether it holds something else."""
    found, at = [], 0
    damaged = False
    while match := RELAYED.search(line, at):
        text = line[match.end():match.end() + int(match[2])]
        if len(text) == int(match[2]) and zlib.crc32(match[1] + b" " + text) == int(match[3], 16):
            damaged = damaged or match.start() > at
            found.append((int(match[1]), text))
            at = match.end() + len(text)
        else:
            damaged = True
            at = match.start() + 1  # a whole line may begin behind the rest of a damaged one
    return found, damaged or at < len(line)


class Stream:
    """The standard output or standard error of mpirun, a pipe whose content is kept in a log."""

    def __init__(self, path, shown, mpi):
        self.path = path
        self.outlet = job_outlet.Outlet(new_log(path))
        self.begin(self.outlet.file, shown, mpi)

    def begin(self, file, shown, mpi):
        self.file = file  # the job writes into it
        self.complained = False
        self.shown = shown
        self.mpi = mpi
        self.damaged = 0  # pieces of output that were neither whole lines of ranks nor mpirun's own
        self.offset = 0
        self.reserved = self.freed = 0
        self.rank = None  # rank of the current piece; mpirun's own output has None
        self.held = collections.defaultdict(bytes)  # the unfinished line of each rank
        self.carried = b""  # the end of the last piece, if it may be the beginning of a tag
        self.in_banner = False
        self.in_ranks_banner = False  # whether the last line under a tag belongs to a banner that goes on

    def complain(self, why):
        """Prints once why output is missing."""
        if not self.complained:
            self.complained = True
            print_line(f"{self.path}: {why}")

    def close(self):
        self.outlet.close()

    def lines(self, ended):
        """Yields (rank, line) of every line completed since the last call. If `ended`, yields the unfinished lines too."""
        return self.whole(self.tagged(ended)) if self.mpi.keeps_output else self.tagged(ended)

    def whole(self, lines):
        """Yields the lines of ranks among `lines` that have arrived whole, and mpirun's own lines. Counts the others."""
        for rank, line in lines:
            # Open MPI sends its explanations of an error under the tag of a rank, too. Those of MPI_Abort are a banner.
            if b"@rank " not in line and (rank is None or not line or self.mpi.own.match(line)):
                yield rank, line
                continue
            if BANNER.fullmatch(line) or (self.in_ranks_banner and b"@rank " not in line):
                self.in_ranks_banner ^= BANNER.fullmatch(line) is not None
                yield None, line
                continue
            found, damaged = relayed(line.replace(b"\0", b""))  # mpirun sometimes writes one before a line
            self.damaged += damaged
            yield from found

    def tagged(self, ended):
        piece, left_out = self.outlet.take()
        if left_out:
            self.complain(TOO_FAST)
            self.held.clear()
            self.carried, self.rank = b"", None
            piece = piece.partition(b"\n")[2]
        if self.outlet.log.why:
            self.complain(f"cannot be written ({self.outlet.log.why}); output is shown and not kept")
        yield from self.split(self.carried + piece)
        if ended:
            yield from self.split(self.carried, last=True)
            yield from ((rank, line) for rank, line in self.held.items() if line)

    def split(self, text, last=False):
        """Yields (rank, line) of `text`. mpirun writes a tag at the beginning of each line and of each piece that it reads."""
        self.carried = b""
        if not last and (cut := self.mpi.cut_tag.search(text)):
            text, self.carried = text[:cut.start()], text[cut.start():]
        at = 0
        for tag in [*self.mpi.tag.finditer(text), None]:
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
        if self.shown is not console.ERROR:
            return False
        if rank is not None:  # Open MPI 5 explains in the output of ranks, too
            return self.mpi.keeps_output and self.mpi.own.match(line) is not None
        if BANNER.fullmatch(line):
            self.in_banner = not self.in_banner
            return True
        return self.in_banner or not line or self.mpi.own.match(line) is not None


class RankStream(Stream):
    """The standard output or standard error of one rank on this machine, which it writes into a file of its own."""

    def __init__(self, path, shown, mpi, rank):
        # A rank whose file cannot be made sends its lines through mpirun, whose stream has complained already.
        self.own_rank, self.path = rank, path
        self.most = bounded_log.most_bytes()
        self.begin(new_file(path, complain=lambda line: None), shown, mpi)
        self.reserve()

    def reserve(self):
        """Reserves room on the disk for the master, which writes the messages about a full disk."""
        if self.own_rank == 0 and self.reserved - self.offset < RESERVE // 2:
            length = ctypes.c_long(RESERVE)
            LIBC.fallocate(self.file, FALLOC_FL_KEEP_SIZE, ctypes.c_long(self.offset), length)
            self.reserved = self.offset + RESERVE

    def free_middle(self):
        """Gives the disk the room of lines in the middle of a long file back, while the rank still writes at its end."""
        first, newest = self.most // 2, self.offset - self.most // 4
        if newest - max(self.freed, first) > self.most // 8:
            LIBC.fallocate(self.file, FALLOC_FL_KEEP_SIZE | FALLOC_FL_PUNCH_HOLE, ctypes.c_long(first), ctypes.c_long(newest - first))
            self.freed = newest

    def close(self):
        if self.offset > self.most:
            try:
                bounded_log.shorten(self.file, self.offset, self.most, 0)
            except OSError:
                pass  # the disk is full; the middle was freed already
        os.close(self.file)

    def lines(self, ended):
        size = os.fstat(self.file).st_size
        if size - self.offset > job_outlet.MOST_AT_ONCE:
            self.complain(TOO_FAST)
            self.offset = size - job_outlet.PIECE
            self.held.clear()
        while self.offset < size and (piece := os.pread(self.file, 1 << 16, self.offset)):
            self.offset += len(piece)
            yield from ((self.own_rank, line) for _, line in self.add(piece))
        self.reserve()
        self.free_middle()
        if ended:
            yield from ((self.own_rank, line) for line in self.held.values() if line)

    def add(self, text):
        lines = (self.held[self.own_rank] + text).split(b"\n")
        self.held[self.own_rank] = lines.pop()
        if len(self.held[self.own_rank]) > LONGEST_LINE:
            lines.append(self.held.pop(self.own_rank))
        return [(self.own_rank, line) for line in lines]
