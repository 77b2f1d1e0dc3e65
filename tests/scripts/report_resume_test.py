#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests that a report continues after Ctrl-C, kill -9, a full disk and a part that fails, with a made-up benchmark.

usage: report_resume_test.py
"""

import pathlib
import re
import resource
import signal
import subprocess
import sys
import tempfile
import time
import unittest

import report_fixture
from report_fixture import NAMES, make_root
from report_check import is_compared
from report_parts import ROOT

FIXTURE = pathlib.Path(report_fixture.__file__)
LONGEST = 60  # [s], bound of every run


def without_times(text):
    """Returns a page without times, loads and the commit."""
    text = re.sub(r"\d+\.\d+ before and \d+\.\d+ after|\| \d+\.\d+ s \||at most \d+\.\d+ \(\w+\)|takes? about \d+ \w+", "TIME", text)
    return re.sub(r"all of them TIME|take about \d+ \w+ on", "TIME on", text)


class Report(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="sandwall-report-")
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)
        make_root(self.root)
        self.out = self.root / "out"

    def command(self, *options):
        return [sys.executable, str(FIXTURE), str(self.root), "--out", str(self.out), *options]

    def run_report(self, *options, **more):
        return subprocess.run(self.command(*options), capture_output=True, text=True, timeout=LONGEST, check=False, **more)

    def does(self, name, what):
        (self.root / f"{name}.does").write_text(what)

    def calls(self):
        """Returns how many times each part was measured."""
        lines = (self.root / "calls").read_text().split("\n")[:-1]
        return {name: sum(line.split()[0] == name for line in lines) for name in NAMES}

    def tables(self):
        return sorted(path.name for path in (self.out / "data").iterdir())

    def page(self):
        return (self.out / "README.md").read_text()

    def whole_page(self):
        """Returns the page of a report that nothing interrupts."""
        ran = self.run_report()
        self.assertEqual(ran.returncode, 0, ran.stderr)
        text = self.page()
        for path in (self.out / "data").glob("*.csv"):
            path.unlink()
        (self.root / "calls").unlink()
        return text

    def interrupt(self, part, number):
        """Starts a report, and sends the signal to it while a part is being measured. Returns its status and output."""
        self.does(part, "wait")
        process = subprocess.Popen(self.command(), stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        self.addCleanup(process.stdout.close)
        try:
            end = time.monotonic() + LONGEST
            while not (self.root / f"{part}.began").exists():
                self.assertLess(time.monotonic(), end, "the part did not begin")
                time.sleep(0.01)
            process.send_signal(number)
            said, _ = process.communicate(timeout=LONGEST)
        finally:
            process.kill()
            process.wait()
        (self.root / f"{part}.does").unlink()
        return process.returncode, said


class Interrupted(Report):
    def test_after_ctrl_c_and_kill_the_page_is_that_of_an_uninterrupted_report(self):
        whole = self.whole_page()
        status, said = self.interrupt("third", signal.SIGINT)
        self.assertEqual(status, 130, said)
        self.assertIn("interrupted; the tables that are whole are kept", said)
        self.assertIn("third.csv: is missing", self.page())
        self.assertEqual(self.tables(), ["first.csv", "second.csv"], "no piece of the interrupted table is left")
        self.assertEqual(self.interrupt("fourth", signal.SIGKILL)[0], -signal.SIGKILL)
        self.assertEqual(self.tables(), [".fourth.csv.part", "first.csv", "second.csv", "third.csv"])
        ran = self.run_report()
        self.assertEqual(ran.returncode, 0, ran.stderr)
        self.assertEqual(self.calls(), {"first": 1, "second": 1, "third": 2, "fourth": 2, "fifth": 1})
        self.assertEqual(self.tables(), sorted(f"{name}.csv" for name in NAMES))
        self.assertEqual(without_times(self.page()), without_times(whole))
        self.assertNotEqual(without_times(self.page()), without_times(whole.replace("0.015625", "0.015626")))

    def test_a_killed_report_leaves_no_benchmark_behind(self):
        self.interrupt("third", signal.SIGKILL)
        end = time.monotonic() + LONGEST
        while subprocess.run(["pgrep", "-f", str(self.root / "bench.py")], capture_output=True, check=False).returncode == 0:
            self.assertLess(time.monotonic(), end, "the benchmark still runs")
            time.sleep(0.02)

    def test_a_second_report_into_the_same_folder_is_refused(self):
        self.does("first", "wait")
        process = subprocess.Popen(self.command(), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        try:
            end = time.monotonic() + LONGEST
            while not (self.root / "first.began").exists():
                self.assertLess(time.monotonic(), end, "the part did not begin")
                time.sleep(0.01)
            ran = self.run_report()
        finally:
            process.send_signal(signal.SIGINT)
            process.wait(LONGEST)
        self.assertEqual(ran.returncode, 2)
        self.assertIn("another report.sh measures into", ran.stderr)


class Kept(Report):
    def test_valid_tables_are_not_measured_again(self):
        self.assertEqual(self.run_report().returncode, 0)
        self.assertEqual(self.run_report().returncode, 0)
        self.assertEqual(set(self.calls().values()), {1})
        head = (self.out / "data" / "first.csv").read_text()
        for fact in ("# release: 1.2.3", "# commit: ", "# source: ", "# algorithm: 7", "# load: ", "# took: ",
                     "# command: bench.py first --sizes 8,16,32\n"):
            self.assertIn(fact, head)

    def test_a_folder_with_a_space_gets_its_tables(self):
        self.out = self.root / "a b"
        ran = self.run_report()
        self.assertEqual(ran.returncode, 0, ran.stderr)
        self.assertIn("# command: bench.py first --sizes 8,16,32\n", (self.out / "data" / "first.csv").read_text())

    def test_another_algorithm_source_or_command_makes_tables_old(self):
        self.assertEqual(self.run_report().returncode, 0)
        (self.root / "bench" / "third.cpp").write_text("int third(int);\n")
        self.assertEqual(self.run_report().returncode, 0)
        self.assertEqual(self.calls(), {name: 2 if name == "third" else 1 for name in NAMES})
        (self.root / "bench" / "shared.hpp").write_text("int shared();  // another comment\n")
        self.assertEqual(self.run_report().returncode, 0)
        self.assertEqual(self.calls()["first"], 1, "a comment does not count")
        (self.root / "bench" / "shared.hpp").write_text("int shared(int);\n")
        self.assertEqual(self.run_report().returncode, 0)
        self.assertEqual(self.calls()["first"], 2, "a header that it includes counts")
        rules = self.root / "sand" / "model" / "rules.hpp"
        rules.write_text(rules.read_text().replace("= 7", "= 8"))
        self.assertEqual(self.run_report().returncode, 0)
        self.assertEqual(self.calls()["first"], 3)
        self.assertEqual(self.run_report("--quick").returncode, 0)
        self.assertEqual(self.calls()["first"], 4)

    def test_times_of_another_release_are_listed_as_old(self):
        self.assertEqual(self.run_report().returncode, 0)
        self.assertIn("Their times are those of release 1.2.3.", self.page())
        (self.root / "CMakeLists.txt").write_text("project(sandwall VERSION 1.3.0 LANGUAGES CXX)\n")
        self.assertEqual(self.run_report().returncode, 0)
        self.assertEqual(set(self.calls().values()), {1})
        self.assertIn("Times of a release other than 1.3.0, so that they are old: first, second", self.page())

    def test_a_draw_measures_nothing_and_lists_old_tables(self):
        self.assertEqual(self.run_report().returncode, 0)
        rules = self.root / "sand" / "model" / "rules.hpp"
        rules.write_text(rules.read_text().replace("= 7", "= 8"))
        self.assertEqual(self.run_report("--draw").returncode, 0)
        self.assertEqual(set(self.calls().values()), {1})
        self.assertIn("old: another algorithm", self.page())
        self.assertIn("0 of 5 tables are valid", self.page())


class Failed(Report):
    def test_a_part_that_fails_is_named_and_the_rest_is_kept(self):
        self.does("second", "fail")
        self.does("fourth", "cut")
        ran = self.run_report()
        self.assertEqual(ran.returncode, 1)
        self.assertEqual(self.tables(), ["fifth.csv", "first.csv", "third.csv"])
        for where in (ran.stderr, self.page()):
            self.assertIn("second: failed with status 3: the made-up part fails", where)
            self.assertIn("fourth: its table could not be written", where)
        self.assertIn("## Fifth\n\nFrom N = 8", self.page())

    def test_a_failed_part_keeps_its_old_table_on_the_page(self):
        self.assertEqual(self.run_report().returncode, 0)
        (self.root / "bench" / "third.cpp").write_text("int third(int);\n")
        self.does("third", "fail")
        ran = self.run_report()
        self.assertEqual(ran.returncode, 1)
        self.assertIn("third: failed with status 3", ran.stderr)
        self.assertIn("## Third\n\nFrom N = 8", self.page())
        self.assertIn("third: failed with status 3", self.page())

    def test_a_full_disk_keeps_what_was_whole(self):
        self.does("third", "large")  # more than a process may write, as if the disk ended there

        def bound():
            resource.setrlimit(resource.RLIMIT_FSIZE, (20000, 20000))
        ran = self.run_report(preexec_fn=bound)
        self.assertEqual(ran.returncode, 1, ran.stderr)
        self.assertEqual(self.tables(), ["fifth.csv", "first.csv", "fourth.csv", "second.csv"])
        self.assertIn("third: failed", self.page())

    def test_bad_options_and_folders_are_one_line(self):
        (self.root / "file").write_text("")
        for options in (["--draw", "--list"], ["--sizes", "8"], ["--out", str(self.root / "file" / "out")]):
            ran = subprocess.run([*self.command()[:3], *options], capture_output=True, text=True, timeout=LONGEST, check=False)
            self.assertEqual((ran.returncode, ran.stderr.count("\n")), (2, 1), ran.stderr)


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
        command = [sys.executable, str(ROOT / "scripts" / "figures" / "report_compare.py"), str(first), str(second)]
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
        for part in report_fixture.report.PARTS:
            self.assertTrue((ROOT / part.source).is_file(), part.name)


if __name__ == "__main__":
    unittest.main()
