#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests that the line of every row of tests/mutations is in the sources exactly once, and that its tests exist. Tests the
rule by which scripts/mutate.sh draws further bugs, and what it reports. mutation_workspace_test.py tests where it plants them.

usage: mutations_test.py   (SANDWALL_BIN: folder of the built test programs)
"""

import ast
import contextlib
import dataclasses
import fnmatch
import functools
import io
import pathlib
import re
import subprocess
import sys
import tempfile
import tomllib
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from launcher_fixture import BIN
from docs_test import PROJECT, ROOT, tracked

sys.path[:0] = [str(ROOT / "scripts" / "checks"), str(ROOT / "scripts" / "checks" / "mutation")]
import draw  # noqa: E402
import run  # noqa: E402
import sites  # noqa: E402
import table  # noqa: E402
import workspace  # noqa: E402

PROGRAMS = run.test_programs()
TABLES = ROOT / "tests" / "mutations"


def faults(row, tests):
    """Yields what is wrong with the text of a row and with the names of its tests."""
    if not re.match(r"[A-Z].*\.$", row.what):
        yield f"{row.name}: `what` must be a sentence"
    program, _, filter_ = row.tests.partition(" ")
    if program.endswith(".py"):
        if row.tests not in script_tests():
            yield f"{row.name}: there is no test {row.tests}"
    elif program not in PROGRAMS:
        yield f"{row.name}: there is no test program {program}"
    else:
        names = tests(program)
        for pattern in filter_.split(":"):
            if not any(fnmatch.fnmatchcase(test, pattern) for test in names):
                yield f"{row.name}: the filter {pattern} runs no test of {program}"


def misplaced(rows, sources):
    """Yields what is wrong with the lines of the rows."""
    for row in rows:
        try:
            sources.changes(row)
        except table.Misplaced as fault:
            yield str(fault)


@functools.cache
def tests_of(program):
    """Returns the full names of the tests that the built `program` has, those with parameters too."""
    listed = subprocess.run([BIN / program, "--gtest_list_tests"], check=True, text=True, capture_output=True, timeout=60).stdout
    suite, names = "", []
    for words in (line.partition("#")[0].rstrip() for line in listed.splitlines()):
        if words.startswith(" "):
            names.append(suite + words.strip())
        else:
            suite = words
    return names


def script_tests():
    """Returns FILE, FILE CLASS and FILE CLASS.TEST of the Python tests."""
    for name in tracked("tests/scripts/*_test.py"):
        file = name.rpartition("/")[2]
        yield file
        for node in ast.parse((ROOT / name).read_text()).body:
            if isinstance(node, ast.ClassDef):
                yield f"{file} {node.name}"
                yield from (f"{file} {node.name}.{test.name}" for test in node.body if isinstance(test, ast.FunctionDef))


class Tables(unittest.TestCase):
    """The rows of tests/mutations."""

    ROW = table.Row("sand_falls_up", "Sand falls up.", (table.Place("Sand::fall", "down();", "up();"),), "sand_tests Law.*:x/Law.Holds/*")

    def setUp(self):
        self.root = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory(prefix="sandwall-mutations-")))
        (self.root / "CMakeLists.txt").write_text("add_subdirectory(sand)\nadd_subdirectory(tests)\n")
        subprocess.run(["git", "init", "--quiet"], cwd=self.root, check=True)

    def write(self, name, text):
        (self.root / name).parent.mkdir(exist_ok=True, parents=True)
        (self.root / name).write_text(text)
        subprocess.run(["git", "add", name], cwd=self.root, check=True)

    def place(self, **changed):
        """Returns the text of all sources with the bug, or why its row has no place."""
        row = dataclasses.replace(self.ROW, places=(dataclasses.replace(self.ROW.places[0], **changed),))
        try:
            changes = table.Sources(self.root).changes(row)
        except table.Misplaced as fault:
            return str(fault)
        return table.planted((self.root / changes[0].file).read_text(), changes)

    def test_are_in_the_sources_and_name_tests_that_exist(self):
        rows = table.rows(TABLES)
        self.assertGreater(len(rows), 400)
        found = [fault for row in rows for fault in faults(row, tests_of)]
        self.assertEqual(found + list(misplaced(rows, table.Sources(ROOT))), [])

    def test_with_a_wrong_text_or_test_are_named(self):
        def tests(_):
            return ["Law.Holds", "x/Law.Holds/0"]

        self.assertEqual(list(faults(self.ROW, tests)), [])
        python = dataclasses.replace(self.ROW, tests="mutations_test.py Tables.test_with_a_wrong_text_or_test_are_named")
        self.assertEqual(list(faults(python, tests)), [])
        for bad in ({"what": "sand falls up."}, {"tests": "sad_tests Law.*"}, {"tests": "sand_tests Rule.*"},
                    {"tests": "sand_tests Law.*:Holds.*"}, {"tests": "mutations_test.py Tables.test_with"}):
            self.assertEqual([fault[:14] for fault in faults(dataclasses.replace(self.ROW, **bad), tests)], ["sand_falls_up:"], bad)

    def test_follow_a_function_into_another_file_and_to_other_lines(self):
        self.write("sand/sand.cpp", "namespace sand {\nvoid Sand::fall() {\n    down();\n}\nvoid Sand::rest() {\n    down();\n}\n}\n")
        self.assertEqual(self.place(), "namespace sand {\nvoid Sand::fall() {\n    up();\n}\nvoid Sand::rest() {\n    down();\n}\n}\n")
        self.write("sand/sand.cpp", "namespace sand {\nvoid Sand::rest() {\n    down();\n}\n}\n")
        self.write("sand/grid/falls.hpp", "// Falls.\nnamespace sand {\nstruct Sand {\n    void fall() {\n        down();\n    }\n};\n}\n")
        self.assertEqual(self.place(wrong=""), "// Falls.\nnamespace sand {\nstruct Sand {\n    void fall() {\n    }\n};\n}\n")
        self.assertEqual(self.place(wrong="\nif (x)\n    up();"),
                         "// Falls.\nnamespace sand {\nstruct Sand {\n    void fall() {\n        if (x)\n            up();\n    }\n};\n}\n")

    def test_without_exactly_one_place_are_named(self):
        self.write("sand/sand.cpp", "void Sand::fall() {\n    down();\n    west();\n    down();\n}\nvoid fly() {\n    up();\n}\n")
        self.write("sand/other.cpp", "void fly() {\n    up();\n    east();\n}\n")
        self.assertEqual(self.place(where="Sand::rise"), "sand_falls_up: nothing is named Sand::rise")
        self.assertEqual(self.place(line="fall();"), "sand_falls_up: Sand::fall has no line `fall();`")
        self.assertEqual(self.place(), "sand_falls_up: the line `down();` of Sand::fall stands at sand/sand.cpp:2, sand/sand.cpp:4; "
                                       "add the next line, or more of the function's name")
        self.assertIn("stands at sand/other.cpp:2, sand/sand.cpp:7", self.place(where="fly", line="up();"))
        self.assertEqual(self.place(where="fly", line="up();\neast();"), "void fly() {\n    up();\n}\n")
        self.assertIn("    up();\n    west();", self.place(line="down();\nwest();", wrong="up();\nwest();"))

    def test_find_methods_constants_and_shaders(self):
        self.write("sand/a.py", "LIMIT = 3\nclass Sand:\n    def fall(self):\n        return 1\ndef fall():\n    return 1\n")
        self.write("sand/b.glsl", "const vec3 kSun = vec3(1, 2, 3);\nvoid main() {\n    down();\n}\n")
        self.write("sand/c.glsl", "void main() {\n    down();\n}\n")
        self.assertEqual(self.place(where="Sand.fall", line="return 1", wrong="return 2").split("\n")[3], "        return 2")
        self.assertEqual(self.place(where="a.fall", line="return 1", wrong="return 2").split("\n")[5], "    return 2")
        self.assertEqual(self.place(where="LIMIT", line="LIMIT = 3", wrong="LIMIT = 4").split("\n")[0], "LIMIT = 4")
        self.assertEqual(self.place(where="kSun", line="const vec3 kSun = vec3(1, 2, 3);", wrong="?").split("\n")[0], "?")
        self.assertEqual(self.place(where="c.main").split("\n")[1], "    up();")

    def test_that_are_not_whole_are_refused(self):
        row = '[a]\nwhat = "W."\nin = "f"\nline = "x"\nwrong = "y"\ntests = "t T.*"\n'
        self.write("tables/one.toml", row)
        self.assertEqual(table.rows(self.root / "tables"), [table.Row("a", "W.", (table.Place("f", "x", "y"),), "t T.*")])
        for more, why in ((row, "a stands in another table, too"), (row.replace("[a]", "[b]").replace("what", "because"), "b has the keys because"),
                          (row.replace("[a]", "[b]") + "test = 1\n", "it needs what")):
            self.write("tables/two.toml", more)
            with self.assertRaisesRegex(ValueError, f"^two.toml: .*{why}"):
                table.rows(self.root / "tables")


class Drawn(unittest.TestCase):
    CODE = """#if 1 + 1
// if (a) 1
if (const int a = f(2); a > 0x1FU) {
    text = "1 + 1" + name, x = -1.5e-3F, on = true;  /* 2 */
}
int operator+(A a), operator-=(A b);
p->next++;
"""
    SCRIPT = """if size > 10 and not f"{size + 1}":  # 1 + 1
    share -= 0.5
    text = "ä+" if "-" in name else f"{-size}" + f"{size}"
"""

    def changes(self, name, text):
        return [(site.kind, text[site.start:site.end], site.replacement) for site in sites.sites(name, text)]

    def test_bugs_are_planted_in_code_alone(self):
        self.assertEqual(self.changes("a.cpp", self.CODE), [
            ("constant", "2", "3"), ("condition", " a > 0x1FU", "!(a > 0x1FU)"), ("constant", "0x1FU", "32U"), ("sign", "+", "-"),
            ("sign", "-", "+"), ("constant", "1.5e-3F", "(1.5 * 1.5e-3F)"), ("constant", "true", "false")])
        self.assertEqual(self.changes("a.py", self.SCRIPT), [
            ("condition", 'size > 10 and not f"{size + 1}"', '(not (size > 10 and not f"{size + 1}"))'), ("constant", "10", "11"),
            ("sign", "-", "+"), ("constant", "0.5", "0.75"), ("condition", '"-" in name', '(not ("-" in name))'), ("sign", "+", "-")])
        self.assertEqual(sites.sites("a.cpp", self.CODE)[1].planted(self.CODE).splitlines()[2],
                         "if (const int a = f(2);!(a > 0x1FU)) {")

    def test_a_change_elsewhere_in_a_source_draws_the_same_bug(self):
        lines = [f"int f{i}() {{ return {i}; }}" for i in range(20)]
        for seed in range(20):
            first = next(draw.candidates(seed, "a.cpp", "\n".join(lines)))
            moved = [line for line in lines if line != first.site.line_text(first.text)][:9]
            text = "\n".join(["// new", *moved, first.site.line_text(first.text)])
            self.assertEqual(next(draw.candidates(seed, "a.cpp", text)).site.words(text), first.site.words(first.text))

    def test_another_seed_draws_other_sources(self):
        bugs = [{list_[0].name for list_ in draw.drawn(seed, 10)} for seed in ("a", "a", "b")]
        self.assertEqual(len(bugs[0]), 10)
        self.assertEqual(bugs[0], bugs[1])
        self.assertNotEqual(bugs[0], bugs[2])

    def test_at_most_a_tenth_is_explained_instead_of_caught(self):
        kept = tomllib.loads((ROOT / "tests" / "mutations" / "drawn.toml").read_text())
        names = {run.key(bug) for list_ in draw.drawn(kept["seed"], run.COUNT) for bug in list_}
        unseen = kept.get("unseen", [])
        self.assertLessEqual(len(unseen), run.COUNT // 10)
        self.assertEqual([entry["bug"] for entry in unseen if entry["bug"] not in names], [], "not drawn from the present sources")
        for entry in unseen:
            self.assertRegex(entry["why"], r"^[A-Z].*\.$")


class Bug:
    """A bug with a given result."""

    def __init__(self, title, result):
        self.title = self.key = title
        self.try_in = lambda _: result


class Report(unittest.TestCase):
    def report(self, bugs, unseen=()):
        """Returns the exit status and the lines that try_all() prints."""
        with contextlib.redirect_stdout(io.StringIO()) as printed:
            status = run.try_all(bugs, [None, None], unseen)
        return status, printed.getvalue()

    def test_a_bug_that_no_test_sees_fails_the_run(self):
        seen, unseen = Bug("seen", (True, "caught by Sand.Falls")), Bug("unseen", (False, "SURVIVED"))
        self.assertEqual(self.report([seen])[0], 0)
        status, printed = self.report([seen, unseen])
        self.assertEqual(status, 1)
        self.assertRegex(printed, r"(?m)^seen +caught by Sand.Falls$")
        self.assertRegex(printed, r"(?m)^unseen +SURVIVED$")
        self.assertRegex(printed, r"(?m)^1 caught or explained, 1 not,")
        self.assertEqual(self.report([unseen], [{"bug": "another", "why": "No user sees it."}])[0], 1)
        self.assertEqual(self.report([unseen], [{"bug": "unseen", "why": "No user sees it."}])[0], 0)

    def test_a_test_program_tells_its_first_failure(self):
        with tempfile.TemporaryDirectory(prefix="sandwall-mutations-") as folder:
            space = workspace.Workspace(pathlib.Path(folder), 1)
            space.bin.mkdir(parents=True)

            def ended(lines, limit=60):
                (space.bin / "tests").write_text(f"#!/bin/sh\n{lines}\n")
                (space.bin / "tests").chmod(0o755)
                return space.run("tests Sand.*", limit)

            self.assertIsNone(ended('[ "$1" = "--gtest_filter=Sand.*" ]'))
            self.assertIsNone(ended(f"exit {workspace.SKIPPED}"))
            self.assertEqual(ended("echo '[  PASSED  ] 0 tests.'"), "no test")
            self.assertEqual(ended("echo '[  FAILED  ] Sand.Falls (2 ms)'; echo '[  FAILED  ] Sand.Rests'; exit 1"), "Sand.Falls")
            self.assertEqual(ended("exit 3"), "status 3")
            self.assertEqual(ended("kill -SEGV $$"), "status -11")
            self.assertEqual(ended("exec sleep 60", limit=0.5), "the time limit")

    def test_a_python_test_that_is_no_unittest_gets_no_options(self):
        with tempfile.TemporaryDirectory(prefix="sandwall-mutations-") as folder:
            scripts = pathlib.Path(folder, "tests", "scripts")
            scripts.mkdir(parents=True)
            (scripts / "a_test.py").write_text("import sys\nsys.exit(len(sys.argv) - 1)\n")
            (scripts / "b_test.py").write_text("import sys\nsys.exit(len(sys.argv) - 1)\nunittest.main()\n")
            space = workspace.Workspace(pathlib.Path(folder), 1)
            self.assertEqual([space.run("a_test.py"), space.run("b_test.py"), space.run("b_test.py A.b")], [None, "status 1", "status 2"])

    def test_folders_and_rows_select_bugs(self):
        rows, sources = table.rows(TABLES), table.Sources(ROOT)

        def selected(*words):
            return run.selected(run.parse(words), {"seed": "a"}, rows, sources)

        name = rows[0].name
        elsewhere = "tracking" if run.TableBug(rows[0], sources).names[0].startswith("scripts/") else "scripts"
        self.assertEqual([bug.title for bug in selected(name)], [name])
        of_folder = selected(elsewhere)
        self.assertTrue(of_folder)
        self.assertEqual([file for bug in of_folder for file in bug.names if not file.startswith(f"{elsewhere}/")], [])
        self.assertEqual([bug.title for bug in selected(elsewhere, name)], [name, *(bug.title for bug in of_folder)])
        self.assertEqual({type(bug) for bug in selected("--drawn-only")}, {run.DrawnBug})
        self.assertEqual({type(bug) for bug in selected("--drawn", "0")}, {run.TableBug})
        with self.assertRaisesRegex(ValueError, "^sandbox: there is no such folder in .*, and no such row in tests/mutations$"):
            selected("sandbox")

    def test_drawn_bugs_run_the_tests_of_their_folder(self):
        programs = {"sand_tests": "sand", "tin_tests": "sand/tin", "sand_oracle_tests": "sand", "master_tests": "master"}
        self.assertEqual(run.tests_for("sand/tin/flow/sweep.cpp", programs), ["tin_tests", "sand_tests", run.SESSIONS])
        self.assertEqual(run.tests_for("master/main.cpp", programs), ["master_tests", run.SESSIONS])
        scripts = run.tests_for("scripts/launcher/programs.py", programs)
        self.assertEqual(scripts[0], "programs_test.py")
        self.assertNotIn("mutations_test.py", scripts)
        self.assertLessEqual(run.SLOW, set(PROGRAMS))
        for pattern in run.SESSIONS.split()[1].split(":"):
            self.assertTrue(fnmatch.filter(PROJECT.all_tests(), pattern), pattern)


if __name__ == "__main__":
    unittest.main()
