# SPDX-License-Identifier: Apache-2.0
"""The report at the end of `sandwall run`: what session_rules.py finds in summary.json (docs/summary.md)."""

import json
import os
import pathlib
import shlex

from ask import session_results, session_rules
from ask.session_lines import BAD, GOOD, LAGGING, NOTE, NOTES, UNMEASURED
from base import checked_json, console, events, layout
from base.bad_input import BadInput
from base.command_line import NOT_YET

VERSION = 1  # of the JSON that --json prints, as in docs/schemas/report.schema.json
NOT_GOOD = 1  # exit status of a session that ended in order and is not good
BAD_INPUT = 2  # exit status if the summary is damaged
COLOURS = {GOOD: 32, NOTE: 33, LAGGING: 33, BAD: 31, UNMEASURED: 2}
JSON_MARKS = {GOOD: "ok", NOTE: "note", LAGGING: "slow", BAD: "BAD", UNMEASURED: "not measured"}


def replay_command(summary, out):
    """Returns the words of the command that replays the session, or None if it wrote no journal."""
    return None if summary["journal"]["state"] == "off" else [launcher(), "replay", str(out), "--hash"]


def launcher():
    """Returns how the user calls this launcher."""
    return "sandwall" if layout.INSTALLED else os.path.relpath(layout.ROOT / layout.PROGRAM)


def final_status(lines, status):
    """Returns the exit status of a session whose job ended with `status`: never 0 if a line is BAD."""
    return NOT_GOOD if status == 0 and any(mark == BAD for mark, _, _ in lines) else status


def verdict(lines, status):
    """Returns the words after the scene's name. `status` is from final_status()."""
    if status != 0:
        return f"NOT GOOD, exit status {status}"
    notes = sum(mark in NOTES for mark, _, _ in lines)
    name = "slow" if any(mark == LAGGING for mark, _, _ in lines) else "good"
    return name if notes == 0 else f"{name}, 1 note" if notes == 1 else f"{name}, {notes} notes"


def text_of(title, lines, out, replay, status, colours):
    """Returns the report as text. No name in it can begin a line."""
    text = [f"{checked_json.one_line(title)}: {verdict(lines, status)}"]
    for mark, name, words in lines:
        shown = f"\033[{COLOURS[mark]}m{mark:<4}\033[0m" if colours else f"{mark:<4}"
        text.append(f"  {shown}  {name:<11}  {checked_json.one_line(words)}")
    text.append(f"        {'folder':<11}  {printable(str(out))}")
    if replay:
        text.append(f"        {'replay':<11}  {printable(shlex.join(replay))}")
    return "\n".join(text)


def printable(path):
    """Returns a path in one line. Bytes that are not UTF-8 stay, because the path is for a command."""
    return "".join(letter if "\udc80" <= letter <= "\udcff" else checked_json.one_line(letter) for letter in path)


def lines_of_no_summary():
    """Returns the lines of a session that ended without a summary."""
    return [(BAD, "end", "no summary was written: a process failed or was killed, or the disk had no room; docs/recovery.md"),
            (UNMEASURED, "sand", "not compared at the end")]


def json_of(lines, summary, out, status):
    """Returns the report for programs. `summary` is None if the session wrote none that can be read."""
    report = {"version": VERSION, "status": status, "good": status == 0 and summary is not None, "out": str(out),
              "notes": [{"mark": mark, "name": name, "message": words} for mark, name, words in lines if mark in (*NOTES, BAD)],
              "lines": [{"mark": JSON_MARKS[mark], "name": name, "message": words} for mark, name, words in lines],
              "session": None}
    if summary is None:
        return report
    marks = {name: mark for mark, name, _ in lines}
    hand = summary["latency_ms"] if marks.get("latency") in (GOOD, NOTE) else None
    report["session"] = {
        **{key: summary[key] for key in ("scene", "wall", "ranks", "frames", "steps", "seconds", "fps", "late_frames", "state_hash")},
        "measured_frames": summary["frame_ms"]["count"],
        "latency_ms": hand and {key: hand[key] for key in ("p50", "p99")},
        "differing_frames": summary["divergences"] + summary["server_divergences"],
        "healed": summary["healed"],
        "recoveries": len(summary["recoveries"]),
        "volume_exact": marks["volume"] == GOOD,
        "journal": summary["journal"]["state"],
        "replay": replay_command(summary, out)}
    return report


class Report:
    """Prints the report at the end of a session, if the session has written summary.json.

    With `as_json`, standard output gets one JSON object, and all that would go there meanwhile goes to standard error.
    """

    def __init__(self, out, as_json=False):
        self.out, self.as_json = pathlib.Path(out), as_json
        self.before = self.identity()
        self.output = None

    def __enter__(self):
        if self.as_json and console.OUT.descriptor is not None:
            self.output = os.dup(1)
            os.dup2(2, 1)
        return self

    def __exit__(self, *_):
        if self.output is not None:
            os.dup2(self.output, 1)
            os.close(self.output)
            self.output = None

    def identity(self):
        try:
            stat = (self.out / "summary.json").lstat()
            return stat.st_ino, stat.st_mtime_ns
        except OSError:
            return None

    def after(self, status, failures=()):
        """Prints the report of a session whose job has ended with this exit status. Returns the exit status of the session.

        `failures` are failed processes, as session_rules.lines_of() reads them.
        """
        self.__exit__()
        summary, lines, title, replay = None, [], str(self.out), None
        if self.identity() not in (None, self.before):
            try:
                summary = session_results.summary_of(self.out)
                lines = session_rules.lines_of(summary, failures)
                title, replay = summary["scene"], replay_command(summary, self.out)
                status = final_status(lines, status)
            except BadInput as complaint:
                console.print_line(complaint)
                summary, lines, status = None, [], status or BAD_INPUT
            except (LookupError, TypeError, AttributeError, ValueError, ArithmeticError):  # fields that do not fit each other
                console.print_line(f"{self.out}/summary.json: fields are missing, or do not fit each other; the file is damaged")
                summary, lines, status = None, [], status or BAD_INPUT
        elif status not in (0, BAD_INPUT, NOT_YET):  # a master that ends in order writes a summary; the others were refused before there was a session
            lines = lines_of_no_summary()
        if summary is None and self.as_json:
            status = status or NOT_GOOD
        if self.as_json:
            console.OUT.line(json.dumps(json_of(lines, summary, self.out, status), indent=1))
        elif lines:
            console.OUT.line(text_of(title, lines, self.out, replay, status, console.colours()))
        if lines:
            bad, notes = ([name for mark, name, _ in lines if mark in marks] for marks in ((BAD,), NOTES))
            events.emit("report", status=status, bad=bad, notes=notes)
        return status
