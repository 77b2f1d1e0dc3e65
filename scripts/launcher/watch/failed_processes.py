# SPDX-License-Identifier: Apache-2.0
"""OUT/failures.jsonl: every failed process that the launcher of a session has seen, one JSON object per line (docs/recovery.md).

The report reads it. A session that is resumed continues the file; any other session begins a new one.
"""

import json
import pathlib

from base import checked_json, session_folder
from base.console import print_line

NAME = "failures.jsonl"
SERVER = "the haptic server"  # the text of its failures begins so
MOST_BYTES = 1 << 20  # of the file that are read; a failure has a few hundred
LONGEST_TEXT = 300


def read_line(line):
    """Returns the failure in a line of the file, or None if the line is damaged."""
    try:
        found = checked_json.parse(line)
    except ValueError:
        return None
    if not isinstance(found, dict) or not isinstance(found.get("what"), str) or type(found.get("restarted")) is not bool:
        return None
    what = checked_json.one_line(found["what"], LONGEST_TEXT)
    return {"what": what, "restarted": found["restarted"], "server": what.startswith(SERVER), "now": False}


class FailedProcesses:
    """The failed processes of a session. `all` holds them as the rules of the report read them (session_rules.py)."""

    def __init__(self, out, resumed):
        """Reads the file of a session that is resumed. Removes that of another session."""
        self.path = pathlib.Path(out) / NAME
        self.all = []
        try:
            if resumed:
                text = session_folder.read_text(self.path)[-MOST_BYTES:]
                self.all = [failure for line in text.splitlines() if (failure := read_line(line))]
            else:
                session_folder.forget(self.path)
        except (OSError, ValueError):
            pass  # there is none, or the report has the failures of this launcher alone

    def add(self, failure, restarted):
        """Adds a process_failure.Failure. Prints why the file cannot be written."""
        self.all.append({"what": failure.text, "restarted": restarted, "server": failure.text.startswith(SERVER), "now": True})
        line = {"what": failure.text, "rank": failure.rank, "how": failure.how, "time": failure.when, "frame": failure.frame,
                "step": failure.step, "restarted": restarted}
        try:
            session_folder.append_line(self.path, json.dumps(line))
        except OSError as error:
            print_line(f"{self.path}: cannot be written ({error.strerror})")
