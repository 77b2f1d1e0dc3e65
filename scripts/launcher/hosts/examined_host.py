# SPDX-License-Identifier: Apache-2.0
"""A machine that `sandwall doctor` checks: its answers to commands, and the findings about it."""

import json
import os
import socket
import subprocess
import sys
import threading
import time

from base import checked_json, marked_answer
from base.bad_input import BadInput
from job import open_mpi
from job.processes import kill_group
from job.rank_hosts import HERE

ANSWER_SECONDS = 45  # a login may wait 30 s for a name or a folder
CLOCK_ROUNDS = 5
TIME = "@time "  # begins a line with the time of a host
COLOURS = {"ok ": 32, "RED": 31, "no ": 33}


def ended_in(seconds, command, text):
    """Runs a command with this input, or without any. Returns (exit status, standard output, standard error).

    Throws subprocess.TimeoutExpired after `seconds`.
    """
    with subprocess.Popen(command, stdin=subprocess.DEVNULL if text is None else subprocess.PIPE, stdout=subprocess.PIPE,
                          stderr=subprocess.PIPE, text=True, errors="replace", start_new_session=True) as process:
        try:
            said, complained = process.communicate(text, timeout=seconds)
        except BaseException:
            kill_group(process)
            raise
        return process.returncode, said, complained


def time_in(stream):
    """Reads lines until one has a time, and returns the time [s]. Throws ValueError if none has."""
    for line in stream:
        if line.startswith(TIME):
            return float(line[len(TIME):])
    raise ValueError("the host has ended the connection")


class Ask:
    """Runs lines of shell on one host."""

    def __init__(self, host):
        self.host = host
        self.words = ["sh", "-c"] if host == HERE else [*open_mpi.remote_shell(), host]

    def command(self, line):
        return [*self.words, marked_answer.marked(line)]

    def run(self, line, text=None, seconds=ANSWER_SECONDS):
        """Returns (exit status, standard output, standard error) of the line itself, without what a login prints.

        The status is None if the line has not run to its end, also after `seconds` without an answer.
        """
        try:
            ended = ended_in(seconds, self.command(line), text)
        except subprocess.TimeoutExpired:
            return None, "", f"no answer within {seconds} s"
        except OSError as error:
            raise BadInput(f"{self.words[0]}: cannot be run; install openssh-client, or name another program in "
                           "OMPI_MCA_plm_rsh_agent") from error
        return marked_answer.of_both(*ended)

    def clock(self):
        """Returns (clock of the host minus clock of this machine, uncertainty) [s], or None if the host prints no time.

        Asks several times over one connection and takes the quickest answer.
        """
        command = f"while read -r line; do printf '\\n{TIME}%s\\n' \"$(date +%s.%N)\"; done"
        with subprocess.Popen(self.command(command), stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                              stderr=subprocess.DEVNULL, text=True, errors="replace", bufsize=1, start_new_session=True) as process:
            best = None
            patience = threading.Timer(ANSWER_SECONDS, kill_group, [process])
            patience.start()
            try:
                for _ in range(CLOCK_ROUNDS):
                    asked, began = time.time(), time.monotonic()
                    process.stdin.write("now\n")
                    there = time_in(process.stdout)
                    half = (time.monotonic() - began) / 2
                    if best is None or half < best[1]:
                        best = (there - asked - half, half)
            except (ValueError, BrokenPipeError):
                return None
            finally:
                patience.cancel()
                kill_group(process)
        return best


class Host:
    """One machine with its ranks and findings: (good, check, words, details for programs)."""

    def __init__(self, name):
        self.name = name
        self.slots = 0  # number of its ranks
        self.probes = []  # ranks to probe for OpenGL: those of a wall file; [0] for a file of hosts
        self.ask = Ask(name)
        self.findings = []

    def add(self, good, check, words, **details):
        self.findings.append((good, check, checked_json.one_line(words), details))
        return good

    def shown_name(self):
        return socket.gethostname() if self.name == HERE else self.name


def machines(hosts, of_wall):
    """Returns one Host per machine, this machine first. `of_wall`: `hosts` are the hosts of the ranks of a wall file."""
    found = {HERE: Host(HERE)}
    for rank, name in enumerate(hosts, start=1):
        host = found.setdefault(name, Host(name))
        host.slots += 1
        host.probes = [*host.probes, rank] if of_wall else [0]
    return list(found.values())


def is_red(good, details):
    """Returns whether a finding is red. A part that no session needs is never red."""
    return not good and details.get("needed", True)


def report(hosts, colours):
    """Prints all findings and returns the number of red ones."""
    red = 0
    width = max(len(host.shown_name()) for host in hosts)
    for host in hosts:
        for good, check, words, details in host.findings:
            mark = "ok " if good else "RED" if is_red(good, details) else "no "
            if colours:
                mark = f"\033[{COLOURS[mark]}m{mark}\033[0m"
            print(f"{host.shown_name():<{width}}  {mark}  {check:<7} {words}")
            red += is_red(good, details)
    return red


def report_json(hosts):
    """Prints all findings as one JSON object and returns the number of red ones."""
    findings = [{"host": host.shown_name(), "check": check, "good": bool(good), "message": words, **details}
                for host in hosts for good, check, words, details in host.findings]
    red = sum(is_red(finding["good"], finding) for finding in findings)
    print(json.dumps({"red": red, "findings": findings}, indent=1))
    return red


def show(hosts, as_json):
    """Prints all findings. Returns the exit status: 0 if no check is red, else 1."""
    if as_json:
        return 1 if report_json(hosts) else 0
    red = report(hosts, sys.stdout.isatty() and "NO_COLOR" not in os.environ)
    print(f"{red} red" if red else "all green")
    return 1 if red else 0
