#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks that every file, heading, function and test that the documents name exists, and that an index lists every page.

usage: docs_test.py
"""

import re
import unittest

from docs_checks import (CODE, PAPERS, RECIPES, ROOT, TEST_NAME, Repository, broken_links, constant, faults, index_faults, linked_functions,
                         missing_filters, missing_functions, missing_pages, missing_sources, missing_tests, recipes, stale_recipes, tracked,
                         unknown_tests, unlisted_names)

LAW = """// named() is only named here
int declared(int number);
Law::Law(int odd) : odd_{odd} {}
bool Law::holds(
    const std::function<int()>& of) const {
    return called(of) != 0;
}
template <class Number>
bool odd(Number number) { return number % 2 != 0; }
"""
PROJECT = Repository.of_the_project()


class Documents(unittest.TestCase):
    maxDiff = None

    def made_up(self, text, name="docs/page.md"):
        return Repository(["docs/page.md", "docs/other.md", "docs/images/a.png", "sand/law.cpp", "tests/sand/law_test.cpp"],
                          {"tests/sand/law_test.cpp": {"Law.Holds", "Law.IsOdd"}},
                          {name: text, "docs/other.md": "# The law: how it holds\n```\n# no heading\n```\n"},
                          {"sand/law.cpp": LAW}.get)

    def test_name_only_what_exists(self):
        self.assertEqual(faults(PROJECT), [])

    def test_of_the_papers_name_many_tests(self):
        named = [span for span in CODE.findall(PROJECT.documents[PAPERS]) if TEST_NAME.match(span)]
        self.assertGreater(len(named), 100)

    def test_every_page_is_in_the_index_of_its_folder_once(self):
        self.assertIn("docs/README.md", PROJECT.documents)
        self.assertEqual(list(index_faults(PROJECT)), [])

    def test_a_page_that_no_index_lists_or_that_one_lists_twice_is_named(self):
        def faults_of(**pages):
            documents = {f"docs/{name.replace('__', '/')}.md": text for name, text in pages.items()}
            return list(index_faults(Repository(documents, {}, documents)))

        self.assertEqual(faults_of(README="[a](page.md) [b](more/README.md)", page="", more__README="[c](part.md#x)", more__part=""), [])
        self.assertEqual(faults_of(README="# All", page=""), ["docs/README.md: lists docs/page.md 0 times instead of once"])
        self.assertEqual(faults_of(README="[a](page.md) [b](page.md#x)", page=""),
                         ["docs/README.md: lists docs/page.md 2 times instead of once"])
        self.assertEqual(faults_of(README="[a](more/part.md)", more__README="[a](part.md)", more__part=""),
                         ["docs/README.md: lists docs/more/README.md 0 times instead of once"])
        self.assertEqual(faults_of(README="[a](more/part.md)", more__part=""),
                         ["docs/more/part.md: its folder has no README.md that lists it"])

    def test_the_citation_names_the_version_that_is_built(self):
        built = re.search(r"^project\(sandwall VERSION ([\d.]+) ", (ROOT / "CMakeLists.txt").read_text(), re.MULTILINE)[1]
        cited = re.search(r"^version: (.*)$", (ROOT / "CITATION.cff").read_text(), re.MULTILINE)[1]
        self.assertEqual(cited, built)

    def test_programs_name_pages_that_exist(self):
        sources = tracked("*.cpp", "*.hpp", "*.py", "*.sh", "scripts/launcher/sandwall")
        self.assertEqual(missing_pages({name: (ROOT / name).read_text(encoding="utf-8") for name in sources
                                        if not name.startswith("tests/")}), [])

    def test_a_page_that_is_gone_is_named(self):
        self.assertEqual(missing_pages({"master/main.cpp": '"see docs/journal.md and docs/no_page.md"'}),
                         ["master/main.cpp: names docs/no_page.md, which does not exist"])

    def test_the_page_of_the_journal_has_the_versions_of_the_code(self):
        said = re.search(r"this is [\d.]+ \(format (\d+), algorithm (\d+)\)", (ROOT / "docs/journal.md").read_text(encoding="utf-8"))
        self.assertEqual(said.groups(), (constant("journal/format.hpp", "kJournalVersion"),
                                         constant("sand/model/rules.hpp", "kAlgorithmVersion")))

    def test_the_page_of_the_protocol_has_the_version_of_the_code(self):
        version = constant("haptic_bridge/link/greetings.hpp", "kProtocolVersion")
        page = (ROOT / "docs/protocol.md").read_text(encoding="utf-8")
        self.assertEqual(re.findall(r"protocol version \((\d+)\)|`sandwall (\d+) (?:master|server)`", page),
                         [(version, ""), ("", version), ("", version)])

    def test_a_link_to_nothing_is_named(self):
        good = "[a](other.md) [b](images/a.png) [c](other.md#the-law-how-it-holds) [d](https://no.where/x) [e](../sand) [f](#page)\n# Page\n"
        self.assertEqual(list(broken_links(self.made_up(good), "docs/page.md")), [])
        for bad in ("[a](none.md)", "[a](other.md#the-law)", "[a](other.md#no-heading)", "[a](#other)", "[a](../images/a.png)"):
            self.assertEqual(len(list(broken_links(self.made_up(bad), "docs/page.md"))), 1, bad)

    def test_a_source_that_is_gone_is_named(self):
        self.assertEqual(list(missing_sources(self.made_up("`sand/law.cpp` `out/demo/a.toml` `law.cpp`"), "docs/page.md")), [])
        good = "`sand` `sand/` `docs/images/a.png` `sand/<name>.cpp` `tests/NAME/law_test.cpp`"
        self.assertEqual(list(missing_sources(self.made_up(good), "docs/page.md")), [])
        for bad in ("sand/rule.cpp", "sand/CMakeLists.txt", "sand/law", "docs/images/b.png", "sand/<name>.hpp", "tests/force/"):
            self.assertEqual(list(missing_sources(self.made_up(f"`{bad}`"), "docs/page.md")),
                             [f"docs/page.md: names {bad}, which is not in the project"])

    def test_a_recipe_that_names_old_code_or_no_test_is_named(self):
        page = "# How to\n## How to add\nExamples.\n### A law\n1. `sand/law.cpp`: {}\n2. {}\n## End\n`kGone`\n"
        def project(code, test):
            return Repository(["sand/law.cpp", "tests/sand/law_test.cpp"], {}, {RECIPES: page.format(code, test)},
                                                {"sand/law.cpp": LAW, "tests/sand/law_test.cpp": ""}.get)
        test = "`tests/sand/law_test.cpp`"
        self.assertEqual(list(stale_recipes(project("`Law::holds`, `odd()`, `law`, `Law::holds()`", test))), [])
        for bad in ("Law::isOdd", "even()", "kOdd"):
            self.assertEqual(list(stale_recipes(project(f"`{bad}`", test))),
                             [f"{RECIPES}: A law: no file of this recipe has {bad}"])
        self.assertEqual(list(stale_recipes(project("`odd()`", "a test"))), [f"{RECIPES}: A law: names no test"])

    def test_a_name_that_a_page_leaves_out_is_named(self):
        lists = (("sand/law.cpp", r"^bool (\w+)|(\w+)\(of\)", ("docs/page.md",)),)
        self.assertEqual(list(unlisted_names(self.made_up("`odd`, the `Law`, `called`"), lists)), [])
        self.assertEqual(list(unlisted_names(self.made_up("the `Law`, `odd-ness` and `called`"), lists)),
                         ["docs/page.md: leaves out odd, which sand/law.cpp declares"])
        self.assertEqual(list(unlisted_names(self.made_up("-"), (("sand/law.cpp", r"^float (\w+)", ("docs/page.md",)),))),
                         ["sand/law.cpp: declares no name that docs_test finds"])

    def test_the_page_has_recipes(self):
        self.assertGreaterEqual(len(list(recipes(PROJECT))), 8)

    def test_the_tour_follows_a_touch_through_twelve_files(self):
        files = [file for _, file in linked_functions(PROJECT, "docs/tour.md")]
        self.assertEqual(len(set(files)), 12)

    def test_a_function_that_is_gone_is_named(self):
        link = "[`{}`](../sand/law.cpp)"
        for good in ("Law::holds", "Law::Law", "odd"):
            self.assertEqual(list(missing_functions(self.made_up(link.format(good)), "docs/page.md")), [], good)
        for bad in ("Law::isOdd", "Law", "declared", "called", "holds", "named"):
            self.assertEqual(list(missing_functions(self.made_up(link.format(bad)), "docs/page.md")),
                             [f"docs/page.md: links {bad} to sand/law.cpp, which does not define it"])
        self.assertEqual(list(missing_functions(self.made_up("[`f`](../sand/rule.cpp)"), "docs/page.md")),
                         ["docs/page.md: links f to sand/rule.cpp, which is not in the project"])

    def test_a_filter_that_runs_nothing_is_named(self):
        self.assertEqual(list(missing_filters(self.made_up("--gtest_filter='Law.*' --gtest_filter=Law.Holds:*Odd*"), "docs/page.md")), [])
        self.assertEqual(len(list(missing_filters(self.made_up("--gtest_filter=Law.Hold --gtest_filter='Rule.*'"), "docs/page.md"))), 2)

    def test_a_test_that_no_file_has_is_named_in_any_document(self):
        text = "`Law.Holds` and `{}` say so, not `law.toml` or `Law`"
        self.assertEqual(list(unknown_tests(self.made_up(text.format("Law.IsOdd")), "docs/page.md")), [])
        self.assertEqual(list(unknown_tests(self.made_up(text.format("Law.IsEven")), "docs/page.md")),
                         ["docs/page.md: names the test Law.IsEven, which is not in the project"])

    def test_a_test_that_is_gone_is_named(self):
        row = "| `sand/law.cpp` | `tests/sand/law_test.cpp` `Law.Holds`, `{}` |"
        self.assertEqual(list(missing_tests(self.made_up(row.format("Law.IsOdd")), "docs/page.md")), [])
        self.assertEqual(list(missing_tests(self.made_up(row.format("Law.IsEven")), "docs/page.md")),
                         ["docs/page.md: tests/sand/law_test.cpp has no test Law.IsEven"])
        self.assertEqual(len(list(missing_tests(self.made_up("| `Law.Holds` |"), "docs/page.md"))), 1)


if __name__ == "__main__":
    unittest.main()
