# SPDX-License-Identifier: Apache-2.0
"""The command that continues a session of `sandwall run`. `run` names it in its last line (docs/recovery.md)."""

import pathlib
import shlex

from ask.session_report import launcher
from base import session_folder
from base.console import print_line

POINTER = "pointer"


def words_of(args, out):
    """Returns the words that continue a session. `args` are those of `run`, with files as the user has named them.

    The journal lacks wall, hosts and hand, so the words have them. They lack --steps, with which the session would end at
    once. They lack --pace, with which it would dig as fast as it can.
    """
    words = [launcher(), "run", "--resume", "--out", out, "--wall", args.wall]
    if args.device not in ("none", POINTER):  # the haptic server reads the scene; the master has it from the journal
        words += ["--scene", args.scene] + (["--as-heights"] if args.as_heights else [])
    words += ["--device", args.device] if args.device != "none" else []
    for option in ("haptic", "hosts", "network", "secret_file", "stereo", "desk"):
        value = getattr(args, option, None)
        words += [f"--{option.replace('_', '-')}", str(value)] if value else []
    words += ["--gl", args.gl] if args.gl != "auto" and args.device != POINTER else []
    return words + (["--here"] if args.here else [])


def print_line_of(args, out):
    """Prints the command that continues the session in `out`, if it has a journal."""
    if (pathlib.Path(out) / session_folder.JOURNAL).is_file():
        print_line(f"`{shlex.join(words_of(args, out))}` continues with this sand")
