# SPDX-License-Identifier: Apache-2.0
"""Altered copies of the report's tables, for tests of its texts."""

import pathlib
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path[:0] = [str(ROOT / "scripts" / folder) for folder in ("figures", "launcher")]
from report.report_data import Table, keys_of  # noqa: E402
from report.report_text import SECTIONS  # noqa: E402

DATA = ROOT / "docs" / "report" / "data"


def results(name, table):
    return [column for column in table.columns if column not in keys_of(name, table.columns)]


def reversed_values(values):
    return values[::-1]


def equal_values(values):
    return [1] * len(values)


def zero_values(values):
    return [0] * len(values)


def rising_values(values):
    return [place + 2 if isinstance(value, (int, float)) else f"{value}{place}" for place, value in enumerate(values)]


class Tables(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.true = {path.stem: Table(path) for path in DATA.glob("*.csv")}
        cls.others = [cls.altered(alter) for alter in (reversed_values, equal_values, zero_values, rising_values)]
        # A result that compares two columns may stay if both are altered.
        cls.others += [cls.altered(zero_values, first, 2) for first in (0, 1)]

    @staticmethod
    def altered(alter, first=0, step=1):
        """Returns all tables with their columns of results altered, or only each column `step` from `first` on. An empty entry stays empty, because the texts read it as such."""
        tables = {path.stem: Table(path) for path in DATA.glob("*.csv")}
        for name, table in tables.items():
            for column in results(name, table)[first::step]:
                rows = [row for row in table.rows if row[column] != ""]
                for row, value in zip(rows, alter([row[column] for row in rows])):
                    row[column] = value
            table.notes = [note for note in table.notes if note.startswith(("command", "compiler", "flags", "scene"))]
        return tables


class Altered(Tables):
    def text(self, title, alter):
        tables = {path.stem: Table(path) for path in DATA.glob("*.csv")}
        alter(tables)
        return next(section for section in SECTIONS if section.title == title).text(tables)

    def set(self, name, column, value, **wanted):
        def alter(tables):
            for row in tables[name].some(**wanted):
                row[column] = value
        return alter

    @staticmethod
    def set_one(name, column, value, place=0):
        """Sets the value of one row alone."""
        def alter(tables):
            tables[name].rows[place][column] = value
        return alter

    def counts(self, title, name, what, alter, fewer=1):
        """Asserts that a section counts all rows of its table, and `fewer` less after `alter`."""
        rows = len(self.true[name].rows)
        self.assertIn(f"in all {rows} {what}s", self.text(title, lambda tables: None))
        self.assertIn(f"in {rows - fewer} of {rows} {what}s", self.text(title, alter))
