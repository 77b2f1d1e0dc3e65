#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests that docs/schemas describe the files of real sessions, and that scripts refuse a summary of another version."""

import copy
import json
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

import jsonschema

from schema_fixture import ROOT, SCHEMAS, SchemaTest, SessionTest, load

from ask import session_results


class RealSessions(SessionTest):
    def ctl(self, *words):
        ended = subprocess.run([ROOT / "scripts" / "sandwall", "ctl", self.out, *words], capture_output=True, text=True, timeout=120,
                               stdin=subprocess.DEVNULL)
        self.assertEqual(ended.returncode, 0, ended.stderr)
        return json.loads(ended.stdout)

    def test_a_session_with_a_hand(self):
        session = self.start("--device", "script:gis", "--track", "opentrack:0")
        self.await_event(session, "link", state="linked")
        self.await_event(session, "progress", hand="hand linked")
        status = self.ctl("status")
        self.valid("status", status)
        self.assertTrue(status["linked"])
        session.stdin.write(b"nonsense\n")
        session.stdin.flush()
        self.await_event(session, "command_refused")
        begun = self.ctl("film")["step"]
        while self.ctl("status")["step"] <= begun:
            pass
        self.assertEqual(self.ctl("film")["folder"], "film_001")
        self.assertEqual(self.ctl("stop"), {"ok": True})
        self.in_order(session)
        summary = session_results.summary_of(self.out)
        self.valid("summary", summary)
        self.assertIn("head_tracking", summary)
        self.assertIn("force_us", summary["haptic"])
        self.assertTrue({"progress", "link", "listening", "head_tracking", "command_refused", "film", "report"} <= set(self.events_by_name()))
        self.reject_all("summary", summary)
        self.reject_all("status", status)

    def test_a_session_that_recovers_and_its_film(self):
        session = self.start("--inject", "die:rank=2,frame=20,signal=9", "--frames", "60")
        self.assertEqual(session.wait(120), 0, self.log.read_text())
        summary = session_results.summary_of(self.out)
        self.valid("summary", summary)
        self.assertEqual([recovery["failed_rank"] for recovery in summary["recoveries"]], [2])
        found = self.events_by_name()
        self.assertTrue({"drill", "restart", "resumed", "recovered"} <= set(found), found)
        self.assertEqual((found["restart"][0]["rank"], found["restart"][0]["how"]), (2, "SIGKILL"))
        film = self.folder / "film"
        subprocess.run([ROOT / "scripts" / "sandwall", "film", self.out, "--wall", self.folder / "wall.toml",
                        "--out", film], check=True, capture_output=True, timeout=200, stdin=subprocess.DEVNULL)
        self.valid("summary", session_results.summary_of(film))

    def test_the_report_of_a_session(self):
        ended = subprocess.run([*self.command("--frames", "20", "--device", "script:gis", "--pace", "fast"), "--json"], capture_output=True, text=True,
                               timeout=200, stdin=subprocess.DEVNULL)
        self.assertEqual(ended.returncode, 0, ended.stderr)
        report = json.loads(ended.stdout)
        self.valid("report", report)
        self.reject_all("report", report)
        self.reject_all("report", report["session"], lambda session: {**report, "session": session})
        self.assertTrue(report["good"], report)
        replayed = subprocess.run(report["session"]["replay"], capture_output=True, text=True, timeout=100)
        self.assertEqual(replayed.stdout.split()[-1:], [report["session"]["state_hash"]], replayed.stderr)

    def test_a_session_that_fails(self):
        session = self.start("--restarts", "0", "--frame-timeout", "5", "--inject", "hang:rank=2,frame=20")
        self.assertEqual(session.wait(120), 1, self.log.read_text())
        failure = json.loads((self.out / "failure.json").read_text())
        self.valid("failure", failure)
        self.assertEqual((failure["what"], failure["rank"]), ("hung", 2))
        found = self.events_by_name()
        self.assertTrue(any(event["ends_job"] and event["ranks"] == [2] for event in found["waiting"]), found)
        self.assertEqual([event["failure"] for event in found["failure"]], [failure])
        self.reject_all("failure", failure)
        for name in ("progress", "drill", "waiting", "failure"):
            self.reject_all("event", found[name][-1])

    def reject_all(self, name, value, whole=lambda value: value):
        """The schema must reject `value` without one of its fields, and `value` with an undocumented field.

        `whole` returns the document that has `value` as a part.
        """
        optional = {"head_tracking"} if name == "summary" else set()
        for field in set(value) - optional:
            self.invalid(name, whole({key: other for key, other in value.items() if key != field}))
        self.invalid(name, whole({**value, "undocumented": 1}))


class Schemas(SchemaTest):
    def test_every_schema_is_one(self):
        files = sorted(SCHEMAS.glob("*.json"))
        self.assertEqual([file.name for file in files], [f"{name}.schema.json" for name in ("event", "failure", "report", "status", "summary")])
        for file in files:
            jsonschema.Draft7Validator.check_schema(json.loads(file.read_text()))

    def test_every_number_tells_its_unit_or_meaning(self):
        def look(schema, where):
            if isinstance(schema, list):
                for part in schema:
                    look(part, where)
            elif isinstance(schema, dict):
                number = schema.get("type") in ("integer", "number") or schema.get("$ref", "").endswith("/count")
                self.assertFalse(number and "description" not in schema, where)
                for key, part in schema.items():
                    look(part, f"{where}/{key}")

        for name in ("event", "failure", "report", "status", "summary"):
            schema = load(name)
            definitions = schema.get("definitions", {})
            definitions.pop("count", None)  # each reference to it has a description
            for part in (schema.get("properties", {}), definitions):
                for key, value in part.items():
                    for inner in (value.get("properties", {}) if name == "event" else {key: value}).items():
                        look(inner[1], f"{name}: {key}/{inner[0]}")

    def test_the_page_and_the_schema_name_the_same_events(self):
        page = (ROOT / "docs" / "events.md").read_text()
        listed = re.findall(r"^\| `(\w+)` \|", page.partition("| event | from |")[2], re.MULTILINE)
        self.assertEqual(sorted(listed), sorted(load("event")["properties"]["event"]["enum"]))

    def test_programs_emit_the_events_of_the_schema(self):
        files = [*ROOT.glob("[a-z]*/**/*.cpp"), *(ROOT / "scripts").rglob("*.py")]
        text = "".join(file.read_text() for file in files if file.relative_to(ROOT).parts[0] not in ("build", "out", "tests"))
        emitted = set(re.findall(r"""\b(?:emitEvent|events\.emit)\(\s*"(\w+)""", text))
        self.assertEqual(sorted(emitted), sorted(load("event")["properties"]["event"]["enum"]))

    def test_an_event_that_is_not_documented_is_a_fault(self):
        self.invalid("event", {"event": "unheard_of"})
        self.invalid("event", {})
        self.valid("event", {"event": "stopping"})
        self.invalid("event", {"event": "stopping", "count": 1})

    def test_an_event_has_the_fields_of_its_state(self):
        self.valid("event", {"event": "journal", "state": "room", "seconds": 2.5})
        self.invalid("event", {"event": "journal", "state": "room", "error": "disk full"})
        self.valid("event", {"event": "journal", "state": "no_room", "step": 7, "error": "disk full"})
        self.invalid("event", {"event": "journal", "state": "failed", "step": 7, "error": "disk full"})
        self.valid("event", {"event": "head_tracking", "state": "listening", "port": 4242})
        self.invalid("event", {"event": "head_tracking", "state": "listening"})
        self.invalid("event", {"event": "head_tracking", "state": "lost", "port": 4242})

    def test_an_event_that_a_short_session_does_not_emit(self):
        """Checks the fields of events that have their own tests elsewhere: divergences and given-up sessions."""
        odd = {"rank": 2, "state_hash": "00000000000000ff", "hash_tile": 3, "columns": [0, 31], "rows": [32, 63], "cells": 9}
        divergence = {"event": "divergence", "frame": 30, "step": 29, "state_hash": "0123456789abcdef", "judge": "majority",
                      "agreeing": 2, "ranks": 3, "odd": [odd], "reproduce": ["sandwall-replay", "session.journal"]}
        self.valid("event", divergence)
        for field in odd:
            wrong = copy.deepcopy(divergence)
            del wrong["odd"][0][field]
            self.invalid("event", wrong)
        given_up = {"event": "given_up", "why": "more failures than 3 in 60 s allows",
                    "failures": [{"what": "the haptic server died", "rank": None, "how": "SIGKILL", "frame": None, "step": None}]}
        self.valid("event", given_up)
        self.invalid("event", {**given_up, "failures": [{}]})


class AnotherVersion(unittest.TestCase):
    def refused(self, text):
        with tempfile.TemporaryDirectory(prefix="sandwall-schema-") as folder:
            file = pathlib.Path(folder) / "summary.json"
            file.write_text(text)
            ended = subprocess.run([sys.executable, ROOT / "scripts" / "figures" / "figures.py", file], capture_output=True, text=True, timeout=60)
        self.assertEqual((ended.returncode, ended.stdout, ended.stderr.count("\n")), (2, "", 1), ended.stderr)
        return ended.stderr.replace(folder + "/", "")

    def test_the_scripts_and_the_schema_have_one_version(self):
        self.assertEqual(load("summary")["properties"]["version"]["const"], session_results.VERSION)

    def test_a_script_refuses_it_in_one_line(self):
        self.assertIn("summary.json: the summary has version 2, but these scripts read version 1", self.refused('{"version": 2}'))
        self.assertIn("summary.json: the summary has version 0, but these scripts read version 1", self.refused('{"frames": 60}'))
        self.assertIn("summary.json: is not JSON", self.refused("{"))


if __name__ == "__main__":
    unittest.main()
