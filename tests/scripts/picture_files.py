# SPDX-License-Identifier: Apache-2.0
"""Reads pictures for tests: PNG files that Sandwall has written, and the screen of an X server in memory."""

import dataclasses
import pathlib
import struct
import zlib


@dataclasses.dataclass(frozen=True)
class Picture:
    width: int
    height: int
    rows: tuple  # of bytes, from the top, three for each pixel

    def part(self, x, y, width, height):
        return Picture(width, height, tuple(row[3 * x:3 * (x + width)] for row in self.rows[y:y + height]))

    def pixel(self, x, y):
        return tuple(self.rows[y][3 * x:3 * x + 3])


def paeth(left, above, corner):
    """Returns the predictor of PNG's filter 4."""
    guess = left + above - corner
    return min((left, above, corner), key=lambda value: abs(guess - value))


def unfiltered(kind, row, above):
    """Returns a row of a PNG file without its filter."""
    done = bytearray(row)
    for i, value in enumerate(row):
        left, up, corner = (done[i - 3], above[i], above[i - 3]) if i >= 3 else (0, above[i], 0)
        done[i] = (value + (0, left, up, (left + up) // 2, paeth(left, up, corner))[kind]) & 255
    return bytes(done)


def read_png(file):
    """Reads a PNG file of 8-bit RGB without interlacing."""
    data, at, packed, size = pathlib.Path(file).read_bytes(), 8, b"", (0, 0)
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at:at + 8])
        body = data[at + 8:at + 8 + length]
        if kind == b"IHDR":
            size = struct.unpack(">II", body[:8])
            assert body[8:10] == b"\x08\x02", "not 8-bit RGB"
        elif kind == b"IDAT":
            packed += body
        at += length + 12
    raw, rows = zlib.decompress(packed), []
    above = bytes(3 * size[0])
    for y in range(size[1]):
        begin = y * (3 * size[0] + 1)
        row = raw[begin + 1:begin + 1 + 3 * size[0]]
        above = row if raw[begin] == 0 else unfiltered(raw[begin], row, above)
        rows.append(above)
    return Picture(*size, tuple(rows))


def read_screen(file):
    """Reads the screen that Xvfb shows, from its file in -fbdir (the format of xwd, 32 bits a pixel)."""
    data = pathlib.Path(file).read_bytes()
    head = struct.unpack(">25I", data[:100])
    length, width, height, stride, colours = head[0], head[4], head[5], head[12], head[19]
    first = length + 12 * colours
    rows = []
    for y in range(height):
        line = data[first + y * stride:first + y * stride + 4 * width]
        row = bytearray(3 * width)
        row[0::3], row[1::3], row[2::3] = line[2::4], line[1::4], line[0::4]
        rows.append(bytes(row))
    return Picture(width, height, tuple(rows))
