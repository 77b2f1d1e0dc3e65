# SPDX-License-Identifier: Apache-2.0
"""The pointer of the wall's windows as the hand, and `sandwall try`, a session on one desktop (docs/pointer.md)."""

import os
import pathlib
import shlex

import desk
from base import layout
from base.bad_input import BadInput
from base.console import print_line
from job import screens

DEVICE = "pointer"
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
    print_line(f"opening {pathlib.Path(wall).stem} with the scene {pathlib.Path(scene).stem}: dig with the left mouse button; h shows the keys, Escape ends")


def session_of(args):
    """Returns the words of `run` for `try`. Replaces the names in `args` by the paths of their files."""
    args.wall, args.scene = layout.found("walls", args.wall), layout.found("scenes", args.scene)
    return ["run", "--here", "--wall", args.wall, "--scene", args.scene, "--device", DEVICE, "--out", args.out]


def print_journal(out, wall):
    journal = pathlib.Path(out) / "session.journal"
    command = [layout.PROGRAM, "film", str(journal), "--wall", wall, "--out", "film"]
    print_line(f"all that you did is in {journal}; `{shlex.join(command)}` makes a film of it")


def add_parser(commands, run):
    """Adds `try` to the launcher's commands."""
    command = commands.add_parser("try", help="dig in sand on this desktop, with the mouse",
                                  description="Shows sand in a window of this desktop, where the mouse digs. Escape ends it; docs/pointer.md.")
    command.set_defaults(run=run)
    command.add_argument("--scene", default="writing", metavar="NAME|FILE", help="scene: a sample's name or a file (default: writing)")
    command.add_argument("--wall", default="desktop", metavar="NAME|FILE", help="wall: a sample's name or a file (default: desktop)")
    command.add_argument("--out", default="out/try", help="folder for journal, pictures and summary (default: out/try)")
