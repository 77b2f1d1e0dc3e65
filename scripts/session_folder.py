# SPDX-License-Identifier: Apache-2.0
"""A session's folder, which one launcher has at a time."""

import fcntl
import os
import pathlib
import time

from rank_hosts import BadInput

PATIENCE = 5  # seconds, for a session that is just ending


class InUse(Exception):
    """Another launcher has the folder."""


class SessionFolder:
    """Holds OUT for as long as it lives; the lock is the kernel's and goes with the process, however that ends.

    A folder that cannot be made or written is the master's to complain of, but where a session goes on in it: that
    would be tried again and again.
    """

    def __init__(self, out, resume):
        self.descriptor = None
        path = pathlib.Path(out)
        try:
            path.mkdir(parents=True, exist_ok=True)
            self.descriptor = os.open(path, os.O_RDONLY | os.O_DIRECTORY | os.O_CLOEXEC)
            self.lock()
        except BlockingIOError:
            raise InUse(f"{out}: another session runs in this folder; stop that one first, or choose another --out") from None
        except OSError:
            return
        if resume and not os.access(path, os.W_OK | os.X_OK):
            raise BadInput(f"{out}: cannot be written, and a session that goes on writes its journal there; make it writable")

    def lock(self):
        deadline = time.monotonic() + PATIENCE
        while True:
            try:
                return fcntl.flock(self.descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except BlockingIOError:
                if time.monotonic() > deadline:
                    raise
            time.sleep(0.05)
