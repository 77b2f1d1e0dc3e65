# SPDX-License-Identifier: Apache-2.0
"""Reads which release wrote a journal, from the first bytes of the file (journal/file_origin.cpp)."""

import functools
import os
import re
import struct
import subprocess
from typing import NamedTuple

from base import checked_json, layout, session_folder
from base.bad_input import BadInput
from base.program_options import MASTER

HEAD = struct.Struct("<4sIII")  # magic number, format, algorithm version, length of the name of the release
RELEASE = re.compile(rb"[0-9A-Za-z.+-]{1,32}")  # it is printed, and may come from a hostile file


class Damaged(Exception):
    """The file does not begin as a journal does. The text says why."""


class Origin(NamedTuple):
    format: int
    algorithm: int
    release: str


def of(journal):
    """Returns the Origin of a journal. Throws Damaged, and OSError if it cannot be read or is a link or no regular file."""
    file = session_folder.open_regular(journal, os.O_RDONLY)
    try:
        begin = os.pread(file, HEAD.size + 32, 0)
    finally:
        os.close(file)
    if begin[:4] != session_folder.MAGIC:
        raise Damaged("it does not begin as a journal does")
    if len(begin) < HEAD.size:
        raise Damaged("it is cut off in its first bytes")
    _, form, algorithm, length = HEAD.unpack_from(begin)
    release = begin[HEAD.size:HEAD.size + length] if length <= 32 else b""
    if not RELEASE.fullmatch(release):
        raise Damaged("it names no release")
    return Origin(form, algorithm, release.decode())


@functools.cache
def ours():
    """Returns the Origin of the journals that this build writes. Throws BadInput if the master does not answer."""
    master = layout.program(MASTER)
    try:
        said = checked_json.parse(subprocess.run([master, "--version", "--json"], stdin=subprocess.DEVNULL, capture_output=True, text=True,
                                                 errors="replace", timeout=layout.ANSWER_SECONDS, check=False).stdout)
        return Origin(int(said["journal"]), int(said["algorithm"]), str(said["version"]))
    except (OSError, ValueError, LookupError, TypeError, subprocess.TimeoutExpired):
        raise BadInput(f"{master}: does not answer --version --json; {layout.MEND}") from None


def refusal(origin):
    """Returns why this release does not read a journal, and which one does, in the words of the master. None: it reads the journal."""
    own = ours()
    if origin[:2] == own[:2]:
        return None
    advice = f"another build of {origin.release} wrote it, or it is damaged" if origin.release == own.release else f"use sandwall {origin.release}"
    return (f"written by sandwall {origin.release} (journal format {origin.format}, algorithm {origin.algorithm}); this is {own.release} "
            f"(format {own.format}, algorithm {own.algorithm}): {advice}")
