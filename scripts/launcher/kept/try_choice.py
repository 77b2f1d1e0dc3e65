# SPDX-License-Identifier: Apache-2.0
"""Chooses between earlier sand and new sand for `sandwall try`, and prints the command that continues (docs/pointer.md)."""

import os
import pathlib
import shlex
import time
from typing import NamedTuple, Optional

from base import layout, session_folder
from base.bad_input import BadInput
from base.command_line import BAD_INPUT
from base.console import print_line
from kept import try_sessions

ROOT = "out/try"  # folder of all sessions without --out


class Choice(NamedTuple):
    """A folder for `run`. `begins` says that the sand is new, and `claim` keeps other sessions of `try` away."""

    out: str
    begins: bool
    claim: Optional[int] = None


def of_folder(out, new):
    """Returns the Choice of a folder that the user has named. Throws BadInput if new sand would move its journal away."""
    out = layout.session_at(out)
    begins = not (pathlib.Path(out) / session_folder.JOURNAL).exists()
    if new and not begins:
        raise BadInput(f"--new: {out} holds sand already; leave out --new to continue with it, or choose another --out")
    return Choice(out, begins)


def below_root(scene, new):
    """Returns the Choice among the sessions of a scene, a marks.Scene."""
    out, claim = (None, None) if new else try_sessions.claimed_of(ROOT, scene)
    begins = out is None
    if begins:
        out, claim = try_sessions.make_new(ROOT, scene)
    return Choice(str(out), begins, claim)


def give_up(choice):
    """Gives up the claim of a session that has ended. Removes the folder of a new one if only the mark is in it."""
    if choice.claim is not None:
        if choice.begins:
            try_sessions.discard(choice.out)
        os.close(choice.claim)


def make_room(choice):
    """Removes the sessions that are too many, each with a line."""
    try_sessions.make_room(ROOT, choice.out)


def commands(again, named):
    """Returns (the command that continues, the end of a sentence about new sand) for a terminal.

    `again` are the words that continue. With `named` the user has named the folder.
    """
    fresh = "another --out begins" if named else f"`{shlex.join([*again, '--new'])}` begins"
    return f"`{shlex.join(again)}`", f"{fresh} with new sand"


def print_beginning(choice, again, named):
    """Says which sand is continued, and how to get new sand."""
    if not choice.begins:
        last = (pathlib.Path(choice.out) / session_folder.JOURNAL).stat().st_mtime
        when = time.strftime("%Y-%m-%d %H:%M", time.localtime(last))
        print_line(f"continues with your sand of {when} in {choice.out}; {commands(again, named)[1]}")


def print_end(choice, again, named, status):
    """Prints the last line of `try`: the command that continues, unless the session left no journal."""
    if not (pathlib.Path(choice.out) / session_folder.JOURNAL).exists():
        return
    command, fresh = commands(again, named)
    refused = status == BAD_INPUT and not choice.begins
    print_line(f"the sand stays in {choice.out}; {fresh}" if refused else f"{command} continues with this sand, and {fresh}")
