#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Streams the positions of a hand to the master of a wall, from a server without sand. Put your device into hand().

    python3 position_sender.py --listen 0.0.0.0:7750 --secret-file FILE     on the machine with the device
    scripts/sandwall run ... --haptic MACHINE:7750 --secret-file FILE       on the wall's

The master connects. This server then greets and sends positions; it need not read later messages of the master. The
master numbers the steps and moves the sand. It lifts the tool if no positions arrive. On 127.0.0.1 no secret is needed.
docs/protocol.md describes every byte, docs/security.md the secret file. The script needs only the standard library and
runs on every system.
"""

import argparse
import hmac
import ipaddress
import math
import os
import secrets
import socket
import struct
import sys
import time

MAGIC, PROTOCOL = b"SWHB", 12
HELLO, REFUSAL, POSITION_GREETING, POSITION, CHALLENGE, PROOF = 1, 3, 19, 20, 21, 22
MOVE, PROVES, REFUSED_SECRET = 1, 1, 7
LONGEST_GREETING, PATIENCE, SILENCE = 1024, 3, 10  # bytes, seconds, seconds


def message(kind, payload):
    """Returns the bytes on the wire: length, type, payload; all little-endian."""
    return struct.pack("<IB", 1 + len(payload), kind) + payload


def greeting(device, proof=bytes(32)):
    name = device.encode()
    return message(POSITION_GREETING, MAGIC + struct.pack("<II", PROTOCOL, len(name)) + name + proof)


def receive(master, deadline):
    """Returns the bytes of a whole message from an unauthenticated connection."""
    def read(count):
        data = b""
        while len(data) < count:
            master.settimeout(max(0.001, deadline - time.monotonic()))
            piece = master.recv(count - len(data))
            if not piece:
                raise OSError("it has closed the connection")
            data += piece
        return data
    length = read(4)
    count = struct.unpack("<I", length)[0]
    if not 1 <= count <= LONGEST_GREETING:
        raise OSError(f"a greeting of {count} bytes")
    return length + read(count)


def refuse(master, text):
    master.sendall(message(REFUSAL, struct.pack("<BI", REFUSED_SECRET, len(text)) + text.encode()))
    raise OSError(text)


def prove(master, device, secret):
    """Checks that the master knows the secret. Returns the proof that this server knows it too."""
    deadline = time.monotonic() + PATIENCE  # for both messages together
    hello = receive(master, deadline)
    if hello[4] != HELLO or len(hello) < 63 or hello[5:9] != MAGIC or hello[9:13] != struct.pack("<I", PROTOCOL):
        raise OSError("its greeting has another protocol")
    role, flags = hello[-34], hello[-33]
    if role != MOVE or flags != PROVES:
        refuse(master, "this server asks for a secret of role move, without TLS; give your side --secret-file, too")
    name = device.encode()
    challenge = message(CHALLENGE, MAGIC + struct.pack("<IIQI", PROTOCOL, 0, 0, len(name)) + name + secrets.token_bytes(32))
    master.sendall(challenge)

    def proof_of(side):
        label = b"sandwall %d %s" % (PROTOCOL, side)
        said = struct.pack("<I", len(label)) + label + hello + challenge + struct.pack("<I", 0)
        return hmac.digest(secret, said, "sha256")
    answer = receive(master, deadline)
    if answer[4] != PROOF or not hmac.compare_digest(answer[5:], proof_of(b"master")):
        refuse(master, "the secret of role move differs here; give both sides the same --secret-file")
    return proof_of(b"server")


def position(seconds, x, y, z, touches):
    return message(POSITION, struct.pack("<qdddB", int(seconds * 1e9), x, y, z, touches))


def hand(seconds):
    """Replace this by a reading of your device.

    x runs east and y north from the centre of the field; 1 is half of its shorter side. z is the height of the tool's
    centre above the sand as the session began, in tool radii. At 1 the tool touches the sand; at 0 half of it is below.
    This example draws circles at z = 0, and lifts the tool for the last quarter of each.
    """
    turn = seconds / 2
    touches = turn % 1 < 0.75
    x, y = 0.5 * math.cos(2 * math.pi * turn), 0.5 * math.sin(2 * math.pi * turn)
    return x, y, 0.0 if touches else 3.0, touches


def stream(master, rate, secret):
    """Sends positions until the master has gone. Their times are on this machine's clock and never run backwards."""
    master.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
    master.settimeout(PATIENCE)
    master.sendall(greeting("circles", prove(master, "circles", secret)) if secret else greeting("circles"))
    master.settimeout(SILENCE)
    begin = due = time.monotonic()
    while True:
        now = time.monotonic()
        master.sendall(position(now, *hand(now - begin)))
        due = max(due + 1 / rate, now - 1)
        time.sleep(max(0.0, due - time.monotonic()))


def secret_of(file):
    """Returns the secret of role move from `file`. From then on this process makes no core dumps."""
    if os.name == "posix":
        import resource  # other systems have no such module
        hard = resource.getrlimit(resource.RLIMIT_CORE)[1]
        least = 0 if hard == 0 else 1  # with 1 the kernel also starts no program that collects cores
        resource.setrlimit(resource.RLIMIT_CORE, (least, least))
    try:
        with open(file, encoding="ascii") as lines:
            about = os.fstat(lines.fileno())
            if os.name == "posix" and (about.st_mode & 0o077 or about.st_uid != os.geteuid()):
                sys.exit(f"{file}: belongs to another user, or other users may read it; make a new secret in a file of your own, "
                         "and run chmod 600 on it")
            for words in map(str.split, lines):
                if len(words) == 2 and words[0] == "move" and len(words[1]) >= 16:
                    return words[1].encode()
    except (OSError, ValueError) as error:
        sys.exit(f"{file}: cannot be read ({getattr(error, 'strerror', None) or error}); give --secret-file a file that you can read")
    sys.exit(f"{file}: holds no line: move SECRET, of at least 16 characters; openssl rand -hex 32 makes one")


def positive(text):
    number = float(text)
    if not (math.isfinite(number) and number > 0):  # float() also reads nan and inf
        raise argparse.ArgumentTypeError(f"must be a finite number above 0, got {text}")
    return number


positive.__name__ = "number"  # argparse prints this name if the text is not a number


def main():
    parser = argparse.ArgumentParser(description="Streams a hand's positions to the master of a wall.")
    parser.add_argument("--listen", default="127.0.0.1:7750", metavar="ADDRESS:PORT", help="port 0 takes any free one")
    parser.add_argument("--rate", type=positive, default=500, help="positions a second")
    parser.add_argument("--secret-file", metavar="FILE", help="line: move SECRET, the same as the wall's")
    args = parser.parse_args()
    address, _, port = args.listen.rpartition(":")
    secret = secret_of(args.secret_file) if args.secret_file else None
    address = "127.0.0.1" if address == "localhost" else address
    if not secret and not ipaddress.ip_address(address).is_loopback:
        sys.exit(f"--listen {args.listen}: other machines can reach that address, so it needs --secret-file")
    with socket.create_server((address, int(port))) as listener:
        print("listening on %s:%d" % listener.getsockname()[:2], flush=True)
        while True:  # the next master may come when one has gone
            master, where = listener.accept()
            print("master", where[0], "linked", file=sys.stderr)
            try:
                with master:
                    stream(master, args.rate, secret)
            except OSError as error:
                print("master", where[0], "gone:", error, file=sys.stderr)


if __name__ == "__main__":
    try:
        main()
    except BrokenPipeError:  # nobody reads what it prints, for example after: | head -1
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())  # Python writes the rest when it ends
        sys.exit(1)
    except KeyboardInterrupt:
        sys.exit(130)
