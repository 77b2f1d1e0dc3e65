# SPDX-License-Identifier: Apache-2.0
"""Finds programs, walls, scenes and strokes: in the sources, or in an installed tree (docs/install.md).

An installed tree may be moved as a whole, because every path begins at this file:

    PREFIX/bin/sandwall                 link to lib/sandwall/python/sandwall
    PREFIX/lib/sandwall/                programs, modules, and a list of options for each program
    PREFIX/lib/sandwall/python/         the launcher and its modules, build.json and a schema
    PREFIX/share/sandwall/              walls, scenes, strokes, samples, examples
"""

import os
import pathlib
import subprocess

from base import checked_json, environment
from base.bad_input import BadInput

HERE = pathlib.Path(__file__).resolve().parents[1]
INSTALLED = (HERE.parent / "sandwall-master").is_file()
ROOT = HERE.parents[2] if INSTALLED else HERE.parents[1]  # prefix of the installed tree, or folder of the sources
SHARED = ROOT / "share" / "sandwall"
FOLDERS = {"walls": SHARED / "walls", "scenes": SHARED / "scenes", "strokes": SHARED / "strokes"} if INSTALLED else {
    "walls": ROOT / "walls" / "configs", "scenes": ROOT / "scenes", "strokes": ROOT / "haptic_bridge" / "devices"}
SCHEMAS = HERE if INSTALLED else ROOT / "docs" / "schemas"  # folder of the schema that the launcher reads
ENDINGS = {"walls": ".toml", "scenes": ".toml", "strokes": ".strokes"}
PROGRAM = "sandwall" if INSTALLED else "scripts/sandwall"  # how a user starts the launcher
MEND = "install Sandwall again" if INSTALLED else "run cmake --build build/release"
ANSWER_SECONDS = 20
JOURNAL = "session.journal"


def bin_folder():
    """Returns the folder of the programs: $SANDWALL_BIN, or that of the installed tree or of the release build."""
    return pathlib.Path(os.environ.get(environment.BIN) or (HERE.parent if INSTALLED else ROOT / "build" / "release" / "bin"))


def in_memory():
    """Returns the backend that draws in memory: osmesa, or egl in a build without OSMesa."""
    folder = bin_folder()
    return "egl" if (folder / "sandwall-gl-egl.so").is_file() and not (folder / "sandwall-gl-osmesa.so").is_file() else "osmesa"


def program(name):
    """Returns the path of one of our programs. Throws BadInput if it does not exist."""
    path = bin_folder() / name
    if not path.is_file() and os.environ.get(environment.BIN):
        raise BadInput(f"{path}: does not exist; unset SANDWALL_BIN, or set it to the folder of the programs")
    if not path.is_file():
        raise BadInput(f"{path}: not installed; {MEND}" if INSTALLED else
                       f"{path}: not built yet; run scripts/demo.sh or cmake --build build/release")
    return str(path)


def known(kind):
    """Returns the names of all walls, scenes or strokes that come with Sandwall, in order."""
    return sorted(path.stem for path in FOLDERS[kind].glob("*" + ENDINGS[kind]))


def found(kind, named):
    """Returns the path of the file that a user has named: a path from the current folder, or the name of a known file.

    Throws BadInput for a name without a folder that is neither. Other paths are returned as they are, so that the reader
    of the file reports them.
    """
    if os.path.exists(named) or "/" in named or not named:
        return named
    shared = FOLDERS[kind] / (named.removesuffix(ENDINGS[kind]) + ENDINGS[kind])
    if not shared.is_file():
        raise BadInput(f"{named}: no file and no known name; {kind} that come with Sandwall: {', '.join(known(kind))}")
    return str(shared)


def journal_at(named):
    """Returns the journal that a user has named: a file, or the journal in a session's folder.

    If the name itself is a link to a file, returns that file, because links to parts of a journal are refused.
    """
    if os.path.isdir(named):
        return str(pathlib.Path(named) / JOURNAL)
    return os.path.realpath(named) if os.path.islink(named) else named


def session_at(named):
    """Returns the session's folder that a user has named: a folder, or the folder of the journal in it."""
    path = pathlib.Path(named)
    return str(path.parent) if path.name == JOURNAL and path.is_file() else named


def build_of(path):
    """Returns the build id that a program prints, or None if it prints no JSON with one."""
    try:
        said = checked_json.parse(subprocess.run([path, "--version", "--json"], stdin=subprocess.DEVNULL, capture_output=True,
                                                 text=True, errors="replace", timeout=ANSWER_SECONDS, check=False).stdout)
    except (OSError, ValueError, subprocess.TimeoutExpired):
        return None
    build = said.get("build") if isinstance(said, dict) else None
    return build if isinstance(build, str) else None


def require_one_build(names):
    """Throws BadInput if a program is of another build than the installed launcher. In the sources there is no such check."""
    try:
        wanted = checked_json.parse((HERE / "build.json").read_text(encoding="utf-8"))["build"]
    except (OSError, ValueError, KeyError, TypeError):
        return
    for name in names:
        build = build_of(path := program(name))
        if build != wanted:
            raise BadInput(f"{path}: is of build {build or 'unknown'}, and this launcher of {wanted}; install programs and "
                           "launcher of one build" + (", or unset SANDWALL_BIN" if "SANDWALL_BIN" in os.environ else ""))
