# SPDX-License-Identifier: Apache-2.0
"""Tables that sandwall-bench wrote, and functions that take the numbers of the report's text from them."""

import csv
import math
import pathlib

# An order has no value at the first N. The other columns are empty in rows to which they do not apply.
MAY_BE_NAN = {"order", "exponent"}
MAY_BE_EMPTY = {"ms_to_rest", "cost", "unit", "why", "ratio", "bound", "behind", "at_end", "of_full"}

IN_TIME = 2  # [ms], time of a step in which the hand digs

# Columns that say what a row is about. All others are results. MORE_KEYS has those of single tables.
KEYS = {"pile", "method", "N", "bits", "band", "variant", "threads", "blocks", "radius", "R", "cells_per_step",
        "sweeps_per_step", "datum", "degrees", "law", "rate", "slope", "shallow", "arm", "delay", "b", "hand", "ground",
        "state", "field", "part", "kind", "what", "tool", "refined", "columns", "rows", "terrain", "mesh", "scheme",
        "code_path", "block", "compiler", "flags", "wall", "link", "load", "nodes", "eye_pixels", "sand", "samples", "unit",
        "used", "why", "world", "integers", "measure", "stays", "talus"}
MORE_KEYS = {"work-precision": {"sweeps"}, "held-tools": {"seconds"}, "decay": {"sweeps"}, "mass-drift": {"sweeps"}, "detail": {"bound"}, "tin-simplify": {"share"}, "large-tools": {"place"},
             "ranks": {"ranks"}, "tin-active": {"raised"}}


class TableFault(Exception):
    """Why a table cannot be used: one line that names the table, and the row if there is one."""


class Table:
    """A table of a CSV file: its rows as dictionaries, with numbers as numbers, and the comment lines above them.

    Raises TableFault if the file has no row, if a row is cut short, or if a number is not finite. The functions below raise
    it for a row or column that is missing.
    """

    def __init__(self, path):
        self.path = pathlib.Path(path)
        try:
            lines = self.path.read_text().splitlines()
        except (OSError, UnicodeDecodeError) as error:
            raise TableFault(f"{self.path.name}: cannot be read ({error})") from None
        self.notes = [line[2:] for line in lines if line.startswith("# ")]
        rows = csv.DictReader((line for line in lines if not line.startswith("#")), restkey="more")
        self.rows = [self._row(place, row) for place, row in enumerate(rows, 1)]
        self.columns = rows.fieldnames or []
        if not self.rows:
            raise TableFault(f"{self.path.name}: has no row")

    def _row(self, place, row):
        if "more" in row or None in row.values():
            raise TableFault(f"{self.path.name}: row {place} has not as many values as the table has columns")
        # A hash stays text, although it may consist of digits alone, or of digits with one e.
        read = {column: text if column.endswith("hash") else number(text) for column, text in row.items()}
        for column, value in read.items():
            empty = value == "" and column not in MAY_BE_EMPTY
            infinite = isinstance(value, float) and not math.isfinite(value) and column not in MAY_BE_NAN
            if empty or infinite:
                raise TableFault(f"{self.path.name}: row {place} ({','.join(row.values())}): {column} is {row[column] or 'empty'}")
        return read

    def fact(self, name, default=None):
        """Returns the value of "machine", "compiler", "command" … in the file's head."""
        found = next((note[len(name) + 2:] for note in self.notes if note.startswith(name + ": ")), default)
        if found is None:
            raise TableFault(f"{self.path.name}: its head has no line with the {name}")
        return found

    def where(self, **wanted):
        for column in wanted:
            self._known(column)
        return [row for row in self.rows if all(row[key] == value for key, value in wanted.items())]

    def some(self, **wanted):
        """Returns the rows with these values, at least one."""
        rows = self.where(**wanted)
        if not rows:
            raise TableFault(f"{self.path.name}: has no row with {', '.join(f'{k} = {v}' for k, v in wanted.items())}")
        return rows

    def values(self, column, **wanted):
        self._known(column)
        return [row[column] for row in self.some(**wanted)]

    def distinct(self, column, **wanted):
        """Returns the values of a column, each once, in the order of their first appearance."""
        return list(dict.fromkeys(self.values(column, **wanted)))

    def one(self, column, **wanted):
        return self.values(column, **wanted)[0]

    def positive(self, column, **wanted):
        """Returns one value by which others are divided."""
        value = self.one(column, **wanted)
        if not isinstance(value, (int, float)) or value <= 0:
            raise TableFault(f"{self.path.name}: {column} is {value}, and not positive, in the row with "
                             f"{', '.join(f'{k} = {v}' for k, v in wanted.items())}")
        return value

    def _known(self, column):
        if column not in self.columns:
            raise TableFault(f"{self.path.name}: has no column {column}")


def number(text):
    try:
        value = float(text)
    except (TypeError, ValueError):
        return text
    return int(value) if value.is_integer() and "." not in text and "e" not in text.lower() else value


def keys_of(name, columns):
    """Returns the columns of a table that say what a row is about."""
    return [column for column in columns if column in KEYS | MORE_KEYS.get(name, set())]


def usual_size(table):
    """Returns the N at which the report compares methods: 128, or the last N of the table."""
    return 128 if 128 in table.distinct("N") else table.distinct("N")[-1]


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


def tools_with_laws(rows):
    """Returns N and R of the tools of large-tools that have been compared with all sweeps, in their order."""
    return list(dict.fromkeys((row["N"], row["R"]) for row in rows if row["law"] != "all sweeps" and row["behind"] != ""))


def built(rows):
    """Returns the row of each case of large-tools that has the law as it is built: the first one with a coarse level."""
    cases = {}
    for row in rows:
        if row["law"] != "all sweeps":
            cases.setdefault((row["place"], row["tool"], row["N"], row["R"]), row)
    return list(cases.values())


def rounded(value, digits):
    """Returns a number with so many significant digits. Only numbers from a million and below 0.0001 get an exponent."""
    return f"{float(f'{value:.{digits}g}'):g}"


def percent(share, digits=2):
    return f"{rounded(100 * share, digits)} %"


def markdown(header, rows):
    lines = ["| " + " | ".join(header) + " |", "|" + "---|" * len(header)]
    return "\n".join(lines + ["| " + " | ".join(str(cell) for cell in row) + " |" for row in rows])


def seconds(value):
    return "never" if value is None else f"{value:.2g} s" if value >= 1 else f"{value * 1e3:.3g} ms" if value >= 1e-3 else f"{rounded(value * 1e6, 2)} µs"
