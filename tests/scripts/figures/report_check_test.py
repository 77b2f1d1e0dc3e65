#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests that a report checks its tables, compares them with others, and knows the sources that measure them.

usage: report_check_test.py
"""

import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

from report_run import LONGEST, Report  # first, because it finds the modules of the report
from report.report_check import is_compared
from report.report_parts import PARTS, ROOT, fingerprint


class Check(Report):
    def setUp(self):
        super().setUp()
        self.assertEqual(self.run_report().returncode, 0)

    def alter(self, old, new):
        file = self.out / "data" / "second.csv"
        text, count = re.subn(old, new, file.read_text(), flags=re.MULTILINE)
        self.assertEqual(count, 1)
        file.write_text(text)

    def check(self):
        ran = self.run_report("--check")
        return ran.returncode, ran.stdout

    def test_the_smallest_n_of_valid_tables_gives_the_same(self):
        (self.root / "calls").unlink()
        status, said = self.check()
        self.assertEqual(status, 0, said)
        self.assertIn("5 of 5 tables are valid", said)
        self.assertIn("second 8\n", (self.root / "calls").read_text())
        self.assertEqual(set(self.calls().values()), {1})

    def test_another_time_is_no_difference(self):
        self.alter(r"^(8,.*),[\d.]+$", r"\1,99")
        self.assertEqual(self.check()[0], 0)

    def test_another_error_or_hash_at_the_smallest_n_is_named(self):
        self.alter("^8,0.015625", "8,0.015626")
        status, said = self.check()
        self.assertEqual(status, 1)
        self.assertRegex(said, r"second.csv: row 1 of the smallest N \(.*\): error is 0.015626, and now 0.015625")
        self.assertIn("4 of 5 tables are valid", said)
        self.alter("^8,0.015626,0000", "8,0.015625,1000")
        self.assertIn("hash is 1000", self.check()[1])

    def test_a_row_that_the_smallest_n_no_longer_has_is_named(self):
        self.alter("^8,0.015625,(.*)$", r"8,0.015625,\1\n8,0.25,\1")
        status, said = self.check()
        self.assertEqual(status, 1)
        self.assertIn("second.csv: has 2 rows with N = 8, and now 1", said)

    def test_old_missing_and_failing_tables_are_not_valid(self):
        (self.out / "data" / "first.csv").unlink()
        self.alter("^# algorithm: 7", "# algorithm: 6")
        self.does("third", "fail")
        status, said = self.check()
        self.assertEqual(status, 1)
        self.assertIn("first.csv: is missing", said)
        self.assertIn("second.csv: its algorithm is 6, and the present one is 7", said)
        self.assertIn("third.csv: cannot be measured again (status 3: the made-up part fails)", said)
        self.assertIn("2 of 5 tables are valid", said)


class Compare(Report):
    def test_figures_that_differ_by_more_than_their_spread_are_beside_each_other(self):
        first, second = self.root / "a", self.root / "b"
        for folder, error, times in ((first, "0.1", "5,4,6"), (second, "0.2", "7,5.5,8")):
            folder.mkdir()
            (folder / "t.csv").write_text(f"N,error,ms_median,ms_min,ms_max\n8,{error},{times}\n16,0.5,{times}\n")
        command = [sys.executable, str(ROOT / "scripts" / "figures" / "report" / "report_compare.py"), str(first), str(second)]
        ran = subprocess.run(command, capture_output=True, text=True, timeout=LONGEST, check=False)
        self.assertEqual(ran.stdout.splitlines()[2:], ["| t | 8 | error | 0.1 | 0.2 |"], ran.stderr)
        (second / "t.csv").write_text("N,error,ms_median,ms_min,ms_max\n8,0.1,7,6.5,8\n")
        ran = subprocess.run(command, capture_output=True, text=True, timeout=LONGEST, check=False)
        self.assertEqual(ran.stdout.splitlines()[2:], ["| t | 8 | ms_median | 5 | 7 |"])

    def test_times_of_latency_without_a_range_are_not_compared(self):
        for column in ("wall_mean", "master_p99", "floor_frame_mean", "floor_p50", "frame_mean"):
            self.assertFalse(is_compared({}, column), column)
        for column in ("wall", "divergences", "error"):
            self.assertTrue(is_compared({}, column), column)


class Sources(unittest.TestCase):
    def test_every_part_names_a_source(self):
        for part in PARTS:
            self.assertTrue((ROOT / part.source).is_file(), part.name)

    def test_the_fingerprint_covers_the_code_and_not_the_folders_of_the_files(self):
        with tempfile.TemporaryDirectory(prefix="sandwall-report-") as name:
            root = pathlib.Path(name)

            def write(files):
                for file, text in files.items():
                    (root / file).parent.mkdir(parents=True, exist_ok=True)
                    (root / file).write_text(text)

            before = {
                "measure.py": "import os\nfrom session import (\n    run)\n", "session.py": "SECONDS = 1\n", "other.py": "",
                "bench/a.cpp": '#include <vector>\n#include "bench/b.hpp"\nint a;', "bench/b.hpp": "int b;"}
            after = {
                "times/measure.py": "import os\nfrom rooms.session import run\n", "rooms/session.py": "SECONDS = 1\n",
                "bench/times/a.cpp": '#include "bench/part/b.hpp"\n#include <vector>\nint a; // of b', "bench/part/b.hpp": "int b;"}
            write({**before, **after})
            self.assertEqual(fingerprint("times/measure.py", root), fingerprint("measure.py", root))
            self.assertEqual(fingerprint("bench/times/a.cpp", root), fingerprint("bench/a.cpp", root))
            script, source = fingerprint("measure.py", root), fingerprint("bench/a.cpp", root)
            write({"other.py": "SECONDS = 2\n"})
            self.assertEqual(fingerprint("measure.py", root), script)
            write({"session.py": "SECONDS = 2\n", "rooms/session.py": "SECONDS = 2\n", "bench/b.hpp": "int c;"})
            self.assertNotEqual(fingerprint("measure.py", root), script)
            self.assertEqual(fingerprint("times/measure.py", root), fingerprint("measure.py", root))
            self.assertNotEqual(fingerprint("bench/a.cpp", root), source)


if __name__ == "__main__":
    unittest.main()
