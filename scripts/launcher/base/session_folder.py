# SPDX-License-Identifier: Apache-2.0
"""A session's folder: makes it, checks that only this user may write to it, and locks it for one launcher at a time."""

import contextlib
import errno
import fcntl
import os
import pathlib
import stat
import time

from base import layout
from base.bad_input import BadInput

PATIENCE = 5  # seconds to wait for a session that is ending
OTHERS_WRITE = stat.S_IWGRP | stat.S_IWOTH
FOLDERS = ("log", "checkpoints", "saves")
JOURNAL = "session.journal"  # first part of the names of all parts
MAGIC = b"SWJL"  # with which each part begins (docs/journal.md)
CONTINUED = ("divergence.txt", "drills.done", "failures.jsonl", "incidents.json", "recoveries.jsonl")  # files of a resumed session


class InUse(Exception):
    """Another launcher uses the folder."""


def make(path):
    """Makes a folder and its missing parents, to which only this user may write. The new names survive a power loss."""
    path = pathlib.Path.cwd() / path  # not simplified: behind a link, ".." is not the folder that holds the link
    missing = [folder for folder in (path, *path.parents) if not folder.exists()]
    for folder in reversed(missing):
        folder.mkdir(mode=0o755, exist_ok=True)
        try:
            descriptor = os.open(folder.parent, os.O_RDONLY | os.O_DIRECTORY | os.O_CLOEXEC)
        except PermissionError:
            continue  # a folder may be used without the right to read it
        try:
            os.fsync(descriptor)
        except OSError:
            pass  # a file system that cannot sync a folder
        finally:
            os.close(descriptor)


def remove_empty(path):
    """Removes a session's folder, and the one that holds it, if they are empty because the session was refused."""
    try:
        os.rmdir(path)
        os.rmdir(os.path.dirname(path))
    except OSError:
        pass  # they hold files


def why_unsafe(path):
    """Returns why a session must not use the folder, or None. The programs have the same check, host::whyUnsafeFolder().

    Another user who may write to the folder could replace files while a session runs.
    """
    link, folder = os.lstat(path), os.stat(path)
    if link.st_uid != os.geteuid():
        return "is a link of another user" if stat.S_ISLNK(link.st_mode) else "belongs to another user"
    if folder.st_uid != os.geteuid():
        return "leads to a folder of another user"
    return "other users may write to it" if folder.st_mode & OTHERS_WRITE else None


def require_safe_content(out):
    """Throws BadInput for a file or folder of an earlier session in `out` that another user owns or may write to, and for a link.

    A link in place of a file of CONTINUED is not refused, because it is never followed. The programs have the same check, host::whyUnsafeContent().
    """
    out = pathlib.Path(out)
    for entry in [path for path in out.iterdir() if path.name in FOLDERS or path.name.startswith(JOURNAL) or
                  (path.name in CONTINUED and not path.is_symlink())]:
        require_safe_entry(entry)
        if entry.name in FOLDERS and entry.is_dir():
            for inside in entry.iterdir():
                require_safe_entry(inside)


def require_safe_entry(path):
    try:
        about = os.lstat(path)
    except FileNotFoundError:
        return  # the session that still ends has removed it
    if stat.S_ISLNK(about.st_mode):
        raise BadInput(f"{path}: is a link, and a session follows none in its folder; remove it, or choose another --out")
    if about.st_uid != os.geteuid():
        raise BadInput(f"{path}: belongs to another user; remove it, or choose another --out")
    if about.st_mode & OTHERS_WRITE:
        raise BadInput(f"{path}: other users may write to it; run chmod -R go-w on the session's folder, or choose another --out")


def require_folder(path, named):
    """Throws BadInput if the path leads to something else than a folder."""
    if not os.path.isdir(path):
        raise BadInput(f"{named}: is not a folder, and --out must be one; choose another")


def require_safe(path):
    """Throws BadInput if why_unsafe() has a reason."""
    if why := why_unsafe(path):
        advice = "run chmod go-w on it, or choose another --out" if why.startswith("other users") else "choose another --out"
        raise BadInput(f"{path}: {why}; {advice}")


def open_regular(path, flags, mode=0o644, *, links=False, folder=None):
    """Returns the descriptor of a regular file. Throws OSError for all else, and never waits, for example for a pipe's reader.

    Follows a link only with `links`, for a file that a user has named. `folder` is the descriptor of the folder in which `path` is.
    """
    follow = 0 if links else os.O_NOFOLLOW
    try:
        descriptor = os.open(path, flags | os.O_CLOEXEC | follow | os.O_NONBLOCK | os.O_NOCTTY, mode, dir_fd=folder)
    except OSError as error:
        if error.errno != errno.ELOOP or links:
            raise
        raise OSError(errno.ELOOP, "is a link, which is not followed", str(path)) from None
    if not stat.S_ISREG(os.fstat(descriptor).st_mode):
        os.close(descriptor)
        raise OSError(errno.EINVAL, "is not a regular file", str(path))
    return descriptor


def open_folder(path):
    """Returns a descriptor of a folder, for names of files in it. A link may lead to it. Throws OSError."""
    return os.open(path, os.O_PATH | os.O_DIRECTORY | os.O_CLOEXEC)


def open_journal(path, folder=None):
    """Returns the descriptor of a part of a journal, after a look at its first bytes. Throws OSError, and never follows a link."""
    descriptor = open_regular(path, os.O_RDONLY, folder=folder)
    try:
        if os.pread(descriptor, len(MAGIC), 0) != MAGIC:
            raise OSError(errno.EINVAL, "is not a journal", str(path))
    except OSError:
        os.close(descriptor)
        raise
    return descriptor


def require_journal(named):
    """Throws BadInput unless a user has named a journal, or a session's folder with one in it."""
    journal = layout.journal_at(named)
    try:
        os.close(open_regular(journal, os.O_RDONLY))
    except OSError as error:
        if error.errno in (errno.ELOOP, errno.EINVAL):
            raise BadInput(f"{journal}: {error.strerror}; name the journal itself") from None
        raise BadInput(f"{journal}: cannot be read ({error.strerror}); check the path") from None


def read_text(path, links=False):
    """Returns the text of a regular file. Throws OSError for all else, and ValueError if it is not UTF-8. `links` as for open_regular()."""
    with open(open_regular(path, os.O_RDONLY, links=links), encoding="utf-8") as file:
        return file.read()


def new_file(path, flags):
    """Makes a file to which only this user may write, and returns its descriptor. Replaces a regular file of this name.

    Throws OSError for a link, a pipe and all else that has this name. A new file has no second name in another folder.
    """
    try:
        about = os.lstat(path)
    except FileNotFoundError:
        about = None
    if about is not None:
        if not stat.S_ISREG(about.st_mode):
            raise OSError(errno.EINVAL, "is a link" if stat.S_ISLNK(about.st_mode) else "is not a regular file", str(path))
        os.unlink(path)
    return os.open(path, flags | os.O_CREAT | os.O_EXCL | os.O_NOFOLLOW | os.O_CLOEXEC, 0o644)


def forget(path):
    """Removes a regular file or a link. Leaves everything else, such as a pipe. Throws OSError if nothing has this name."""
    kind = os.lstat(path).st_mode
    if stat.S_ISREG(kind) or stat.S_ISLNK(kind):
        os.unlink(path)


def write_text(path, text):
    """Writes a new file as new_file() makes it. Throws OSError. Names of files in `text` need not be UTF-8."""
    with open(new_file(path, os.O_WRONLY), "w", encoding="utf-8", errors="surrogateescape") as file:
        file.write(text)


@contextlib.contextmanager
def held(out, resume=False):
    """Holds a lock on the folder `out`. The kernel releases the lock when the process ends for any reason.

    Throws BadInput if the folder cannot be made or written, or if other users may write to it. The same holds for what
    earlier sessions left in it. Throws InUse if another launcher holds the lock.
    """
    path = pathlib.Path(out)
    try:
        make(path)
    except OSError as error:
        raise BadInput(f"{out}: cannot be made ({error.strerror}); choose another --out") from error
    try:
        require_folder(path, out)
        require_safe(path)
        require_safe_content(path)
        descriptor = os.open(path, os.O_RDONLY | os.O_DIRECTORY | os.O_CLOEXEC)
    except OSError:
        yield
        return
    try:
        lock(descriptor, out)
        if not os.access(path, os.W_OK | os.X_OK):
            raise BadInput(f"{out}: cannot be written; " +
                           ("a resumed session writes its journal there, so make it writable" if resume else "choose another --out"))
        yield
    finally:
        os.close(descriptor)


def is_held(path):
    """Returns whether a launcher holds the lock on the folder."""
    descriptor = os.open(path, os.O_RDONLY | os.O_DIRECTORY | os.O_CLOEXEC)
    try:
        fcntl.flock(descriptor, fcntl.LOCK_SH | fcntl.LOCK_NB)
        return False
    except BlockingIOError:
        return True
    finally:
        os.close(descriptor)


def append_line(path, line):
    """Appends a line to a regular file, which must not be a link. Begins on a line of its own if a crash has cut the last line off. Throws OSError."""
    with open(open_regular(path, os.O_RDWR | os.O_CREAT | os.O_APPEND), "ab", buffering=0) as file:
        size = os.fstat(file.fileno()).st_size
        torn = size > 0 and os.pread(file.fileno(), 1, size - 1) != b"\n"
        file.write((b"\n" if torn else b"") + line.encode() + b"\n")


def lock(descriptor, out):
    deadline = time.monotonic() + PATIENCE
    while True:
        try:
            return fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            if time.monotonic() > deadline:
                raise InUse(f"{out}: another session runs in this folder; stop that one first, or choose another --out") from None
        except OSError:
            return None  # a file system without locks
        time.sleep(0.05)
