# SPDX-License-Identifier: Apache-2.0
"""Locks a session's folder, so that one launcher uses it at a time."""

import contextlib
import fcntl
import os
import pathlib
import time

from rank_hosts import BadInput

PATIENCE = 5  # seconds to wait for a session that is ending


class InUse(Exception):
    """Another launcher uses the folder."""


@contextlib.contextmanager
def held(out, resume=False):
    """Holds a lock on the folder `out`. The kernel releases the lock when the process ends for any reason.

    If the folder cannot be made or written, the master reports it. With `resume` this function throws BadInput, because
    the launcher would otherwise restart the master again and again. Throws InUse if another launcher holds the lock.
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
            raise BadInput(f"{out}: cannot be written, but a resumed session writes its journal there; make it writable")
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
