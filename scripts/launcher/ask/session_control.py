# SPDX-License-Identifier: Apache-2.0
"""`sandwall ctl`: sends an operator's command to a session's control socket (docs/operator.md)."""

import os
import pathlib
import socket

from base import checked_json, console, program_options, session_folder
from base.bad_input import BadInput

SOCKET = "control"
PATIENCE_SECONDS = 120  # a capture of a large wall takes long
LONGEST_ANSWER = 1 << 16
RESTARTING = "restarting"  # file in OUT/log with the failure, from the failure to the first frame after it


def verbs():
    """Returns the commands of a session with their arguments, as the master of this build knows them."""
    return program_options.listed(program_options.MASTER)["verbs"]


def connect(session, patience=PATIENCE_SECONDS):
    """Returns a connection to the master of the session in the folder `session`."""
    try:
        folder = os.open(session, os.O_PATH | os.O_DIRECTORY | os.O_CLOEXEC)
    except OSError as error:
        raise BadInput(f"{session}: cannot be opened ({error.strerror}); name the --out folder of a session") from None
    peer = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
    peer.settimeout(patience)
    control = None
    try:
        # A link in a folder of another user could lead to the socket of another session of this user.
        control = os.open(SOCKET, os.O_PATH | os.O_NOFOLLOW | os.O_CLOEXEC, dir_fd=folder)
        # The path goes through a descriptor, because the path of a socket has at most 107 bytes. A link cannot be connected to.
        peer.connect(f"/proc/self/fd/{control}")
    except PermissionError:
        raise BadInput(f"{session}: belongs to another user; only that user may command the session") from None
    except (FileNotFoundError, ConnectionRefusedError):
        raise BadInput(f"{session}: {why_silent(session)}") from None
    except OSError as error:
        raise BadInput(f"{session}: cannot be reached ({error})") from None
    finally:
        os.close(folder)
        if control is not None:
            os.close(control)
    return peer


def why_silent(session):
    """Returns why no master answers in the folder. Between two tries a launcher still holds the folder's lock."""
    try:
        if session_folder.is_held(session):
            try:
                failure = checked_json.one_line(session_folder.read_text(pathlib.Path(session) / "log" / RESTARTING).strip())
                return f"the session is being started again, because {failure}; try again in a moment"
            except (OSError, ValueError):
                return "the session is being started; try again in a moment"
    except OSError:
        pass  # a folder that this user may not read, or a file system without locks
    return "no session is running in this folder"


def ask(session, line, patience=PATIENCE_SECONDS):
    """Returns the master's answer to a line as text."""
    with connect(session, patience) as peer:
        answer = b""
        try:
            peer.sendall(line.encode(errors="surrogateescape") + b"\n")
            while len(answer) < LONGEST_ANSWER and (piece := peer.recv(4096)):
                answer += piece
        except socket.timeout:
            raise BadInput(f"{session}: no answer within {patience} s") from None
        except (ConnectionResetError, BrokenPipeError):
            pass  # the answer before the end of the connection is still valid
    return answer.decode(errors="replace").strip()


def ctl(args):
    if args.words in (["help"], ["--help"], ["-h"]):
        console.OUT.line("\n".join(verbs()))
        return 0
    line = " ".join(args.words)
    if "\n" in line:
        raise BadInput("a command must be one line")
    answer = ask(args.session, line)
    if not answer:
        raise BadInput(f"{args.session}: the session ended before it answered")
    try:
        reply = checked_json.parse(answer)
    except ValueError:
        reply = None
    if not isinstance(reply, dict) or type(reply.get("ok")) is not bool or checked_json.one_line(answer) != answer:
        raise BadInput(f"{args.session}: the program that answers there is not a session")
    if not reply["ok"]:
        raise BadInput(f"{args.session}: {checked_json.one_line(str(reply.get('error')))}")
    console.OUT.line(answer)
    return 0


def add_parser(commands, remainder):
    """Adds `ctl` to the launcher's commands, and returns its parser. `remainder` is argparse.REMAINDER."""
    parser = commands.add_parser("ctl", help="command a running session",
                                 description="Commands a session that runs on this machine; docs/operator.md.")

    def complete():
        parser.epilog = f"Commands: help, {', '.join(verbs())}."

    parser.add_help_later(complete)
    parser.set_defaults(run=ctl)
    parser.add_argument("session", metavar="SESSION", help="the session's folder, or the journal in it")
    parser.add_argument("words", metavar="VERB", nargs=remainder, help="command and its arguments")
    return parser
