# SPDX-License-Identifier: Apache-2.0
"""Writes lines to the launcher's own standard output and error.

The launcher must not end because a log is on a full disk or the reader of its output has gone. So this module drops a line
that cannot be written. As soon as the stream can be written again, it prints how many lines are missing.
"""

import contextlib
import os
import re
import sys
import threading

CONTROLS = re.compile("[\x00-\x1f\x7f-\x9f\u2028\u2029]")  # a name that holds one could begin a line of its own, or command a terminal


def encoded(text):
    """Returns `text` in UTF-8. Names of files keep their bytes. Halves of surrogate pairs, which JSON can hold, become '?'."""
    try:
        return text.encode(errors="surrogateescape")
    except UnicodeEncodeError:
        return text.encode(errors="replace")


class Console:
    """One stream of this process. `descriptor` is None if the process was started without the stream. Any thread."""

    def __init__(self, descriptor):
        self.descriptor = descriptor
        self.lost = 0  # lines since the last one that was written
        self.why = ""  # the system's reason for the last lost line
        self.torn = False  # whether the last write ended within a line
        self.lock = threading.Lock()

    def line(self, text):
        """Writes `text`, a str or bytes, and a line feed. Raises nothing if the stream cannot be written."""
        if isinstance(text, str):
            text = encoded(text)
        with self.lock:
            if self.lost:
                lines = "1 line is" if self.lost == 1 else f"{self.lost} lines are"
                notice = f"sandwall: {lines} missing here, because this output could not be written ({self.why})"
                if not self.write(notice.encode()):
                    self.lost += 1
                    return
                self.lost = 0
            if not self.write(text):
                self.lost += 1

    def write(self, text):
        """Returns whether all of the line was written."""
        # os.write and not sys.stdout, because a failed write would stay in the buffer of sys.stdout and fail again at the end.
        rest = (b"\n" if self.torn else b"") + text + b"\n"
        try:
            while self.descriptor is not None and rest:
                count = os.write(self.descriptor, rest)
                rest = rest[count:]
                self.torn = bool(rest)
        except OSError as error:
            self.why = error.strerror
            return False
        return self.descriptor is not None


# Python has no sys.stdout if descriptor 1 was closed. A file that is opened later may then have the descriptor 1.
OUT = Console(None if sys.stdout is None else 1)
ERROR = Console(None if sys.stderr is None else 2)


def colours():
    """Returns whether standard output is a terminal whose user wants colours."""
    return OUT.descriptor is not None and os.isatty(OUT.descriptor) and "NO_COLOR" not in os.environ


def print_line(line):
    """Prints a line of the launcher for a person. A name in it cannot begin another line."""
    ERROR.line(f"sandwall: {CONTROLS.sub('?', str(line))}")


@contextlib.contextmanager
def reader_may_go():
    """Ends the program without a traceback if the reader of standard output has gone, as `head` does."""
    try:
        yield
    except BrokenPipeError:
        pass
    finally:
        try:
            if sys.stdout is not None:
                sys.stdout.flush()
        except BrokenPipeError:
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())  # Python would try again when it ends
