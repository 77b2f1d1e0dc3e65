# SPDX-License-Identifier: Apache-2.0
"""Whole sessions that scripts of this folder measure, and the tables that they write."""

import ctypes
import math
import os
import pathlib
import re
import signal
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass

sys.dont_write_bytecode = True
sys.path[:0] = [str(pathlib.Path(__file__).resolve().parents[2] / room) for room in ("figures", "launcher")]
from ask import session_results
from base import command_line, events, layout

ROOT = pathlib.Path(__file__).resolve().parents[3]
BIN = layout.bin_folder()
SCENE = ROOT / "scenes" / "sandbox.toml"
START_SECONDS = 120  # longest start of a session, on a busy machine
REFRESH = 60  # Hz, on every wall


@dataclass
class Load:
    name: str
    divisor: int  # divides width and height in pixels of the wall file's tiles
    stereo: bool
    digs: bool


class Failed(Exception):
    """The reason, in one line, why a measurement failed."""


class Helper:
    """A program that runs beside the sessions and emits the event `listening`. It is ended by its process id."""

    def __init__(self, *command):
        self.log = tempfile.NamedTemporaryFile(prefix="sandwall-latency-")
        self.process = subprocess.Popen([str(word) for word in command], stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                                        stderr=self.log, env=dict(os.environ, **{events.VARIABLE: "1"}), start_new_session=True)
        listening = events.wait_for(self.log.name, "listening", START_SECONDS, lambda: self.process.poll() is None)
        if listening is None:
            said = pathlib.Path(self.log.name).read_text(errors="replace").strip()[-300:]
            self.stop()
            raise Failed(f"{command[0]}: did not start: {said}")
        self.address = listening["address"]

    def stop(self):
        self.process.terminate()
        try:
            self.process.wait(timeout=5)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()
        self.log.close()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.stop()


def circles(seconds):
    """Returns a stroke list that lasts at least `seconds`: rings of all sizes, at 2 cells per step on 512² cells."""
    lines, lasts, ring = ["speed 0.5", "depth 0.5", "stroke", "point 0.6 0"], 0.0, 0
    while lasts < seconds:
        radius = 0.6 - 0.04 * (ring % 13)
        lines.append(f"arc 0 0 {radius:.2f} {radius:.2f} 0 360")
        lasts += 2 * math.pi * radius / 0.5
        ring += 1
    return "\n".join(lines) + "\n"


def smaller(folder, wall, load):
    """Writes the wall file with fewer pixels. Returns the file and (width, height) of its largest tile [pixel]."""
    text = (ROOT / "walls" / "configs" / wall.file).read_text()
    sizes = []

    def divide(match):
        sizes.append((int(match[2]) // load.divisor, int(match[3]) // load.divisor))
        return f"{match[1]}pixels = [{sizes[-1][0]}, {sizes[-1][1]}]"

    file = folder / f"{load.divisor}_{wall.file}"
    file.write_text(re.sub(r"^((?:tile_)?)pixels = \[(\d+), (\d+)\]", divide, text, flags=re.MULTILINE))
    return file, max(sizes)


def die_with_parent():
    """Runs in the launcher before it begins: it ends its ranks in order if this script ends for any reason."""
    PR_SET_PDEATHSIG = 1
    ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGTERM)


def session(folder, wall_file, load, haptic, args, scene=SCENE):
    """Runs a wall for `args.warm_up` + `args.seconds` seconds and returns its summary."""
    log, out = folder / "log.txt", folder / "out"
    command = [ROOT / "scripts" / "sandwall", "run", "--here", "--wall", wall_file, "--scene", scene, "--haptic", haptic, "--out", out,
               "--no-pictures", "--gl", layout.in_memory(), "--refresh", REFRESH, "--frame-timeout", START_SECONDS]
    command += [] if load.stereo else ["--mono"]
    with log.open("w") as said:
        run = subprocess.Popen([str(word) for word in command], stdin=subprocess.PIPE, stdout=said, stderr=subprocess.STDOUT, text=True,
                               env=dict(os.environ, SANDWALL_BIN=str(BIN), **{events.VARIABLE: "1"}), start_new_session=True, preexec_fn=die_with_parent)
    try:
        if events.wait_for(log, "link", START_SECONDS, lambda: run.poll() is None, state="linked") is None:
            raise Failed(f"no hand was linked: {log.read_text(errors='replace').strip()[-300:]}")
        time.sleep(args.warm_up + args.seconds)
        try:
            run.stdin.write("stop\n")
            run.stdin.flush()
        except BrokenPipeError:
            pass  # the session has ended, and its status says why
        if run.wait(timeout=START_SECONDS) != 0:
            raise Failed(f"the session failed: {log.read_text(errors='replace').strip()[-300:]}")
    except subprocess.TimeoutExpired:
        raise Failed("the session did not end") from None
    finally:
        if run.poll() is None:
            run.terminate()  # the launcher ends its ranks in order
            try:
                run.wait(timeout=START_SECONDS)
            except subprocess.TimeoutExpired:
                run.kill()
    return session_results.read_summary(out)


def processor():
    for line in pathlib.Path("/proc/cpuinfo").read_text().splitlines():
        if line.startswith("model name"):
            return line.split(":")[1].strip()
    return "unknown processor"


def stop_on_signals():
    def end(*_):
        raise KeyboardInterrupt
    signal.signal(signal.SIGTERM, end)


def write_csv(file, rows, said, program):
    """Writes rows to a file, or to standard output if `file` is None, as a table whose head has the lines `said` and the command
    of `program`. Returns the exit status."""
    lines = [f"# {line}" for line in [*said, f"command: {program} {' '.join(sys.argv[1:])}", time.strftime("date: %Y-%m-%dT%H:%M:%SZ", time.gmtime())]]
    lines.append(",".join(rows[0]))
    for row in rows:
        lines.append(",".join(f"{value:.6g}" if isinstance(value, float) else str(value) for value in row.values()))
    text = "\n".join(lines) + "\n"
    try:
        file.write_text(text) if file else sys.stdout.write(text)
    except OSError as error:
        print(f"{program}: {file}: cannot be written ({error.strerror})", file=sys.stderr)
        return 1
    return 0


class Parser(command_line.Parser):
    def chosen(self, option, text, known):
        names = text.split(",")
        for name in names:
            if name not in known:
                self.error(f"{option}: '{name}' is unknown; choose from {', '.join(known)}")
        return [value for name, value in known.items() if name in names]
