# SPDX-License-Identifier: Apache-2.0
"""`sandwall doctor` without a wall: what works on this machine, and what to install for the rest (docs/doctor.md)."""

import math
import os
import subprocess

from base import layout, marked_answer
from base.bad_input import BadInput
from hosts import doctor, examined_host, first_frame, machine_needs
from job import screens
from job.rank_hosts import HERE

# Memory of a session on the desktop wall: three processes, and what each cell of the field adds to all of them. The scene
# sandbox took 93 MiB, and 82 bytes per cell up to 2048 x 2048 cells. Sand that was dug is drawn in more detail, so there is
# room for twice as much.
FIXED_MEGABYTES = 256
BYTES_PER_CELL = 200
FIELD_SIDES = (512, 1024, 2048, 4096)


def check_start(host, chosen):
    """Adds whether a session shows a frame on the desktop wall. It draws in memory unless a backend was chosen."""
    variables = {name: value for name, value in os.environ.items()
                 if name not in ("DISPLAY", "WAYLAND_DISPLAY") or chosen == "glfw"}
    first_frame.check(host, "desktop", chosen, options=["--here"], variables=variables)


def check_launcher(host):
    """Adds a finding if the programs are of another build than the installed launcher. A session would refuse them."""
    try:
        layout.require_one_build(["sandwall-master", "sandwall-render-node", "sandwall-haptic-server"])
    except BadInput as complaint:
        host.add(False, "launcher", str(complaint))


def check_cores(host):
    cores = len(os.sched_getaffinity(0))
    host.add(cores >= 2, "cores", f"{cores} for this process" + ("" if cores >= 2 else "; a hand and a picture need two: the wall "
             "will be slow"), needed=False, cores=cores)


def largest_side(megabytes):
    """Returns the side of the largest square field for which this memory is enough [cells], or 0."""
    cells = max(0, megabytes - FIXED_MEGABYTES) * (1 << 20) // BYTES_PER_CELL
    return math.isqrt(cells)


def check_memory(host, node, answers):
    free = doctor.free_mebibytes(host, node, answers)
    if free is None:
        return
    fitting = [side for side in FIELD_SIDES if side <= largest_side(free)]
    words = f"{free} MiB free: " + (f"fields of up to {fitting[-1]} x {fitting[-1]} cells on the desktop wall" if fitting else
                                    f"{FIELD_SIDES[0]} x {FIELD_SIDES[0]} cells on the desktop wall need more; end other programs")
    host.add(bool(fitting), "memory", words, free_mebibytes=free, largest_side=fitting[-1] if fitting else 0)


def check_display(host, chosen):
    """Adds whether windows can open. A display that is named and does not answer is needed: a session would be refused."""
    name = os.environ.get("DISPLAY", "")
    if missing := screens.missing():
        host.add(False, "display", f"{missing}; --gl {layout.in_memory()} draws in memory", needed=chosen in ("auto", "glfw"), display=name or None)
    elif name:
        host.add(True, "display", f"{name} accepts connections", display=name)
    else:
        host.add(False, "display", "DISPLAY is not set: sessions draw in memory; start them in a desktop session to see windows", needed=False,
                 display=None)


def check_gl(host, node, chosen):
    """Adds a finding for the chosen backend. "auto" means all: a wall needs one, and osmesa needs no card and no display.

    A build without OSMesa draws in memory with egl.
    """
    in_memory = layout.in_memory()
    for backend in dict.fromkeys((in_memory, "egl", "glfw")) if chosen == "auto" else (chosen,):
        try:
            ended = subprocess.run([node, "--probe", "0", "--gl", backend, "--json"], stdin=subprocess.DEVNULL, capture_output=True,
                                   text=True, errors="replace", timeout=doctor.PROBE_SECONDS, check=False)
            found, complaint = doctor.probed(ended.stdout) if ended.returncode == 0 else None, marked_answer.own_line(ended.stderr)
        except subprocess.TimeoutExpired:
            found, complaint = None, f"no answer within {doctor.PROBE_SECONDS} s"
        if found:
            host.add(True, "gl", f"--gl {backend}: {found['renderer']}", backend=backend, renderer=found["renderer"])
        else:
            words = complaint.removeprefix("sandwall-render-node: ") or "does not answer"
            host.add(False, "gl", f"{'' if words.startswith('--gl') else f'--gl {backend}: '}{words}; docs/backends.md",
                     needed=backend in (in_memory, chosen), backend=backend)


def examine(node, master, out, backend, as_json):
    """Checks this machine for sessions that draw with `backend` ("auto": any). Returns the exit status: 0 if a session can run here, else 1."""
    host = examined_host.Host(HERE)
    host.slots = 1
    build = layout.build_of(node)
    doctor.check_master(host, master, build)
    check_launcher(host)
    doctor.check_out(host, out)
    can_start = doctor.check_needs(host, machine_needs.here(2))
    examiner = doctor.Doctor(node, build, None, backend)
    answers = examiner.reach(host)
    if answers is not None:
        examiner.check_programs(host, answers)
        if can_start:
            check_start(host, backend)
        check_cores(host)
        check_memory(host, node, answers)
        check_display(host, backend)
        check_gl(host, node, backend)
    return examined_host.show([host], as_json)
