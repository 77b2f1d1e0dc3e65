# SPDX-License-Identifier: Apache-2.0
"""Waits for a wall that is not there yet, such as a host or an X server that still starts (--wait-for-wall, docs/cluster.md)."""

import time

from base import command_line, console
from base.bad_input import NotYet

LONGEST = 86400  # [s], a day
FIRST_PAUSE, LONGEST_PAUSE = 1, 10  # between two tries [s]
LOOK_SECONDS = 0.05


class Stopped(Exception):
    """A signal has ended the wait."""


class Patience:
    """The time for which a session may wait for its wall, from the making of this object.

    `seconds` is None if it may not wait. `stop` counts signals, as processes.StopSignals does.
    """

    def __init__(self, seconds, stop):
        self.seconds, self.stop = seconds, stop
        self.until = time.monotonic() + (seconds or 0)
        self.pause = FIRST_PAUSE
        self.told = False  # whether the wait was reported

    def renew(self):
        """Begins a new wait, for a wall that has been there."""
        self.until, self.pause, self.told = time.monotonic() + (self.seconds or 0), FIRST_PAUSE, False

    def left(self):
        """Returns the rest of the wait [s], at least 0."""
        return max(0.0, self.until - time.monotonic())

    def wait(self, missing):
        """Waits before another try. `missing` is a line that says what is missing.

        Throws NotYet with this line if the time is over, and Stopped after a signal.
        """
        if self.seconds is None:
            raise NotYet(missing)
        if self.left() == 0:
            raise NotYet(f"{missing}; waited {self.seconds:g} s for it (--wait-for-wall)")
        if not self.told:
            console.print_line(f"waits up to {self.seconds:g} s for this: {missing}")
            self.told = True
        until = time.monotonic() + min(self.pause, self.left())
        self.pause = min(LONGEST_PAUSE, 2 * self.pause)
        while time.monotonic() < until:
            if self.stop.count > 0:
                raise Stopped
            time.sleep(LOOK_SECONDS)

    def until_there(self, question):
        """Returns what question() returns. Asks again as long as it throws NotYet and there is time."""
        while True:
            try:
                return question()
            except NotYet as missing:
                self.wait(str(missing))


def seconds(text):
    """The type of --wait-for-wall for argparse: more than 0, and at most a day [s]."""
    return command_line.number(float, lambda value: 0 < value <= LONGEST, f"more than 0 and at most {LONGEST} s, which is a day")(text)


seconds.__name__ = "float"  # argparse prints this name if the text is not a number
