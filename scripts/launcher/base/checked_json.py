# SPDX-License-Identifier: Apache-2.0
"""Reads JSON of other programs. It may be cut off, damaged, or written by another program than expected."""

import json
import re

# Control characters and separators of lines, and the halves of surrogate pairs, which no file and no terminal can show.
UNPRINTABLE = re.compile("[\x00-\x1f\x7f-\x9f\u2028\u2029\ud800-\udfff]")


def parse(text):
    """Returns the JSON value in `text`. Throws ValueError if it is not JSON, or if it is nested too deeply to be read."""
    try:
        return json.loads(text)
    except RecursionError:
        raise ValueError("nested too deeply") from None


def one_line(text, most=None):
    """Returns `text` in one line that every stream takes, cut to `most` characters: others become '?'."""
    return UNPRINTABLE.sub("?", text)[:most]


def whole(value, least=0, most=2 ** 63 - 1):
    """Returns `value` if it is a whole number from `least` to `most`, else None."""
    return value if type(value) is int and least <= value <= most else None
