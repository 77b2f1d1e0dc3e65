# SPDX-License-Identifier: Apache-2.0
"""Asks the hosts of a session, before it starts, whether they can run ranks, and for the identity of each machine."""

import shlex
import socket
import subprocess
import time

import open_mpi
from rank_hosts import HERE, BadInput

REACH_SECONDS = 20
# Machines may have the same name. Each start of a machine has another boot id.
IDENTITY = "echo \"$(uname -n) $(cat /proc/sys/kernel/random/boot_id)\""
VERSION = "mpirun --version 2>/dev/null | head -n 1"


def identity_here():
    """Returns the identity of this machine, as a rank prints it (lockstep::machineId)."""
    try:
        with open("/proc/sys/kernel/random/boot_id", encoding="ascii") as file:
            boot = file.read().strip()
    except OSError:
        boot = ""
    return f"{socket.gethostname()}/{boot}"


def identity_of(line):
    """Returns the identity in a host's answer to IDENTITY, or "" if the line is something else."""
    words = line.split()
    return "/".join(words) if len(words) == 2 and len(line) < 400 else ""


class Answers:
    """The answers of hosts. `complaints` has the reason of each host that cannot run a rank, and `identities` the identity of each."""

    def __init__(self):
        self.complaints, self.identities = {}, {HERE: identity_here()}


def ask(hosts, node, version=None):
    """Asks all other hosts at once whether they have the program `node`, and an mpirun of the same `version`, if that is given."""
    agent = open_mpi.remote_shell()
    others = sorted(set(hosts) - {HERE}, key=hosts.index)
    asked = []
    found = Answers()
    deadline = time.monotonic() + REACH_SECONDS
    # sh runs it, because the user's own shell on the host may be another one.
    command = "sh -c " + shlex.quote(f"test -x {shlex.quote(node)} && {IDENTITY} && {VERSION}")
    try:
        for host in others:
            asked.append(subprocess.Popen([*agent, host, command], stdin=subprocess.DEVNULL,
                                          stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, errors="replace"))
        for host, process in zip(others, asked):
            complaint, said = complaint_of(process, node, deadline, agent)
            lines = [*said.split("\n"), "", ""]
            found.identities[host] = identity_of(lines[0])
            other = open_mpi.VERSION.search(lines[1])
            if not complaint and version and other and other[1] != version:
                complaint = f"has mpirun (Open MPI) {other[1]}, and this machine {version}; install the same version on every host"
            if complaint:
                found.complaints[host] = f"{host} (rank {hosts.index(host) + 1}): {complaint}"
    except OSError as error:
        raise BadInput(f"{agent[0]}: cannot be run; install openssh-client, or name another program in OMPI_MCA_plm_rsh_agent") from error
    finally:
        for process in asked:
            if process.poll() is None:
                process.kill()
                process.wait()
            process.stdout.close()
            process.stderr.close()
    return found


def complaint_of(process, node, deadline, agent):
    """Returns (why the host that `process` asks cannot run a rank, or None if it can; what it has printed)."""
    try:
        said, complained = process.communicate(timeout=max(0, deadline - time.monotonic()))
    except subprocess.TimeoutExpired:
        return f"no answer within {REACH_SECONDS} s; docs/hosts.md", ""
    complained = complained.strip().split("\n")[-1]
    if process.returncode == 1 and not complained:
        return f"has no {node}; install the same build at the same path on every host", ""
    if process.returncode != 0:
        return f"cannot be reached: {complained or f'{agent[0]} failed'}; docs/hosts.md", ""
    return None, said
