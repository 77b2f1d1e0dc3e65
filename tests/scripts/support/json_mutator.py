# SPDX-License-Identifier: Apache-2.0
"""Changes JSON values and bytes at random, for tests of code that reads files of other programs."""

import copy
import json

# Values that a reader may not expect: other types, and the limits of numbers and texts.
ODD = (None, True, False, 0, -1, 1, 2 ** 31, 2 ** 63, -2 ** 64, 10 ** 400, 0.5, -0.0, 1e308, float("nan"), float("inf"), "", "0", "a" * 5000,
       "two\nlines", "\0", "\x1b[2J", "\ud800", "\udcff", "\U0001f600", "{}", "%s{0}", [], {}, [[]], [None], [-1], ["x"], {"": None}, {"rank": 1})
DEEP = 100_000  # more nested lists than Python's stack has room for


def places(value):
    """Returns (container, key) of every value inside `value`."""
    keys = value.keys() if isinstance(value, dict) else range(len(value)) if isinstance(value, list) else ()
    found = []
    for key in keys:
        found += [(value, key), *places(value[key])]
    return found


def changed_value(value, random):
    """Returns a copy of a JSON value with up to four changes."""
    value = copy.deepcopy(value)
    for _ in range(random.randint(1, 4)):
        inside = places(value)
        if not inside or random.random() < 0.03:
            value = copy.deepcopy(random.choice(ODD))
            continue
        container, key = random.choice(inside)
        kind = random.randrange(8)
        if kind == 0 and isinstance(container, dict):
            del container[key]
        elif kind == 1:
            container[key] = copy.deepcopy(random.choice(inside)[0])
        elif kind == 2:
            container[key] = [container[key]]
        else:
            container[key] = copy.deepcopy(random.choice(ODD))
    return value


def changed_bytes(text, random):
    """Returns a copy of bytes with one change: a bit, a piece left out or twice, an end cut off, a line moved."""
    at, end = sorted(random.randrange(len(text) + 1) for _ in range(2))
    kind = random.randrange(6)
    if kind == 0 and at < len(text):
        return text[:at] + bytes([text[at] ^ 1 << random.randrange(8)]) + text[at + 1:]
    if kind == 1:
        return text[:at] + text[end:]
    if kind == 2:
        return text[:end] + text[at:]
    if kind == 3:
        return text[:at]
    if kind == 4:
        return text[:at] + random.choice((b"\xff\xfe", b"\0", b"\n", b"\r\n", b"NaN", b"1e999", b"9" * 5000, b"\\u", b'"', b"[" * DEEP)) + text[at:]
    return text[at:] + text[:at]


def changed_json(value, random):
    """Returns a changed JSON value as text, whose bytes are changed in every fourth case."""
    text = json.dumps(changed_value(value, random), ensure_ascii=random.random() < 0.9).encode(errors="surrogatepass")
    return changed_bytes(text, random) if random.random() < 0.25 else text
