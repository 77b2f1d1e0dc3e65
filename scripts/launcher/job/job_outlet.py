# SPDX-License-Identifier: Apache-2.0
"""A pipe into which mpirun writes its output. So a full disk or a slow reader of the output cannot hinder mpirun.

A thread empties the pipes, so that mpirun never keeps output in memory. If the launcher ends, job_guard.py empties them.
"""

import contextlib
import fcntl
import os
import select
import threading

from job import bounded_log

PIPE_BYTES = 1 << 20
PIECE = 1 << 20
MOST_AT_ONCE = 4 << 20  # bytes that one call of pump() reads
# Bytes that wait to be read as lines. Lines are slow to read, and the thread below must keep up with mpirun meanwhile. mpirun
# keeps all output in memory that the pipe does not take.
MOST_WAITING = 1 << 18
LOOK_MILLISECONDS = 500


class Outlet:
    """`file` is the end of the pipe for mpirun, and `reading` the other end. `log` keeps the output. Any thread."""

    def __init__(self, log):
        self.log = bounded_log.BoundedLog(log)
        self.reading, self.file = os.pipe2(os.O_CLOEXEC)
        os.set_blocking(self.reading, False)
        with contextlib.suppress(OSError):  # the system's limit for a user's pipes is reached
            fcntl.fcntl(self.file, fcntl.F_SETPIPE_SZ, PIPE_BYTES)
        self.waiting = bytearray()  # output that take() has not returned yet
        self.left_out = 0  # bytes before `waiting` that came too fast to be read as lines
        self.lock = threading.Lock()

    def pump(self):
        """Takes what is in the pipe."""
        with self.lock:
            count = 0
            while count < MOST_AT_ONCE:
                try:
                    piece = os.read(self.reading, PIECE)
                except BlockingIOError:
                    return
                if not piece:
                    return
                count += len(piece)
                self.log.write(piece)
                self.waiting += piece
                if (more := len(self.waiting) - MOST_WAITING) > 0:
                    del self.waiting[:more]
                    self.left_out += more

    def take(self):
        """Returns (output since the last call, bytes before it that were left out)."""
        self.pump()
        with self.lock:
            found = bytes(self.waiting), self.left_out
            self.waiting, self.left_out = bytearray(), 0
            return found

    def close(self):
        os.close(self.reading)
        os.close(self.file)
        if self.log.file is not None:
            os.close(self.log.file)


class Pump:
    """Empties pipes in a thread until stop()."""

    def __init__(self, outlets):
        self.outlets = {outlet.reading: outlet for outlet in outlets}
        self.ended = False
        self.thread = threading.Thread(target=self.run, daemon=True)
        self.thread.start()

    def run(self):
        poll = select.poll()
        for reading in self.outlets:
            poll.register(reading, select.POLLIN)
        while not self.ended:
            for reading, _ in poll.poll(LOOK_MILLISECONDS):
                self.outlets[reading].pump()

    def stop(self):
        self.ended = True
        os.write(next(iter(self.outlets.values())).file, b"\n")  # ends the wait
        self.thread.join()
