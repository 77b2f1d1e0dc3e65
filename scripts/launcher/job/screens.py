# SPDX-License-Identifier: Apache-2.0
"""Decides whether a session opens windows by itself (docs/backends.md)."""

import os
import re
import socket

MOST_OUTPUTS = 2  # [output] of a wall whose windows open by themselves
PATIENCE_SECONDS = 2
XWAYLAND = "on this Wayland desktop windows need Xwayland: install Xwayland (Debian's xwayland), and log in again"
FIRST_PORT = 6000  # X display N listens at this port plus N, if it listens on TCP
NAME = re.compile(r"(?:([^/]*)/)?([^/]*):0*(\d{1,5})(?:\.\d+)?")  # [PROTOCOL/][HOST]:NUMBER[.SCREEN]


def present(name=None):
    """Returns whether an X server accepts connections at the display `name`, by default $DISPLAY: [PROTOCOL/][HOST]:NUMBER[.SCREEN]."""
    found = NAME.fullmatch(os.environ.get("DISPLAY", "") if name is None else name)
    if not found:
        return False
    protocol, host, number = found[1], found[2].strip("[]"), int(found[3])
    if host not in ("", "unix") and protocol not in ("unix", "local"):
        return answers(host, FIRST_PORT + number)
    # Linux has the first address too; it needs no file, so it works where /tmp is another one than the server's.
    path = f"/tmp/.X11-unix/X{number}"
    return answers("\0" + path) or answers(path)


def answers(address, port=None):
    """Returns whether a server accepts a connection at the path of a socket, or at a host's port."""
    try:
        with socket.socket(socket.AF_UNIX) if port is None else socket.create_connection((address, port), PATIENCE_SECONDS) as peer:
            if port is None:
                peer.settimeout(PATIENCE_SECONDS)
                peer.connect(address)
            return True
    except (OSError, OverflowError, UnicodeError):
        return False


def missing():
    """Returns why no window can open although the environment names a display, or "" if it names none, or if one can open."""
    if name := os.environ.get("DISPLAY"):
        return "" if present() else f"no X server accepts connections at DISPLAY={name}; start it, or correct or unset DISPLAY"
    if os.environ.get("WAYLAND_DISPLAY"):
        return f"no X display (DISPLAY is not set); {XWAYLAND}"
    return ""


def may_come():
    """Returns whether a display that is missing() may still come, as one whose X server still starts."""
    return NAME.fullmatch(os.environ.get("DISPLAY", "")) is not None


def backend(outputs, placed):
    """Returns (backend, line for the user or "") for a wall on this machine, whose environment names a display.

    `outputs` is the number of outputs, and `placed` the number of those to which the wall file gives a place on a screen.
    """
    if placed > 0:
        return "auto", ""  # each rank follows the wall file
    if outputs <= MOST_OUTPUTS:
        return "glfw", ""
    return "auto", (f"draws the wall's {outputs} outputs in memory, because only up to {MOST_OUTPUTS} open windows by "
                    "themselves; --gl glfw opens windows")
