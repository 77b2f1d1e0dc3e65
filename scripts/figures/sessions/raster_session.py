# SPDX-License-Identifier: Apache-2.0
"""Sessions on made-up rasters, whose start and memory scripts of this folder measure."""

import array
import contextlib
import math
import os
import pathlib
import random
import re
import subprocess
import sys
import time

from base import events, layout
from sessions.measured_session import ROOT, Failed, die_with_parent, processor
from sessions.rest_cost import family_of

LONGEST_START = 900  # [s]
STROKES = "speed 0.5\ndepth 0.5\nstroke\npoint -0.3 0\npoint 0.3 0.2\n"  # takes some two seconds
PROGRAMS = ("sandwall-haptic-server", "sandwall-master", "sandwall-render-node")
HEADER = """BYTEORDER {order}
LAYOUT BIL
NROWS {side}
NCOLS {side}
NBANDS 1
NBITS 16
PIXELTYPE SIGNEDINT
ULXMAP 0
ULYMAP 0
XDIM 30
YDIM 30
"""
SCENE = """name = "start"
[terrain]
kind = "dem"
file = "start.bil"
lengths = true
datum = 400
[tool]
radius = 400
[material]
talus_deg = 34
"""


@contextlib.contextmanager
def busy_processes(count):
    """Scope in which `count` processes compute beside the sessions."""
    busy = [subprocess.Popen([sys.executable, "-c", "while True: pass"], preexec_fn=die_with_parent) for _ in range(count)]
    try:
        yield
    finally:
        for process in busy:
            process.kill()


def make_scene(folder, side, rough):
    """Writes a scene with a raster of dunes. Returns its file.

    A `rough` one has noise of ±3 m, and its rows do not fit together, so that most of its sand slides from the start.
    """
    noise = random.Random(1)
    profile = array.array("h", (round(400 + 200 * math.sin(x / 300) + 60 * math.sin(x / 70)) + (noise.randint(-3, 3) if rough else 0)
                                for x in range(side + 2000)))
    with (folder / "start.bil").open("wb") as file:
        for row in range(side):
            shift = (noise.randrange(1000) if rough else 0) + round(400 * (1 + math.sin(row / 260)))
            file.write(profile[shift:shift + side].tobytes())
    (folder / "start.hdr").write_text(HEADER.format(order="I" if sys.byteorder == "little" else "M", side=side))
    (folder / "start.toml").write_text(SCENE)
    (folder / "once.strokes").write_text(STROKES)
    return folder / "start.toml"


def memory_of(root):
    """Returns the resident memory and its peak of each program below the process `root`: {program: (now, peak)} [byte]."""
    found = {}
    for process in family_of(root):
        with contextlib.suppress(OSError):
            folder = pathlib.Path("/proc") / str(process)
            name = pathlib.Path(os.readlink(folder / "exe")).name
            status = (folder / "status").read_text()
            if name in PROGRAMS:
                found[name] = tuple(1024 * int(re.search(rf"^{key}:\s+(\d+)", status, re.MULTILINE)[1]) for key in ("VmRSS", "VmHWM"))
    return found


class RasterSession:
    """A session of a scene of make_scene(), on memory instead of a screen. It ends when the object is left.

    `launcher` and `programs` are of one build; without them, those of this one. `options` are more options of `run`.
    """

    def __init__(self, scene, out, wall, *options, launcher=ROOT / "scripts" / "sandwall", programs=None):
        self.log = out.with_suffix(".log")
        command = [launcher, "run", "--here", "--wall", wall, "--scene", scene, "--device", f"script:{scene.parent / 'once.strokes'}",
                   "--no-pictures", "--gl", layout.in_memory(), "--out", out, *options]
        environment = dict(os.environ, **{events.VARIABLE: "1"}, **({"SANDWALL_BIN": str(programs)} if programs else {}))
        self.began = time.monotonic()
        with self.log.open("w") as said:
            self.run = subprocess.Popen([str(word) for word in command], stdin=subprocess.PIPE, stdout=said, stderr=subprocess.STDOUT,
                                        text=True, env=environment, preexec_fn=die_with_parent)

    def wait_for(self, event, **fields):
        """Waits for an event, and returns the time since the start [s]. Throws Failed if it does not come."""
        if events.wait_for(self.log, event, LONGEST_START, lambda: self.run.poll() is None, **fields) is None:
            raise Failed(f"{self.log.stem}: no {event}: {self.said()}")
        return time.monotonic() - self.began

    def said(self):
        return self.log.read_text(errors="replace").strip()[-300:]

    def memory(self):
        return memory_of(self.run.pid)

    def stop(self):
        """Ends the session in order, and returns how long that takes [s]. Throws Failed if the session has failed."""
        stopped = time.monotonic()
        self.run.communicate("stop\n", timeout=LONGEST_START)
        if self.run.returncode != 0:
            raise Failed(f"{self.log.stem}: the session failed: {self.said()}")
        return time.monotonic() - stopped

    def __enter__(self):
        return self

    def __exit__(self, *_):
        if self.run.poll() is None:
            self.run.terminate()
            self.run.wait(timeout=LONGEST_START)


def print_table(columns, rows, more=""):
    """Prints a table in Markdown, and the machine. `more` follows the machine."""
    print("| " + " | ".join(columns) + " |\n|" + "---|" * len(columns))
    for cells in rows:
        print("| " + " | ".join(cells) + " |")
    print(f"\n- machine: {processor()}, {len(os.sched_getaffinity(0))} cores{more}")
