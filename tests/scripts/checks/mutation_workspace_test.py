#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests the copy of the sources in which scripts/mutate.sh plants bugs, and that no process of a test with a bug is left.

usage: mutation_workspace_test.py
"""

import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path[:0] = [str(ROOT / "scripts" / folder) for folder in ("launcher", "checks", "checks/mutation")]
import run  # noqa: E402
import workspace  # noqa: E402
from base import process_marks  # noqa: E402


def heed_signals():
    """A test run in the background ignores SIGINT, and one under nohup SIGHUP. So would its children."""
    for number in (signal.SIGINT, signal.SIGHUP):
        signal.signal(number, signal.SIG_DFL)


class Copy(unittest.TestCase):
    """The copy of the sources in which bugs are planted."""

    def setUp(self):
        self.folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory(prefix="sandwall-mutations-")))
        self.sources, self.space = self.folder / "sources", workspace.Workspace(self.folder / "copy", 1)
        self.sources.mkdir()
        self.git("init", "--quiet")
        self.write("docs/old.md", "the same page")
        self.write("main.cpp", "int main() {}")
        self.space.copy_sources(self.sources)

    def git(self, *words):
        subprocess.run(["git", *words], cwd=self.sources, check=True)

    def write(self, name, text):
        (self.sources / name).parent.mkdir(exist_ok=True)
        (self.sources / name).write_text(text)
        self.git("add", name)

    def copied(self):
        paths = [path for path in self.space.folder.rglob("*") if path.is_file() and self.space.folder / ".git" not in path.parents]
        return {path.relative_to(self.space.folder).as_posix(): path.read_text() for path in paths}

    def test_a_kept_copy_holds_the_tracked_files_and_its_build_alone(self):
        self.assertEqual(self.copied(), {"docs/old.md": "the same page", "main.cpp": "int main() {}"})
        self.space.bin.mkdir(parents=True)
        self.space.write("build/release/bin/tests", "built")
        self.space.write("main.cpp", "int main() { return 1; }  // a bug that an interrupted run has left")
        self.space.write("main.cpp.rej", "left by a patch")
        (self.sources / "pages").mkdir()
        self.git("mv", "docs/old.md", "pages/new.md")
        self.space.copy_sources(self.sources)
        self.assertEqual(self.copied(), {"pages/new.md": "the same page", "main.cpp": "int main() {}", "build/release/bin/tests": "built"})
        self.assertFalse((self.space.folder / "docs").exists())

    def test_git_lists_the_files_of_a_copy_and_knows_its_commit(self):
        (self.space.folder / "build").mkdir()
        self.space.write("build/tests", "built")
        self.git("mv", "docs/old.md", "new.md")
        self.write(".gitignore", "build/")
        self.space.copy_sources(self.sources)
        for words, lines in (("ls-files", [".gitignore", "main.cpp", "new.md"]), ("status --short", []),
                             ("log --format=%s", 2 * ["the sources without a bug"])):
            ran = subprocess.run(["git", *words.split()], cwd=self.space.folder, check=True, capture_output=True, text=True)
            self.assertEqual(ran.stdout.splitlines(), lines)

    def test_a_folder_may_replace_a_file_of_a_kept_copy(self):
        self.git("mv", "main.cpp", "main")
        self.space.copy_sources(self.sources)
        self.git("mv", "main", "main.cpp")
        self.write("main/new.cpp", "int f();")
        self.space.copy_sources(self.sources)
        self.assertEqual(self.copied(), {"docs/old.md": "the same page", "main.cpp": "int main() {}", "main/new.cpp": "int f();"})

    def test_a_link_is_copied_as_a_link_in_both_directions(self):
        (self.sources / "link").symlink_to("main.cpp")
        self.git("add", "link")
        for _ in range(2):
            self.space.copy_sources(self.sources)
            self.assertEqual((self.space.folder / "link").readlink(), pathlib.Path("main.cpp"))
        self.git("rm", "--quiet", "--force", "link")
        self.write("link", "a file now")
        self.space.copy_sources(self.sources)
        self.assertFalse((self.space.folder / "link").is_symlink())
        self.assertEqual(self.copied(), {"docs/old.md": "the same page", "main.cpp": "int main() {}", "link": "a file now"})
        (self.sources / "link").unlink()
        (self.sources / "link").symlink_to("docs/old.md")
        self.space.copy_sources(self.sources)
        self.assertEqual((self.space.folder / "link").readlink(), pathlib.Path("docs/old.md"))


class Processes(unittest.TestCase):
    """A test program leaves processes in sessions of their own, as a launcher with a bug does."""

    LEAVES = "setsid sleep 1000 & echo >> began"
    # Tries two bugs in one workspace.
    RUN = """import pathlib, sys
sys.path.insert(0, sys.argv[2])
import run, workspace
class Bug:
    title = "bug"
    def try_in(self, space):
        return True, space.run("tests Sand.*")
bugs, space = [Bug(), Bug()], workspace.Workspace(pathlib.Path(sys.argv[1]), 1)
sys.exit(run.until_interrupted(lambda: run.try_all(bugs, [space], [])))
"""

    def setUp(self):
        self.folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory(prefix="sandwall-mutations-")))
        self.space = workspace.Workspace(self.folder, 1)
        self.space.bin.mkdir(parents=True)

    def program(self, lines):
        (self.space.bin / "tests").write_text(f"#!/bin/sh\n{lines}\n")
        (self.space.bin / "tests").chmod(0o755)

    def left(self):
        return process_marks.marked(f"{workspace.MARK}={self.folder}".encode())

    def what_began(self):
        began = self.folder / "began"
        return began.read_text() if began.exists() else ""

    def begin(self, *before):
        command = [*before, sys.executable, "-c", self.RUN, self.folder, pathlib.Path(run.__file__).parent]
        process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True, preexec_fn=heed_signals)
        self.addCleanup(process.stdout.close)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        return process

    def test_are_ended_after_the_test_and_at_its_time_limit(self):
        other = subprocess.Popen(["sleep", "1000"], env={**os.environ, workspace.MARK: f"{self.folder}/other"})
        self.addCleanup(other.wait)
        self.addCleanup(other.kill)
        self.program(f"{self.LEAVES}; exit 3")
        self.assertEqual((self.space.run("tests Sand.*"), self.left()), ("status 3", []))
        self.program(f"{self.LEAVES}; exec sleep 1000")
        self.assertEqual((self.space.run("tests Sand.*", 0.5), self.left()), ("the time limit", []))
        self.assertIsNone(other.poll(), "the process of another workspace")

    def test_of_a_run_that_was_killed_are_ended_by_the_next(self):
        left = subprocess.Popen(["sleep", "1000"], env=self.space.environment())
        self.addCleanup(left.kill)
        self.space.end_processes()
        self.assertEqual(left.wait(60), -signal.SIGKILL)

    def test_are_ended_by_a_signal_and_no_further_bug_is_tried(self):
        self.program(f"{self.LEAVES}; exec sleep 1000")
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            process = self.begin()
            # The shell creates the file before it writes the line. A signal between the two would leave it empty.
            while not self.what_began():
                self.assertIsNone(process.poll(), "no test began")
                time.sleep(0.01)
            process.send_signal(number)
            self.assertEqual((process.wait(60), self.left()), (130, []), number)
            self.assertEqual(self.what_began(), "\n")
            (self.folder / "began").unlink()

    def test_get_signals_that_the_run_itself_ignores(self):
        for ignored, sent in (("INT", "kill -INT $$"), ("HUP", "kill -HUP $PPID; kill -HUP $$")):
            self.program(sent)
            process = self.begin("sh", "-c", f"trap '' {ignored}; exec \"$@\"", "sh")
            status = -signal.Signals[f"SIG{ignored}"]
            self.assertEqual((process.communicate(timeout=60)[0].count(f" status {status}\n"), process.returncode), (2, 0))


if __name__ == "__main__":
    unittest.main()
