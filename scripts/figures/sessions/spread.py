#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Measures how long the frames of a session are with large tools, whose steps are spread over frames.

Runs sessions on a desktop wall in real time, with a head that moves. Each ROW is one kind of session, and takes at most four
minutes:

dunes61, dunes153   dunes of 512 x 512 cells, tool of 61 or 153 cells, the recorded hand `gis`
large               level sand of 4096 x 4096 cells, tool of 61 cells, a stamp and then the same hand. The frame of the first
                    stroke, which copies the sand for an undo, has a figure of its own
edits               dunes of 2048 x 2048 cells on rock, without a hand: `material talus`, `settle`, `reset` and `load`. The step of
                    a reset moves all sand without a sweep, so that its frame is the measure of the others. After each edit
                    the session is paused, so that the same sand is drawn at rest, too

Prints the longest frame, the samples of the hand that are in no step, and by how much the tool is slower than the hand. With
--before ROOT the sessions of an earlier build run in turns with those of build/release.

usage: scripts/figures/sessions/spread.py ROW [--before ROOT] [--seconds S]   (the machine should be idle otherwise)
"""

import json
import pathlib
import subprocess
import sys
import tempfile
import threading
import time

sys.dont_write_bytecode = True
sys.path[:0] = [str(pathlib.Path(__file__).resolve().parents[2] / room) for room in ("figures", "launcher")]
from ask import session_control
from base.bad_input import BadInput
from base.command_line import Parser, above
from sessions.wall_rates import ROOT, swaying_head

LONGEST_FRAME = 120  # for which an answer is awaited [s]
PERIOD = 1 / 60  # of the wall [s]
SCENE = """name = "{name}"
[field]
columns = {cells}
rows = {cells}
width = 2.0
[terrain]
{terrain}
[material]
talus_deg = 34
settling_time = 0.1
[tool]
radius = {radius}
"""
DUNES = 'kind = "dunes"\nheight = 0.15\ndune_height = 0.09\ndune_length = 0.55'


class Frames:
    """The frames of a running session. A master answers `status` once in each frame, so the answers are as far apart as frames."""

    def __init__(self, out):
        self.out, self.seen, self.stopped = out, [], False
        self.thread = threading.Thread(target=self.follow)

    def __enter__(self):
        self.thread.start()
        return self

    def __exit__(self, *_):
        self.stopped = True
        self.thread.join()

    def follow(self):
        while not self.stopped:
            try:
                status = json.loads(session_control.ask(self.out, "status", LONGEST_FRAME))
            except (BadInput, ValueError):
                time.sleep(0.05)  # not begun yet, or at its end
                continue
            self.seen.append((time.monotonic(), status))

    def longest(self, since=0.0, until=float("inf"), wanted=lambda before, after: True):
        """Returns the longest frame between two times [ms]. Frames without an answer count as punctual."""
        found = 0.0
        for (then, before), (now, after) in zip(self.seen, self.seen[1:]):
            frames = after["frame"] - before["frame"]
            if frames > 0 and since <= then and now <= until and wanted(before, after):
                found = max(found, now - then - (frames - 1) * PERIOD)
        return 1e3 * found

    def wait(self, wanted, patience=LONGEST_FRAME):
        """Waits until a status is as wanted, and returns whether one was."""
        ends = time.monotonic() + patience
        while time.monotonic() < ends:
            if self.seen and wanted(self.seen[-1][1]):
                return True
            time.sleep(0.02)
        return False


class Session:
    """A session of the sources `root`, from its start to the end of the block."""

    def __init__(self, folder, root, scene, head, hand=None):
        self.out = folder / "out"
        self.command = [root / "scripts" / "sandwall", "run", "--wall", root / "walls/configs/desktop.toml", "--scene", scene,
                        "--gl", "osmesa", "--track", f"trace:{head}", "--no-pictures", "--restarts", "0", "--out", self.out]
        self.command += ["--device", f"script:{hand}"] if hand else []
        self.summary = None

    def __enter__(self):
        self.log = (self.out.parent / "log.txt").open("w")
        self.process = subprocess.Popen(list(map(str, self.command)), stdout=self.log, stderr=subprocess.STDOUT)
        self.frames = Frames(self.out).__enter__()
        if not self.frames.wait(lambda status: status["step"] > 0):
            self.process.terminate()
            self.frames.__exit__()
            sys.exit(f"the session did not begin: {pathlib.Path(self.log.name).read_text()[-400:]}")
        return self

    def ask(self, line):
        answer = json.loads(session_control.ask(self.out, line, 180))
        if not answer.get("ok"):
            sys.exit(f"{line}: {answer.get('error')}")
        return answer

    def __exit__(self, *failed):
        self.frames.__exit__()
        self.process.terminate() if any(failed) else self.ask("stop")
        self.process.wait(timeout=180)
        self.log.close()
        if not any(failed):
            self.summary = json.loads((self.out / "summary.json").read_text())


def hand_words(summary):
    haptic = summary.get("haptic") or {}
    slow = summary["hand"].get("slow_motion")
    motion = "slow motion not measured" if slow is None else f"slow motion {slow:.1f}"
    return f"{summary['steps']} steps in {summary['frames']} frames, {haptic.get('samples_dropped', 0)} samples left out, {motion}"


def hand_row(folder, root, scene, head, hand, seconds):
    """Returns the words about a session with a hand. The path of `gis` takes four seconds."""
    with Session(folder, root, scene, head, hand) as session:
        session.frames.wait(lambda status: status["linked"])
        began = time.monotonic()
        time.sleep(seconds)
        # The hand may press before this program sees that it is linked.
        first = session.frames.longest(wanted=lambda before, after: not before["can_undo"] and after["can_undo"])
        others = session.frames.longest(began, wanted=lambda before, after: before["can_undo"] == after["can_undo"])
    return f"longest frame {others:6.0f} ms, that of the first stroke {first:6.0f} ms; {hand_words(session.summary)}"


def edits_row(folder, root, scene, head, _, seconds):
    """Returns the words about edits of a field that all moves, about moving it without sweeps, and about drawing it at rest."""
    longest, moved, at_rest = {}, [], 0.0
    with Session(folder, root, scene, head) as session:
        session.ask("save start")
        for edit in ("material talus 20", "settle", "reset", "material talus 12", "load start", "material talus 8", "reset"):
            began = time.monotonic()
            asked = threading.Thread(target=session.ask, args=(edit,))  # a settle may be answered at its end
            asked.start()
            time.sleep(seconds / 4)
            longest[edit] = max(session.frames.longest(began), longest.get(edit, 0))
            if edit == "reset":
                moved.append(session.frames.longest(began, wanted=lambda before, after: before["edits"] < after["edits"]))
            session.ask("pause")
            asked.join()
            paused = time.monotonic()
            time.sleep(2)
            at_rest = max(at_rest, session.frames.longest(paused))
            session.ask("resume")
    found = ", ".join(f"{edit} {ms:.0f} ms" for edit, ms in longest.items())
    return (f"longest frames: {found}; all sand moves without sweeps {max(moved):.0f} ms, 1.6 times and 50 ms more are "
            f"{1.6 * max(moved) + 50:.0f} ms; drawn at rest {at_rest:.0f} ms")


def stamp_and_gis(folder):
    """Writes a stroke list that first stamps, and then has the strokes of `gis`."""
    file = folder / "stamp.strokes"
    gis = (ROOT / "haptic_bridge" / "devices" / "gis.strokes").read_text()
    file.write_text("depth 0.2\nstroke\npoint 0.8 0.8\nhold 0.2\n" + gis)
    return file


def scene_of(folder, row):
    cells, radius, terrain = {"dunes61": (512, 0.24, DUNES), "dunes153": (512, 0.6, DUNES),
                              "large": (4096, 61 / 2048, 'kind = "flat"\nheight = 0.2'),
                              "edits": (2048, 0.03, DUNES + "\nlayer = 0.1")}[row]
    file = folder / f"{row}.toml"
    file.write_text(SCENE.format(name=row, cells=cells, radius=radius, terrain=terrain))
    return file


ROWS = {"dunes61": hand_row, "dunes153": hand_row, "large": hand_row, "edits": edits_row}


def main():
    parser = Parser(description=__doc__.split("\n\n")[0])
    parser.add_argument("row", choices=ROWS, metavar="ROW", help=f"kind of session: {', '.join(ROWS)}")
    parser.add_argument("--before", type=pathlib.Path, metavar="ROOT", help="sources of an earlier build, with build/release")
    parser.add_argument("--seconds", type=above(float, 0), default=20, metavar="S", help="of each session with a hand, or of four edits (default: 20)")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        head = swaying_head(folder, 600)
        hand = stamp_and_gis(folder) if arguments.row == "large" else "gis"
        for when, root in (("before", arguments.before), ("now", ROOT)):
            if root is not None:
                words = ROWS[arguments.row](folder, root.resolve(), scene_of(folder, arguments.row), head, hand, arguments.seconds)
                print(f"{arguments.row}, {when}: {words}", flush=True)


if __name__ == "__main__":
    main()
