# SPDX-License-Identifier: Apache-2.0
"""Decides whether a session opens windows by itself (docs/backends.md)."""

import os
import re
import socket

MOST_OUTPUTS = 2  # [output] of a wall whose windows open by themselves
PATIENCE_SECONDS = 2
FIRST_PORT = 6000  # X display N listens at this port plus N, if it listens on TCP


def present(name=None):
    """Returns whether an X server accepts connections at the display `name`, by default $DISPLAY."""
    found = re.fullmatch(r"(?:(unix)|([^:]*)):(\d{1,5})(\.\d+)?", os.environ.get("DISPLAY", "") if name is None else name)
    if not found:
        return False
    number, host = int(found[3]), found[2]
    if host:
        return answers(socket.AF_INET, (host, FIRST_PORT + number))
    # Linux has the first address too; it needs no file, so it works where /tmp is another one than the server's.
    path = f"/tmp/.X11-unix/X{number}"
    return answers(socket.AF_UNIX, "\0" + path) or answers(socket.AF_UNIX, path)


def answers(family, address):
    """Returns whether a server accepts a connection at the address."""
    try:
        with socket.socket(family, socket.SOCK_STREAM) as peer:
            peer.settimeout(PATIENCE_SECONDS)
            peer.connect(address)
            return True
    except (OSError, OverflowError):
        return False


def backend(outputs, placed):
    """Returns (backend, line for the user or "") for a wall on this machine, where a display is present.

    `outputs` is the number of outputs, and `placed` the number of those to which the wall file gives a place on a screen.
    """
    if placed > 0:
        return "auto", ""  # each rank follows the wall file
    if outputs <= MOST_OUTPUTS:
        return "glfw", ""
    return "auto", (f"draws the wall's {outputs} outputs in memory, because only up to {MOST_OUTPUTS} open windows by "
                    "themselves; --gl glfw opens windows")
