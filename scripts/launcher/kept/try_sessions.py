# SPDX-License-Identifier: Apache-2.0
"""Chooses the session that `sandwall try` continues, makes the folder of a new one, and removes the oldest (docs/pointer.md)."""

import contextlib
import os
import pathlib
import re
import shlex
import shutil
import stat
import time

from ask.session_report import launcher
from base import journal_origin, session_folder
from base.bad_input import BadInput
from base.console import print_line
from kept import marks

MOST_SESSIONS = 10
MOST_BYTES = 2 * 1000 ** 3  # of all sessions together
SAND = ("checkpoints", "saves")  # beside the parts of the journal
REASONS = {"count": f"only the {MOST_SESSIONS} newest sessions stay", "bytes": f"the sessions may have {MOST_BYTES // 1000 ** 3} GB together"}


class Kept:
    """A marked folder below the folder of all sessions of `try`."""

    def __init__(self, path, scene):
        self.path, self.scene = pathlib.Path(path), scene
        times = [entry.lstat().st_mtime_ns for entry in self.path.iterdir() if entry.name.startswith(session_folder.JOURNAL)]
        self.has_sand = bool(times) or any((self.path / name).exists() for name in SAND)
        self.has_journal = (self.path / session_folder.JOURNAL).is_file()
        self.time = max(times, default=(self.path / marks.NAME).lstat().st_mtime_ns)  # of the last step [ns]

    def why_unreadable(self):
        """Returns why no session can continue this one, or None."""
        if why := session_folder.why_unsafe(self.path):
            return why
        if self.scene is None:
            return f"its {marks.NAME} is damaged"
        try:
            session_folder.require_safe_content(self.path)
            return journal_origin.refusal(journal_origin.of(self.path / session_folder.JOURNAL))
        except journal_origin.Damaged as damage:
            return f"its journal is damaged: {damage}"
        except OSError as error:
            return f"its journal cannot be read ({error.strerror})"
        except BadInput as complaint:
            return str(complaint)

    def bytes(self):
        """Returns how much of the disk the folder takes [byte]."""
        found = 0
        for folder, _, files in os.walk(self.path):
            for name in files:
                with contextlib.suppress(OSError):
                    found += os.lstat(os.path.join(folder, name)).st_blocks * 512
        return found


def all_below(root, report=print_line):
    """Returns the sessions of `try` below a folder, the newest first. A folder without a mark is left out.

    report(line) is called for a folder that cannot be read. Throws BadInput if `root` cannot be used.
    """
    found = []
    try:
        paths = list(pathlib.Path(root).iterdir())
        session_folder.require_safe(root)
    except FileNotFoundError:
        return []
    except NotADirectoryError:
        session_folder.require_folder(root, root)
    except OSError as error:
        raise BadInput(f"{root}: cannot be read ({error.strerror}); choose another --out") from None
    for path in paths:
        try:
            if stat.S_ISDIR(path.lstat().st_mode):
                found.append(Kept(path, marks.read(path)))
        except FileNotFoundError:
            continue  # without a mark, or another `try` has removed it
        except OSError as error:
            report(f"{path}: cannot be read ({error.strerror}); its sand stays there")
    return sorted(found, key=lambda kept: kept.time, reverse=True)


def claimed_of(root, scene):
    """Returns (the newest session of this scene, its claim), or (None, None) if new sand must begin.

    Prints a line about each newer one that cannot be continued. It stays as it is.
    """
    for kept in all_below(root):
        if not kept.has_journal or (kept.scene is not None and kept.scene.name != scene.name):
            continue
        if why := kept.why_unreadable():
            print_line(f"{kept.path}: {why}; its sand stays there")
            continue
        if kept.scene.digest != scene.digest:
            print_line(f"{kept.path}: has the scene as it was before its file has changed; its sand stays there, and `{try_there(kept.path)}` continues it")
            return None, None
        if (claim := claim_of(kept.path)) is None:
            print_line(f"{kept.path}: another session digs there now, so this one begins with new sand")
            return None, None
        return kept.path, claim
    return None, None


def claim_of(path, needs_lock=False):
    try:
        return marks.claim(path, needs_lock)
    except OSError:
        return None  # it has been removed meanwhile


def try_there(folder):
    return shlex.join([launcher(), "try", "--out", str(folder)])


def make_new(root, scene):
    """Makes and marks a folder for new sand below `root`, which is safe afterwards. Returns (path, claim). Throws BadInput."""
    stem = re.sub(r"[^A-Za-z0-9_.-]", "_", pathlib.Path(scene.name).stem)[:64] or "sand"
    begin = pathlib.Path(root) / f"{stem.lstrip('.-') or 'sand'}-{time.strftime('%Y%m%d-%H%M%S')}"
    path = begin
    try:
        session_folder.make(root)
        session_folder.require_folder(root, root)
        session_folder.require_safe(root)
        for number in range(2, 1000):
            with contextlib.suppress(FileExistsError):
                path.mkdir(mode=0o755)
                break
            path = begin.with_name(f"{begin.name}-{number}")
        marks.write(path, scene)
        return path, marks.claim(path)
    except OSError as error:
        discard(path)
        raise BadInput(f"{path}: cannot be made ({error.strerror}); make room, or choose another --out") from None


def discard(path):
    """Removes a new folder in which no session has begun. Leaves a folder with other files, and says nothing."""
    with contextlib.suppress(OSError):
        if {entry.name for entry in pathlib.Path(path).iterdir()} <= {marks.NAME}:
            (pathlib.Path(path) / marks.NAME).unlink(missing_ok=True)
            os.rmdir(path)


def make_room(root, begun):
    """Removes the oldest sessions below `root` until at most MOST_SESSIONS of MOST_BYTES are left. Prints a line for each.

    The session `begun` and one that runs stay. One that no session can continue stays too, and does not count: it may be of
    another release or of another user, or damaged. Nor does one without sand, whose start has failed.
    """
    count = total = 0
    for kept in all_below(root, report=lambda line: None):
        is_begun = kept.path.name == pathlib.Path(begun).name
        if not kept.has_sand and not is_begun:
            continue
        size = kept.bytes()
        reason = "count" if count >= MOST_SESSIONS else "bytes" if count > 0 and total + size > MOST_BYTES else None
        why = kept.why_unreadable() if kept.has_journal else session_folder.why_unsafe(kept.path)
        if why:
            if reason:
                print_line(f"{kept.path}: {why}; it stays, although {REASONS[reason]}")
        elif is_begun or not reason or not remove(kept, reason):
            count, total = count + 1, total + size


def remove(kept, reason):
    """Removes a session that has to go, and prints a line. Returns whether it has gone. It stays while another session digs there."""
    if (claim := claim_of(kept.path, needs_lock=True)) is None:
        return False
    try:
        for entry in kept.path.iterdir():
            if entry.name != marks.NAME:
                shutil.rmtree(entry) if entry.is_dir() and not entry.is_symlink() else entry.unlink()
        (kept.path / marks.NAME).unlink()  # the last file: what an error leaves is still a session of `try`
        kept.path.rmdir()
        print_line(f"{kept.path}: is removed, because {REASONS[reason]}; a session that you move to another folder is kept")
        return True
    except OSError as error:
        print_line(f"{kept.path}: cannot be removed ({error.strerror}); {REASONS[reason]}")
        return False
    finally:
        os.close(claim)
