# SPDX-License-Identifier: Apache-2.0
"""Starts a session of one frame for `sandwall doctor` (docs/doctor.md)."""

import os
import pathlib
import subprocess
import sys
import tempfile

from base import layout, marked_answer
from hosts import reachable
from job.rank_hosts import HERE

START_SECONDS = 60  # for one rank; drivers of OpenGL that start for the first time compile shaders for long
MORE_SECONDS = 2  # for each further rank
# Other hosts may be silent before they answer: first to the question of the launcher, and then to mpirun.
MORE_SECONDS_WITH_HOSTS = 2 * reachable.REACH_SECONDS
# A small tile for each slot of a file of hosts, which names no wall.
TILES = """name = "one tile per slot"
[viewer]
eye = [0.0, 0.0, 1.0]
[stereo]
mode = "mono"
[grid]
rows = 1
columns = {columns}
tile_size = [0.1, 0.1]
tile_pixels = [64, 64]
lower_left = [0.0, 0.0, 0.0]
[stage]
centre = [0.0, 0.0, -0.2]
width = 0.1
tilt_deg = 0
"""


def check(host, wall, backend, ranks=1, options=(), variables=None, more_seconds=0):
    """Adds to `host` whether a session shows a frame on `wall`, and returns that. Only a session shows all that a session needs.

    It draws with `backend`, and has `options` of `sandwall run` beside those of a session that keeps nothing.
    """
    seconds = START_SECONDS + MORE_SECONDS * (ranks - 1) + more_seconds
    with tempfile.TemporaryDirectory(prefix="sandwall-doctor-") as folder:
        command = [sys.executable, str(layout.HERE / "sandwall"), "run", "--wall", wall, "--scene", "sandbox", "--frames", "1",
                   "--gl", backend, "--journal", "off", "--no-pictures", "--restarts", "0", "--out", os.path.join(folder, "out"), *options]
        try:
            ended = subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, text=True, errors="replace",
                                   timeout=seconds, check=False, env=variables)
            complaint = "" if ended.returncode == 0 else marked_answer.own_line(ended.stderr) or f"exit status {ended.returncode}"
        except subprocess.TimeoutExpired:
            complaint = f"a session shows no frame within {seconds} s"
    shown = "a session shows a frame" + (f" on {ranks} ranks" if ranks > 1 else "")
    return host.add(not complaint, "start", complaint.removeprefix("sandwall: ") or shown)


def check_hosts(host, hosts, wall, backend, options):
    """Does so for a wall whose ranks have these hosts. If `wall` is None, the hosts are slots, and each gets a small tile."""
    more_seconds = MORE_SECONDS_WITH_HOSTS if set(hosts) != {HERE} else 0
    if wall is not None:
        return check(host, wall, backend, len(hosts), options, more_seconds=more_seconds)
    with tempfile.TemporaryDirectory(prefix="sandwall-doctor-") as name:
        folder = pathlib.Path(name)
        (folder / "hosts").write_text("".join(f"{slot}\n" for slot in hosts), encoding="utf-8")
        (folder / "wall.toml").write_text(TILES.format(columns=len(hosts)), encoding="utf-8")
        return check(host, str(folder / "wall.toml"), backend, len(hosts), ["--hosts", str(folder / "hosts"), *options],
                     more_seconds=more_seconds)
