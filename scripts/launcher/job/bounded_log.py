# SPDX-License-Identifier: Apache-2.0
"""A file of output that stays small: the first and the newest lines are kept (docs/recovery.md)."""

import os
import resource

MOST_BYTES = 8 << 20  # of one file; a try has two of them


def most_bytes():
    """Returns MOST_BYTES, or the limit of this process for the size of a file (ulimit -f) if that is lower."""
    limit = resource.getrlimit(resource.RLIMIT_FSIZE)[0]
    return MOST_BYTES if limit == resource.RLIM_INFINITY else min(MOST_BYTES, limit)


def shorten(file, size, most, left_out):
    """Leaves out lines in the middle of a file of this size, so that it is shorter than `most`. Returns its new size.

    `left_out` is the number of bytes that earlier calls have left out. The line in their place names all of them.
    Throws OSError.
    """
    first = os.pread(file, most // 2, 0)
    end = first.rfind(b"\n", 0, most // 2) + 1 or len(first)
    newest = os.pread(file, most // 4, size - most // 4)
    newest = newest[newest.find(b"\n") + 1:]
    gap = size - end - len(newest) + left_out
    os.ftruncate(file, end)
    text = b"[%d bytes are left out here]\n%s" % (gap, newest)
    return end + os.write(file, text)


class BoundedLog:
    """A log that only this process writes. `file` is a descriptor opened with O_APPEND, or None if nothing is kept."""

    def __init__(self, file):
        self.file = file
        self.size = 0
        self.total = 0  # bytes that were written in all
        self.most = most_bytes()
        self.why = ""  # the system's reason why the newest piece could not be written

    def write(self, text):
        """Writes `text`. A piece that the disk does not take is lost, and `why` has the reason."""
        if self.file is None:
            return
        text = text[-(self.most // 4):] if len(text) > self.most // 4 else text
        try:
            if self.size + len(text) > self.most:
                self.size = shorten(self.file, self.size, self.most, self.total - self.size)
            while text:
                count = os.write(self.file, text)
                self.size, self.total, text = self.size + count, self.total + count, text[count:]
        except OSError as error:
            self.why = error.strerror
