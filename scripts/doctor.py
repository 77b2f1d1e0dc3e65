# SPDX-License-Identifier: Apache-2.0
"""Looks at every machine of a wall before a show: one line per check, and what to do about the red ones."""

import concurrent.futures
import json
import os
import pathlib
import shlex
import shutil
import socket
import subprocess
import sys
import threading
import time

import rank_hosts
from rank_hosts import HERE, BadInput

ANSWER_SECONDS = 20
PROBE_SECONDS = 60  # shaders of a first driver start take their time
CLOCK_ROUNDS = 5
MOST_CLOCK_SECONDS = 1.0  # sessions measure the rest away; a day wrong makes logs unreadable
RANK_MEGABYTES = 256  # a rank of 512 x 512 cells and 1024 x 768 pixels holds about 140
OUT_MEGABYTES = 256
MOST_HOSTS_AT_ONCE = 32
# What a host says of itself, one answer a line; {node} is the program there.
QUESTIONS = ('echo "build $({node} --version --json 2>&1 | head -n 1)"; '
             'echo "mpi $(mpirun --version 2>&1 | head -n 1)"; '
             'echo "memory $(sed -n "s/^MemAvailable: *//p" /proc/meminfo)"; '
             'echo "client $SSH_CONNECTION"')


def build_of(answer):
    """The build id in what a program prints for --version --json, or None."""
    try:
        return json.loads(answer)["build"]
    except (ValueError, KeyError, TypeError):
        return None


class Ask:
    """How to run a line of shell on a host."""

    def __init__(self, host):
        self.host = host
        agent = rank_hosts.remote_shell()
        if agent[0] == "ssh":
            agent += ["-o", f"ConnectTimeout={ANSWER_SECONDS // 2}"]
        self.words = ["sh", "-c"] if host == HERE else [*agent, host]

    def command(self, line):
        # By sh, whatever shell the user has there.
        return [*self.words, line if self.host == HERE else "sh -c " + shlex.quote(line)]

    def run(self, line, text=None, seconds=ANSWER_SECONDS):
        """(exit status, what it printed, what it complained of); the status is None when there was no answer in time."""
        given = {"stdin": subprocess.DEVNULL} if text is None else {"input": text}
        try:
            ended = subprocess.run(self.command(line), capture_output=True, text=True, errors="replace",
                                   timeout=seconds, check=False, **given)
        except subprocess.TimeoutExpired:
            return None, "", f"no answer within {seconds} s"
        except OSError as error:
            raise BadInput(f"{self.words[0]}: cannot be run; install openssh-client, or name another in "
                           "OMPI_MCA_plm_rsh_agent") from error
        return ended.returncode, ended.stdout, ended.stderr

    def clock(self):
        """(seconds ahead of this machine, uncertainty), from the quickest of a few questions over one connection."""
        command = "while read -r line; do date +%s.%N; done"
        with subprocess.Popen(self.command(command), stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                              stderr=subprocess.DEVNULL, text=True, bufsize=1) as process:
            best = None
            patience = threading.Timer(ANSWER_SECONDS, process.kill)
            patience.start()
            try:
                for _ in range(CLOCK_ROUNDS):
                    asked = time.time()
                    process.stdin.write("now\n")
                    there = float(process.stdout.readline())
                    half = (time.time() - asked) / 2
                    if best is None or half < best[1]:
                        best = (there - asked - half, half)
            except (ValueError, BrokenPipeError):
                return None
            finally:
                patience.cancel()
                process.kill()
        return best


class Host:
    """One machine, its ranks, and what was found: (good, check, words, details for programs)."""

    def __init__(self, name):
        self.name = name
        self.slots = 0  # how many ranks it takes
        self.probes = []  # of the wall, its ranks; of a mere list of hosts, 0
        self.ask = Ask(name)
        self.findings = []

    def add(self, good, check, words, **details):
        self.findings.append((good, check, words, details))
        return good

    def shown_name(self):
        return socket.gethostname() if self.name == HERE else self.name


def last_line(text):
    return (text.strip().split("\n") or [""])[-1]


def probed(said):
    """What a render rank's program prints for --probe --json, or None."""
    try:
        found = json.loads(said)
        return {key: found[key] for key in ("backend", "renderer", "shortcomings")}
    except (ValueError, KeyError, TypeError):
        return None


def spans(ranks):
    """"rank 3", or "ranks 1-4, 7"."""
    pieces = []
    for rank in ranks:
        if pieces and pieces[-1][1] == rank - 1:
            pieces[-1][1] = rank
        else:
            pieces.append([rank, rank])
    words = ", ".join(f"{a}-{b}" if a != b else str(a) for a, b in pieces)
    return f"rank{'s' if len(ranks) > 1 else ''} {words}"


class Doctor:
    """Examines hosts; `node` is the render rank's program, at the same path everywhere."""

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
                self.check_clock(host)
                self.check_way_back(host, answers)
            self.check_gl(host)

    def reach(self, host):
        """What the host answers to all questions, by their first words; None when it does not answer."""
        status, said, complaint = host.ask.run(QUESTIONS.format(node=shlex.quote(self.node)))
        if status != 0:
            host.add(False, "ssh", f"cannot be reached: {last_line(complaint) or f'exit status {status}'}; "
                     f"`ssh -o BatchMode=yes {host.name} true` must end without a word (docs/hosts.md)")
            return None
        if host.name != HERE:
            host.add(True, "ssh", "answers")
        return {first: rest for first, _, rest in (line.partition(" ") for line in said.splitlines())}

    def check_programs(self, host, answers):
        build = build_of(answers.get("build", ""))
        if build is None:
            host.add(False, "build", f"{self.node} does not answer ({answers.get('build', '')}); install the same build at the same path everywhere")
        elif build == self.build:
            host.add(True, "build", build)
        else:
            host.add(False, "build", f"{build}, here it is {self.build}; install the same build at the same path everywhere")
        mpi = answers.get("mpi", "")
        if host.name == HERE:
            self.mpi = mpi
        if "Open MPI" not in mpi:
            host.add(False, "mpi", f"no mpirun on the path of a command ({mpi}); scripts/install_dependencies.sh installs it")
        elif self.mpi and mpi != self.mpi:
            host.add(False, "mpi", f"{mpi}, here it is {self.mpi}; install the same version on every host")
        else:
            host.add(True, "mpi", mpi)

    def check_memory(self, host, answers):
        words = answers.get("memory", "").split()
        free = int(words[0]) // 1024 if words and words[0].isdigit() else 0
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
        """Daemons and ranks connect to this machine on any port: one is opened, and the host asked to come to it."""
        client = answers.get("client", "").split()
        if not client:
            host.add(True, "ports", "not tried: the agent in the place of ssh does not say where this machine is")
            return
        family = socket.AF_INET6 if ":" in client[0] else socket.AF_INET
        with socket.socket(family, socket.SOCK_STREAM) as listener:
            listener.bind(("", 0))
            listener.listen()
            port = listener.getsockname()[1]
            line = f"exec 3<>/dev/tcp/{client[0]}/{port}"
            status, _, _ = host.ask.run(f"timeout 8 bash -c {shlex.quote(line)}")
        if status == 0:
            host.add(True, "ports", f"comes to this machine at {client[0]}, port {port}")
        else:
            host.add(False, "ports", f"does not come to this machine at {client[0]}, port {port}; open the firewalls "
                     "between the hosts for all TCP ports")

    def check_gl(self, host):
        """What every rank would draw with; ranks that answer alike share a line."""
        answers = {}
        for rank in host.probes:
            status, said, complaint = host.ask.run(f"{shlex.quote(self.node)} --probe {rank} --gl {self.gl} --json",
                                                   self.wall_text if rank else "", PROBE_SECONDS)
            answers.setdefault((status, said, last_line(complaint)), []).append(rank)
        for (status, said, complaint), ranks in answers.items():
            who = spans(ranks) + ": " if ranks != [0] else ""
            found = probed(said) if status == 0 else None
            if found is None:
                host.add(False, "gl", f"{who}{complaint or f'exit status {status}'}; docs/backends.md", ranks=ranks)
                continue
            host.add(True, "gl", f"{who}{found['backend']}: {found['renderer']}", ranks=ranks, **found)
            for line in found["shortcomings"]:
                host.add(False, "screen", f"{who}{line}; docs/backends.md", ranks=ranks)


def check_out(host, out):
    """Room for journal and pictures, on this machine alone."""
    place = pathlib.Path(out).absolute()
    while not place.exists():
        place = place.parent
    free = shutil.disk_usage(place).free >> 20
    if not place.is_dir() or not os.access(place, os.W_OK | os.X_OK):
        host.add(False, "disk", f"{place}: cannot be written; choose another --out")
    elif free < OUT_MEGABYTES:
        host.add(False, "disk", f"{free} MiB free in {place}; make room for {OUT_MEGABYTES} MiB")
    else:
        host.add(True, "disk", f"{free} MiB free in {place}")


def check_master(host, master, build):
    """The master's program, on this machine alone."""
    ended = subprocess.run([master, "--version", "--json"], stdin=subprocess.DEVNULL, capture_output=True, text=True,
                           errors="replace", timeout=ANSWER_SECONDS, check=False)
    said = build_of(ended.stdout)
    host.add(said == build, "master", said if said == build else
             f"build {said or last_line(ended.stderr)}, the ranks have {build}; cmake --build build/release")


def machines(hosts, of_wall):
    """A Host per machine, this one first, each with what it has to draw."""
    found = {HERE: Host(HERE)}
    for rank, name in enumerate(hosts, start=1):
        host = found.setdefault(name, Host(name))
        host.slots += 1
        host.probes = [*host.probes, rank] if of_wall else [0]
    return list(found.values())


def report(hosts, colours):
    """Prints all that was found and returns how many were red."""
    red = 0
    width = max(len(host.shown_name()) for host in hosts)
    for host in hosts:
        for good, check, words, _ in host.findings:
            mark = "ok " if good else "RED"
            if colours:
                mark = f"\033[{32 if good else 31}m{mark}\033[0m"
            print(f"{host.shown_name():<{width}}  {mark}  {check:<7} {words}")
            red += 0 if good else 1
    return red


def report_json(hosts):
    """Prints all that was found as one JSON object and returns how many were red."""
    findings = [{"host": host.shown_name(), "check": check, "good": bool(good), "message": words, **details}
                for host in hosts for good, check, words, details in host.findings]
    red = sum(not finding["good"] for finding in findings)
    print(json.dumps({"red": red, "findings": findings}, indent=1))
    return red


def examine(hosts, wall_text, node, master, out, gl, as_json=False):
    """Looks at the host of every rank and at this machine. `wall_text` is None where only hosts are known. Returns the
    exit status: 0 when nothing is red, else 1."""
    said = subprocess.run([node, "--version", "--json"], stdin=subprocess.DEVNULL, capture_output=True, text=True,
                           errors="replace", timeout=ANSWER_SECONDS, check=False).stdout
    here, *others = machines(hosts, wall_text is not None)
    build = build_of(said)
    doctor = Doctor(node, build, wall_text, gl)
    check_master(here, master, build)
    check_out(here, out)
    doctor.examine(here)  # first: the others are compared with it
    with concurrent.futures.ThreadPoolExecutor(MOST_HOSTS_AT_ONCE) as pool:
        list(pool.map(doctor.examine, others))
    if as_json:
        return 1 if report_json([here, *others]) else 0
    red = report([here, *others], sys.stdout.isatty() and "NO_COLOR" not in os.environ)
    print(f"{red} to put right" if red else "nothing to put right")
    return 1 if red else 0
