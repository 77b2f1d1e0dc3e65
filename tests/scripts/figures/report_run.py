# SPDX-License-Identifier: Apache-2.0
"""Runs of scripts/figures/report/report.py with a made-up benchmark, for tests."""

import pathlib
import subprocess
import sys
import tempfile
import time
import unittest

import report_fixture
from report_fixture import NAMES, make_root

FIXTURE = pathlib.Path(report_fixture.__file__)
LONGEST = 60  # [s], bound of every run


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
