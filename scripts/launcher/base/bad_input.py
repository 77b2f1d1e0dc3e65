# SPDX-License-Identifier: Apache-2.0
"""Errors that the launcher prints before it ends: bad input, and things that may still come."""

from base import checked_json


class BadInput(Exception):
    """An error in the user's input: one line for the user. Quoted text may hold line feeds, which become '?'."""

    def __init__(self, line):
        super().__init__(checked_json.one_line(str(line)))


class NotYet(BadInput):
    """Something is missing that may still come, such as a host that still starts. The line says what."""
