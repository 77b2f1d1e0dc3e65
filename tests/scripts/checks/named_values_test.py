#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests that valuesOf() of each enum lists all of its values in their order.

A value without a name cannot be written or read, and no other test goes through it. The compiler cannot tell.

usage: named_values_test.py
"""

import pathlib
import re
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "scripts" / "checks"))
import product  # noqa: E402

# Values that have no name on purpose, and why.
NAMELESS = {"sand/model/step.hpp: Kind::none": "a step without an edit"}

COMMENT = re.compile(r"//[^\n]*")
ENUM = re.compile(r"\benum class (\w+)[^;{]*\{([^}]*)\}")
VALUES = re.compile(r"\bvaluesOf\((?:\w+::)*(\w+)[^)]*\) \{(.*?)\};\s*\}", re.DOTALL)
NAMED = re.compile(r"\bNamed\{(?:\w+::)*(\w+), \"")


def declared(body):
    """Returns the names in the braces of an enum."""
    return [value.split("=")[0].strip() for value in body.split(",") if value.strip()]


def faults(files):
    """Returns a line for each enum whose valuesOf() leaves a value out, or has another order. Both are in one file."""
    found = []
    for path, text in files.items():
        enums = dict(ENUM.findall(text))
        for enum, body in VALUES.findall(text):
            expected = [value for value in declared(enums.get(enum, "")) if f"{path}: {enum}::{value}" not in NAMELESS]
            named = NAMED.findall(body)
            if named != expected:
                found.append(f"{path}: valuesOf({enum}) has {', '.join(named)}; the enum has {', '.join(expected)}")
    return found


class NamedValues(unittest.TestCase):
    maxDiff = None
    files = {str(path.relative_to(ROOT)): COMMENT.sub("", path.read_text(encoding="utf-8"))
             for folder in product.folders() for path in sorted((ROOT / folder).rglob("*.hpp"))}

    def test_every_value_has_its_name_at_its_place(self):
        self.assertEqual(faults(self.files), [])

    def test_every_enum_with_names_is_found(self):
        declarations = sum(len(re.findall(r"\bvaluesOf\([\w:]+\s*(?:/\*.*?\*/)?\) \{", text)) for text in self.files.values())
        self.assertEqual(sum(len(VALUES.findall(text)) for text in self.files.values()), declarations)
        self.assertGreater(declarations, 20)

    def test_a_value_without_a_name_is_found(self):
        enum = "enum class Law : std::uint8_t {{\n    even,\n    odd = 3\n}};\n"
        values = "constexpr auto valuesOf(Law) {{ return std::array{{{}}}; }}\n"
        for names, right in (('base::Named{Law::even, "even"}, base::Named{odd, "odd"}', True), ('base::Named{Law::even, "even"}', False),
                             ('base::Named{odd, "odd"}, base::Named{even, "even"}', False)):
            with self.subTest(names):
                self.assertEqual(faults({"sand/law.hpp": enum.format() + values.format(names)}) == [], right)


if __name__ == "__main__":
    unittest.main()
