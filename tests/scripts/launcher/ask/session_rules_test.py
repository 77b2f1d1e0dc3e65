#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests that every field of summary.json has a line of the report or a reason, and that the page has the rules."""

import json
import pathlib
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "support"))
from launcher_fixture import ROOT
from sample_summary import SAMPLES, SERVER_DIED
import jsonschema


from ask import session_rules

SCHEMA = json.loads((ROOT / "docs" / "schemas" / "summary.schema.json").read_text())


class Traced(dict):
    """A part of a summary that writes down which fields are read."""

    def __init__(self, value, read, path=""):
        super().__init__({key: traced(inner, read, f"{path}.{key}".lstrip(".")) for key, inner in value.items()})
        self.read, self.path = read, path

    def note(self, key):
        self.read.add(f"{self.path}.{key}".lstrip("."))

    def __getitem__(self, key):
        self.note(key)
        return super().__getitem__(key)

    def get(self, key, default=None):
        self.note(key)
        return super().get(key, default)

    def items(self):
        for key in self:
            self.note(key)
        return super().items()

    def values(self):
        return [value for _, value in self.items()]


def traced(value, read, path):
    if isinstance(value, dict):
        return Traced(value, read, path)
    return [traced(item, read, path + "[]") for item in value] if isinstance(value, list) else value


def fields_of(schema, path=""):
    """Yields the path of each field of summary.json that holds no other fields, and of each array."""
    if "$ref" in schema:
        schema = SCHEMA["definitions"][schema["$ref"].rpartition("/")[2]]
    inner = dict(schema.get("properties", {}))
    inner.update({name: {} for name in schema.get("propertyNames", {}).get("enum", ())})
    for name, part in inner.items():
        yield from fields_of(part, f"{path}.{name}".lstrip("."))
    if "items" in schema:
        yield from fields_of(schema["items"], path + "[]")
    if not inner and "items" not in schema:
        yield path


FIELDS = sorted(fields_of(SCHEMA))


def covers(path, field):
    return field == path or field.startswith(path + ".")


class EveryField(unittest.TestCase):
    def test_each_field_is_read_by_a_line_or_has_a_reason(self):
        for field in FIELDS:
            readers = [rule.name for rule in session_rules.RULES if any(covers(path, field) for path in rule.fields)]
            reasons = [path for path in session_rules.UNREAD if covers(path, field)]
            self.assertTrue(readers or reasons, f"{field}: no line of the report reads it; add it to a Rule or to UNREAD in scripts/launcher/ask/session_rules.py")
            self.assertFalse(readers and reasons, f"{field}: read by {readers}, and called unread in scripts/launcher/ask/session_rules.py")

    def test_each_path_in_the_list_is_a_field(self):
        for path in [*session_rules.UNREAD, *(path for rule in session_rules.RULES for path in rule.fields)]:
            found = any(covers(path, field) or field.startswith(path + "[]") for field in FIELDS)
            self.assertTrue(found, f"{path}: summary.schema.json has no such field")

    def test_a_line_reads_the_fields_that_the_list_names_and_no_others(self):
        read = {}
        for summary in SAMPLES:
            for rule in session_rules.RULES:
                for failures in ((), (SERVER_DIED,)):
                    rule.line(Traced(summary, read.setdefault(rule.name, set())), failures)
        for rule in session_rules.RULES:
            for path in read[rule.name]:
                inside = any(covers(given, path) or covers(path, given) or given.startswith(path + "[]") for given in rule.fields)
                self.assertTrue(inside, f"the line {rule.name} reads {path}, which its list does not name")
            for field in FIELDS:
                if any(covers(given, field) for given in rule.fields):
                    self.assertIn(field, read[rule.name], f"the line {rule.name} never reads {field}, which its list names")

    def test_a_field_that_nobody_has_thought_of_is_noticed(self):
        self.assertFalse(any(covers(path, "unheard_of") for path in session_rules.UNREAD))
        self.assertFalse(any(covers(path, "haptic.unheard_of") for path in session_rules.UNREAD))

    def test_the_samples_are_as_the_schema_says(self):
        for summary in SAMPLES:
            jsonschema.Draft7Validator(SCHEMA).validate(summary)


class Page(unittest.TestCase):
    def test_the_table_of_the_page_is_the_list(self):
        page = (ROOT / "docs" / "summary.md").read_text()
        self.assertIn("\n" + session_rules.table() + "\n", page,
                      "docs/summary.md has another table; put the output of scripts/launcher/ask/session_rules.py there")

    def test_the_page_to_read_next_exists(self):
        for rule in session_rules.RULES:
            self.assertTrue((ROOT / "docs" / rule.page).is_file(), rule.name)

    def test_slow_is_never_bad(self):
        for rule in session_rules.RULES:
            if rule.name in ("frames", "latency", "strokes", "skew", "slowest", "disk", "recoveries"):
                self.assertEqual(rule.bad, "", rule.name)


if __name__ == "__main__":
    unittest.main()
