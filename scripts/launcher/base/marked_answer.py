# SPDX-License-Identifier: Apache-2.0
"""Marks the output of a command that runs on another host, because a login there may print lines of its own before and after it."""

import re
import shlex

BEGIN, END = "@sandwall begin", "@sandwall end"
# Each line of what a command prints, behind a word that names the question. printf and not echo, which reads backslashes.
SAY = 'say() { while IFS= read -r line || [ -n "$line" ]; do printf "%s %s\\n" "$1" "$line"; done; }'
# A login may leave its last line without an end, so each mark begins with a line feed.
ANSWER = re.compile(rf"(?:^|\n){BEGIN}\r?\n(.*?)\n{END} (\d+)\r?(?:\n|$)", re.DOTALL)
BEGUN = re.compile(rf"(?:^|\n){BEGIN}\r?\n(.*)$", re.DOTALL)


def marked(line):
    """Returns a line of shell that runs `line` in sh, and marks what it prints on both outputs. Any shell takes it."""
    both = [f'printf "\\n{BEGIN}\\n"{to}' for to in ("", " >&2")]
    after = [f'printf "\\n{END} %s\\n" "$status"{to}' for to in ("", " >&2")]
    return "sh -c " + shlex.quote("; ".join([*both, f"( {line} )", "status=$?", *after, 'exit "$status"']))


def answer(text):
    """Returns (exit status, what the command itself has printed) of an output. The status is None without an end of the answer.

    Returns None if the command has not begun.
    """
    if found := ANSWER.search(text):
        return int(found[2]), found[1]
    found = BEGUN.search(text)
    return found and (None, found[1])


def of_both(status, said, complained):
    """Returns (exit status, standard output, standard error) of a marked command. `status` is that of the program in place of ssh.

    The status is None if the command has not run to its end there. The standard error is then what the login or ssh printed.
    """
    out, err = answer(said), answer(complained)
    if out is None or out[0] is None:
        return status or None, "", (err[1] if err else complained).strip() or said.strip()
    return out[0], out[1], err[1] if err else complained


def named_lines(text):
    """Returns {word: lines} of an output whose lines begin with a word, as SAY prints them."""
    found = {}
    for line in text.splitlines():
        word, _, rest = line.partition(" ")
        found[word] = f"{found[word]}\n{rest}" if word in found else rest
    return found


def last_line(text):
    """Returns the last line of a text that is not empty, or ""."""
    return next((line.strip() for line in reversed(text.splitlines()) if line.strip()), "")


def own_line(text, beginning="sandwall"):
    """Returns the last line that begins as our programs do, else the last line. Libraries print lines of their own."""
    return next((line.strip() for line in reversed(text.splitlines()) if line.startswith(beginning)), last_line(text))
