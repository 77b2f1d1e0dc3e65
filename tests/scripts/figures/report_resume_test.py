#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests that a report continues after Ctrl-C, kill -9, a full disk and a part that fails, with a made-up benchmark.

usage: report_resume_test.py
"""

import re
import resource
import signal
import subprocess
import time
import unittest

from report_fixture import NAMES
from report_run import LONGEST, Report


def without_times(text):
    """Returns a page without times, loads and the commit."""
    text = re.sub(r"\d+\.\d+ before and \d+\.\d+ after|\| \d+\.\d+ s \||at most \d+\.\d+ \(\w+\)|takes? about \d+ \w+", "TIME", text)
    return re.sub(r"all of them TIME|take about \d+ \w+ on", "TIME on", text)


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


if __name__ == "__main__":
    unittest.main()
