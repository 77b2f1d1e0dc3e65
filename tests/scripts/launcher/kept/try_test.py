#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests which sand `sandwall try` continues, which sessions it keeps, and its first and last lines. Its programs are made up."""

import os
import pathlib
import subprocess
import sys
import time
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "support"))
import journal_begin
from display_fixture import DisplayTest
from launcher_fixture import ROOT

MASTER = """#!/bin/sh
echo '{"program": "sandwall-master", "version": "0.2.0", "build": "0", "algorithm": 16, "journal": 10}'
"""
# Appends its words to a file, and begins a journal in the folder after --out, or appends to it.
MPIRUN = """#!/bin/sh
echo "$*" >> "$SAID"
while [ "$1" != --out ]; do shift; done
[ -e "$2/session.journal" ] || cat "$BEGIN" > "$2/session.journal"
echo step >> "$2/session.journal"
exit ${STATUS:-0}
"""


class TryTest(DisplayTest):
    """Runs `try` in a folder of its own, on a made-up display."""

    def setUp(self):
        super().setUp()
        self.script("sandwall-master", MASTER)
        self.script("mpirun", MPIRUN)
        (self.folder / "begin").write_bytes(journal_begin.OURS)
        self.wall = self.write("wall.toml", "-\n")
        self.environment.update(DISPLAY=self.display(), SAID=str(self.folder / "said"), BEGIN=str(self.folder / "begin"))
        self.root = self.folder / "out" / "try"

    def dig(self, *words, status=0, **environment):
        """Runs `try`, and returns its lines on standard error."""
        ended = subprocess.run([str(ROOT / "scripts" / "sandwall"), "try", "--wall", self.wall, *words], cwd=self.folder, text=True,
                               capture_output=True, timeout=120, stdin=subprocess.DEVNULL, env={**self.environment, **environment})
        self.assertEqual(ended.returncode, status, ended.stderr)
        self.assertNotIn("Traceback", ended.stderr)
        return ended.stderr.splitlines()

    def last_job(self):
        return (self.folder / "said").read_text().splitlines()[-1]

    def sessions(self):
        """Returns the folders of all sessions, the oldest first."""
        return sorted((path for path in self.root.iterdir()), key=lambda path: (path / "session.journal").stat().st_mtime_ns)

    def line_with(self, lines, words):
        found = [line for line in lines if words in line]
        self.assertEqual(len(found), 1, lines)
        return found[0]


class Continued(TryTest):
    def test_the_next_try_continues_with_the_sand_of_the_last_one(self):
        first = self.dig()
        self.assertEqual(len(self.sessions()), 1)
        self.assertNotIn("--resume", self.last_job())
        self.assertFalse([line for line in first if "continues with your sand" in line])
        second = self.dig()
        folder = self.sessions()[0]
        self.assertEqual(len(self.sessions()), 1)
        self.assertIn(f"--out out/try/{folder.name}", self.last_job())
        self.assertIn("--resume", self.last_job())
        self.assertNotIn("--scene", self.last_job(), "the journal has the scene")
        self.assertEqual((folder / "session.journal").read_bytes(), journal_begin.OURS + b"step\nstep\n")
        line = self.line_with(second, "continues with your sand of ")
        self.assertIn(f" in out/try/{folder.name}; ", line)
        self.assertTrue(line.endswith("try --wall " + self.wall + " --new` begins with new sand"), line)

    def test_the_last_line_names_the_command_that_continues(self):
        for words in ((), ("dunes",)):
            last = self.dig(*words)[-1]
            named = "dunes " if words else ""
            self.assertRegex(last, rf"^sandwall: `[./\w-]*sandwall try {named}--wall \S+` continues with this sand, and "
                             rf"`[./\w-]*sandwall try {named}--wall \S+ --new` begins with new sand$")
        self.assertEqual(len(self.sessions()), 2)

    def test_a_named_folder_is_the_session_itself_and_nothing_in_it_goes(self):
        self.dig("--out", "mine")
        last = self.dig("--out", "mine")[-1]
        self.assertIn("--out mine", self.last_job())
        self.assertIn("--resume", self.last_job())
        self.assertTrue(last.endswith("--out mine` continues with this sand, and another --out begins with new sand"), last)
        lines = self.dig("--out", "mine", "--new", status=2)
        self.assertEqual(lines, ["sandwall: --new: mine holds sand already; leave out --new to continue with it, or choose another --out"])
        self.assertEqual((self.folder / "mine" / "session.journal").read_bytes(), journal_begin.OURS + b"step\nstep\n")
        self.assertFalse(self.root.exists())

    def test_a_scene_that_is_named_for_a_folder_is_compared_by_the_master(self):
        self.dig("dunes", "--out", "mine")
        self.dig("dunes", "--out", "mine")
        self.assertRegex(self.last_job(), "--scene .*dunes.toml .*--resume|--resume .*--scene .*dunes.toml")

    def test_a_session_that_did_not_begin_leaves_no_folder(self):
        self.script("mpirun", "#!/bin/sh\nexit 2\n")
        self.dig(status=2)
        self.assertFalse([path for path in self.root.iterdir() if not (path / "log").exists()])
        lines = self.dig(DISPLAY=":64999", status=2)
        self.assertEqual(len(lines), 1)

    def test_sand_that_the_master_refuses_stays_and_the_last_line_names_new_sand(self):
        self.dig()
        last = self.dig(status=2, STATUS="2")[-1]
        self.assertRegex(last, rf"the sand stays in out/try/{self.sessions()[0].name}; `.* --new` begins with new sand$")

    def test_terrain_that_is_refused_is_one_line_and_leaves_no_folder(self):
        self.script("sandwall-check", (self.folder / "bin" / "sandwall-check").read_text().replace(
            "#!/bin/sh\n", '#!/bin/sh\n[ "$3" = --cells ] && { echo "sandwall-check: valley.tif: degrees" >&2; exit 2; }\n'))
        (self.folder / "valley.tif").write_bytes(b"II*\0" + bytes(99))
        self.assertEqual(self.dig("valley.tif", status=2), ["sandwall: valley.tif: degrees"])
        self.assertEqual(list(self.root.iterdir()), [])

    def test_two_scenes_are_one_too_many(self):
        self.assertEqual(self.dig("dunes", "--scene", "writing", status=2), ["sandwall: try: dunes and --scene writing are two scenes; name one"])


class AtOnce(TryTest):
    def test_a_second_try_begins_with_new_sand_while_the_first_one_digs(self):
        go, began = self.folder / "go", self.folder / "began"
        os.mkfifo(go)
        self.script("mpirun", MPIRUN.replace("exit", f'touch {began}; read -r line < {go}; exit', 1))
        command = [str(ROOT / "scripts" / "sandwall"), "try", "--wall", self.wall]
        first = subprocess.Popen(command, cwd=self.folder, env=self.environment, stdin=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        self.addCleanup(first.stderr.close)
        self.addCleanup(first.kill)
        deadline = time.monotonic() + 60
        while not began.exists() and time.monotonic() < deadline:
            time.sleep(0.01)
        running = self.sessions()[0]
        self.script("mpirun", MPIRUN)
        lines = self.dig()
        self.assertEqual(self.line_with(lines, "another session digs there now"),
                         f"sandwall: out/try/{running.name}: another session digs there now, so this one begins with new sand")
        self.assertNotIn("--resume", self.last_job())
        self.assertEqual(len(self.sessions()), 2)
        with open(go, "w") as line:
            line.write("\n")
        self.assertEqual(first.wait(60), 0)


class FullDisk(TryTest):
    def test_a_full_disk_is_one_line_and_the_sand_stays(self):
        script = f"mkdir out && mount -t tmpfs -o size=256k none out && {ROOT}/scripts/sandwall try --wall {self.wall} 2>first; " \
            f"cat /dev/zero > out/full 2>/dev/null; {ROOT}/scripts/sandwall try --wall {self.wall} --new 2>second; echo $? > status; cat out/try/*/session.journal > kept"
        ended = subprocess.run(["unshare", "-m", "sh", "-c", script], cwd=self.folder, env=self.environment, capture_output=True, text=True,
                               stdin=subprocess.DEVNULL, timeout=120)
        if "unshare" in ended.stderr or "mount" in ended.stderr:
            self.skipTest("no rights to mount a small disk")
        second = (self.folder / "second").read_text()
        self.assertEqual((self.folder / "status").read_text(), "2\n", second)
        self.assertRegex(second, r"\Asandwall: out/try/writing-\S+: cannot be made \(No space left on device\); make room, or choose another --out\n\Z")
        self.assertEqual((self.folder / "kept").read_bytes(), journal_begin.OURS + b"step\n")


if __name__ == "__main__":
    unittest.main()
