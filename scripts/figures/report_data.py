# SPDX-License-Identifier: Apache-2.0
"""Tables that sandwall-bench wrote, and functions that take the numbers of the report's text from them."""

import csv
import math
import pathlib


class Table:
    """A table of a CSV file: its rows as dictionaries, with numbers as numbers, and the comment lines above them."""

    def __init__(self, path):
        self.path = pathlib.Path(path)
        lines = self.path.read_text().splitlines()
        self.notes = [line[2:] for line in lines if line.startswith("# ")]
        rows = csv.DictReader(line for line in lines if not line.startswith("#"))
        self.rows = [{key: number(value) for key, value in row.items()} for row in rows]

    def fact(self, name):
        """Returns the value of "machine", "compiler", "command" … in the file's head."""
        return next(note[len(name) + 2:] for note in self.notes if note.startswith(name + ": "))

    def states(self, name):
        """Whether the file's head has a value of this name."""
        return any(note.startswith(name + ": ") for note in self.notes)

    def where(self, **wanted):
        return [row for row in self.rows if all(row[key] == value for key, value in wanted.items())]

    def values(self, column, **wanted):
        return [row[column] for row in self.where(**wanted)]

    def distinct(self, column, **wanted):
        """Returns the values of a column, each once, in the order of their first appearance."""
        return list(dict.fromkeys(self.values(column, **wanted)))

    def one(self, column, **wanted):
        return self.values(column, **wanted)[0]


def number(text):
    try:
        value = float(text)
    except ValueError:
        return text
    return int(value) if value.is_integer() and "." not in text and "e" not in text else value


def held(rows):
    """Returns runs of one pile in which each row's error is replaced by the worst error from there to the run's end.

    An error that a run only passes through does not count as reached, because a user cannot know when to stop.
    """
    worst = {}
    result = []
    for row in sorted(rows, key=lambda row: -row["sweeps"]):
        run = (row["method"], row["N"])
        worst[run] = max(row["misplaced"], worst.get(run, 0))
        result.append(dict(row, misplaced=worst[run]))
    return result


def frontier(rows, cost, error):
    """Returns the samples to which no other sample is better in both cost and error."""
    best = math.inf
    result = []
    for row in sorted(rows, key=lambda row: (row[cost], row[error])):
        if row[error] < best:
            best = row[error]
            result.append(row)
    return result


def least_seconds(rows, error):
    """Returns the least time of all samples with at most this error, or None if all samples are worse."""
    good = [row["seconds_median"] for row in rows if row["misplaced"] <= error]
    return min(good) if good else None


def percent(share, digits=2):
    return f"{100 * share:.{digits}g} %"


def markdown(header, rows):
    lines = ["| " + " | ".join(header) + " |", "|" + "---|" * len(header)]
    return "\n".join(lines + ["| " + " | ".join(str(cell) for cell in row) + " |" for row in rows])


def seconds(value):
    return "never" if value is None else f"{value:.2g} s" if value >= 1 else f"{value * 1e3:.3g} ms" if value >= 1e-3 else f"{float(f'{value * 1e6:.2g}'):g} µs"
