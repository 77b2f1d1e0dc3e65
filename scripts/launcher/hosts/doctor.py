# SPDX-License-Identifier: Apache-2.0
"""Checks every machine of a wall before a show. Prints one line per check; a red line says what to do."""

import concurrent.futures
import errno
import pathlib
import shlex
import shutil
import socket
import subprocess
import tempfile

from base import checked_json, marked_answer, session_folder
from base.bad_input import BadInput
from hosts import first_frame, machine_needs, reachable
from hosts.examined_host import ANSWER_SECONDS, is_red, machines, show
from job import open_mpi
from job.rank_hosts import HERE

PROBE_SECONDS = 60  # a driver that starts for the first time compiles shaders for long
MOST_CLOCK_SECONDS = 1.0  # a session subtracts the difference; a larger one makes logs unreadable
RANK_MEGABYTES = 256  # a rank of 512 x 512 cells and 1024 x 768 pixels holds about 140
OUT_MEGABYTES = 256
MOST_HOSTS_AT_ONCE = 32
# Commands for a host, whose answers begin with a word each. {node} and {check} are the paths of programs there.
QUESTIONS = (marked_answer.SAY + '; echo "reached yes"; {node} --version --json 2>&1 | say build; '
             'mpirun --version 2>&1 | say mpi; '
             '{check} --free-memory 2>&1 | say memory; '
             'df -Pk /dev/shm 2>&1 | say shm; df -Pk "${TMPDIR:-/tmp}" 2>&1 | say tmp; '
             'echo "client $SSH_CONNECTION"')


def build_of(answer):
    """Returns the build id in the output of --version --json, or None if no line of the output has one."""
    for line in answer.splitlines():
        try:
            found = checked_json.parse(line)
        except ValueError:
            continue
        if isinstance(found, dict) and isinstance(found.get("build"), str):
            return found["build"]
    return None


def probed(said):
    """Returns the fields that a render rank's program printed for --probe --json, or None if `said` is not such output."""
    try:
        found = checked_json.parse(said)
    except ValueError:
        return None
    if not isinstance(found, dict) or not all(isinstance(found.get(key), str) for key in ("backend", "renderer")):
        return None
    shortcomings = found.get("shortcomings")
    if not isinstance(shortcomings, list) or not all(isinstance(line, str) for line in shortcomings):
        return None
    return {key: found[key] for key in ("backend", "renderer", "shortcomings")}


def free_mebibytes(host, node, answers):
    """Returns the free memory in a host's answers [MiB], or None after a red finding that they lack it. `node` is the program there."""
    said = reachable.FREE.fullmatch(answers.get("memory", ""))
    if not said:
        host.add(False, "memory", f"{reachable.check_beside(node)} does not answer ({marked_answer.last_line(answers.get('memory', ''))}); "
                 "install the same build at the same path everywhere")
    return int(said[1]) >> 20 if said else None


def unsupported(mpi):
    """Returns why the launcher refuses an mpirun that prints this version, or None."""
    try:
        open_mpi.kind_of(mpi)
    except BadInput as complaint:
        return str(complaint)
    return None


def spans(ranks):
    """Returns `ranks` as text, such as "rank 3" or "ranks 1-4, 7"."""
    pieces = []
    for rank in ranks:
        if pieces and pieces[-1][1] == rank - 1:
            pieces[-1][1] = rank
        else:
            pieces.append([rank, rank])
    words = ", ".join(f"{a}-{b}" if a != b else str(a) for a, b in pieces)
    return f"rank{'s' if len(ranks) > 1 else ''} {words}"


class Doctor:
    """Examines hosts. `node` is the path of the render rank's program, which is the same on every host."""

    def __init__(self, node, build, wall_text, gl):
        self.node = node
        self.build = build
        self.mpi = ""
        self.wall_text = wall_text
        self.gl = gl

    def examine(self, host):
        answers = self.reach(host)
        if answers is not None:
            self.check_programs(host, answers)
            self.check_memory(host, answers)
            if host.name != HERE:
                check_needs(host, machine_needs.of_answers(answers, max(1, host.slots)))
                self.check_clock(host)
                self.check_way_back(host, answers)
            self.check_gl(host)

    def reach(self, host):
        """Returns the host's answers by their first words, or None if the host cannot be reached."""
        check = reachable.check_beside(self.node)
        status, said, complaint = host.ask.run(QUESTIONS.replace("{node}", shlex.quote(self.node)).replace("{check}", shlex.quote(check)))
        answers = marked_answer.named_lines(said)
        if "reached" not in answers:
            host.add(False, "ssh", f"cannot be reached: {marked_answer.last_line(complaint) or f'exit status {status}'}; "
                     f"`ssh -o BatchMode=yes {host.name} true` must end with status 0 (docs/hosts.md)")
            return None
        if host.name != HERE:
            host.add(True, "ssh", "answers")
        return answers

    def check_programs(self, host, answers):
        build = build_of(answers.get("build", ""))
        if build is None:
            host.add(False, "build", f"{self.node} does not answer ({marked_answer.last_line(answers.get('build', ''))}); install the same build at the same path everywhere")
        elif build == self.build:
            host.add(True, "build", build)
        else:
            host.add(False, "build", f"{build}, here it is {self.build}; install the same build at the same path everywhere")
        said = answers.get("mpi", "")
        found = open_mpi.VERSION.search(said)
        mpi = found[0] if found else said
        if host.name == HERE:
            self.mpi = mpi
        if "Open MPI" not in mpi:
            host.add(False, "mpi", f"no mpirun on the path of a command ({marked_answer.last_line(mpi)}); apt-get install openmpi-bin")
        elif complaint := unsupported(mpi):
            host.add(False, "mpi", complaint)
        elif self.mpi and mpi != self.mpi:
            host.add(False, "mpi", f"{mpi}, here it is {self.mpi}; install the same version on every host")
        else:
            host.add(True, "mpi", mpi)

    def check_memory(self, host, answers):
        free = free_mebibytes(host, self.node, answers)
        if free is None:
            return
        slots = max(1, host.slots)
        needed = RANK_MEGABYTES * slots
        line = f"{free} MiB free, {slots} rank{'s' if slots > 1 else ''} may take {needed}"
        host.add(free >= needed, "memory", line if free >= needed else line + "; end other programs or spread the ranks")

    def check_clock(self, host):
        found = host.ask.clock()
        if found is None:
            host.add(False, "clock", "`date +%s.%N` gives no time; install coreutils")
            return
        ahead, give = found
        line = f"{abs(ahead) * 1e3:.1f} ms {'ahead of' if ahead >= 0 else 'behind'} this machine's, give or take {give * 1e3:.1f} ms"
        good = abs(ahead) - give <= MOST_CLOCK_SECONDS
        host.add(good, "clock", line if good else line + "; set it, with chrony or systemd-timesyncd")

    def check_way_back(self, host, answers):
        """Opens a port on this machine and has the host connect to it, as daemons and ranks do on any port."""
        client = answers.get("client", "").split()
        if not client:
            host.add(True, "ports", "not tried: the program that replaces ssh does not set SSH_CONNECTION")
            return
        family = socket.AF_INET6 if ":" in client[0] else socket.AF_INET
        with socket.socket(family, socket.SOCK_STREAM) as listener:
            listener.bind(("", 0))
            listener.listen()
            port = listener.getsockname()[1]
            line = f"exec 3<>/dev/tcp/{client[0]}/{port}"
            status, _, _ = host.ask.run(f"timeout 8 bash -c {shlex.quote(line)}")
        if status == 0:
            host.add(True, "ports", f"connects to this machine at {client[0]}, port {port}")
        else:
            host.add(False, "ports", f"cannot connect to this machine at {client[0]}, port {port}; open the firewalls "
                     "between the hosts for all TCP ports")

    def check_gl(self, host):
        """Adds the OpenGL renderer of every rank. Ranks with the same answer share a line."""
        answers = {}
        for rank in host.probes:
            status, said, complaint = host.ask.run(f"{shlex.quote(self.node)} --probe {rank} --gl {self.gl} --json",
                                                   self.wall_text if rank else "", PROBE_SECONDS)
            answers.setdefault((status, said, marked_answer.own_line(complaint)), []).append(rank)
        for (status, said, complaint), ranks in answers.items():
            who = spans(ranks) + ": " if ranks != [0] else ""
            found = probed(said) if status == 0 else None
            if found is None:
                host.add(False, "gl", f"{who}{complaint or f'exit status {status}'}; docs/backends.md", ranks=ranks)
                continue
            host.add(True, "gl", f"{who}{found['backend']}: {found['renderer']}", ranks=ranks, **found)
            for line in found["shortcomings"]:
                host.add(False, "screen", f"{who}{line}; docs/backends.md", ranks=ranks)


def check_needs(host, needs):
    """Adds what mpirun needs of the host. `needs` are those of machine_needs. Returns whether all are met."""
    return all([host.add(need.good(), need.name, need.why or need.words) for need in needs])


def check_out(host, out):
    """Adds whether `out` on this machine can be written and has room for journal and pictures."""
    place = pathlib.Path(out).absolute()
    try:
        while not place.exists():
            place = place.parent
        session_folder.require_folder(place, place)
        if place == pathlib.Path(out).absolute():
            session_folder.require_safe(place)
        free = shutil.disk_usage(place).free >> 20
        # os.access is not enough: it allows root everything, also in folders of the kernel.
        with tempfile.TemporaryFile(dir=place):
            pass
    except BadInput as complaint:
        host.add(False, "disk", str(complaint))
        return
    except OSError as error:
        if error.errno not in (errno.ENOSPC, errno.EDQUOT):
            host.add(False, "disk", f"{place}: cannot be written ({error.strerror}); choose another --out")
            return
    if free < OUT_MEGABYTES:
        host.add(False, "disk", f"{free} MiB free in {place}; make room for {OUT_MEGABYTES} MiB")
    else:
        host.add(True, "disk", f"{free} MiB free in {place}")


def version_of(program):
    """Returns (build id, complaint) of a program on this machine. The build id is None if the program prints none."""
    try:
        ended = subprocess.run([program, "--version", "--json"], stdin=subprocess.DEVNULL, capture_output=True, text=True,
                               errors="replace", timeout=ANSWER_SECONDS, check=False)
    except subprocess.TimeoutExpired:
        return None, f"no answer within {ANSWER_SECONDS} s"
    except OSError as error:
        return None, f"{program}: cannot be run ({error.strerror})"
    return build_of(ended.stdout), marked_answer.own_line(ended.stderr)


def check_master(host, master, build):
    """Adds whether the master's program on this machine is of the build `build`."""
    said, complaint = version_of(master)
    host.add(said is not None and said == build, "master", said if said and said == build else
             f"build {said or complaint}, the ranks have {build}; cmake --build build/release")


def examine(hosts, wall, node, master, out, gl, as_json=False, options=()):
    """Checks this machine and the host of every rank. `wall` is the path of the wall file, or None if `hosts` are the slots of a file of hosts.

    `options` are those of the coming session for all its hosts, such as --network. Returns the exit status of show().
    """
    text = None if wall is None else pathlib.Path(wall).read_text(encoding="utf-8")
    here, *others = machines(hosts, wall is not None)
    build, _ = version_of(node)
    doctor = Doctor(node, build, text, gl)
    check_master(here, master, build)
    check_out(here, out)
    check_needs(here, machine_needs.here(1 + here.slots))
    doctor.examine(here)  # first, because the other hosts are compared with this machine
    with concurrent.futures.ThreadPoolExecutor(MOST_HOSTS_AT_ONCE) as pool:
        list(pool.map(doctor.examine, others))
    if not any(is_red(good, details) for host in (here, *others) for good, _, _, details in host.findings):
        first_frame.check_hosts(here, hosts, wall, gl, options)
    return show([here, *others], as_json)
