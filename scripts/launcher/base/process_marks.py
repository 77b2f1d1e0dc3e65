# SPDX-License-Identifier: Apache-2.0
"""Finds processes by a variable in their environment, which they hand on to all that they start."""

import os
import pathlib
import time

# Places among the words behind the name in /proc/PID/stat: startcode, env_start and env_end of proc(5).
CODE, ENVIRONMENT_BEGIN, ENVIRONMENT_END = 23, 47, 48
EMPTY_SECONDS = 1  # after which an environment counts as empty; a program may have unmapped it


def marked(mark):
    """Returns the ids of the processes of this user that have `mark`, a whole entry NAME=VALUE, in their environment.

    Root can read every process's environment, and any user can write any mark into that of a process.
    """
    return [int(entry) for entry in os.listdir("/proc") if entry.isdigit() and has_mark(entry, mark)]


def has_mark(pid, mark):
    process = pathlib.Path("/proc", str(pid))
    try:
        return process.stat().st_uid == os.geteuid() and mark in environment_of(process).split(b"\0")
    except OSError:
        return False  # it has ended, or belongs to another user


def environment_of(process):
    """Returns the environment of a process, given by its folder in /proc. Throws OSError if it has ended.

    While a process begins another program, its environment seems empty. On a busy machine that takes a while. An environment
    that was opened before and is read after that seems empty, too. The kernel sets the start of the code last. With it, equal
    addresses of the start and the end tell that an environment is really empty.
    """
    deadline = time.monotonic() + EMPTY_SECONDS
    while not (text := (process / "environ").read_bytes()) and time.monotonic() < deadline:
        (process / "exe").readlink()  # throws for threads of the kernel and for processes that have ended
        numbers = (process / "stat").read_text().rpartition(")")[2].split()
        if int(numbers[CODE]) != 0 and numbers[ENVIRONMENT_BEGIN] == numbers[ENVIRONMENT_END]:
            break
        time.sleep(0.001)
    return text
