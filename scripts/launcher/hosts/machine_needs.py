# SPDX-License-Identifier: Apache-2.0
"""Checks the needs of mpirun on a machine: the loopback interface, shared memory, and room for temporary files (docs/doctor.md).

Without one of them mpirun fails with text of its own, which does not always name the reason.
"""

import dataclasses
import errno
import os
import re
import resource
import socket
import tempfile

from base.bad_input import BadInput, NotYet

SHARED = "/dev/shm"
# Open MPI 4.1 makes a file of 4 MiB for each process in shared memory, and refuses if it has not 5 % more. It fills little of it.
SHARED_MEBIBYTES, SHARED_MEBIBYTES_PER_RANK = 5, 1
TEMPORARY_MEBIBYTES = 12  # PMIx of Open MPI 4.1 takes 8 MiB for the first ranks, and fails at a full disk
FILE_MEBIBYTES = 16  # of the largest file: mpirun's have 4 MiB, and a log 8
CONNECT_SECONDS = 2
# A line of `df -Pk`: size, used and available [KiB], and the mount point.
FILE_SYSTEM = re.compile(r"\s(\d{1,15})\s+-?\d{1,15}\s+(-?\d{1,15})\s+\S+%\s+/")


@dataclasses.dataclass
class Need:
    """A need of mpirun. `why` is a line that says what is missing and what to do, or "" if it is met."""

    name: str
    why: str
    words: str = ""  # the finding for a need that is met
    may_come: bool = True  # whether a wait may help

    def good(self):
        return not self.why


def loopback():
    try:
        with socket.create_server(("127.0.0.1", 0)) as server, socket.create_connection(server.getsockname(), CONNECT_SECONDS):
            return Need("lo", "", "connects to 127.0.0.1")
    except OSError as error:
        return Need("lo", f"lo: no connection to 127.0.0.1 ({error.strerror or error}), which mpirun needs; run `ip link set lo up`")


def shared_memory(total, free, ranks):
    """`total` and `free` [MiB] are those of SHARED on a machine with this number of ranks."""
    needed = SHARED_MEBIBYTES + SHARED_MEBIBYTES_PER_RANK * ranks
    words = f"{ranks} process{'es' if ranks > 1 else ''} need {needed}"
    if total < needed:
        return Need("shm", f"{SHARED}: has {total} MiB, and {words}; mount it larger, or start the container with --shm-size", may_come=False)
    if free < needed:
        return Need("shm", f"{SHARED}: {free} MiB free, and {words}; remove files that ended programs have left there")
    return Need("shm", "", f"{free} MiB free in {SHARED}")


def temporary(free, folder):
    """`free` [MiB] is the room in the folder for temporary files."""
    if free < TEMPORARY_MEBIBYTES:
        return Need("tmp", f"{folder}: {free} MiB free, and mpirun needs {TEMPORARY_MEBIBYTES} for temporary files; make room, or set TMPDIR "
                    "to another folder")
    return Need("tmp", "", f"{free} MiB free in {folder}")


def temporary_folder():
    """Returns the folder in which mpirun makes its files. Python itself would go to another one if this is full."""
    return next((os.environ[name] for name in ("TMPDIR", "TEMP", "TMP") if os.environ.get(name)), "/tmp")


def temporary_here():
    folder = temporary_folder()
    try:
        with tempfile.TemporaryFile(dir=folder) as file:
            os.write(file.fileno(), b"\0" * 4096)
    except OSError as error:
        if error.errno not in (errno.ENOSPC, errno.EDQUOT):
            return Need("tmp", f"{folder}: no temporary file can be made ({error.strerror}); correct the folder, or set TMPDIR to another one",
                        may_come=False)
        return temporary(0, folder)
    return temporary(free_of(folder)[1], folder)


def free_of(folder):
    """Returns (size, free room) of a file system [MiB]."""
    found = os.statvfs(folder)
    return found.f_blocks * found.f_frsize >> 20, found.f_bavail * found.f_frsize >> 20


def file_size():
    limit = resource.getrlimit(resource.RLIMIT_FSIZE)[0]
    if limit != resource.RLIM_INFINITY and limit >> 20 < FILE_MEBIBYTES:
        return Need("limit", f"ulimit -f: a file may have {limit >> 10} KiB, and a session needs {FILE_MEBIBYTES << 10}; raise the limit, or set it "
                    "to unlimited, because the journal grows", may_come=False)
    return Need("limit", "", "files may have any size" if limit == resource.RLIM_INFINITY else f"files of up to {limit >> 20} MiB")


def here(ranks):
    """Returns the needs on this machine, on which this number of ranks runs, with the master."""
    try:
        shared = shared_memory(*free_of(SHARED), ranks)
    except OSError as error:
        shared = Need("shm", f"{SHARED}: cannot be read ({error.strerror}), and mpirun needs it; mount a tmpfs there", may_come=False)
    return [loopback(), shared, file_size(), temporary_here()]


def of_answers(answers, ranks):
    """Returns the needs on another host, from its answers `shm` and `tmp` of `df -Pk`. Leaves out what the host did not answer."""
    found = []
    if match := FILE_SYSTEM.search(answers.get("shm", "")):
        found.append(shared_memory(int(match[1]) >> 10, int(match[2]) >> 10, ranks))
    if match := FILE_SYSTEM.search(answers.get("tmp", "")):
        found.append(temporary(int(match[2]) >> 10, "its folder for temporary files"))
    return found


def require(ranks):
    """Throws BadInput for the first need that this machine does not meet: NotYet if a wait may help."""
    for need in here(ranks):
        if not need.good():
            raise (NotYet if need.may_come else BadInput)(need.why)
