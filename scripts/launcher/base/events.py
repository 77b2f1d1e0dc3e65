#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The events that programs of a session write for other programs (docs/events.md)."""

import json
import os
import pathlib
import sys
import time

if __name__ == "__main__":
    sys.path[0] = str(pathlib.Path(__file__).resolve().parents[1])
from base import checked_json, command_line, console, environment

VARIABLE = environment.EVENTS
TAG = "@sandwall "
FAILURES = ("hung", "broken", "disk", "sand", "summary")  # `what` of failure.json
MOST_RANKS = 1_000_000
LONGEST_TEXT = 300  # characters of a text that the launcher shows and passes on


def wanted():
    """Returns whether the user asks for events."""
    return os.environ.get(VARIABLE) == "1"


def parse(line):
    """Returns the event in `line`, a str or bytes, or None if the line is not an event."""
    text = line.decode(errors="replace") if isinstance(line, bytes) else line
    if not text.startswith(TAG):
        return None
    try:
        event = checked_json.parse(text[len(TAG):])
    except ValueError:
        return None
    return event if isinstance(event, dict) and isinstance(event.get("event"), str) else None


def failure_in(value):
    """Returns the fields of failure.json or of the event `failure`, which have the same schema.

    Returns {} if `value` is not such an object. Leaves out a field that is not as the schema says.
    """
    if not isinstance(value, dict) or value.get("what") not in FAILURES:
        return {}
    found = {"what": value["what"]}
    if (rank := checked_json.whole(value.get("rank"), -1, MOST_RANKS)) is not None:
        found["rank"] = rank
    for key in ("host", "tile", "message"):
        if isinstance(value.get(key), str):
            found[key] = " ".join(checked_json.one_line(" ".join(value[key].split()), LONGEST_TEXT).split())
    return found


def emit(name, **fields):
    """Writes an event to standard error if the user asks for events."""
    if wanted():
        console.ERROR.line(TAG + json.dumps({"event": name, **fields}))


def read(path):
    """Returns the events in a file of output, in order. Returns an empty list while the file cannot be read."""
    try:
        with open(path, "rb") as stream:
            return [event for line in stream if line.endswith(b"\n") and (event := parse(line))]
    except OSError:
        return []


def wait_for(path, name, seconds, alive=lambda: True, **fields):
    """Returns the first event with this name and these fields in a growing file of output.

    Returns None if the event does not come within `seconds`, or if `alive()` becomes false before it comes.
    """
    deadline = time.monotonic() + seconds
    while True:
        last = not alive() or time.monotonic() > deadline
        for event in read(path):
            if event["event"] == name and all(event.get(key) == value for key, value in fields.items()):
                return event
        if last:
            return None
        time.sleep(0.05)


def main():
    parser = command_line.Parser(description="Waits for an event in a growing file of output, and prints one field of the event.")
    parser.add_argument("file")
    parser.add_argument("event")
    parser.add_argument("field")
    parser.add_argument("--seconds", type=command_line.at_least(float, 0), default=60, help="how long to wait (default: 60)")
    args = parser.parse_args()
    event = wait_for(args.file, args.event, args.seconds)
    if event is None or args.field not in event:
        print(f"{args.file}: no event {args.event} with the field {args.field} within {args.seconds:g} s", file=sys.stderr)
        return 1
    print(checked_json.one_line(str(event[args.field])))
    return 0


if __name__ == "__main__":
    sys.exit(main())
