# SPDX-License-Identifier: Apache-2.0
"""Reads the tables of bugs, tests/mutations/*.toml, and finds the line of each in the sources. docs/testing.md

A row names a function, a class or a constant, but no file, so that these can move without a change of the row.
"""

import dataclasses
import textwrap
import tomllib

import product
from definitions import Definitions

KEYS = {"what", "in", "line", "wrong", "tests", "programs", "also"}


class Misplaced(Exception):
    """A row whose line is not in the sources exactly once."""


@dataclasses.dataclass(frozen=True)
class Place:
    """One change of a row: in the definition `where`, the whole lines `line` become `wrong`; if this is empty, they go."""

    where: str
    line: str
    wrong: str


@dataclasses.dataclass(frozen=True)
class Row:
    """A bug with its test."""

    name: str
    what: str
    places: tuple
    tests: str  # PROGRAM FILTER, or FILE.py [CLASS.TEST]
    programs: tuple = ()  # that the test starts


@dataclasses.dataclass(frozen=True)
class Change:
    """The place of a row in the sources: the lines from `first` to `last` of `file`, from 1, become `lines`."""

    file: str
    first: int
    last: int
    lines: tuple


def planted(text, changes):
    """Returns the text of a source with its `changes`."""
    lines = text.split("\n")
    for change in sorted(changes, key=lambda each: -each.first):  # from the end, so that the numbers of the others stay right
        lines[change.first - 1:change.last] = change.lines
    return "\n".join(lines)


def rows(folder):
    """Returns the rows of all tables in `folder`. Throws ValueError for a row that is not whole."""
    found = {}
    for file in sorted(folder.glob("*.toml")):
        for name, row in tomllib.loads(file.read_text()).items():
            if file.name == "drawn.toml":
                continue
            if name in found:
                raise ValueError(f"{file.name}: {name} stands in another table, too")
            if not {"what", "in", "line", "wrong", "tests"} <= row.keys() <= KEYS:
                raise ValueError(f"{file.name}: {name} has the keys {', '.join(row)}; it needs what, in, line, wrong and tests")
            places = [Place(each["in"], each["line"], each["wrong"]) for each in (row, *row.get("also", ()))]
            found[name] = Row(name, row["what"], tuple(places), row["tests"], tuple(row.get("programs", ())))
    return list(found.values())


class Sources:
    """The sources of the product in `root`, and what they define."""

    def __init__(self, root):
        self.root = root
        self.lines_of = {}
        self.definitions = Definitions(root, product.sources(root))

    def lines(self, file):
        if file not in self.lines_of:
            self.lines_of[file] = (self.root / file).read_text().split("\n")
        return self.lines_of[file]

    def changes(self, row):
        """Returns the changes of a row. Throws Misplaced."""
        return [self.change(row.name, place) for place in row.places]

    def change(self, name, place):
        defined = self.definitions.named(place.where)
        if not defined:
            raise Misplaced(f"{name}: nothing is named {place.where}")
        wanted = [line.strip() for line in place.line.strip("\n").split("\n")]
        found = {(one.file, at) for one in defined for at in self.occurrences(one, wanted)}
        if not found:
            raise Misplaced(f"{name}: {place.where} has no line `{place.line.strip()}`")
        if len(found) > 1:
            places = ", ".join(f"{file}:{at}" for file, at in sorted(found))
            raise Misplaced(f"{name}: the line `{place.line.strip()}` of {place.where} stands at {places}; "
                            "add the next line, or more of the function's name")
        file, at = found.pop()
        first = self.lines(file)[at - 1]
        indent = first[:len(first) - len(first.lstrip())]
        wrong = textwrap.indent(textwrap.dedent(place.wrong.strip("\n")), indent)
        return Change(file, at, at + len(wanted) - 1, tuple(wrong.split("\n")) if wrong else ())

    def occurrences(self, definition, wanted):
        """Yields the numbers of the lines in `definition` at which the lines `wanted` begin."""
        lines = self.lines(definition.file)
        for at in range(definition.first, min(definition.last, len(lines)) - len(wanted) + 2):
            if [line.strip() for line in lines[at - 1:at - 1 + len(wanted)]] == wanted:
                yield at
