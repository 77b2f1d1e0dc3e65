#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Measures how long the frames of a session are with large tools, whose steps are spread over frames.

Runs sessions on a desktop wall with dunes of 512 x 512 cells, in real time, with the recorded hand `gis` and a head that
moves. Prints for each tool the frames, the steps and the samples of the hand that are in no step. With --before ROOT the
sessions of an earlier build run in turns with those of build/release.

usage: scripts/figures/spread.py [--before ROOT] [--seconds S]   (some minutes; the machine should be idle otherwise)
"""

import json
import pathlib
import subprocess
import sys
import tempfile

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "launcher"))
from command_line import Parser, above
from wall_rates import ROOT, swaying_head

RADII = (0.24, 0.6)  # scene units; 61 and 154 cells


def scene(folder, radius):
    usual = (ROOT / "scenes" / "dunes.toml").read_text()
    text = usual.replace("radius = 0.03 ", f"radius = {radius} ")
    if text == usual:
        sys.exit("scenes/dunes.toml: has no tool of radius 0.03; give its radius in scripts/figures/spread.py")
    file = folder / f"dunes_{radius}.toml"
    file.write_text(text)
    return file


def session(folder, root, scene_file, head, seconds):
    """Runs a session of the sources `root`, and returns its summary."""
    out = folder / "out"
    command = [root / "scripts" / "sandwall", "run", "--wall", root / "walls/configs/desktop.toml", "--scene", scene_file,
               "--device", "script:gis", "--track", f"trace:{head}", "--frames", str(int(60 * seconds)), "--no-pictures",
               "--restarts", "0", "--out", out]
    ran = subprocess.run(list(map(str, command)), capture_output=True, text=True)
    if ran.returncode != 0:
        sys.exit(f"{' '.join(map(str, command))}: {ran.stderr.strip() or ran.stdout.strip()}")
    return json.loads((out / "summary.json").read_text())


def row(what, summary):
    frame = summary["frame_ms"]
    dropped = (summary.get("haptic") or {}).get("samples_dropped", 0)
    return (f"{what:28} {frame['count']:6} frames, p50 {frame['p50']:6.0f} ms, p99 {frame['p99']:6.0f} ms, longest {frame['max']:6.0f} ms; "
            f"{summary['steps']:6} steps, {dropped:7.0f} samples left out")


def main():
    parser = Parser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--before", type=pathlib.Path, metavar="ROOT", help="sources of an earlier build, with build/release")
    parser.add_argument("--seconds", type=above(float, 0), default=20, metavar="S", help="of each session, if frames are on time (default: 20)")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        head = swaying_head(folder, 600)
        for radius in RADII:
            for root in (arguments.before, ROOT):
                if root is not None:
                    summary = session(folder, root.resolve(), scene(folder, radius), head, arguments.seconds)
                    when = "before" if root == arguments.before else "now"
                    print(row(f"{radius * 256:.0f} cells, {when}", summary), flush=True)


if __name__ == "__main__":
    main()
