# SPDX-License-Identifier: Apache-2.0
"""A session's folder, which one launcher has at a time."""

import contextlib
import fcntl
import os
import pathlib
import time

from rank_hosts import BadInput

PATIENCE = 5  # seconds, for a session that is just ending


class InUse(Exception):
    """Another launcher has the folder."""


@contextlib.contextmanager
def held(out, resume=False):
    """Holds OUT; the lock is the kernel's and goes with the process, however that ends.

    A folder that cannot be made or written is the master's to complain of, but where a session goes on in it: that
    would be tried again and again.
    """
    path = pathlib.Path(out)
    try:
        path.mkdir(parents=True, exist_ok=True)
        descriptor = os.open(path, os.O_RDONLY | os.O_DIRECTORY | os.O_CLOEXEC)
    except OSError:
        yield
        return
    try:
        lock(descriptor, out)
        if resume and not os.access(path, os.W_OK | os.X_OK):
            raise BadInput(f"{out}: cannot be written, and a session that goes on writes its journal there; make it writable")
        yield
    finally:
        os.close(descriptor)


def lock(descriptor, out):
    deadline = time.monotonic() + PATIENCE
    while True:
        try:
            return fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            if time.monotonic() > deadline:
                raise InUse(f"{out}: another session runs in this folder; stop that one first, or choose another --out") from None
        except OSError:
            return None  # a file system without locks
        time.sleep(0.05)
