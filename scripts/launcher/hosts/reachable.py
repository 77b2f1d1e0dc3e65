# SPDX-License-Identifier: Apache-2.0
"""Asks the hosts of a session, before it starts, whether they can run ranks, and for the identity of each machine."""

import math
import os
import pathlib
import re
import shlex
import socket
import subprocess
import time

from base import marked_answer
from base.bad_input import BadInput
from job import open_mpi
from job.processes import die_with, kill_group
from job.rank_hosts import HERE

LOOK_SECONDS = 0.1
REACH_SECONDS = 45  # a login may wait 30 s for a name or a folder
SILENT_SECONDS = 10  # after which the hosts that have not answered are named
FREE = re.compile(r"free (\d{1,18})")  # answer of `sandwall-check --free-memory` [byte]
# Machines may have the same name. Each start of a machine has another boot id.
QUESTIONS = (marked_answer.SAY + '; test -x {node} && echo "program yes"; '
             'echo "machine $(uname -n) $(cat /proc/sys/kernel/random/boot_id)"; '
             'echo "memory $({check} --free-memory 2>/dev/null)"; mpirun --version 2>/dev/null | say mpi')


def identity_here():
    """Returns the identity of this machine, as a rank prints it (lockstep::machineId)."""
    try:
        with open("/proc/sys/kernel/random/boot_id", encoding="ascii") as file:
            boot = file.read().strip()
    except OSError:
        boot = ""
    return f"{socket.gethostname()}/{boot}"


def identity_of(words):
    """Returns the identity in a host's answer, or "" if it is something else than a name and a boot id."""
    found = words.split()
    return "/".join(found) if len(found) == 2 and len(words) < 400 else ""


def check_beside(node):
    """Returns the path of the program sandwall-check that was installed with the program `node`."""
    return str(pathlib.Path(node).with_name("sandwall-check"))


def free_here(check):
    """Returns the memory that is free on this machine [byte], or None if the program `check` does not tell it."""
    try:
        found = FREE.fullmatch(subprocess.run([check, "--free-memory"], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                              stderr=subprocess.DEVNULL, text=True, errors="replace").stdout.strip())
    except OSError:
        return None
    return int(found[1]) if found else None


class Answers:
    """The answers of hosts. `complaints` has the reason of each host that cannot run a rank, and `identities` the identity of each.

    `absent` are the hosts among `complaints` that may still come: they do not answer, or their programs are on a file system
    that is not mounted yet. `free` is the memory that is free on each host [byte], as far as they have answered.
    """

    def __init__(self):
        self.complaints, self.identities, self.absent, self.free = {}, {HERE: identity_here()}, set(), {}


def ask(hosts, node, version=None, stopped=lambda: False, say_silent=lambda hosts: None):
    """Asks all other hosts at once whether they have the program `node`, and an mpirun of the same `version`, if that is given.

    Gives up the hosts that have not answered as soon as stopped() is true. Calls say_silent() once, with the hosts that have
    not answered after SILENT_SECONDS.
    """
    agent = open_mpi.remote_shell()
    others = sorted(set(hosts) - {HERE}, key=hosts.index)
    asked = []
    found = Answers()
    began = time.monotonic()
    say_at = began + SILENT_SECONDS

    def goes_on():
        nonlocal say_at
        if time.monotonic() > say_at:
            say_at = math.inf
            say_silent([host for host, process in zip(others, asked) if process.poll() is None])
        return not stopped() and time.monotonic() <= began + REACH_SECONDS

    command = marked_answer.marked(QUESTIONS.replace("{node}", shlex.quote(node)).replace("{check}", shlex.quote(check_beside(node))))
    try:
        for host in others:
            asked.append(subprocess.Popen([*agent, host, command], stdin=subprocess.DEVNULL,
                                          stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, errors="replace",
                                          start_new_session=True, preexec_fn=die_with(os.getpid())))
        for host, process in zip(others, asked):
            complaint, answers = complaint_of(process, node, agent, goes_on)
            if complaint:
                found.absent.add(host)
            found.identities[host] = identity_of(answers.get("machine", ""))
            if memory := FREE.fullmatch(answers.get("memory", "")):
                found.free[host] = int(memory[1])
            other = open_mpi.VERSION.search(answers.get("mpi", ""))
            if not complaint and version and other and other[1] != version:
                complaint = f"has mpirun (Open MPI) {other[1]}, and this machine {version}; install the same version on every host"
            if complaint:
                found.complaints[host] = f"{host} (rank {hosts.index(host) + 1}): {complaint}"
    except OSError as error:
        raise BadInput(f"{agent[0]}: cannot be run; install openssh-client, or name another program in OMPI_MCA_plm_rsh_agent") from error
    finally:
        for process in asked:
            if process.poll() is None:
                kill_group(process)
                process.wait()
            process.stdout.close()
            process.stderr.close()
    return found


def outputs_of(process, goes_on):
    """Returns (standard output, standard error) of a process that ends. Throws TimeoutExpired as soon as goes_on() is false."""
    while True:
        try:
            return process.communicate(timeout=LOOK_SECONDS)
        except subprocess.TimeoutExpired:
            if not goes_on():
                raise


def complaint_of(process, node, agent, goes_on):
    """Returns (why the host that `process` asks cannot run a rank, or None if it can; its answers by their first words)."""
    try:
        said, complained = outputs_of(process, goes_on)
    except subprocess.TimeoutExpired:
        return f"no answer within {REACH_SECONDS} s; docs/hosts.md", {}
    status, said, complained = marked_answer.of_both(process.returncode, said, complained)
    answers = marked_answer.named_lines(said)
    if "machine" not in answers:
        why = marked_answer.last_line(complained) or (f"{agent[0]} failed" if status else "it runs no command")
        return f"cannot be reached: {why}; docs/hosts.md", {}
    if "program" not in answers:
        return f"has no {node}; install the same build at the same path on every host", {}
    return None, answers
