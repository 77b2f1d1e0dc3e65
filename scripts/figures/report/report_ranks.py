#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs whole sessions of 60 steps over several render ranks, and replays their journals. Writes both hashes as CSV.

usage: scripts/figures/report/report_ranks.py [--walls 1x1,2x2,3x4] [--out FILE.csv]
"""

import pathlib
import re
import subprocess
import sys
import tempfile

sys.dont_write_bytecode = True
sys.path[:0] = [str(pathlib.Path(__file__).resolve().parents[2] / room) for room in ("figures", "launcher")]
from ask import session_results
from base import layout
from base.command_line import Parser
from sessions.measured_session import processor, write_csv

ROOT = pathlib.Path(__file__).resolve().parents[3]


def wall(text):
    match = re.fullmatch(r"([1-9])x([1-9])", text)
    if not match:
        raise ValueError
    return int(match[1]), int(match[2])


def walls(text):
    return [wall(word) for word in text.split(",")]


def run(*command):
    ran = subprocess.run([str(word) for word in command], capture_output=True, text=True)
    if ran.returncode != 0:
        sys.exit(f"report_ranks.py: {' '.join(map(str, command))}: {(ran.stderr.strip() or ran.stdout.strip())[-300:]}")
    return ran.stdout


def measure(rows, columns, folder):
    """Returns one row of the table: a session and the replay of its journal."""
    text = (ROOT / "walls" / "configs" / "tiled_3x4.toml").read_text()
    for name, value in (("rows", rows), ("columns", columns)):
        text = re.sub(rf"^{name} = .*", f"{name} = {value}", text, flags=re.MULTILINE)
    file, out = folder / "wall.toml", folder / f"{rows}x{columns}"
    file.write_text(text)
    run(ROOT / "scripts" / "sandwall", "run", "--wall", file, "--scene", ROOT / "scenes" / "writing.toml", "--device", "script:gis",
        "--gl", layout.in_memory(), "--pace", "fast", "--steps", 60, "--out", out)
    summary = session_results.read_summary(out)
    replayed = re.findall(r"\b[0-9a-f]{16}\b", run(layout.bin_folder() / "sandwall-replay", out / "session.journal", "--hash"))
    return {"ranks": rows * columns, "session_hash": summary["state_hash"], "replay_hash": replayed[-1], "divergences": summary["divergences"]}


def main():
    parser = Parser(prog="report_ranks.py", description=__doc__.splitlines()[0])
    parser.add_argument("--walls", type=walls, default="1x1,2x2,3x4", help="rows and columns of tiles, one render rank each (default: 1x1,2x2,3x4)")
    parser.add_argument("--out", type=pathlib.Path, help="CSV file to write (default: standard output)")
    args = parser.parse_args()
    results = []
    with tempfile.TemporaryDirectory(prefix="sandwall-ranks-") as folder:
        for rows, columns in args.walls:
            print(f"a session on {rows} x {columns} tiles", file=sys.stderr)
            results.append(measure(rows, columns, pathlib.Path(folder)))
    return write_csv(args.out, results, [f"machine: {processor()}"], "report_ranks.py")


if __name__ == "__main__":
    sys.exit(main())
