# SPDX-License-Identifier: Apache-2.0
"""Chooses the machine of each rank of a session."""

import functools
import ipaddress
import pathlib
import re
import socket

from base import text_file
from base.bad_input import BadInput

HERE = "localhost"  # mpirun's name for its own machine, on which the master always runs
NO_HOST = "-"  # sandwall-check prints it for a tile without a host
MOST_SLOTS = 1024
# Refuses names that ssh could take for an option, or mpirun for a list.
HOST_NAME = re.compile(r"[A-Za-z0-9_][A-Za-z0-9_.-]{0,252}")


def is_here(host):
    """Returns whether `host` is a name or an address of this machine. Letters may be small or capital.

    Its own name and the one in the list may be short or full. Another name of this machine has one of its addresses. A
    loopback address is not enough for that, because files of hosts give it to many names.
    """
    host, name = plain(host), plain(socket.gethostname())
    if host in (name, HERE) or host.startswith(f"{HERE}."):
        return True
    found = addresses(host)
    if any(is_own(address) and not is_loopback(address) for address in found):
        return True
    if is_address(host):
        return any(map(is_own, found))
    # Machines of several domains may have the same first label, so that two full names must be equal.
    if host.split(".")[0] != name.split(".")[0] or ("." in host and "." in name):
        return False
    return not found or any(map(is_own, found))


def plain(host):
    """Returns a name as all its spellings have it: in small letters, and without the dot that ends a full name."""
    return host.lower().removesuffix(".")


def is_address(host):
    try:
        ipaddress.ip_address(host)
        return True
    except ValueError:
        return False


@functools.cache  # a name that cannot be resolved may take seconds, and each rank asks for its host
def addresses(host):
    """Returns the addresses of `host` as (family, address). It has none if the name cannot be resolved."""
    try:
        return [(family, address) for family, _, _, _, address in socket.getaddrinfo(host, None, type=socket.SOCK_DGRAM)]
    except (OSError, UnicodeError):
        return []


def is_own(found):
    """Returns whether an address of addresses() is one of this machine. Only such an address can be bound."""
    family, address = found
    with socket.socket(family, socket.SOCK_DGRAM) as tried:
        try:
            tried.bind((address[0], 0, *address[2:]))
            return True
        except OSError:
            return False


def is_loopback(found):
    return ipaddress.ip_address(found[1][0].partition("%")[0]).is_loopback


def checked_host(host, where):
    if not HOST_NAME.fullmatch(host):
        raise BadInput(f"{where}: '{host[:80]}' is not a host name; write one as ssh knows it, such as node01")
    return HERE if is_here(host) else host


def spelled_once(hosts):
    """Returns `hosts` with the first spelling of each name. ssh and DNS take small and capital letters for the same."""
    known = {}
    return [known.setdefault(plain(host), host) for host in hosts]


def hosts_of_wall(lines, wall):
    """Returns the host of every render rank, from the output of `sandwall-check WALL --hosts`."""
    return spelled_once([HERE if line == NO_HOST else checked_host(line, wall) for line in lines.split()])


def hosts_of_file(path, ranks):
    """Returns the host of every render rank, from a file of lines `HOST [slots=N] [spare]`.

    The slots are filled in the order of ranks. The master takes no slot.
    """
    hosts = [host for host, slots, spare in entries_of_file(path) if not spare for _ in range(slots)]
    if len(hosts) < ranks:
        raise BadInput(f"{path}: {len(hosts)} slots are too few for the wall's {ranks} render ranks; add hosts, or slots=N")
    return hosts[:ranks]


def spares_of_file(path):
    """Returns (host, slots) of every spare in a file of hosts."""
    return [(host, slots) for host, slots, spare in entries_of_file(path) if spare]


def slots_of_file(path):
    """Returns the host of every slot in a file of hosts, with the spares."""
    return [host for host, slots, _ in entries_of_file(path) for _ in range(slots)]


def entries_of_file(path):
    """Returns (host, slots, whether it is a spare) of every line of a file of hosts."""
    entries = []
    try:
        lines = text_file.lines_of(pathlib.Path(path).read_bytes())
    except OSError as error:
        raise BadInput(f"--hosts {path}: cannot be read; check the path") from error
    except text_file.NotText as error:
        raise BadInput(f"{path}:{error.line}: {error}") from error
    for number, line in enumerate(lines, start=1):
        words = line.split("#")[0].split()
        if words:
            where = f"{path}:{number}"
            spare = "spare" in words[1:]
            if spare:
                words.remove("spare")
            entries.append((checked_host(words[0], where), slots_of(words[1:], where), spare))
    names = spelled_once([host for host, _, _ in entries])
    return [(name, slots, spare) for name, (_, slots, spare) in zip(names, entries)]


def slots_of(words, where):
    """Returns the number of ranks that a host takes, from `words` behind its name. It is 1 without words."""
    if not words:
        return 1
    match = re.fullmatch(r"slots=([0-9]{1,6})", words[0])
    if len(words) > 1 or not match:
        raise BadInput(f"{where}: '{' '.join(words)[:80]}' is neither slots=N nor spare")
    slots = int(match[1])
    if not 1 <= slots <= MOST_SLOTS:
        raise BadInput(f"{where}: slots must be from 1 to {MOST_SLOTS}, got {slots}")
    return slots


def checked_network(text):
    """Returns `text` as a network for mpirun, such as 10.0.0.0/24. Throws BadInput if it is not a network."""
    try:
        if "/" not in text:
            raise ValueError
        return str(ipaddress.IPv4Network(text, strict=False))
    except ValueError as error:
        raise BadInput(f"--network: '{text}' is not a network; write one such as 10.0.0.0/24") from error


def most_on_one_host(hosts):
    return max(hosts.count(host) for host in hosts)
