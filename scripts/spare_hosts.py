# SPDX-License-Identifier: Apache-2.0
"""The hosts of a session's ranks while it runs, and the spares that take the place of lost ones."""

import collections
import socket

import events
import rank_hosts
from rank_hosts import BadInput

STRIKES = 2  # so often may a host's ranks fail before a spare takes its place


class SessionHosts:
    """`names` is the host of every render rank, in their order; `spares` are (host, slots) in the order they are taken."""

    def __init__(self, names, spares, node):
        self.names, self.spares, self.node = list(names), list(spares), node
        self.strikes = collections.Counter()

    def host_of(self, rank):
        """Where a render rank runs, for a person."""
        host = self.names[rank - 1] if 1 <= rank <= len(self.names) else "a host unknown"
        return socket.gethostname() if host == rank_hosts.HERE else host

    def struck(self, failure):
        """Counts a failure against the host it happened on."""
        if failure.rank and failure.rank <= len(self.names):
            host = self.names[failure.rank - 1]
            self.strikes[host] += STRIKES if failure.host_is_lost else 1

    def require_reachable(self, say):
        """Puts spares in the place of hosts that cannot be reached or have failed too often, and says so.

        Throws BadInput for a host that cannot be reached and that no spare can replace.
        """
        complaints = rank_hosts.complaints(self.names, self.node)
        for host in [host for host, strikes in self.strikes.items() if strikes >= STRIKES and host in self.names]:
            if not self.replace(host, complaints.pop(host, f"{host}: its ranks have failed too often"), say):
                self.strikes[host] = 0  # there is no better one
        for host, complaint in complaints.items():
            if host in self.names and not self.replace(host, complaint, say):
                raise BadInput(complaint)

    def replace(self, host, why, say):
        """Whether a spare that can be reached, with slots for all its ranks, has taken the place of a host."""
        ranks = [rank for rank, name in enumerate(self.names, start=1) if name == host]
        for spare, slots in list(self.spares):
            if slots < len(ranks):
                continue
            self.spares.remove((spare, slots))
            if rank_hosts.complaints([spare], self.node):
                say(f"spare {spare} cannot be reached either")
                continue
            self.names = [spare if name == host else name for name in self.names]
            listed = ", ".join(str(rank) for rank in ranks)
            say(f"{why}; spare {spare} takes its place (rank{'s' if len(ranks) > 1 else ''} {listed})")
            events.emit("spare", host=host, spare=spare, ranks=ranks)
            return True
        return False
