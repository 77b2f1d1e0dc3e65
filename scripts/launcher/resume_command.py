# SPDX-License-Identifier: Apache-2.0
"""The command that continues a session of `sandwall run`. `run` names it in its last line (docs/recovery.md)."""

import pathlib
import shlex

from ask.session_report import launcher
from base import program_options, session_folder
from base.console import print_line

POINTER = "pointer"
# The session would end at once, be as fast as it can, have the drills again, or write a recording over another one.
LEFT_OUT = ("--visible-tool", "--steps", "--frames", "--warm-up", "--pace", "--inject", "--record")
USUAL = {"restarts": 3, "restart_window": 60}  # of options of `run`; others have no default
NAMED = ("--secret-file", "--stereo", "--desk", "--gl")  # words_of() has them


def words_of(args, out):
    """Returns the words that continue a session. `args` are those of `run`, with files as the user has named them.

    The journal lacks wall, hosts, hand and the options of its programs, so the words have them, except LEFT_OUT. Variables of
    --env have their names alone, because a value may be secret.
    """
    words = [launcher(), "run", "--resume", "--out", out, "--wall", args.wall]
    if args.device not in ("none", POINTER):  # the haptic server reads the scene; the master has it from the journal
        words += ["--scene", args.scene] + (["--as-heights"] if args.as_heights else [])
    words += ["--device", args.device] if args.device != "none" else []
    for option in ("haptic", "hosts", "network", "secret_file", "stereo", "desk"):
        value = getattr(args, option, None)
        words += [f"--{option.replace('_', '-')}", str(value)] if value else []
    words += ["--gl", args.gl] if args.gl != "auto" and args.device != POINTER else []
    for option in ("restarts", "restart_window", "wait_for_wall", "gl_threads"):
        value = getattr(args, option, None)
        if value is not None and value != USUAL.get(option):
            words += [f"--{option.replace('_', '-')}", str(program_options.whole(value))]
    words += ["--json"] if getattr(args, "json", False) else []
    for given in getattr(args, "env", []):
        words += ["--env", given.partition("=")[0]]
    return words + words_of_programs(args) + (["--here"] if args.here else [])


def is_default(value, option):
    """Returns whether an option has its default. A number may be written in several ways."""
    return "default" in option and (program_options.type_of(option) or str)(option["default"]) == value


def words_of_programs(args):
    """Returns the words of options of master and haptic server that are given, and not their defaults."""
    words, seen = [], {*LEFT_OUT, *NAMED}
    for program in (program_options.MASTER, program_options.SERVER):
        for option in program_options.offered("run", program):
            value = getattr(args, program_options.variable(option), None)
            if option["name"] in seen or value is None or value is False or value == [] or is_default(value, option):
                continue
            seen.add(option["name"])
            for single in value if isinstance(value, list) else [value]:
                words += [option["name"]] if value is True else [option["name"], str(program_options.whole(single))]
    return words


def print_line_of(args, out):
    """Prints the command that continues the session in `out`, if it has a journal."""
    if (pathlib.Path(out) / session_folder.JOURNAL).is_file():
        print_line(f"`{shlex.join(words_of(args, out))}` continues with this sand")
