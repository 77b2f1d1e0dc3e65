#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests what a session prints at its end, its exit status, and which summaries are refused. session_rules_test.py has the lines."""

import json
import os
import pathlib
import signal
import stat
import subprocess
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "support"))
from launcher_fixture import ROOT, LauncherTest
from sample_summary import SUMMARY, changed, film, without_hand
from ask import session_report, session_rules
from base import json_schema

SLOW = changed(seconds=20.0, fps=30.0)
LAGGING = changed(hand__slow_motion=4.1)
WRONG = changed(volume_final=891)
# Writes the summary that a test has prepared, as a master does at the end of a session.
MPIRUN = """#!/bin/sh
echo "frame 1"
[ -n "$WAIT" ] && read -r line
while [ $# -gt 0 ]; do [ "$1" = --out ] && { mkdir -p "$2"; cp "$SUMMARY" "$2/summary.json"; exit "$STATUS"; }; shift; done
"""
# Dies as soon as it listens.
SERVER = """#!/bin/sh
while [ "$1" != --listening-file ]; do shift; done
for file in "$2" "$4"; do echo 4711 > "$file.new"; mv "$file.new" "$file"; done
sleep 0.3; kill -KILL $$
"""


class Text(unittest.TestCase):
    def text(self, summary=SUMMARY, status=0, colours=False, out="out/s"):
        lines = session_rules.lines_of(summary)
        return session_report.text_of(summary["scene"], lines, out, session_report.replay_command(summary, out),
                                      session_report.final_status(lines, status), colours)

    def test_a_good_session_is_called_good_and_its_lines_are_aligned(self):
        lines = self.text().splitlines()
        self.assertEqual(lines[0], "dunes: good")
        self.assertLessEqual(len(lines), 19)
        self.assertTrue(lines[-1].endswith("sandwall replay out/s --hash"), lines[-1])
        for words in ("small, 2 render ranks", "60.0 of 60 frames/s", "29.5 ms from hand to picture", "0123456789abcdef", "exact", "written (required)", "out/s"):
            self.assertIn(words, self.text())
        self.assertEqual(len({line.index(line.split(None, 2)[2]) for line in lines[1:-2]}), 1, "the words must be aligned")

    def test_the_first_line_counts_notes_and_tells_the_exit_status(self):
        self.assertEqual(self.text(SLOW).splitlines()[0], "dunes: good, 1 note")
        self.assertEqual(self.text({**SLOW, "steps_left_out": 2}).splitlines()[0], "dunes: good, 2 notes")
        self.assertEqual(self.text(LAGGING).splitlines()[0], "dunes: slow, 1 note")
        self.assertEqual(self.text({**LAGGING, "steps_left_out": 2}).splitlines()[0], "dunes: slow, 2 notes")
        self.assertEqual(self.text(WRONG).splitlines()[0], "dunes: NOT GOOD, exit status 1")
        self.assertEqual(self.text(status=137).splitlines()[0], "dunes: NOT GOOD, exit status 137")

    def test_colours_change_no_word(self):
        coloured = self.text(SLOW, colours=True)
        self.assertIn("\033[33mnote\033[0m", coloured)
        self.assertNotIn("\033", self.text())

    def test_a_name_cannot_write_a_line_of_the_report(self):
        forged = "x\n  ok    sand\x1b[2J\u2028\x85"
        summary = changed(scene=forged, wall=forged, slowest={"rank": 1, "name": forged, "share": 0.5, "wall_waited_ms": 3.0})
        text = self.text(summary, out=forged)
        self.assertEqual(len(text.splitlines()), len(self.text(SLOW).splitlines()) + 1)
        self.assertNotIn("\x1b", text)
        self.assertIn("name\udcff", self.text(out="name\udcff"), "bytes of a file's name that are not UTF-8 are for a command")

    def test_a_session_without_a_hand_or_a_journal_says_so(self):
        summary = without_hand(journal={**SUMMARY["journal"], "state": "off", "policy": "off", "whole": False})
        self.assertNotIn("hand", self.text(summary))
        self.assertNotIn("sandwall replay", self.text(summary))
        report = session_report.json_of(session_rules.lines_of(summary), summary, "out/s", 0)
        self.assertEqual((report["session"]["latency_ms"], report["session"]["replay"], report["good"]), (None, None, True))


class Sessions(LauncherTest):
    def setUp(self):
        super().setUp()
        self.script("mpirun", MPIRUN)
        self.environment.update(STATUS="0", WAIT="", SUMMARY=str(self.folder / "prepared.json"))
        self.prepare(SUMMARY)

    def prepare(self, summary):
        self.write("prepared.json", summary if isinstance(summary, str) else json.dumps(summary))

    def test_a_session_ends_with_the_report(self):
        ended = self.start(["-"], "--gl", "osmesa")
        self.assertEqual((ended.returncode, ended.stderr), (0, ""))
        self.assertTrue(ended.stdout.startswith("frame 1\ndunes: good\n"), ended.stdout)
        self.assertTrue(ended.stdout.endswith(f"replay {self.folder / 'out'} --hash\n"), ended.stdout)

    def test_json_is_all_of_the_standard_output(self):
        for restarts in ("0", "3"):
            ended = self.start(["-"], "--gl", "osmesa", "--json", "--restarts", restarts)
            report = json.loads(ended.stdout)
            self.assertEqual((report["good"], report["status"], report["out"]), (True, 0, str(self.folder / "out")))
            self.assertEqual(ended.stderr, "frame 1\n")

    def test_a_session_that_is_not_good_has_status_1(self):
        self.prepare(WRONG)
        for words in ((), ("--json",), ("--restarts", "0"), ("--resume",), ("--resume", "--json")):
            ended = self.start(["-"], "--gl", "osmesa", *words)
            self.assertEqual(ended.returncode, 1, words)
            if "--json" in words:
                report = json.loads(ended.stdout)
                self.assertEqual((report["status"], report["good"], [note["mark"] for note in report["notes"]]), (1, False, ["BAD"]))
            else:
                self.assertIn("dunes: NOT GOOD, exit status 1\n", ended.stdout)

    def test_the_last_event_has_the_status_and_the_names_of_the_lines_with_a_mark(self):
        self.environment["SANDWALL_EVENTS"] = "1"
        for summary, status, bad in ((SUMMARY, 0, []), (WRONG, 1, ["volume"])):
            self.prepare(summary)
            for words in ((), ("--json",)):
                last = self.start(["-"], "--gl", "osmesa", *words).stderr.splitlines()[-1]
                self.assertEqual(last, f"@sandwall {json.dumps({'event': 'report', 'status': status, 'bad': bad, 'notes': []})}")

    def test_ctrl_c_of_a_good_session_has_status_0(self):
        self.environment["WAIT"] = "1"
        for summary, status in ((SUMMARY, 0), (WRONG, 1)):
            self.prepare(summary)
            process = subprocess.Popen(self.command(["-"], "--gl", "osmesa"), env=self.environment, stdin=subprocess.DEVNULL,
                                       stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
            self.assertEqual(process.stdout.readline(), "frame 1\n")
            process.send_signal(signal.SIGINT)
            process.communicate(timeout=60)
            self.assertEqual(process.returncode, status)

    def test_a_film_that_is_not_good_has_status_1(self):
        self.script("ffmpeg", "#!/bin/sh\nexit 0\n")
        journal = self.write("s.journal", "")
        for summary, status, words in ((film(), 0, "dunes: good\n"), (film(volume_final=891), 1, "dunes: NOT GOOD, exit status 1\n"),
                                       (film(divergences=2, unhealed=2), 1, "dunes: NOT GOOD, exit status 1\n")):
            self.prepare(summary)
            ended = subprocess.run([str(ROOT / "scripts" / "sandwall"), "film", journal, "--wall", self.write("wall", "-\n"), "--out",
                                    str(self.folder / "film")], env=self.environment, text=True, capture_output=True, timeout=60, stdin=subprocess.DEVNULL)
            self.assertEqual(ended.returncode, status, ended.stderr)
            self.assertIn(words, ended.stdout)

    def test_a_haptic_server_that_was_killed_is_bad_and_written_down_without_restarts_too(self):
        self.script("sandwall-haptic-server", SERVER)
        self.script("mpirun", MPIRUN.replace('echo "frame 1"', 'echo "frame 1"; sleep 1.5'))
        ended = self.start(["-"], "--gl", "osmesa", "--device", "script:gis", "--restarts", "0")
        self.assertEqual(ended.returncode, 1)
        self.assertEqual(ended.stderr, "sandwall: the haptic server was killed by SIGKILL; the session continues without it, because of --restarts 0\n")
        self.assertIn("BAD   hand         the haptic server was killed by SIGKILL and was not started again", ended.stdout)
        failure = json.loads((self.folder / "out" / "failures.jsonl").read_text())
        self.assertEqual({key: failure[key] for key in failure if key != "time"},
                         {"what": "the haptic server was killed by SIGKILL", "rank": None, "how": "SIGKILL", "frame": None, "step": None, "restarted": False})
        self.assertEqual(self.start(["-"], "--gl", "osmesa").returncode, 0)
        self.assertFalse((self.folder / "out" / "failures.jsonl").exists(), "the file of another session")

    def test_a_resumed_session_remembers_its_failures(self):
        out = self.folder / "out"
        out.mkdir()
        (out / "session.journal").write_text("")
        line = {"what": "the haptic server was killed by SIGKILL", "rank": None, "how": "SIGKILL", "time": 1.0, "frame": 9, "step": 8, "restarted": False}
        (out / "failures.jsonl").write_text(f"{json.dumps(line)}\nnonsense\n[3]\n" + '{"torn": ')
        ended = self.start(["-"], "--gl", "osmesa", "--resume")
        self.assertEqual(ended.returncode, 0, ended.stderr)
        self.assertIn("note  recoveries   0 in the session; 1 failure without a restart", ended.stdout)

    def test_a_session_that_was_killed_was_not_compared_at_the_end(self):
        self.script("mpirun", "#!/bin/sh\nkill -KILL $$\n")
        ended = self.start(["-"], "--gl", "osmesa", "--restarts", "0")
        self.assertEqual(ended.returncode, 137)
        self.assertIn("NOT GOOD, exit status 137\n", ended.stdout)
        self.assertIn("--    sand         not compared at the end\n", ended.stdout)
        failure = json.loads((self.folder / "out" / "failures.jsonl").read_text())
        self.assertEqual((failure["what"], failure["how"], failure["restarted"]), ("mpirun was killed by SIGKILL", "SIGKILL", False))

    def test_a_summary_that_cannot_be_believed_is_one_line_and_status_2(self):
        for text in ("{", '{"version": 1}', "[]", json.dumps({**SUMMARY, "version": 2}), json.dumps(changed(divergences=-1)),
                     json.dumps(changed(divergences=2 ** 64 - 1)), json.dumps(changed(seconds=float("nan"))), json.dumps(changed(fps="NaN\nok"))):
            self.prepare(text)
            ended = self.start(["-"], "--gl", "osmesa")
            self.assertEqual((ended.returncode, ended.stdout, ended.stderr.count("\n")), (2, "frame 1\n", 1), ended.stderr)
            self.assertTrue(ended.stderr.startswith(f"sandwall: {self.folder}/out/summary.json: "), ended.stderr)
            self.assertNotIn("Traceback", ended.stderr)
        report = json.loads(self.start(["-"], "--gl", "osmesa", "--json").stdout)
        self.assertEqual((report["status"], report["good"], report["session"]), (2, False, None))

    def test_the_summary_of_an_earlier_session_is_not_reported(self):
        self.start(["-"], "--gl", "osmesa")
        self.script("mpirun", "#!/bin/sh\nexit 2\n")
        self.assertEqual(self.start(["-"], "--gl", "osmesa").stdout, "")
        report = json.loads(self.start(["-"], "--gl", "osmesa", "--json").stdout)
        self.assertEqual((report["status"], report["good"], report["session"]), (2, False, None))

    def test_a_reader_that_leaves_gets_no_traceback(self):
        command = [str(ROOT / "scripts" / "sandwall")]
        for words in (self.command(["-"], "--gl", "osmesa", "--json"), self.command(["-"], "--gl", "osmesa", "--print-command"),
                      [*command, "run", "--help"], [*command, "list"], [*command, "ctl", str(self.folder), "help"]):
            read, write = os.pipe()
            os.close(read)
            ended = subprocess.run(words, env=self.environment, stdin=subprocess.DEVNULL, stdout=write, stderr=subprocess.PIPE, text=True, timeout=60)
            os.close(write)
            self.assertNotIn("Traceback", ended.stderr)
            self.assertNotIn("Exception", ended.stderr)
            self.assertEqual(ended.returncode, 0, ended.stderr)

    def test_a_folder_whose_name_could_write_a_line_is_refused(self):
        for name in ("x\n  ok    sand  equal", "x\x1b[2J"):
            command = [word if word != str(self.folder / "out") else str(self.folder / name) for word in self.command(["-"], "--gl", "osmesa")]
            ended = subprocess.run(command, env=self.environment, text=True, capture_output=True, timeout=60, stdin=subprocess.DEVNULL)
            self.assertEqual((ended.returncode, ended.stdout, ended.stderr.count("\n")), (2, "", 1), ended.stderr)
            self.assertNotIn("\x1b", ended.stderr)

    def test_a_session_without_out_gets_a_new_folder(self):
        command = [word for word in self.command(["-"], "--gl", "osmesa") if word not in ("--out", str(self.folder / "out"))]
        ended = self.start_here(command)
        self.assertEqual(ended.returncode, 0, ended.stderr)
        made = list((self.folder / "sessions").iterdir())
        self.assertEqual(len(made), 1)
        self.assertRegex(made[0].name, r"^scene-\d{8}-\d{6}$")
        self.assertEqual(ended.stderr, f"sandwall: the session's folder is sessions/{made[0].name}\n")
        self.assertIn(f"  folder       sessions/{made[0].name}\n", ended.stdout)
        self.assertFalse(made[0].stat().st_mode & (stat.S_IWGRP | stat.S_IWOTH))

    def test_a_refused_session_leaves_no_folder(self):
        self.script("mpirun", "#!/bin/sh\nexit 2\n")
        command = [word for word in self.command(["-"], "--gl", "osmesa", "--restarts", "0") if word not in ("--out", str(self.folder / "out"))]
        self.assertEqual(self.start_here(command).returncode, 2)
        self.assertFalse((self.folder / "sessions").exists())

    def test_resume_needs_the_folder(self):
        command = [word for word in self.command(["-"], "--resume") if word not in ("--out", str(self.folder / "out"))]
        ended = self.start_here(command)
        self.assertEqual((ended.returncode, ended.stderr), (2, "sandwall: --resume: name the session's folder with --out\n"))

    def start_here(self, command):
        return subprocess.run(command, env=self.environment, text=True, capture_output=True, timeout=120, stdin=subprocess.DEVNULL, cwd=self.folder)


class Schema(unittest.TestCase):
    """The reader of schemas, on what the schemas of this project use."""

    def test_each_word_of_a_schema_refuses_what_is_wrong(self):
        schema = {"type": "object", "required": ["a"], "definitions": {"count": {"type": "integer", "minimum": 0}},
                  "properties": {"a": {"$ref": "#/definitions/count"}, "b": {"type": ["number", "null"]}, "c": {"enum": ["x"]}, "d": {"const": 1},
                                 "e": {"type": "array", "minItems": 1, "items": {"$ref": "#/definitions/count"}},
                                 "f": {"type": "string", "pattern": "^[0-9]$"}, "g": {"oneOf": [{"type": "null"}, {"$ref": "#/definitions/count"}]},
                                 "h": {"type": "object", "additionalProperties": {"$ref": "#/definitions/count"}}, "i": {"type": "boolean"},
                                 "j": {"type": "number", "exclusiveMinimum": 0}}}
        for good in ({"a": 0}, {"a": 1, "b": None}, {"a": 1, "b": 2.5, "e": [1]}, {"a": 1, "f": "7", "g": None}, {"a": 1, "h": {"x": 2}}, {"a": 1, "new": []}):
            self.assertIsNone(json_schema.fault(good, schema), good)
        for wrong, field in (({}, "a is missing"), ({"a": True}, "a must"), ({"a": -1}, "a must"), ({"a": 1.0}, "a must"), ({"a": 2 ** 63}, "a must"),
                             ({"a": 1, "b": "NaN"}, "b must"), ({"a": 1, "b": float("inf")}, "b must"), ({"a": 1, "c": "y"}, "c must"),
                             ({"a": 1, "d": 2}, "d must"), ({"a": 1, "d": True}, "d must"), ({"a": 1, "e": []}, "e has 0"), ({"a": 1, "e": [-1]}, r"e[0] must"),
                             ({"a": 1, "f": "x"}, "f must"), ({"a": 1, "g": -1}, "g must"), ({"a": 1, "h": {"x": -2}}, "h.x must"), ({"a": 1, "i": 1}, "i must"), ({"a": 1, "j": 0}, "j must"),
                             ([], "it must")):
            self.assertTrue((json_schema.fault(wrong, schema) or "").startswith(field), (wrong, json_schema.fault(wrong, schema)))


if __name__ == "__main__":
    unittest.main()
