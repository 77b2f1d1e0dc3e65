# SPDX-License-Identifier: Apache-2.0
"""The events that programs of a session write for other programs (docs/events.md)."""

import json
import os
import sys

VARIABLE = "SANDWALL_EVENTS"
TAG = "@sandwall "


def wanted():
    """Whether the user asks for events."""
    return os.environ.get(VARIABLE) == "1"


def parse(line):
    """The event in a line of output, str or bytes, or None."""
    text = line.decode(errors="replace") if isinstance(line, bytes) else line
    if not text.startswith(TAG):
        return None
    try:
        event = json.loads(text[len(TAG):])
    except ValueError:
        return None
    return event if isinstance(event, dict) and "event" in event else None


def emit(name, **fields):
    """Writes an event to standard error, if the user asks for events."""
    if wanted():
        print(TAG + json.dumps({"event": name, **fields}), file=sys.stderr, flush=True)
