# SPDX-License-Identifier: Apache-2.0
"""Sessions in windows, on X servers in memory. xdotool moves the pointer, presses keys and asks the window manager."""

import csv
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import picture_files

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path[:0] = [str(ROOT / "scripts" / room) for room in ("figures", "launcher")]
from ask import session_control  # noqa: E402
from base import events  # noqa: E402
from sessions import x_server  # noqa: E402

BIN = pathlib.Path(os.environ.get("SANDWALL_BIN", ROOT / "build" / "release" / "bin"))
PATIENCE = 120  # seconds for work that takes a few seconds on an idle machine
LOOK_AGAIN = 0.01  # [s], pause between two looks at a state that will change
EDGE = bytes((158, 128, 84))  # colour of the edge of answers and help (render_node/overlay/help.cpp)
SHORTEST_EDGE = 40  # [pixel]; sand has no such line


def launch(words, **popen):
    """Runs a command of scripts/sandwall to its end."""
    environment = {**os.environ, "SANDWALL_BIN": str(BIN), **popen.pop("env", {})}
    return subprocess.run([str(ROOT / "scripts" / "sandwall"), *map(str, words)], env=environment, capture_output=True, text=True,
                          timeout=PATIENCE, **popen)


def edges(picture):
    """Returns the lengths of the horizontal edges of answers and of the help in a picture [pixel], from the top."""
    found = []
    for row in picture.rows:
        longest = 0
        while EDGE * max(longest + 1, SHORTEST_EDGE) in row:
            longest = max(longest + 1, SHORTEST_EDGE)
        if longest:
            found.append(longest)
    return found


class Display(x_server.XServer):
    """A screen with a pointer and keys. Its pixels can be read. `manager` is the command of openbox, if it has a window manager."""

    def __init__(self, width, height, manager=None):
        self.folder = tempfile.TemporaryDirectory(prefix="sandwall-screen-")
        super().__init__(f"{width}x{height}", "-fbdir", self.folder.name)
        self.manager = manager and self.managed_by(manager)

    def managed_by(self, manager):
        """Starts a window manager, and waits until it has started. While it starts, it may overlook a new window."""
        started = pathlib.Path(self.folder.name) / "started"
        process = subprocess.Popen([*manager, "--startup", f"touch {started}"], env=self.environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        deadline = time.monotonic() + PATIENCE
        while not started.exists():
            if process.poll() is not None or time.monotonic() > deadline:
                raise AssertionError(f"{manager[0]} has not started")
            time.sleep(LOOK_AGAIN)
        return process

    def do(self, *words):
        """Runs xdotool with these words, and returns what it prints."""
        return subprocess.run(["xdotool", *map(str, words)], env=self.environment, check=True, timeout=PATIENCE, capture_output=True, text=True).stdout

    def screen(self):
        return picture_files.read_screen(pathlib.Path(self.folder.name) / "Xvfb_screen0")

    def keep(self, name):
        """Saves a screenshot for people if the variable SANDWALL_KEEP_PICTURES names a folder."""
        folder = os.environ.get("SANDWALL_KEEP_PICTURES")
        if folder:
            picture_files.write_png(self.screen(), pathlib.Path(folder) / name)

    def end(self):
        if self.manager:
            self.manager.terminate()
            self.manager.wait(PATIENCE)
        super().end()
        self.folder.cleanup()


class Session:
    """A session of scripts/sandwall that shows frames in windows of `display`. Its files are in `folder`."""

    def __init__(self, display, folder, *words):
        self.display, self.folder = display, pathlib.Path(folder)
        self.out, self.log = self.folder / "out", self.folder / "log.txt"
        environment = {**display.environment, "SANDWALL_BIN": str(BIN), events.VARIABLE: "1"}
        with self.log.open("w") as log:
            self.process = subprocess.Popen([str(ROOT / "scripts" / "sandwall"), *map(str, words), "--out", str(self.out)], env=environment,
                                            stdin=subprocess.DEVNULL, stdout=log, stderr=subprocess.STDOUT, start_new_session=True)
        if events.wait_for(self.log, "progress", PATIENCE, self.runs) is None:
            self.stop()
            raise AssertionError(self.log.read_text())

    def runs(self):
        return self.process.poll() is None

    def stop(self):
        if self.runs():
            self.process.terminate()
            self.process.wait(PATIENCE)

    def until(self, holds, otherwise=""):
        """Waits until `holds()` is true, and returns its value. Fails if the session ends or if it takes too long."""
        deadline = time.monotonic() + PATIENCE
        while not (value := holds()):
            if not self.runs() or time.monotonic() > deadline:
                raise AssertionError(f"{otherwise}\n{self.log.read_text()}")
            time.sleep(LOOK_AGAIN)
        return value

    def ask(self, line):
        if not self.runs():
            raise AssertionError(self.log.read_text())
        return json.loads(session_control.ask(self.out, line))

    def status(self):
        return self.ask("status")

    def wait_for_status(self, wanted, what=""):
        """Waits until the session's status fulfils `wanted`."""
        return self.until(lambda: wanted(self.status()), what)

    def frames_pass(self, count=3):
        """Waits until so many more frames are shown, so that the windows have read the pointer."""
        last = self.status()["frame"] + count
        self.wait_for_status(lambda now: now["frame"] >= last)

    def act(self, *words, display=None):
        """Runs xdotool, and waits until the windows have shown what it did."""
        (display or self.display).do(*words)
        self.frames_pass()

    def drag(self, places, button=1, keys=()):
        """Drags the pointer through places on the screen while keys are held. A slow wall must not skip a place."""
        self.act("mousemove", *places[0])
        self.act(*(word for key in keys for word in ("keydown", key)), "mousedown", button)
        for place in places[1:]:
            self.act("mousemove", *place)
        self.act("mouseup", button, *(word for key in keys for word in ("keyup", key)))

    def end(self, *words):
        """Ends the session by xdotool, and returns its summary. All replicas were equal, and a replay has the same sand."""
        self.display.do(*words)
        status = self.process.wait(PATIENCE)
        summary = json.loads((self.out / "summary.json").read_text())
        said = (status, summary["divergences"], self.replay("--hash"))
        if said != (0, 0, summary["state_hash"]):
            raise AssertionError(f"{said} instead of {summary['state_hash']}\n{self.log.read_text()}")
        return summary

    def replay(self, *words):
        ran = subprocess.run([str(BIN / "sandwall-replay"), str(self.out / "session.journal"), *map(str, words)], capture_output=True,
                             text=True, timeout=PATIENCE)
        if ran.returncode != 0:
            raise AssertionError(ran.stderr)
        return ran.stdout.strip()

    def steps(self, after=0):
        """Returns the rows of all steps whose number is larger than `after`."""
        file = self.folder / "steps.csv"
        self.replay("--export", file)
        with file.open(newline="") as rows:
            return [row for row in csv.DictReader(line for line in rows if not line.startswith("#")) if int(row["number"]) > after]

    def heights_changed(self):
        """Returns how much higher the sand is than at the start, by row from the north [scene unit]."""
        file = self.folder / "difference.asc"
        self.replay("--difference", file)
        rows = [line.split() for line in file.read_text().splitlines()]
        return [[float(word) for word in row] for row in rows if len(row) > 2]


class WindowTest(unittest.TestCase):
    """Tests that share one session, in the order of their names. A derived class starts it in setUpClass()."""

    @classmethod
    def prepare(cls, *tools):
        for tool in ("Xvfb", "xdotool", *tools):
            if shutil.which(tool) is None:
                raise AssertionError(f"{tool} is missing; run scripts/install_dependencies.sh --with-tests")
        temporary = tempfile.TemporaryDirectory(prefix="sandwall-window-")
        cls.addClassCleanup(temporary.cleanup)
        cls.folder = pathlib.Path(temporary.name)

    @classmethod
    def display_of(cls, width, height, manager=None):
        display = Display(width, height, manager)
        cls.addClassCleanup(display.end)
        return display

    @classmethod
    def begin(cls, display, *words):
        cls.session = Session(display, cls.folder, *words)
        cls.addClassCleanup(cls.session.stop)
