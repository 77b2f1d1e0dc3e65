#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests that the sentences of the report follow its tables: altered tables change them.

usage: report_words_test.py
"""

import pathlib
import re
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from report_tables import DATA, Altered, Tables  # first, because it finds the modules of the report
from report.report_claims import listing
from report.report_data import Table, TableFault
from report.report_page import builds_of
from report.report_parts import PRESETS
from report.report_text import SECTIONS, Section

# Words of a sentence that claims a result.
CLAIMS = re.compile(r"\b(never|always|every|converges?|orders?|whatever|no matter|however long|cannot|exactly|nearly|"
                    r"faster|slower|better|worse|fewer|best|grows?|falls?|depends?|bears?|hardly|"
                    r"all|none|same|changes)\b", re.IGNORECASE)
# Constant sentences with such a word, which define a word or a measurement.
DEFINITIONS = (
    "The entry *never* means that the method does not reach this error in this table.",
    "An error counts from the point where the run does not exceed it again, because a user cannot know when to stop.",
    "The ratio is how many times faster than the reference a method is.",
    "The figure shows the same pile from the same start at one N, with one point per sample of the run.",
    "The figure shows the same pile in coarser and finer height units.",
    "The table has the rows of 1.5 cells per step on the largest grid and on TINs; [data](data/dig.csv) has all.",
    "- *lifted*: the same sum after the tool is lifted, so that the hole it leaves has to fill too.",
    "The row *copy* reads and writes one number per cell in the same run.",
    "All lengths are in units of 2⁻¹⁶ cells.",
    "It must be within the bound, all sand must be there or have left over an open rim, and stable sand must stay.",
    "Bound 0 draws all cells.",
    "Ratio and errors compare with bound 0 in the same run.",
    "The method *local* is the default, and *local at once* is the same without recovery.",
    "In the other direction of the circle the sign of the work changes:",
    "Errors are vertical, over all samples, as a share of the relief.",
)


def sentences(text):
    """Returns the sentences of a section, without its tables."""
    prose = [line for line in text.splitlines() if line and not line.startswith("|")]
    return [part.strip() for line in prose for part in re.split(r"(?<=[.:?])\s+(?=[A-Z*\[])", line)]


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


class AlteredTables(Altered):
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
        below = len(self.true["certificate"].where(method="N4"))
        self.counts("The certificate", "certificate", "row", self.set("certificate", "bound", 0, method="N4"), below)

    def test_hashes_that_differ_are_reported(self):
        self.assertIn("**the hashes differ**", self.text("One hash", self.set("hashes-release", "hash", "0", threads=7)))

    def test_one_hash_is_claimed_for_all_builds_only_if_all_are_there(self):
        def builds(presets):
            def alter(tables):
                tables.update({f"hashes-{preset}": Table(DATA / "hashes-release.csv") for preset in presets})
            return alter
        text = self.text("One hash", builds(PRESETS))
        self.assertIn(f"{len(PRESETS)} of {len(PRESETS)} builds have computed", text)
        self.assertIn("each scheme has one hash over all of them", text)
        text = self.text("One hash", lambda tables: [tables.pop(f"hashes-{preset}", None) for preset in PRESETS[1:]])
        self.assertIn(f"1 of {len(PRESETS)} builds have computed", text)
        self.assertIn("each scheme has one hash there, and the other builds are missing", text)
        self.assertNotIn("over all of them", text)

    def test_a_mesh_that_is_not_at_rest_or_not_exact_is_counted(self):
        for column in ("settled", "exact"):
            self.counts("Piles on a TIN", "tin-piles", "row", self.set_one("tin-piles", column, 0))

    def test_a_rule_that_still_changes_is_counted(self):
        rule = {"pile": "low", "method": "float32 N4 in place"}

        def moves(tables):
            self.set("work-precision", "at_rest", 0, **rule)(tables)
            for row in tables["work-precision"].some(**rule):
                row["misplaced"] = 1 / row["sweeps"]
        self.assertIn("With all 4 rules", self.text("Error against time, at one N", lambda tables: None))
        self.assertIn("With 3 of 4 rules", self.text("Error against time, at one N", moves))

    def test_a_band_that_changes_the_pile_is_named(self):
        error = self.true["band"].one("misplaced", pile="low", method="G", band=0)
        wide = {"pile": "low", "method": "G", "band": 0.1}
        for value, verdict in ((1.04 * error, "hardly depends on the band"), (1.06 * error, "has slid depends on the band")):
            self.assertIn(verdict, self.text("The hysteresis band", self.set("band", "misplaced", value, **wide)))

    def test_a_unit_that_changes_the_error_counts(self):
        table = self.true["height-bits"]
        size = table.distinct("N", pile="low")[-1]
        error, finest = table.one("misplaced", pile="low", N=size, bits=16), table.some(pile="low", N=size)[-1]["bits"]
        for value, verdict in ((0.96 * error, "So the grid decides, not the unit."), (0.94 * error, "So the unit counts, too.")):
            alter = self.set("height-bits", "misplaced", value, pile="low", N=size, bits=finest)
            self.assertIn(verdict, self.text("Height bits", alter))

    def test_a_turn_in_which_the_hand_gains_energy_is_counted(self):
        slopes = [place for place, row in enumerate(self.true["force-work"].rows) if row["law"] == "repulse" and row["slope"] > 0]
        self.assertIn(f"in all {len(slopes)} turns", self.text("Work of the force", lambda tables: None))
        for place in slopes:
            text = self.text("Work of the force", self.set_one("force-work", "net", 1e-6, place))
            self.assertIn(f"in {len(slopes) - 1} of {len(slopes)} turns", text)

    def test_a_trial_that_does_not_rest_is_counted(self):
        rows = self.true["guarded-sweep"].rows
        trials, rest = sum(row["trials"] for row in rows), sum(row["rest"] * row["trials"] for row in rows[1:])
        text = self.text("Springs that an arm bears", self.set_one("guarded-sweep", "rest", 0))
        self.assertIn(f"Behind the guards {rest:.0f} of {trials} trials come to rest", text)

    def test_the_longest_step_of_settled_sand_is_given(self):
        self.assertIn("takes at most 98765.4 µs", self.text("Digging", self.set_one("dig", "idle_us", 98765.4, -1)))

    def test_the_fastest_to_rest_is_named(self):
        text = self.text("Seconds to rest", self.set("rest", "seconds_median", 1e-6, method="G"))
        self.assertIn("The least median has G on the low pile", text)
        text = self.text("Seconds to rest", self.set("rest", "seconds_median", 1e-6, method="settle"))
        self.assertIn("The least median has settle on the low pile", text)

    def test_a_grid_that_is_nearer_than_a_mesh_is_counted(self):
        for column in ("max", "rms"):
            self.counts("A TIN of a raster", "tin-simplify", "row", self.set_one("tin-simplify", column, 1e9))

    def test_a_wall_that_is_slower_than_that_of_the_paper_is_counted(self):
        rows = len(self.true["latency"].rows)
        self.assertIn(f"in all {rows} rows", self.text("From the hand to the wall", self.set("latency", "wall_mean", 0.1)))

        def one_slower(tables):
            self.set("latency", "wall_mean", 0.1)(tables)
            tables["latency"].rows[-1]["wall_mean"] = 900.5
        text = self.text("From the hand to the wall", one_slower)
        self.assertIn(f"in {rows - 1} of {rows} rows, and at most 900.5 ms", text)


class MadeUpTables(Altered):
    """Texts that need rows or columns that a table of a short report lacks."""

    @staticmethod
    def with_threads(gain, gain_of_loop):
        def alter(tables):
            table = tables["throughput"]
            table.rows = [row for row in table.rows if not row["variant"].startswith("loop") and "threads" not in row["variant"]]
            for row in table.where(variant="G"):
                loop = dict(row, variant="loop")
                table.rows += [loop, dict(row, variant="G 2 threads", ns_per_cell_median=row["ns_per_cell_median"] / gain),
                               dict(loop, variant="loop 2 threads", ns_per_cell_median=row["ns_per_cell_median"] / gain_of_loop)]
        return alter

    def test_what_threads_gain_is_given(self):
        sizes = self.true["throughput"].distinct("N")
        text = self.text("Throughput", self.with_threads(1.5, 2))
        self.assertIn(f"faster by more than 5 % at N = {listing(sizes)}; at N = {sizes[-1]} it is 1.50 times as fast, and the loop "
                      "without memory 2.00 times", text)
        self.assertIn("faster by more than 5 % at N = none;", self.text("Throughput", self.with_threads(1.04, 2)))

    def test_edits_whose_hashes_differ_are_counted(self):
        def hashed(other):
            def alter(tables):
                table = tables["edit"]
                table.columns = [*table.columns, "hash"]
                for row in table.rows:
                    row["hash"] = "1234"
                table.rows[0]["hash"] = other
            return alter
        pairs = len({(row["N"], row["radius"]) for row in self.true["edit"].rows})
        self.assertIn(f"the same hash of the sand in all {pairs} pairs", self.text("One edit", hashed("1234")))
        self.assertIn(f"the same hash of the sand in {pairs - 1} of {pairs} pairs", self.text("One edit", hashed("4321")))

    def test_digging_on_a_mesh_has_rows_of_its_own(self):
        def alter(tables):
            table = tables["dig"]
            table.rows = [dict(row, sand="grid") for row in table.rows if row.get("sand", "grid") == "grid"]
            usual = table.some(cells_per_step=1.5)[0]
            for sweeps, behind, most in ((3, 0.5, 1.9), (5, 0.25, 2.0), (7, 0.125, 2.1)):
                table.rows.append(dict(usual, sand="TIN", N=77, sweeps_per_step=sweeps, misplaced_held=behind, ms_p99=most))
        text = self.text("Digging", alter)
        radius = self.true["dig"].some(cells_per_step=1.5)[0]["R"]
        self.assertIn(f"R = {radius:g} on the TIN of N = 77, 25 % with 5 sweeps per step", text)
        self.assertEqual(text.count("| TIN | 77 |"), 3)

    def test_sessions_whose_hashes_or_ranks_differ_are_counted(self):
        first, second = "1,30e7863412345678,{},0", "4,0000000000000042,0000000000000042,{}"
        for replay, divergences, count in (("30e7863412345678", 0, "in all 2 sessions"), ("30e7863412345679", 0, "in 1 of 2 sessions"),
                                           ("30e7863412345678", 1, "in 1 of 2 sessions")):
            with tempfile.TemporaryDirectory(prefix="sandwall-report-") as folder:
                file = pathlib.Path(folder) / "ranks.csv"
                file.write_text("\n".join(["ranks,session_hash,replay_hash,divergences", first.format(replay), second.format(divergences)]))
                ranks = Table(file)
            text = self.text("One hash", lambda tables, ranks=ranks: tables.update(ranks=ranks))
            self.assertIn(f"and no rank differs, {count}.", text)
            # A hash may look like a number.
            self.assertIn(f"| 1 | 30e7863412345678 | {replay} | 0 |", text)
            self.assertIn("| 4 | 0000000000000042 | 0000000000000042 |", text)


class Head(Tables):
    def test_each_compiler_and_code_path_is_named_with_its_tables(self):
        tables = {name: self.true[name] for name in ("band", "budget", "extremes")}
        for name, path in (("band", "v3"), ("budget", "v4"), ("extremes", "v4")):
            tables[name].notes = ["compiler: GNU", f"code path: {path}"]
        self.assertEqual(builds_of(tables, "compiler", "`"), "`GNU`")
        self.assertEqual(builds_of(tables, "code path"), "v4 for most tables; v3 for band")
        self.assertEqual(builds_of(tables, "flags"), "unknown")


if __name__ == "__main__":
    unittest.main()
