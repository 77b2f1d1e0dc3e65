# SPDX-License-Identifier: Apache-2.0
"""The pointer of the wall's windows as the hand, and `sandwall try`, a session on one desktop (docs/pointer.md)."""

import os
import pathlib
import shlex

import desk
from ask.session_report import launcher
from base import layout
from base.bad_input import BadInput
from base.console import print_line
from job import screens
from kept import try_choice

DEVICE = "pointer"
SCENE, WALL = "writing", "desktop"  # of `try`
ELSEWHERE = ("run `try` in a terminal of a desktop; without one, `run --gl osmesa` draws in memory, and "
             "`run --device script:gis` digs without a mouse")


def choose_backend(args):
    """Makes the ranks open windows if the hand is the pointer. Throws BadInput if the user asks for another backend."""
    if args.device == DEVICE:
        if args.gl not in ("auto", "glfw"):
            raise BadInput(f"--device pointer: --gl {args.gl} draws without windows, but the pointer needs them; leave out --gl, or choose another --device")
        args.gl = "glfw"


def windows_of(wall, render_node, check):
    """Returns the options of `run` for the wall's windows on this desktop. Throws BadInput in one line if it cannot show them."""
    if not os.environ.get("DISPLAY") and os.environ.get("WAYLAND_DISPLAY"):
        raise BadInput(f"try: no X display (DISPLAY is not set); {screens.XWAYLAND}")
    if not os.environ.get("DISPLAY"):
        raise BadInput(f"try: no X display (DISPLAY is not set); {ELSEWHERE}")
    if not screens.present():
        raise BadInput(f"try: no X server accepts connections at DISPLAY={os.environ['DISPLAY']}; {ELSEWHERE}")
    words = desk.words_for(wall, render_node, check)
    if "--desk" not in words:
        try:
            with open(wall, "rb") as text:
                desk.probe(render_node, "1", stdin=text)
        except BadInput as error:
            raise BadInput(f"try: {error}; {ELSEWHERE}") from None
    return words


def print_greeting(wall, scene):
    """Tells the person what opens and how to use it, before anything that the programs print."""
    print_line(f"opening {pathlib.Path(wall).stem} with the scene {pathlib.Path(scene).stem}: dig with the left mouse button; h shows the keys, Escape twice ends")


def again(args, scene):
    """Returns the words of the command that continues this session of `try`. Scene and wall are as the user has named them."""
    words = [launcher(), "try"]
    if scene != SCENE and (args.out is None or args.scene):
        words.append(scene)
    words += ["--as-heights"] if args.as_heights else []
    words += ["--wall", args.wall] if args.wall != WALL else []
    return words + (["--out", args.out] if args.out else [])


def session_of(args, choice, scene):
    """Returns the words of `run` for `try`. A session that continues takes its scene from the journal, unless the user names one."""
    words = ["run", "--here", "--wall", layout.found("walls", args.wall), "--device", DEVICE, "--out", choice.out]
    words.append("--visible-tool" if choice.begins else "--resume")
    if choice.begins or (args.out and args.scene):
        words += ["--scene", scene] + (["--as-heights"] if args.as_heights else [])
    return words


def print_journal(out, wall):
    """Says where the journal is, and which command makes a film of it. `wall` is as the user has named it."""
    journal = pathlib.Path(out) / "session.journal"
    command = [launcher(), "film", str(out), "--wall", wall, "--out", "film"]
    print_line(f"all that you did is in {journal}; `{shlex.join(command)}` makes a film of it")


def add_parser(commands, run):
    """Adds `try` to the launcher's commands."""
    command = commands.add_parser("try", help="dig in sand on this desktop, with the mouse",
                                  description="Shows sand in a window of this desktop, where the mouse digs. The next `try` continues with the sand. "
                                              "Escape, pressed twice, ends it; docs/pointer.md.")
    command.set_defaults(run=run)
    command.add_argument("terrain", nargs="?", metavar="NAME|FILE", help="the same as --scene")
    command.add_argument("--scene", metavar="NAME|FILE", help=f"a sample's name, a scene file, or a raster, a picture or points (default: {SCENE})")
    command.add_argument("--wall", default=WALL, metavar="NAME|FILE", help=f"wall: a sample's name or a file (default: {WALL})")
    command.add_argument("--new", action="store_true", help="begin with new sand in place of the newest sand of this scene, which stays")
    command.add_argument("--out", help=f"folder for journal, pictures and summary (default: one for each session, below {try_choice.ROOT})")
    return command
