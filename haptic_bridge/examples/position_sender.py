#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Streams where a hand is to the master of a wall, from a server that has no sand: put your device into hand().

    python3 position_sender.py --listen 0.0.0.0:7750        on the machine with the device, of whatever system
    scripts/sandwall run ... --haptic MACHINE:7750          on the wall's

The master connects, this server greets and sends positions; whatever the master says need not be read. It numbers the
steps, moves the sand, and lifts the tool when positions stay away. docs/protocol.md has every byte. Standard library.
"""

import argparse
import math
import socket
import struct
import sys
import time

MAGIC, PROTOCOL = b"SWHB", 5
POSITION_GREETING, POSITION = 19, 20


def message(kind, payload):
    """As on the wire: length, type, payload; all little-endian."""
    return struct.pack("<IB", 1 + len(payload), kind) + payload


def greeting(device):
    name = device.encode()
    return message(POSITION_GREETING, MAGIC + struct.pack("<II", PROTOCOL, len(name)) + name)


def position(seconds, x, y, z, touches):
    return message(POSITION, struct.pack("<qdddB", int(seconds * 1e9), x, y, z, touches))


def hand(seconds):
    """Replace this by a reading of your device.

    x runs east and y north from the centre of the field, 1 is half of its shorter side; z is the height of the tool's
    centre over the sand as the session began, in tool radii: 1 touches it, 0 is half sunk. Here: circles, half sunk,
    lifted for the last quarter of each.
    """
    turn = seconds / 2
    touches = turn % 1 < 0.75
    x, y = 0.5 * math.cos(2 * math.pi * turn), 0.5 * math.sin(2 * math.pi * turn)
    return x, y, 0.0 if touches else 3.0, touches


def stream(master, rate):
    """Sends positions until the master has gone; the times are this machine's, and never run backwards."""
    master.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
    master.sendall(greeting("circles"))
    begin = due = time.monotonic()
    while True:
        now = time.monotonic()
        master.sendall(position(now, *hand(now - begin)))
        due = max(due + 1 / rate, now - 1)
        time.sleep(max(0.0, due - time.monotonic()))


def main():
    parser = argparse.ArgumentParser(description="Streams a hand's positions to the master of a wall.")
    parser.add_argument("--listen", default="127.0.0.1:7750", metavar="ADDRESS:PORT", help="port 0 takes any free one")
    parser.add_argument("--rate", type=float, default=500, help="positions a second")
    args = parser.parse_args()
    address, _, port = args.listen.rpartition(":")
    with socket.create_server((address, int(port))) as listener:
        print("listening on %s:%d" % listener.getsockname()[:2], flush=True)
        while True:  # the next master may come when one has gone
            master, where = listener.accept()
            print("master", where[0], "linked", file=sys.stderr)
            try:
                with master:
                    stream(master, args.rate)
            except OSError as error:
                print("master", where[0], "gone:", error, file=sys.stderr)


if __name__ == "__main__":
    main()
