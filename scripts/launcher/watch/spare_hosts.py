# SPDX-License-Identifier: Apache-2.0
"""The hosts of a session's ranks while it runs, and the spares that take the place of lost ones."""

import collections
import socket

from base import events
from base.bad_input import BadInput, NotYet
from hosts import reachable, session_memory
from job import rank_hosts
from watch.patience import Stopped

STRIKES = 2  # number of failures of a host's ranks after which a spare takes its place


class SessionHosts:
    """The hosts of all render ranks, and the spares.

    `names` has the host of every render rank in their order. `spares` has (host, slots) in the order of use. `version` is that
    of this machine's mpirun, which every host must have. stopped() ends the wait for answers.
    `needs` has the memory of each process, as session_memory.needs_of() returns it.
    """

    def __init__(self, names, spares, node, version, stopped=lambda: False, needs=None):
        self.stopped, self.needs = stopped, needs or {}
        self.names, self.spares, self.node, self.version = list(names), list(spares), node, version
        self.identities = {}  # of every host that has answered, as reachable.py reads them
        self.free = {}  # free memory of every other host that has answered, then [byte]
        self.strikes = collections.Counter()
        self.silent = set()  # hosts that a line has named because they did not answer for a while

    def host_of(self, rank):
        """Returns the name of a render rank's host for messages."""
        host = self.names[rank - 1] if 1 <= rank <= len(self.names) else "an unknown host"
        return socket.gethostname() if host == rank_hosts.HERE else host

    def struck(self, failure):
        """Counts a failure for the host on which it happened."""
        if failure.rank and failure.rank <= len(self.names):
            host = self.names[failure.rank - 1]
            self.strikes[host] += STRIKES if failure.host_is_lost else 1

    def require_reachable(self, print_line):
        """Replaces hosts that cannot be reached or have failed too often by spares, and prints each replacement.

        Throws BadInput if a host cannot run a rank and no spare can replace it: NotYet if the host may still come. Throws
        Stopped if stopped() has ended the wait for answers.
        """
        answers = self.ask(self.names, print_line)
        complaints = answers.complaints
        for host in [host for host, strikes in self.strikes.items() if strikes >= STRIKES and host in self.names]:
            if not self.replace(host, complaints.pop(host, f"{host}: its ranks have failed too often"), print_line):
                self.strikes[host] = 0  # no spare can replace the host, so its count begins again
        for host, complaint in complaints.items():
            if host in self.names and not self.replace(host, complaint, print_line):
                raise NotYet(complaint) if host in answers.absent else BadInput(complaint)

    def require_memory(self, scene):
        """Throws BadInput if a machine lacks the memory for its processes. `scene` names what needs it."""
        session_memory.require(scene, self.needs, self.names, self.free_memory(), self.identities)

    def free_memory(self):
        """Returns the memory that is free on this machine now, and was free on every other host when it answered [byte]."""
        return {**self.free, rank_hosts.HERE: reachable.free_here(reachable.check_beside(self.node))}

    def ask(self, hosts, print_line):
        """Returns the reachable.Answers of the hosts. Notes which machines they are. Names each host that is silent, once."""
        def say_silent(silent):
            if names := [host for host in silent if host not in self.silent]:
                print_line(f"waits up to {reachable.REACH_SECONDS} s for the answer of {', '.join(names)}; docs/hosts.md")
                self.silent.update(names)

        answers = reachable.ask(hosts, self.node, self.version, self.stopped, say_silent)
        if answers.complaints and self.stopped():
            raise Stopped
        self.identities.update(answers.identities)
        self.free.update(answers.free)
        return answers

    def places(self):
        """Returns the options that tell the master on which machine each rank must run."""
        words = []
        for host in dict.fromkeys(self.names):
            if self.identities.get(host):
                ranks = ",".join(str(rank) for rank, name in enumerate(self.names, start=1) if name == host)
                words += ["--place", f"{ranks}={host}={self.identities[host]}"]
        return words

    def ranks_here(self):
        """Returns the ranks on this machine, with the master."""
        return [0, *(rank for rank, host in enumerate(self.names, start=1) if host == rank_hosts.HERE)]

    def replace(self, host, why, print_line):
        """Replaces a host by the first spare that can be reached and has slots for all ranks of the host.

        Returns whether there was such a spare. A spare that lacks memory now stays a spare, because it may have it later.
        """
        ranks = [rank for rank, name in enumerate(self.names, start=1) if name == host]
        for spare, slots in list(self.spares):
            if slots < len(ranks):
                continue
            self.spares.remove((spare, slots))
            if self.ask([spare], print_line).complaints:
                print_line(f"spare {spare} cannot be reached either")
                continue
            names = [spare if name == host else name for name in self.names]
            if lack := session_memory.lack_of(self.needs, names, self.free_memory(), self.identities, spare):
                self.spares.append((spare, slots))
                print_line(f"spare {spare} cannot take the place of {host}: {lack}")
                continue
            self.names = names
            listed = ", ".join(str(rank) for rank in ranks)
            print_line(f"{why}; spare {spare} takes its place (rank{'s' if len(ranks) > 1 else ''} {listed})")
            events.emit("spare", host=host, spare=spare, ranks=ranks)
            return True
        return False
