#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Lists every file that a session writes, with its owner and mode under each umask (docs/security.md).

Runs small sessions on this machine: with recording, checkpoint, saved sand, capture, failures, restart, resumption and
pictures. Looks at the folder all the time, so that files are listed too that are soon gone. The exit status is 1 if group
or other users may write to a file or folder, or if another user owns it.
"""

import contextlib
import json
import os
import pathlib
import pwd
import re
import stat
import subprocess
import sys
import tempfile
import threading
import time

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "figures"))
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "launcher"))
from ask import session_control
from base import command_line, events, layout
from base.bad_input import BadInput
from job import processes
from sessions.session_cost import WALL

ROOT = pathlib.Path(__file__).resolve().parents[2]
PATIENCE_SECONDS = 120
LOOK_SECONDS = 0.005
# Rank 1 dies, so that the job is started again. Then rank 2 differs, and at last sends garbage, which ends the session.
DRILLS = ("die:rank=1,frame=20", "diverge:rank=2,frame=30", "garbage:rank=2,frame=100")
OTHERS_WRITE = stat.S_IWGRP | stat.S_IWOTH


class Failed(Exception):
    """The reason, in one line, why the list cannot be made."""


def kind_of(name):
    """Returns the name of a file with N in place of the numbers that differ from session to session."""
    return re.sub(r"\d+(?=\.checkpoint)|\.\d+(?=\.part$)", lambda found: ".N" if found[0].startswith(".") else "N", name)


class Watch:
    """Looks at a folder in a thread of its own, and keeps owner and mode of everything that was ever in it."""

    def __init__(self, folder):
        self.folder = folder
        self.seen = {}  # name: set of (user id, file type and mode)
        self.ending = threading.Event()
        self.thread = threading.Thread(target=self.look)

    def __enter__(self):
        self.thread.start()
        return self

    def __exit__(self, *_):
        self.ending.set()
        self.thread.join()

    def look(self):
        while not self.ending.wait(LOOK_SECONDS):
            self.look_once()
        self.look_once()

    def look_once(self):
        for folder, folders, files in os.walk(self.folder):
            for name in (".", *folders, *files):
                path = pathlib.Path(folder, name)
                if name == "." and path != self.folder:
                    continue
                with contextlib.suppress(OSError):  # it is gone already
                    about = os.lstat(path)
                    kept = kind_of(str(path.relative_to(self.folder)) + ("/" if stat.S_ISDIR(about.st_mode) else ""))
                    self.seen.setdefault(kept, set()).add((about.st_uid, about.st_mode))


def ask(out, *words):
    """Sends a command to the session until its master answers that it is done."""
    until = time.monotonic() + PATIENCE_SECONDS
    while time.monotonic() < until:
        with contextlib.suppress(BadInput, ValueError):
            if json.loads(session_control.ask(out, " ".join(words)))["ok"]:
                return
        time.sleep(0.02)
    raise Failed(f"the session did not answer {words[0]}")


def run(folder, umask):
    """Runs the sessions in `folder`. Returns {file: set of (user id, mode)}."""
    out = folder / "out"
    (folder / "wall.toml").write_text(re.sub(r"tile_pixels.*", "tile_pixels = [64, 48]", WALL))
    command = [ROOT / "scripts" / "sandwall", "run", "--wall", folder / "wall.toml", "--scene", ROOT / "scenes" / "sandbox.toml", "--gl", layout.in_memory(),
               "--device", "script:gis", "--checkpoint", "0.2", "--restarts", "1", "--out", out]
    drills = [word for drill in DRILLS for word in ("--inject", drill)]
    with Watch(out) as watch, (folder / "said.txt").open("wb") as said:
        def start(*more):
            return subprocess.Popen([*command, *more], stdin=subprocess.DEVNULL, stdout=said, stderr=said, umask=umask,
                                    env={**os.environ, events.VARIABLE: "1"}, preexec_fn=processes.die_with(os.getpid()))

        def awaited(process, status):
            if process.wait(PATIENCE_SECONDS) != status:
                said.flush()
                raise Failed(f"the session ended with status {process.returncode}: {(folder / 'said.txt').read_text(errors='replace')[-2000:]}")

        awaited(start("--record", out / "ticks.csv", *drills), 1)
        resumed = start("--resume")
        for words in (("save", "dunes"), ("capture",), ("stop",)):
            ask(out, *words)
        awaited(resumed, 0)
    return watch.seen


def words_of(found):
    """Returns owner and mode as words, such as "root 0644"."""
    names = {uid: pwd.getpwuid(uid).pw_name for uid, _ in found}
    return ", ".join(sorted({f"{names[uid]} {stat.S_IMODE(mode):04o}" for uid, mode in found}))


def main():
    parser = command_line.Parser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("umasks", nargs="*", metavar="UMASK", default=["000", "022", "077"], help="umasks to try, in octal (default: 000 022 077)")
    args = parser.parse_args()
    for text in args.umasks:
        if not re.fullmatch(r"0?[0-7]{3}", text):
            parser.error(f"UMASK must be three octal digits, got '{text}'")
    lists = {}
    try:
        for text in args.umasks:
            with tempfile.TemporaryDirectory(prefix="sandwall-files-") as name:
                lists[text] = run(pathlib.Path(name), int(text, 8))
    except Failed as failure:
        print(f"session_files.py: {failure}", file=sys.stderr)
        return 1
    print("| file |" + "".join(f" umask {text} |" for text in args.umasks) + "\n|---|" + "---|" * len(args.umasks))
    for name in sorted(set().union(*lists.values())):
        print(f"| `{name}` |" + "".join(f" {words_of(lists[text][name]) if name in lists[text] else '-'} |" for text in args.umasks))
    bad = [name for found in lists.values() for name, all_seen in found.items()
           if any(uid != os.geteuid() or mode & OTHERS_WRITE for uid, mode in all_seen)]
    if bad:
        print(f"session_files.py: other users own or may write to {', '.join(sorted(set(bad)))}", file=sys.stderr)
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
