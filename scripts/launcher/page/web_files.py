# SPDX-License-Identifier: Apache-2.0
"""The files that `sandwall web` serves. Each is opened once by its name in a folder that stays open, and never through a link."""

import errno
import os
import pathlib
import re

from base import layout, session_folder
from base.bad_input import BadInput

TYPES = {".html": "text/html; charset=utf-8", ".js": "text/javascript", ".mjs": "text/javascript", ".css": "text/css",
         ".wasm": "application/wasm", ".txt": "text/plain; charset=utf-8",
         ".scene": "application/octet-stream"}
BYTES = "application/octet-stream"
NEEDED = ("index.html", "replica.wasm")
MEND = "install a package that has it" if layout.INSTALLED else "run scripts/web.sh"
JOURNAL = "/session/session.journal"
PART = re.compile(re.escape(JOURNAL) + r"(?:\.([1-9][0-9]{0,8}))?")


class Page:
    """The files of the page, in a folder that stays open."""

    def __init__(self, folder):
        """Throws BadInput if one that every page needs is not there, or is a link."""
        self.folder = session_folder.open_folder(folder)
        self.names = {"/" + path.name: path.name for path in pathlib.Path(folder).iterdir() if path.suffix in TYPES}
        self.names["/"] = "index.html"
        for name in NEEDED:
            try:
                os.close(session_folder.open_regular(name, os.O_RDONLY, folder=self.folder))
            except OSError as error:
                raise BadInput(f"{pathlib.Path(folder) / name}: cannot be served ({error.strerror}); {MEND}") from error

    def opened(self, path):
        """Returns (descriptor, type) for the path of a request, or None. Throws OSError, and follows no link."""
        name = self.names.get(path)
        return name and (session_folder.open_regular(name, os.O_RDONLY, folder=self.folder), TYPES[pathlib.Path(name).suffix])


class Journal:
    """The parts of the journal that a user has named, in a folder that stays open. Another file of this name may take its place."""

    def __init__(self, named):
        """Throws BadInput unless the first part is a journal."""
        self.path = pathlib.Path(layout.journal_at(named))
        try:
            self.folder = session_folder.open_folder(self.path.parent)
            os.close(self.open_part(self.path.name))
        except OSError as error:
            why = "no journal" if error.errno in (errno.ENOENT, errno.ENOTDIR) else error.strerror
            raise BadInput(f"{self.path}: {why}; name a session's folder or its session.journal") from error

    def open_part(self, name):
        """Throws OSError, also for a second name of another user's file, which that user may have closed to others."""
        descriptor = session_folder.open_journal(name, self.folder)
        about = os.fstat(descriptor)
        if about.st_nlink > 1 and about.st_uid != os.fstat(self.folder).st_uid:
            os.close(descriptor)
            raise OSError(errno.EPERM, "is another name of another user's file", name)
        return descriptor

    def opened(self, path):
        """Returns (descriptor, type) for the path of a request, or None. Throws OSError, and follows no link."""
        part = PART.fullmatch(path)
        if part is None or part.group(1) == "1":
            return None
        return self.open_part(self.path.name + (f".{part.group(1)}" if part.group(1) else "")), BYTES
