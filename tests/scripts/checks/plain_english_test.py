#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests of scripts/plain_english.py: its rules, the prose that it finds in each kind of file, and its exit status.

usage: plain_english_test.py
"""

import pathlib
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "scripts" / "checks"))
import plain_english  # noqa: E402
import prose_reader  # noqa: E402

AVOIDED = plain_english.words_to_avoid(plain_english.GLOSSARY.read_text())


def cases():
    """Returns a list of (whether the rule flags it, sentence) by rule."""
    found = {}
    for line in pathlib.Path(__file__).with_name("plain_english_cases.txt").read_text().splitlines():
        if line.startswith(("+ ", "- ")):
            found[rule].append((line[0] == "+", line[2:]))
        elif line and not line.startswith("#"):
            rule = line
            found[rule] = []
    return found


CASES = cases()
BAD = [sentence for rule in CASES.values() for flagged, sentence in rule if flagged and len(sentence.split()) > 3]


def flags_of(text):
    """Returns the names of all rules that the sentences of a comment break."""
    sentences = plain_english.sentences(text)
    found = [plain_english.flags(sentence, i == 0, AVOIDED) for i, sentence in enumerate(sentences)]
    return [name.partition(":")[0] for names in found for name in names]


class Rules(unittest.TestCase):
    def test_every_rule_has_both_kinds_of_cases(self):
        self.assertEqual(set(CASES), {*plain_english.RULES, "more than 25 words", "word to avoid"})
        for rule, sentences in CASES.items():
            self.assertEqual({flagged for flagged, _ in sentences}, {True, False}, rule)

    def test_a_rule_flags_its_sentences(self):
        for rule, sentences in CASES.items():
            for sentence in (sentence for flagged, sentence in sentences if flagged):
                with self.subTest(rule=rule, sentence=sentence):
                    self.assertIn(rule, flags_of(sentence))

    def test_plain_sentences_are_not_flagged(self):
        for rule, sentences in CASES.items():
            for sentence in (sentence for flagged, sentence in sentences if not flagged):
                with self.subTest(rule=rule, sentence=sentence):
                    self.assertEqual(flags_of(sentence), [])

    def test_some_first_words_are_flagged_in_comments_alone(self):
        for sentence, rule in (("Its length is the length of the stroke.", "leans on another line"),
                               ("where the head's pose comes from", "clause without a noun")):
            self.assertEqual(plain_english.flags(sentence, True, AVOIDED), [rule])
            self.assertEqual(plain_english.flags(sentence, False, AVOIDED), [])

    def test_the_words_to_avoid_come_from_the_first_column_of_their_table(self):
        page = ("| a | b |\n|---|---|\n| `first` | x |\n\n## Words that we avoid\n\nA line.\n\n| a | b |\n|---|---|\n"
                "| `old sand`, `PROGRAM sings` (rarely) | `x` |\n\n| a | b |\n|---|---|\n| `third` | x |\n")
        avoided = plain_english.words_to_avoid(page)
        for text, word in (("Old sand slides.", "Old sand"), ("Both ranks sing; the rank sings.", "rank sings"), ("cold sand", None),
                           ("first or third", None), ("rarely x", None)):
            found = avoided.search(text)
            self.assertEqual(found and found[0], word, text)


    def test_names_avoid_single_words_of_both_tables(self):
        page = ("## Words that we avoid\n\n| a | b |\n|---|---|\n| `first`, `old sand`, `PROGRAM sings` | x |\n\n"
                "### Words that names avoid\n\n| a | b |\n|---|---|\n| `second` (rarely), `third` | `x` |\n")
        self.assertEqual(plain_english.words_that_names_avoid(page), {"first", "second", "third"})


class Reading(unittest.TestCase):
    def test_a_page_has_paragraphs_items_and_cells(self):
        page = ("# Heading\n\nOne line\nand the next.\n\n- an item\n  of two lines\n1. a number\n\n    code\n\n```\nmore code\n```\n"
                "| a | cell |\n|---|---|\n![picture](x.png)\n")
        self.assertEqual([(line, text) for line, _, text in prose_reader.markdown(page) if "--" not in text],
                         [(3, "One line and the next."), (6, "an item of two lines"), (8, "a number"), (15, "a"), (15, "cell")])

    def test_a_cpp_file_has_comments_and_messages(self):
        source = ('// SPDX-License-Identifier: x\n/// One line\n/// and the next.\n///\n/// @param a  The side [m].\n'
                  'int a;  // trailing\n        // and its second line\nint b;  // another\n/* a block\n * of two lines */\n'
                  'const char* c = "the // first" " part";\nfail("no " + name(1, 2) + ", sorry");\n'
                  'log << "a fresh one";\nconst char* raw = R"(key = "value")";  int million = 1\'000\'000;\n')
        found = list(prose_reader.cpp(source))
        self.assertEqual([(line, text) for line, kind, text in found if kind == "comments"],
                         [(2, "One line and the next."), (5, "@param a  The side [m]."), (6, "trailing and its second line"),
                          (8, "another"), (9, "a block of two lines")])
        self.assertEqual([(line, text) for line, kind, text in found if kind == "messages"],
                         [(11, "the // first part"), (12, "no Code, sorry"), (13, "a fresh one")])

    def test_a_numbered_equation_begins_a_paragraph(self):
        source = "/// The law:\n///   (1) a = b\n///   (2) b = c\n/// It lies at\n/// (0, 0) of the field.\n"
        self.assertEqual([(line, text) for line, _, text in prose_reader.cpp(source)],
                         [(1, "The law:"), (2, "(1) a = b"), (3, "(2) b = c It lies at (0, 0) of the field.")])

    def test_a_python_file_has_comments_docstrings_and_messages(self):
        source = ('#!/usr/bin/env python3\n"""A script.\n\nusage: x.py\n"""\n# One line\n# and the next.\n'
                  'def f(name):\n    """Prints\n    a name."""\n    print(f"name {name!r}: " "found")  # trailing\n')
        self.assertEqual(sorted(prose_reader.python(source)),
                         [(2, "comments", "A script."), (6, "comments", "One line and the next."), (9, "comments", "Prints a name."),
                          (11, "comments", "trailing"), (11, "messages", "name Code: found")])

    def test_a_script_has_comments(self):
        source = "#!/bin/sh\n# One line\n# and the next.\necho \"# ${#1}\" '#' # trailing\n[ $# -gt 2 ]\n"
        self.assertEqual([(line, text) for line, _, text in prose_reader.script(source)],
                         [(2, "One line and the next."), (4, "trailing")])

    def test_code_and_data_in_literals_are_no_messages(self):
        for literal in ("[grid]\nrows = 2\ncolumns is a word", "cp $folder/a $folder/b and so on", "{} {} {} {} {}", "two words"):
            self.assertFalse(prose_reader.for_a_person(literal), literal)
        self.assertTrue(prose_reader.for_a_person("the file cannot be read"))

    def test_sentences_end_at_full_stops_and_not_at_abbreviations(self):
        self.assertEqual(plain_english.sentences("**One.** Two, e.g. [a](b.md). x is `x`; y: Three"),
                         ["One.", "Two, e.g a.", "x is Code;", "y:", "Three"])


class Command(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def write(self, name, text):
        path = self.folder / name
        path.write_text(text)
        return str(path)

    def run_check(self, *arguments):
        ended = subprocess.run([str(ROOT / "scripts" / "plain_english.py"), *arguments], cwd=self.folder, text=True,
                               capture_output=True, timeout=120)
        return ended.returncode, ended.stdout, ended.stderr

    def test_plain_text_has_status_0(self):
        status, printed, error = self.run_check(self.write("a.md", "The master paces the frames.\n"))
        self.assertEqual((status, printed, error), (0, "documents: 0 of 1 sentences flagged, 0.0 %\n", ""))

    def test_a_document_may_have_one_flag_in_a_hundred_sentences(self):
        plain = "The master paces the frames.\n\n" * 99
        self.assertEqual(self.run_check(self.write("a.md", plain + BAD[0]))[0], 0)
        self.assertEqual(self.run_check(self.write("a.md", plain[:-30] + BAD[0]))[0], 1)

    def test_messages_may_have_half_of_that(self):
        plain = 'f("the file cannot be read");\n'
        for count, status in ((199, 0), (198, 1)):
            self.assertEqual(self.run_check(self.write("a.cpp", plain * count + f'f("{BAD[0]}");\n'))[0], status)

    def test_each_kind_that_fails_has_one_line(self):
        path = self.write("a.cpp", f'// {BAD[0]}\nf("{BAD[1]}");\n')
        status, printed, error = self.run_check("--list", path)
        self.assertEqual((status, error.count("\n")), (1, 2), error)
        self.assertIn("plain_english.py: 100.0 % of the sentences in comments are flagged, more than 1.0 %;", error)
        self.assertTrue(printed.startswith(f"a.cpp:2: messages: [{flags_of(BAD[1])[0]}") or
                        printed.startswith(f"a.cpp:1: comments: [{flags_of(BAD[0])[0]}"), printed)
        self.assertIn(f"] {BAD[0]}\n", printed)

    def test_a_header_may_have_no_name_with_a_word_to_avoid(self):
        plain = "".join(f"int name{i};\n" for i in range(2000))
        self.assertEqual(self.run_check(self.write("a.hpp", plain))[:2], (0, "names: 0 of 2001 names flagged, 0.0 %\n"))
        status, printed, error = self.run_check("--list", self.write("a.hpp", plain + "void tellAll();\n"))
        self.assertEqual((status, error.count("\n")), (1, 1), error)
        self.assertIn("a.hpp:2001: names: [word to avoid: tell] tellAll\n", printed)
        self.assertIn("plain_english.py: 1 names in headers are flagged, more than 0.0 %;", error)
        self.assertEqual(self.run_check(self.write("a.cpp", "void tellAll();\n"))[0], 0, "only names of headers are checked")

    def test_a_semicolon_ends_a_sentence_of_a_message_alone(self):
        half = "the file has a word in the place of a number and the scene cannot be loaded"
        self.assertEqual(self.run_check(self.write("a.cpp", f'f("{half}; {half}");\n'))[0], 0)
        self.assertEqual(self.run_check(self.write("a.cpp", f"// {half}; {half}\n"))[0], 1)

    def test_a_folder_is_read_as_far_as_git_tracks_it(self):
        self.write("a.md", "The master paces the frames.\n")
        self.write("b.md", BAD[0])
        for command in (["init", "-q"], ["add", "a.md"]):
            subprocess.run(["git", *command], cwd=self.folder, check=True)
        self.assertEqual(self.run_check(".")[:2], (0, "documents: 0 of 1 sentences flagged, 0.0 %\n"))

    def test_a_link_in_a_folder_is_not_read_again(self):
        self.write("a.md", "The master paces the frames.\n")
        (self.folder / "b.md").symlink_to("a.md")
        for command in (["init", "-q"], ["add", "a.md", "b.md"]):
            subprocess.run(["git", *command], cwd=self.folder, check=True)
        self.assertEqual(self.run_check(".")[:2], (0, "documents: 0 of 1 sentences flagged, 0.0 %\n"))
        self.assertEqual(self.run_check("b.md")[:2], (0, "documents: 0 of 1 sentences flagged, 0.0 %\n"))

    def test_a_path_that_cannot_be_checked_is_one_line(self):
        for path, reason in ((str(self.folder / "nowhere.md"), "does not exist; check the path"),
                             (self.write("a.png", ""), "holds no text that this check reads; ")):
            status, printed, error = self.run_check(path)
            self.assertEqual((status, printed, error.count("\n")), (2, "", 1), error)
            self.assertTrue(error.startswith(f"plain_english.py: {path}: {reason}"), error)


if __name__ == "__main__":
    unittest.main()
