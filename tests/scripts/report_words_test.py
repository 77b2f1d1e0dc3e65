#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests that the sentences of the report follow its tables: altered tables change them, or are refused by name.

usage: report_words_test.py
"""

import pathlib
import re
import shutil
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "scripts" / folder) for folder in ("figures", "launcher")]
from report_data import Table, TableFault, keys_of  # noqa: E402
from report_page import page  # noqa: E402
from report_parts import PARTS  # noqa: E402
from report_text import SECTIONS, Section  # noqa: E402

DATA = ROOT / "docs" / "report" / "data"

# Words of a sentence that claims a result.
CLAIMS = re.compile(r"\b(never|always|every|converges?|orders?|whatever|no matter|however long|cannot|exactly|nearly|"
                    r"faster|slower|better|worse|fewer|best|grows?|falls?|depends?|bears?|hardly)\b", re.IGNORECASE)
# Constant sentences with such a word, which define a word or a measurement.
DEFINITIONS = (
    "The entry *never* means that the method does not reach this error in this table.",
    "An error counts from the point where the run does not exceed it again, because a user cannot know when to stop.",
    "The ratio is how many times faster than the reference a method is.",
)


def sentences(text):
    """Returns the sentences of a section, without its tables."""
    prose = [line for line in text.splitlines() if line and not line.startswith("|")]
    return [part.strip() for line in prose for part in re.split(r"(?<=[.:?])\s+(?=[A-Z*\[])", line)]


def results(name, table):
    return [column for column in table.columns if column not in keys_of(name, table.columns)]


def reversed_values(values):
    return values[::-1]


def equal_values(values):
    return [1] * len(values)


def rising_values(values):
    return [place + 2 if isinstance(value, (int, float)) else f"{value}{place}" for place, value in enumerate(values)]


class Tables(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.true = {path.stem: Table(path) for path in DATA.glob("*.csv")}
        cls.others = [cls.altered(alter) for alter in (reversed_values, equal_values, rising_values)]

    @staticmethod
    def altered(alter):
        """Returns all tables with each column of results altered."""
        tables = {path.stem: Table(path) for path in DATA.glob("*.csv")}
        for name, table in tables.items():
            for column in results(name, table):
                for row, value in zip(table.rows, alter([row[column] for row in table.rows])):
                    row[column] = value
            table.notes = [note for note in table.notes if note.startswith(("command", "compiler", "flags", "scene"))]
        return tables


def constants(section, true, others):
    """Returns the sentences that a section prints for the true tables and for all others too."""
    kept = set(sentences(section.text(true)))
    for tables in others:
        try:
            kept &= set(sentences(section.text(tables)))
        except TableFault:
            pass
    return kept


class ConstantSentences(Tables):
    def test_a_sentence_that_claims_a_result_follows_the_tables(self):
        for section in SECTIONS:
            if all(name in self.true for name in section.needs):
                kept = constants(section, self.true, self.others)
                for sentence in {sentence for sentence in kept if not sentence.endswith("?")} - set(DEFINITIONS):
                    self.assertIsNone(CLAIMS.search(sentence), f"{section.title}: the tables do not decide: {sentence}")
                self.assertNotEqual(kept, set(sentences(section.text(self.true))), f"{section.title}: its text has no result")

    def test_finds_a_constant_claim(self):
        constant = Section("Made up", None, ["sweeps"], lambda tables: "A diamond never becomes a circle. The table has sweeps.")
        kept = constants(constant, self.true, self.others)
        self.assertTrue(any(CLAIMS.search(sentence) for sentence in kept))


class AlteredTables(Tables):
    def text(self, title, alter):
        tables = {path.stem: Table(path) for path in DATA.glob("*.csv")}
        alter(tables)
        return next(section for section in SECTIONS if section.title == title).text(tables)

    def set(self, name, column, value, **wanted):
        def alter(tables):
            for row in tables[name].some(**wanted):
                row[column] = value
        return alter

    def test_a_peer_that_wins_is_named(self):
        peer = {"method": "float32 N8 sqrt2 Jacobi"}
        text = self.text("Error against time, at one N", self.set("work-precision", "misplaced", 1e-6, **peer))
        self.assertIn("it is smaller with float32 N8 sqrt2 Jacobi", text)
        self.assertNotIn("times as large with the others", text)

        def wins(tables):
            self.set("work-precision", "misplaced", 1e-6, **peer)(tables)
            self.set("work-precision", "seconds_median", 1e-9, **peer)(tables)
        text = self.text("Least time for a wanted error", wins)
        self.assertIn("at no error of this table", text)
        self.assertIn("no error at N = 128", text)

    def test_an_order_of_two_fifths_is_no_convergence(self):
        text = self.text("Error at rest against N", self.set("error-at-rest", "order", 0.4, method="G"))
        self.assertIn("That of G falls slowly with N (orders from 0.40 to 0.40)", text)
        self.assertNotIn("That of G converges", text)
        text = self.text("Error at rest against N", self.set("error-at-rest", "order", 1.5, method="N4"))
        self.assertIn("That of N4 converges", text)

    def test_an_arm_that_does_not_rest_is_named(self):
        text = self.text("Springs that an arm bears", self.set("stability", "bears", 400, arm="falcon", delay=1))
        self.assertIn("the arm falcon stops resting above 400 N/m", text)
        self.assertNotIn("each stiffness that was tried", text)

    def test_sand_that_is_lost_is_reported(self):
        text = self.text("Mass", self.set("mass-drift", "drift", 1e-9, method="G"))
        self.assertIn("up to 1.0e-09", text)
        self.assertNotIn("exactly", text)

    def test_a_bound_below_the_distance_is_counted(self):
        text = self.text("The certificate", self.set("certificate", "bound", 0, method="N4"))
        self.assertNotIn("in all", text)

    def test_hashes_that_differ_are_reported(self):
        self.assertIn("**the hashes differ**", self.text("One hash", self.set("hashes-release", "hash", "0", threads=7)))


EXTREMES = """world,scheme,band,columns,rows,talus,sweeps,at_rest,moved,outflow,lost,measure,start,excess,bound,stays,why
"talus 0°, rough",G,0,31,33,0,2000,1,1662,0,0,face,641,4,4,0,"a quarter"
one cell,G,0,1,1,65536,1,1,0,0,0,slope,-65536,-65536,,1,"moves nothing"
"""


class Verdicts(unittest.TestCase):
    def text(self, old="", new=""):
        with tempfile.TemporaryDirectory(prefix="sandwall-report-") as folder:
            file = pathlib.Path(folder) / "extremes.csv"
            self.assertTrue(old in EXTREMES)
            file.write_text(EXTREMES.replace(old, new) if old else EXTREMES)
            return next(section for section in SECTIONS if section.title == "Extremes").text({"extremes": Table(file)})

    def test_a_world_within_its_bound_holds(self):
        text = self.text()
        self.assertIn("The verdict *holds* is found in all 2 rows. Nearest", text)
        self.assertIn("*talus 0°, rough*, with 4 of 4 units", text)

    def test_each_fault_is_the_verdict_of_its_world(self):
        for old, new, world, verdict in (("641,4,4", "641,5,4", "talus 0°, rough", "exceeds its bound"),
                                         ("2000,1,1662,0,0", "2000,1,1662,0,3", "talus 0°, rough", "loses 3 units"),
                                         ("2000,1,", "2000,0,", "talus 0°, rough", "still moves"),
                                         ("2000,1,1662", "2000,1,0", "talus 0°, rough", "does not move"),
                                         ("65536,1,1,0", "65536,1,1,7", "one cell", "moves")):
            with self.subTest(verdict=verdict):
                text = self.text(old, new)
                self.assertIn(f"in 1 of 2 rows. The others: {world}.", text)
                self.assertIn(f"**{verdict}**", text)


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
        text, complaints = self.with_lines("sweeps", lambda rows: [row for row in rows if not row.startswith("low,G,0,128")])
        self.assertIn("sweeps.csv: has no row with pile = low, method = G, band = 0, N = 128", " ".join(complaints))
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
