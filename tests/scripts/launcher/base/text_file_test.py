#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests that the scripts read texts by the same rules as the programs: both read tests/base/text_cases.json."""

import json
import pathlib
import random
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[4]
sys.path.insert(0, str(ROOT / "scripts" / "launcher"))
from base import text_file  # noqa: E402

CASES = json.loads((ROOT / "tests/base/text_cases.json").read_text())


class Cases(unittest.TestCase):
    def test_every_text_has_the_lines_of_the_table(self):
        self.assertGreater(len(CASES), 30)
        for case in CASES:
            data = bytes.fromhex(case["bytes"])
            with self.subTest(case["name"]):
                if "lines" in case:
                    self.assertEqual(text_file.lines_of(data), case["lines"])
                else:
                    with self.assertRaisesRegex(text_file.NotText, "^" + case["error"]) as refusal:
                        text_file.lines_of(data)
                    self.assertEqual(refusal.exception.line, case["line"])

    def test_no_bytes_end_in_another_error(self):
        numbers = random.Random(1)
        for _ in range(2000):
            data = bytes(numbers.choice(b"\0\x1a\xff\xfe\xef\xbb\xbf\xc3\xe4\r\n a") for _ in range(numbers.randrange(12)))
            try:
                text_file.lines_of(data)
            except text_file.NotText as refusal:
                self.assertGreaterEqual(refusal.line, 1)


if __name__ == "__main__":
    unittest.main()
