#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests the verdicts in the tables of the report, and that a faulty table is refused by name.

usage: report_faults_test.py
"""

import pathlib
import re
import shutil
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from report_tables import DATA, Altered  # first, because it finds the modules of the report
from report.report_data import Table
from report.report_page import page
from report.report_parts import PARTS
from report.report_text import SECTIONS

EXTREMES = """world,scheme,band,columns,rows,talus,sweeps,at_rest,moved,outflow,lost,measure,start,excess,bound,stays,why
"talus 0°, rough",G,0,31,33,0,2000,1,1662,0,0,face,641,4,4,0,"a quarter"
one cell,G,0,1,1,65536,1,1,0,0,0,slope,-65536,-65536,,1,"moves nothing"
"""


class Verdicts(Altered):
    def of_extremes(self, old="", new=""):
        with tempfile.TemporaryDirectory(prefix="sandwall-report-") as folder:
            file = pathlib.Path(folder) / "extremes.csv"
            self.assertTrue(old in EXTREMES)
            file.write_text(EXTREMES.replace(old, new) if old else EXTREMES)
            return next(section for section in SECTIONS if section.title == "Extremes").text({"extremes": Table(file)})

    def test_a_world_within_its_bound_holds(self):
        text = self.of_extremes()
        self.assertIn("The verdict *holds* is found in all 2 rows. Nearest", text)
        self.assertIn("*talus 0°, rough*, with 4 of 4 units", text)
        self.assertEqual(text.count("| holds |"), 2)

    def test_each_fault_is_the_verdict_of_its_world(self):
        for old, new, world, verdict in (("641,4,4", "641,5,4", "talus 0°, rough", "exceeds its bound"),
                                         ("2000,1,1662,0,0", "2000,1,1662,0,3", "talus 0°, rough", "loses 3 units"),
                                         ("2000,1,", "2000,0,", "talus 0°, rough", "still moves"),
                                         ("2000,1,1662", "2000,1,0", "talus 0°, rough", "does not move"),
                                         ("65536,1,1,0", "65536,1,1,7", "one cell", "moves")):
            with self.subTest(verdict=verdict):
                text = self.of_extremes(old, new)
                self.assertIn(f"in 1 of 2 rows. The others: {world}.", text)
                self.assertIn(f"| **{verdict}** |", text)
                self.assertEqual(text.count("| holds |"), 1)

    def test_a_fault_of_one_mesh_is_the_verdict_of_its_line(self):
        size = self.true["tin-piles"].distinct("N")[-1]
        self.assertNotIn("**no**", self.text("Piles on a TIN", lambda tables: None))
        for column in ("settled", "exact"):
            def alter(tables, column=column):
                tables["tin-piles"].some(pile="low", mesh="regular", N=size)[-1][column] = 0
            lines = self.text("Piles on a TIN", alter).splitlines()
            self.assertEqual([line[:18] for line in lines if "**no** |" in line], ["| low | regular | "])


class FaultyTables(unittest.TestCase):
    """Tables with a missing row, one row, NaN, a short row or no row."""

    def setUp(self):
        self.folder = tempfile.TemporaryDirectory(prefix="sandwall-report-")
        self.addCleanup(self.folder.cleanup)
        self.out = pathlib.Path(self.folder.name)
        self.data = self.out / "data"
        self.data.mkdir()

    @staticmethod
    def draw(name, table, file):
        file.write_text(name)

    def with_lines(self, name, alter):
        """Copies the tables, alters the rows of one, and returns its sections of the page and their complaints."""
        sections = [section for section in SECTIONS if name in section.needs]
        needed = {needed for section in sections for needed in section.needs}
        for table in needed:
            shutil.copy(DATA / f"{table}.csv", self.data)
        file = self.data / f"{name}.csv"
        lines = file.read_text().splitlines()
        first = next(place for place, line in enumerate(lines) if not line.startswith("#")) + 1
        file.write_text("\n".join(lines[:first] + alter(lines[first:])) + "\n")
        return page(self.out, self.draw, sections, [part for part in PARTS if part.name in needed])

    def test_a_row_that_the_text_needs_is_missed_by_name(self):
        size = Table(DATA / "sweeps.csv").distinct("N")[-1]
        text, complaints = self.with_lines("sweeps", lambda rows: [row for row in rows if not row.startswith(f"low,G,0,{size},")])
        self.assertIn(f"sweeps.csv: has no row with pile = low, method = G, band = 0, N = {size}", " ".join(complaints))
        self.assertIn("**This section is missing.** sweeps.csv: has no row", text)

    def test_not_a_number_is_refused_with_its_row(self):
        for bad in ("nan", "-nan", "inf"):
            _, complaints = self.with_lines("budget", lambda rows, bad=bad: [rows[0], re.sub(r"[^,]+$", bad, rows[1]), *rows[2:]])
            self.assertRegex(" ".join(complaints), rf"budget.csv: row 2 \(.*\): misplaced is {bad}")

    def test_a_row_that_is_cut_short_is_refused(self):
        _, complaints = self.with_lines("band", lambda rows: rows[:-1] + [rows[-1][:9]])
        self.assertIn("band.csv: row", " ".join(complaints))

    def test_one_row_or_none_changes_the_text_or_is_refused_by_name(self):
        for name in {name for section in SECTIONS for name in section.needs if (DATA / f"{name}.csv").exists()}:
            true, known = self.with_lines(name, lambda rows: rows)
            self.assertEqual(known, [])
            for count in (1, 0):
                with self.subTest(table=name, rows=count):
                    text, complaints = self.with_lines(name, lambda rows, count=count: rows[:count])
                    self.assertNotEqual(text, true)
                    self.assertTrue(all(f"{name}.csv" in line for line in complaints), complaints)
                    self.assertTrue(complaints or count == 1, "a table without rows is refused")

    def test_a_missing_table_is_named_on_the_page(self):
        for path in DATA.glob("*.csv"):
            shutil.copy(path, self.data / path.name)
        (self.data / "dig.csv").unlink()
        sections = [section for section in SECTIONS if section.title in ("Digging", "The hysteresis band")]
        text, complaints = page(self.out, self.draw, sections, [part for part in PARTS if part.name in ("dig", "band")])
        self.assertIn("Digging: dig.csv: is missing", " ".join(complaints))
        self.assertIn("**Missing on this page:**", text)
        self.assertIn("## The hysteresis band", text)


if __name__ == "__main__":
    unittest.main()
