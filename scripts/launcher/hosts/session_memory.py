# SPDX-License-Identifier: Apache-2.0
"""Checks, before a session starts, that each of its hosts has the memory for the processes that it gets (docs/scenes.md)."""

import re
import resource

from base.bad_input import BadInput
from job.rank_hosts import HERE

# A line of `sandwall-check --memory`: the process, its bytes at rest, at the start and with all sand moving, and shared ones.
LINE = re.compile(r"(server|master|[1-9]\d{0,5}) (\d{1,18}) (\d{1,18}) (\d{1,18}) (\d{1,18})")
PROCESS = {"server": "haptic server", "master": "master", "rank": "rank"}
ADVICE = "use fewer cells, leave checkpoints out with --checkpoint 0, or take a machine with more memory"


class Need:
    """Memory of one process [byte]. `shared` is the part that other processes of its `kind` on the same host share."""

    def __init__(self, kind, most, shared):
        self.kind, self.most, self.shared = kind, most, shared


def needs_of(lines):
    """Returns {"server", "master" or rank: Need} from the output of `sandwall-check --memory`. Skips other lines."""
    found = {}
    for match in filter(None, map(LINE.fullmatch, lines.splitlines())):
        who = match[1] if match[1] in ("server", "master") else int(match[1])
        figures = [int(number) for number in match.groups()[1:]]
        found[who] = Need(who if who in ("server", "master") else "rank", max(figures[:3]), figures[3])
    return found


def in_words(number):
    """Returns a number of bytes for a person, as our programs write it."""
    return f"{number / 2 ** 20:.0f} MiB" if number < 2 ** 30 else f"{number / 2 ** 30:.1f} GiB"


def require(scene, needs, names, free, identities):
    """Throws BadInput if a process has a limit below its need, or a machine lacks the memory for all of its processes.

    `names` has the host of every render rank. `free` is {host: free memory}; a host that is not in it is not checked.
    `identities` are those of SessionHosts. The haptic server and the master run on this machine.
    """
    limit = resource.getrlimit(resource.RLIMIT_AS)[0]
    largest = max(needs.values(), key=lambda need: need.most, default=None)
    if largest and limit != resource.RLIM_INFINITY and largest.most > limit:
        raise BadInput(f"{scene}: needs {in_words(largest.most)} in the {PROCESS[largest.kind]}, and ulimit -v allows {in_words(limit)}; "
                       "raise the limit, or use fewer cells")
    if complaint := lack_of(needs, names, free, identities):
        raise BadInput(f"{scene}: {complaint}; {ADVICE}")


def lack_of(needs, names, free, identities, only=None):
    """Returns a text about the first machine that lacks the memory for its processes, or None. Looks at the machine of the host `only` alone, if given."""
    for hosts, processes in processes_of_machines(needs, names, identities):
        if only is not None and only not in hosts:
            continue
        needed, there = total(processes), min((free[host] for host in hosts if host in free and free[host] is not None), default=None)
        if there is not None and needed > there:
            name = "this machine" if HERE in hosts else hosts[0]
            return f"needs {in_words(needed)} on {name} for {listed(processes)}, where {in_words(there)} are free"
    return None


def processes_of_machines(needs, names, identities):
    """Returns (names, Needs) of each machine. Two names of one machine have the same identity in {host: identity}."""
    found = {}
    for who, need in needs.items():
        host = names[who - 1] if need.kind == "rank" and who <= len(names) else HERE
        hosts, processes = found.setdefault(identities.get(host) or host, ([], []))
        if host not in hosts:
            hosts.append(host)
        processes.append(need)
    return list(found.values())


def total(processes):
    """Returns the memory of processes on one host [byte]. Those of one kind share their code."""
    shared = {kind: max(need.shared for need in processes if need.kind == kind) for kind in {need.kind for need in processes}}
    return sum(need.most - need.shared for need in processes) + sum(shared.values())


def listed(processes):
    """Returns text such as "the haptic server, the master and 2 ranks"."""
    ranks = sum(need.kind == "rank" for need in processes)
    words = [f"the {PROCESS[kind]}" for kind in ("server", "master") if any(need.kind == kind for need in processes)]
    words += [f"{ranks} rank{'s' if ranks > 1 else ''}"] if ranks else []
    return " and ".join(filter(None, [", ".join(words[:-1]), words[-1]]))
