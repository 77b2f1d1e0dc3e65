#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests that docs/glossary.md and the headers agree.

The types of its terms exist, no two types have one name, and no name has a word that the glossary avoids.

usage: glossary_test.py
"""

import collections
import pathlib
import re
import subprocess
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "scripts" / "checks"))
import cpp_names  # noqa: E402
import plain_english  # noqa: E402

PAGE = plain_english.GLOSSARY.read_text()
NOT_IN_PROGRAMS = ("bench", "examples", "tests")


def headers():
    """Returns the text of each tracked header by path."""
    git = subprocess.run(["git", "ls-files", "-z", "*.hpp"], cwd=ROOT, capture_output=True, text=True, check=True)
    return {name: (ROOT / name).read_text() for name in git.stdout.split("\0") if name and (ROOT / name).is_file()}


HEADERS = headers()


def terms(page):
    """Returns the terms of the first table."""
    rows = re.findall(r"^\| ([^|]+) \|", page[:page.index("## Types of the terms")], re.MULTILINE)
    return {term.strip() for row in rows[1:] for term in row.split(", ")}


def types_of_terms(page):
    """Returns {full name of a type: term}."""
    table = page[page.index("## Types of the terms"):page.index("## Words that we avoid")]
    return {f"{namespace}::{name}": term for namespace, cell in re.findall(r"^\| `([\w:]+)` \| (.*) \|$", table, re.MULTILINE)
            for term, name in re.findall(r"(?:^|, )([\w ]+) `(\w+)`", cell)}


def faults(page, sources):
    """Returns a line for each disagreement of a page with the types of headers."""
    listed, known = types_of_terms(page), terms(page)
    declared = collections.defaultdict(set)
    for path, text in sources.items():
        if path.split("/")[0] not in NOT_IN_PROGRAMS:
            for name in cpp_names.types(text):
                declared[name.rpartition("::")[2]].add(name)
    found = [f"{name}: its term '{term}' is not in the first table" for name, term in listed.items() if term not in known]
    for name in listed:
        short = name.rpartition("::")[2]
        if name not in declared[short]:
            found.append(f"{name}: is declared in no header; rename it in the glossary, too")
        found += [f"{other}: has the name of {name}, the type of '{listed[name]}'; give it another name"
                  for other in sorted(declared[short] - set(listed))]
    return found


class Glossary(unittest.TestCase):
    def test_the_types_of_the_terms_are_in_headers_and_no_other_type_has_their_names(self):
        self.assertEqual(faults(PAGE, HEADERS), [])

    def test_the_table_of_types_is_read_whole(self):
        listed = types_of_terms(PAGE)
        namespaces = {name.rpartition("::")[0] for name in listed}
        table = PAGE[PAGE.index("| namespace |"):PAGE.index("## Words that we avoid")]
        self.assertEqual(len(listed) + len(namespaces), table.count("`") // 2)
        self.assertIn("sand::Replica", listed)

    def test_a_type_that_is_renamed_is_found(self):
        renamed = {path: re.sub(r"\bReplica\b", "Terrain", text) for path, text in HEADERS.items()}
        self.assertEqual(faults(PAGE, renamed), ["sand::Replica: is declared in no header; rename it in the glossary, too"])

    def test_a_second_type_of_the_name_is_found(self):
        twice = HEADERS | {"sand/tin/second.hpp": "namespace sand::tin {\nstruct Place {\n    int x = 0;\n};\n}\n"}
        self.assertEqual(faults(PAGE, twice), ["sand::tin::Place: has the name of walls::Place, the type of 'place'; "
                                               "give it another name"])

    def test_a_type_without_a_term_is_found(self):
        page = PAGE.replace("| `scene` | scene `Scene` |", "| `scene` | scene `Scene`, colour `Look` |")
        self.assertEqual(faults(page, HEADERS), ["scene::Look: its term 'colour' is not in the first table"])

    def test_terms_are_in_order(self):
        table = PAGE[:PAGE.index("## Types of the terms")]
        rows = re.findall(r"^\| ([^|,]+)", table[table.index("|---"):], re.MULTILINE)
        self.assertEqual(rows, sorted(rows, key=lambda row: (row.strip().lower())))

    def test_no_name_in_a_header_has_a_word_that_the_glossary_avoids(self):
        avoided = plain_english.words_that_names_avoid(PAGE)
        found = [f"{path}:{line}: {name}: {', '.join(why)}" for path in HEADERS
                 for line, _, name, why in plain_english.judged_names(ROOT / path, avoided) if why]
        self.assertEqual(found, [], "docs/glossary.md names the words to use")


class Names(unittest.TestCase):
    def test_an_identifier_has_parts(self):
        for name, parts in (("grantSentNs", ["grant", "sent", "ns"]), ("kMaxGuests", ["k", "max", "guests"]), ("told_", ["told"]),
                            ("HTTPServer", ["http", "server"]), ("snake_case2", ["snake", "case"])):
            self.assertEqual(cpp_names.parts(name), parts)

    def test_identifiers_are_those_of_code(self):
        source = ('#include "a/guest.hpp"\n// a guest\nint tell(int said);  // tell\nconst char* text = "guest";\n'
                  "int tell(char c = 'q');\n#define MORE \\\n    guest\n")
        self.assertEqual([(line, name) for line, name in cpp_names.identifiers(source) if name not in ("int", "const", "char")],
                         [(3, "tell"), (3, "said"), (4, "text"), (5, "c")])

    def test_types_are_those_of_namespaces(self):
        source = ("class Announced;\nnamespace a::b {\nclass Later;\nstruct One { struct Inner { int x; }; };\n"
                  "template <class Kind>\nclass Two final : public Base<Kind> {\n};\nenum class Three : int { first };\n"
                  "using Four = std::vector<One>;\ninline int f() { struct Local { int y; }; return 0; }\n"
                  "namespace {\nstruct Hidden {};\n}\n}  // namespace a::b\nnamespace c {\nstruct Five {};\n}\nstruct Outside {};\n")
        self.assertEqual(list(cpp_names.types(source)), ["a::b::One", "a::b::Two", "a::b::Three", "a::b::Four", "c::Five"])


if __name__ == "__main__":
    unittest.main()
