# SPDX-License-Identifier: Apache-2.0
"""Checks the environment variables of Sandwall like options, and reads those that --env gives to the ranks."""

import os
import re

from base.bad_input import BadInput

BIN = "SANDWALL_BIN"
EVENTS = "SANDWALL_EVENTS"
START_TIMEOUT = "SANDWALL_START_TIMEOUT"  # [s], read by the ranks (lockstep/watchdog.hpp)
LONGEST_START = 3600  # [s]
NUMBER = re.compile(r"[0-9]+(\.[0-9]*)?([eE][+-]?[0-9]+)?")
NAME = re.compile(r"[A-Za-z_][A-Za-z0-9_]*")
OPEN_MPI = ("OMPI_", "PMIX_", "PRTE_")  # mpirun writes the values of such variables into the command lines of its daemons


def why_bad(environment):
    """Returns why a variable of Sandwall in `environment` cannot be used, as one line, or None. An empty value counts as unset."""
    if (value := environment.get(EVENTS, "")) not in ("", "0", "1"):
        return f"{EVENTS}: must be 0 or 1, got '{value}'"
    value = environment.get(START_TIMEOUT, "")
    if value and not (NUMBER.fullmatch(value) and 1 <= float(value) <= LONGEST_START):
        return f"{START_TIMEOUT}: must be a number from 1 to {LONGEST_START} [s], got '{value}'; unset it for 120 s"
    folder = environment.get(BIN)
    return f"{BIN}: {folder} is not a folder; unset it, or set it to the folder of the programs" if folder and not os.path.isdir(folder) else None


def for_ranks(words):
    """Returns the variables that the words of --env, NAME=VALUE or NAME, give to every rank.

    Throws BadInput for a word that cannot be used. The message never shows a value that may be secret.
    """
    variables = {}
    for word in words:
        name, equals, value = word.partition("=")
        if not NAME.fullmatch(name) or "\n" in value:
            raise BadInput(f"--env {name}: write NAME, or NAME=VALUE in one line")
        if name.startswith(OPEN_MPI):
            raise BadInput(f"--env {name}: belongs to Open MPI, which shows its value in command lines; export it instead")
        if not equals and name not in os.environ:
            raise BadInput(f"--env {name}: is not set here; export it, or write {name}=VALUE")
        variables[name] = value if equals else os.environ[name]
    if why := why_bad(variables):
        raise BadInput(f"--env {why}")
    return variables
