#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests that every block of commands in the documents can be run or has a mark, and how blocks are found and run.

No program of the project is run: a made-up scripts/sandwall replaces it.

usage: docs_commands_test.py
"""

import pathlib
import shutil
import sys
import tempfile
import time
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "scripts" / "checks"))
import docs_blocks  # noqa: E402
import docs_commands  # noqa: E402

RUN = "scripts/sandwall run --wall walls/configs/desktop.toml --scene scenes/dunes.toml"
# Ends with the status in the file `status` at SIGINT, or when it is asked to. Its `status` has a step once it runs.
SANDWALL = """#!/bin/bash
case "$1 $3" in
    "ctl status") [[ -f $2/pid ]] && echo '{"ok": true, "step": 200}'; exit ;;
    "ctl stop") kill -INT "$(cat "$2/pid")"; exit ;;
esac
out=${@: -1}
mkdir -p "$out"
trap 'rm "$out/pid"; exit "$(cat status)"' INT
echo $$ >"$out/pid.new"
mv "$out/pid.new" "$out/pid"
while true; do sleep 0.05; done
"""


def page(*parts):
    """Returns the text of a page whose blocks are separated by empty lines."""
    return "\n\n".join(parts) + "\n"


def only_block(text):
    [block] = docs_blocks.blocks("page.md", text)
    return block


def mistakes(*parts):
    return [what for _, what in docs_blocks.mistakes("page.md", page(*parts))]


class Documents(unittest.TestCase):
    def test_have_only_commands_that_can_be_run_or_are_marked(self):
        names = docs_commands.pages([])
        texts = {name: (ROOT / name).read_text() for name in names}
        self.assertEqual([f"{name}:{line}: {what}" for name in names for line, what in docs_blocks.mistakes(name, texts[name])], [])
        to_run = [block for name in names for block in docs_blocks.blocks(name, texts[name]) if not block.why_not_run()]
        self.assertIn("README.md", names)
        self.assertGreater(len(to_run), 50)


class Blocks(unittest.TestCase):
    def test_are_indented_or_fenced_without_another_language(self):
        text = page("A paragraph:\n    that continues", "    ls a\n\n    ls b", "```\nls c\n```", "~~~sh\nls d\n~~~",
                    "```toml\n[field]\n```", "# Heading\n    ls e", "- item\n    continued", "```text\n    ls f\n```")
        found = docs_blocks.blocks("page.md", text)
        self.assertEqual([block.text.split() for block in found], [["ls", "a", "ls", "b"], ["ls", "c"], ["ls", "d"], ["ls", "e"]])
        self.assertEqual([text.splitlines()[block.line - 1].strip() for block in found], ["ls a", "ls c", "ls d", "ls e"])

    def test_have_one_command_per_logical_line(self):
        text = "    # a comment\n    ls a \\\n        b   # why\n\n    ls c"
        self.assertEqual([line.split() for line in only_block(text).commands()], [["ls", "a", "b", "#", "why"], ["ls", "c"]])

    def test_begin_with_the_commands_of_first_and_have_their_placeholders_filled(self):
        block = only_block("<!-- first: ls one -->\n<!-- first: ls FILE -->\n<!-- with: FILE=a.b, 100=2 -->\n    ls FILE FILES.x 100 1000")
        self.assertEqual(block.commands(), ["ls one", "ls FILE", "ls a.b FILES.x 2 1000"])

    def test_for_another_terminal_run_together_with_the_block_before(self):
        text = page("    ls a", "Text.", "<!-- other terminal -->\n    ls b", "    ls c")
        self.assertEqual([len(group) for group in docs_blocks.sessions(docs_blocks.blocks("page.md", text))], [2])
        text = page("    ls a", "Text.", "<!-- other terminal -->\n    ls b", "Text.", "    ls c")
        self.assertEqual([len(group) for group in docs_blocks.sessions(docs_blocks.blocks("page.md", text))], [2, 1])

    def test_that_can_be_run_or_are_marked_have_no_mistake(self):
        self.assertEqual(mistakes("    " + RUN, "<!-- other terminal -->\n    (umask 077; for role in move; do echo $role; done) | cat",
                                  "<!-- not run: needs a haptic arm -->\n    unknown-program FILE",
                                  "<!-- with: FILE=a, OUT=b -->\n    sandwall-replay FILE --heights OUT.tif  # ENVI",
                                  "    A=1 build/release/bin/sandwall-check a.toml && mkdir -p b"), [])

    def test_that_cannot_be_run_have_one_mistake_each(self):
        for wrong, block in {"FILE is not filled": "    sandwall-replay FILE --hash",
                             "unknown-program: no program": "    ls a\n    unknown-program b",
                             "scripts/unknown.py: no program": "    scripts/unknown.py",
                             "scripts/launcher/samples/hosts: no program": "    scripts/launcher/samples/hosts",
                             "build/release/bin/sandwall-unknown: no program": "    build/release/bin/sandwall-unknown",
                             "scripts/unknown.sh: no program": "<!-- not run: takes an hour -->\n    scripts/unknown.sh",
                             "no commands for bash": "    sandwall: rank 3 (host a",
                             "[terrain]: no program": "    [terrain]",
                             "the mark replaces OUT": "<!-- with: OUT=a -->\n    ls b",
                             "unknown mark 'not run'": "<!-- not run -->\n    ls",
                             "unknown mark 'runs: never'": "<!-- runs: never -->\n    ls",
                             "is not on the line above": "<!-- not run: takes an hour -->\n\n    ls",
                             "is above a block of toml": "<!-- first: ls -->\n```toml\na = 1\n```",
                             "needs no other mark": "<!-- first: ls -->\n<!-- not run: takes an hour -->\n    ls",
                             "nothing runs in the other terminal": "<!-- other terminal -->\n    ls"}.items():
            found = mistakes("Text.", block)
            self.assertEqual(len(found), 1, (wrong, found))
            self.assertIn(wrong, found[0])


class Runs(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.path = pathlib.Path(self.folder.name)
        (self.path / "scripts").mkdir()
        (self.path / "scripts" / "sandwall").write_text(SANDWALL)
        (self.path / "scripts" / "sandwall").chmod(0o755)
        (self.path / "status").write_text("0")
        docs_commands.MORE_SECONDS = 0

    def run_blocks(self, *parts, seconds=60):
        [group] = docs_blocks.sessions(docs_blocks.blocks("page.md", page(*parts)))
        return docs_commands.run(group, self.path, seconds)

    def test_continue_until_ctrl_c_if_no_option_ends_them(self):
        for endless in (RUN + " --out a  # comment with --steps", "python3 haptic_bridge/examples/position_sender.py",
                        "build/release/bin/sandwall-watch MACHINE:1", "sandwall-track --send opentrack:1"):
            self.assertTrue(docs_commands.is_endless(endless), endless)
        for ends in (RUN + " --steps 240 --out a", RUN + " --out a 2> b &", "scripts/sandwall ctl a status", "sandwall-track --seconds 1",
                     "sandwall-haptic-server --version", "ls"):
            self.assertFalse(docs_commands.is_endless(ends), ends)

    def test_of_sessions_end_in_order_with_a_second_terminal_or_without(self):
        self.assertEqual(self.run_blocks(f"    {RUN} --out a\n    # in another terminal\n    scripts/sandwall ctl a status > b"), (1, ""))
        self.assertIn('"step": 200', (self.path / "b").read_text())
        self.assertEqual(self.run_blocks(f"    {RUN} --out a", "Text.", "<!-- other terminal -->\n    scripts/sandwall ctl a stop"), (2, ""))
        self.assertFalse((self.path / "a" / "pid").exists())

    def test_of_a_session_that_ends_with_a_status_fail(self):
        (self.path / "status").write_text("130")
        good, complaint = self.run_blocks(f"    {RUN} --out a")
        self.assertEqual(good, 0)
        self.assertIn("until Ctrl-C ended with status 130", complaint)

    def test_fail_at_the_first_command_that_fails(self):
        good, complaint = self.run_blocks("    echo one", "Text.", "<!-- other terminal -->\n    echo two\n    false\n    echo three")
        self.assertEqual((good, complaint.split()), (1, ["exit", "status", "1", "one", "two"]))
        self.assertEqual(self.run_blocks("    false | true")[1], "exit status 1")

    def test_that_take_too_long_fail(self):
        good, complaint = self.run_blocks("    echo begun\n    sleep 100", seconds=0.5)
        self.assertEqual((good, complaint), (0, "not done after 0.5 s\n    begun"))

    def test_leave_no_process_behind(self):
        self.assertEqual(self.run_blocks("    (setsid sleep 1000 & echo $! > pid) ; sleep 0.1"), (1, ""))
        process = int((self.path / "pid").read_text())
        deadline = time.monotonic() + 10
        while pathlib.Path("/proc", str(process)).exists() and time.monotonic() < deadline:
            time.sleep(0.01)
        self.assertFalse(pathlib.Path("/proc", str(process)).exists())

    def test_of_a_session_without_a_folder_are_told_in_one_line(self):
        block = docs_blocks.blocks("page.md", f"    {RUN}\n")[0]
        with tempfile.TemporaryDirectory() as folder:
            good, complaint = docs_commands.run([block], pathlib.Path(folder), 60)
        self.assertEqual((good, complaint), (0, f"a session that continues until Ctrl-C needs --out FOLDER: {RUN}"))
        self.assertEqual(docs_commands.out_of(RUN + " --out 'a b' --mono"), "a b")
        self.assertEqual(docs_commands.out_of(RUN + " --out=c"), "c")

    def test_use_a_folder_that_shows_the_project_without_its_results(self):
        folder = docs_commands.scratch()
        self.addCleanup(shutil.rmtree, folder)
        self.assertEqual((folder / "README.md").resolve(), ROOT / "README.md")
        self.assertEqual((folder / docs_blocks.BIN).resolve(), (ROOT / docs_blocks.BIN).resolve())
        self.assertFalse((folder / "build" / "release").is_symlink())  # a build would change the project
        self.assertFalse((folder / "out").exists())
        self.assertFalse((folder / ".git").exists())


if __name__ == "__main__":
    unittest.main()
