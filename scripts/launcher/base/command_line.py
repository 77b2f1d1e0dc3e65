# SPDX-License-Identifier: Apache-2.0
"""Command lines of the scripts: errors in one line, and types of numbers for argparse. These types refuse nan and inf."""

import argparse
import math
import os

from base import environment

BAD_INPUT = 2
NOT_YET = 75  # something is missing that may still come (base::kExitNotYet)


class Parser(argparse.ArgumentParser):
    """Reports an error in one line, as all our programs do. Checks the environment variables of Sandwall too.

    Adds 022 to the umask: no file of this process and of those that it starts is writable for its group or for others.
    """

    def __init__(self, **options):
        super().__init__(**options)
        os.umask(os.umask(0o022) | 0o022)
        self.later = self.help_later = None

    def add_later(self, complete):
        """Calls `complete` before the first parse. A command of many has options then only if it is the chosen one."""
        self.later = complete

    def add_help_later(self, complete):
        """Calls `complete` before the first help. For texts that need a build, in a command that does not."""
        self.help_later = complete

    def format_help(self):
        if self.help_later is not None:
            complete, self.help_later = self.help_later, None
            complete()
        return super().format_help()

    def parse_known_args(self, *args, **options):
        if self.later is not None:
            if why := environment.why_bad(os.environ):  # before the programs are looked for
                self.exit(BAD_INPUT, f"{self.prog.split()[0]}: {why}\n")
            complete, self.later = self.later, None
            complete()
        return super().parse_known_args(*args, **options)

    def parse_args(self, *args, **options):
        parsed = super().parse_args(*args, **options)
        if why := environment.why_bad(os.environ):
            self.exit(BAD_INPUT, f"{self.prog}: {why}\n")
        return parsed

    def error(self, message):
        self.exit(BAD_INPUT, f"{self.prog}: {message}; try --help\n")


def number(kind, allowed, words):
    """Returns a type for argparse: finite numbers of `kind` for which `allowed` is true. `words` say which these are."""
    def read(text):
        value = kind(text)
        if not math.isfinite(value):
            raise argparse.ArgumentTypeError(f"must be a finite number, got {text}")
        if not allowed(value):
            raise argparse.ArgumentTypeError(f"{text} must be {words}")
        return value

    read.__name__ = kind.__name__  # argparse prints this name if the text is not a number
    return read


def at_least(kind, least):
    return number(kind, lambda value: value >= least, f"{least} or more")


def above(kind, bound):
    return number(kind, lambda value: value > bound, f"more than {bound}")


def within(kind, least, most):
    return number(kind, lambda value: least <= value <= most, f"from {least} to {most}")
