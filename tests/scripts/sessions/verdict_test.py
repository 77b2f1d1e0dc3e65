#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests the verdict on real sessions whose truth is known: the mark of the line, and the exit status."""

import json
import os
import pathlib
import signal
import subprocess
import time
import unittest

from schema_fixture import ROOT, SessionTest


def haptic_server_of(launcher):
    """Returns the process id of the haptic server that a launcher has started."""
    for child in pathlib.Path(f"/proc/{launcher}/task/{launcher}/children").read_text().split():
        if b"sandwall-haptic-server" in pathlib.Path(f"/proc/{child}/cmdline").read_bytes().split(b"\0")[0]:
            return int(child)
    raise AssertionError(f"process {launcher} has no haptic server")


class Verdict(SessionTest):
    def report(self, *options):
        """Runs a session and returns its report."""
        ended = subprocess.run([*self.command(*options), "--json"], capture_output=True, text=True, timeout=200, stdin=subprocess.DEVNULL)
        report = json.loads(ended.stdout)
        self.valid("report", report)
        self.assertEqual(report["status"], ended.returncode, ended.stderr)
        self.assertEqual(report["good"], ended.returncode == 0)
        return report

    def mark(self, report, name):
        return {line["name"]: line["mark"] for line in report["lines"]}.get(name)

    def test_a_hand_that_was_asked_for_and_never_came_is_bad(self):
        report = self.report("--haptic", "127.0.0.1:9", "--frames", "20")
        self.assertEqual((report["status"], self.mark(report, "hand"), self.mark(report, "latency")), (1, "BAD", "not measured"), report)

    def test_a_difference_in_the_last_frame_is_found_and_healed(self):
        report = self.report("--frames", "20", "--pace", "fast", "--inject", "diverge:rank=1,frame=20")
        self.assertEqual((report["status"], self.mark(report, "sand"), self.mark(report, "hand")), (0, "note", None), report)
        self.assertEqual((report["session"]["differing_frames"], report["session"]["healed"]), (1, 1))
        summary = json.loads((self.out / "summary.json").read_text())
        self.assertEqual((summary["compared"]["first_difference"], summary["compared"]["at_end"]), (20, True))

    def test_a_haptic_server_that_dies_for_good_is_bad(self):
        session = self.start("--device", "script:gis", "--restarts", "0", "--json")
        self.await_event(session, "progress", hand="hand linked")
        os.kill(haptic_server_of(session.pid), signal.SIGKILL)
        self.await_event(session, "link", state="lost")
        # The master sees the end of the link before the launcher sees the end of the process.
        end = time.monotonic() + 30
        while not (self.out / "failures.jsonl").exists() and time.monotonic() < end:
            time.sleep(0.05)
        session.send_signal(signal.SIGINT)
        self.assertEqual(session.wait(120), 1, self.log.read_text())
        failure = json.loads((self.out / "failures.jsonl").read_text())
        self.assertEqual((failure["how"], failure["restarted"]), ("SIGKILL", False))
        text = self.log.read_text()
        report = json.loads(text[text.index("\n{\n") + 1:text.rindex("\n}\n") + 3])
        self.assertEqual((report["good"], self.mark(report, "hand")), (False, "BAD"))

    def test_a_session_whose_summary_cannot_be_written_ends_when_it_is_told_to(self):
        session = self.start("--json")
        self.await_event(session, "progress")
        (self.out / "summary.json").mkdir()
        subprocess.run([ROOT / "scripts" / "sandwall", "ctl", self.out, "stop"], check=True, capture_output=True, timeout=60)
        self.assertEqual(session.wait(120), 1, self.log.read_text())
        failure = json.loads((self.out / "failure.json").read_text())
        self.valid("failure", failure)
        self.assertEqual(failure["what"], "summary")
        self.assertNotIn("starting again", self.log.read_text())


if __name__ == "__main__":
    unittest.main()
