# SPDX-License-Identifier: Apache-2.0
"""Reads the summary.json of a session (docs/summary.md)."""

import errno
import functools
import pathlib
import sys

from base import checked_json, json_schema, layout, session_folder
from base.bad_input import BadInput

VERSION = 1  # version of summary.json, as in docs/schemas/summary.schema.json
BAD_INPUT = 2


@functools.cache
def schema():
    """Returns docs/schemas/summary.schema.json."""
    return checked_json.parse((layout.SCHEMAS / "summary.schema.json").read_text(encoding="utf-8"))


def summary_of(path):
    """Returns the content of a summary file, or of the one in a session's folder or beside its journal. The latter may not be a link.

    Raises BadInput if the file cannot be read, has another version, or is not as its schema says.
    """
    path = pathlib.Path(path)
    inside = path.is_dir() or path.name == session_folder.JOURNAL
    if inside:
        path = (path if path.is_dir() else path.parent) / "summary.json"
    named = checked_json.one_line(str(path))
    try:
        found = checked_json.parse(session_folder.read_text(path, links=not inside))
    except OSError as error:
        if error.errno in (errno.ELOOP, errno.EINVAL):
            raise BadInput(f"{named}: {error.strerror}; name the summary.json of a session itself") from None
        raise BadInput(f"{named}: cannot be read ({error.strerror}); the session has not ended in order") from None
    except ValueError as error:
        raise BadInput(f"{named}: is not JSON ({checked_json.one_line(str(error), 200)}); name the summary.json of a session") from None
    version = found.get("version", 0) if isinstance(found, dict) else 0
    if checked_json.whole(version) != VERSION:
        raise BadInput(f"{named}: the summary has version {checked_json.one_line(str(version), 40)}, but these scripts read version "
                       f"{VERSION}; use the scripts of the build that wrote it")
    if wrong := json_schema.fault(found, schema()):
        raise BadInput(f"{named}: {checked_json.one_line(wrong, 200)}; the file is damaged, or of another build than these scripts")
    return found


def read_summary(path):
    """Returns summary_of(path). If it raises BadInput, prints one line and ends the script with exit status 2."""
    try:
        return summary_of(path)
    except BadInput as complaint:
        print(complaint, file=sys.stderr)
        sys.exit(BAD_INPUT)
