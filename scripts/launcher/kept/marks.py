# SPDX-License-Identifier: Apache-2.0
"""The mark in a folder of `sandwall try`: which scene is dug there. Its lock says that the session runs.

A folder without a mark belongs to a person. `try` neither continues nor removes it.
"""

import fcntl
import hashlib
import json
import os
import pathlib
import tomllib
from typing import NamedTuple

from base import checked_json, layout, session_folder
from base.bad_input import BadInput

NAME = "try.json"
VERSION = 1
MOST_BYTES = 1 << 16  # of a mark


class Scene(NamedTuple):
    """Identity of a scene. Two sessions dig the same scene if both values are equal."""

    name: str    # of a sample, or the absolute path of a file
    digest: str  # of the scene, and of size and time of the files that it names


def about(path):
    """Returns name, size and time of a file, as bytes. They are empty if it cannot be read, which the programs report."""
    try:
        found = os.stat(path)
        return f"{os.path.basename(path)} {found.st_size} {found.st_mtime_ns}\n".encode("utf-8", "surrogateescape")
    except (OSError, ValueError):
        return b""


def files_of(text, folder):
    """Returns the paths of the files of terrain and rock that the text of a scene names."""
    try:
        terrain = tomllib.loads(text.decode()).get("terrain", {})
        return [folder / terrain[key] for key in ("file", "bedrock") if isinstance(terrain.get(key), str)]
    except (ValueError, AttributeError, RecursionError):
        return []  # the programs report what is wrong


def scene_of(path, made_from=()):
    """Returns the Scene in the file `path`. If it is terrain, `made_from` says how a scene is made of it."""
    path = pathlib.Path(path)
    name = path.stem if path.parent == layout.FOLDERS["scenes"] else os.path.abspath(path)
    if made_from:
        return Scene(name, hashlib.sha256(repr(made_from).encode() + about(path)).hexdigest())
    try:
        content = path.read_bytes()
    except OSError as error:
        raise BadInput(f"{path}: cannot be read ({error.strerror}); check the path") from None
    digest = hashlib.sha256(content)
    for file in files_of(content, path.parent):
        digest.update(about(file))
    return Scene(name, digest.hexdigest())


def write(folder, scene):
    """Marks a new folder. Throws OSError."""
    # Names of files need not be UTF-8. JSON escapes the halves of surrogate pairs that stand for their bytes.
    session_folder.write_text(pathlib.Path(folder) / NAME, json.dumps({"version": VERSION, "scene": scene.name, "digest": scene.digest}) + "\n")


def read(folder):
    """Returns the Scene of a marked folder, or None if its mark is damaged. Throws FileNotFoundError without a mark, and OSError."""
    file = session_folder.open_regular(pathlib.Path(folder) / NAME, os.O_RDONLY)
    try:
        text = os.pread(file, MOST_BYTES, 0)
    finally:
        os.close(file)
    try:
        mark = checked_json.parse(text)
        scene = Scene(mark["scene"], mark["digest"])
    except (ValueError, LookupError, TypeError):
        return None
    return scene if mark.get("version") == VERSION and all(isinstance(word, str) for word in scene) else None


def claim(folder, needs_lock=False):
    """Locks the mark of a folder for this process, and returns its descriptor. Returns None while another `try` digs there.

    A file system without locks gives the descriptor all the same, unless `needs_lock`. The kernel releases the lock when the
    process ends for any reason. Throws OSError.
    """
    file = session_folder.open_regular(pathlib.Path(folder) / NAME, os.O_RDWR)  # NFS locks no file that is only read
    try:
        locked = lock(file)
        free = not session_folder.is_held(folder) if locked else locked is None and not needs_lock  # `run --resume` may hold it
    except OSError:
        os.close(file)
        raise
    if free:
        return file
    os.close(file)
    return None


def lock(file):
    """Locks a file. Returns False if another process has locked it, and None on a file system without locks."""
    try:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    except OSError:
        return None
    return True
