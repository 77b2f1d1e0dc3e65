# SPDX-License-Identifier: Apache-2.0
"""Pictures for tests: reads PNG files that Sandwall has written, and the screen of an X server in memory."""

import dataclasses
import itertools
import pathlib
import struct
import zlib

END = b"IEND\xaeB`\x82"  # of a PNG file that is complete


@dataclasses.dataclass(frozen=True)
class Picture:
    width: int
    height: int
    rows: tuple  # of bytes, from the top, three for each pixel

    def part(self, x, y, width, height):
        return Picture(width, height, tuple(row[3 * x:3 * (x + width)] for row in self.rows[y:y + height]))

    def pixel(self, x, y):
        return tuple(self.rows[y][3 * x:3 * x + 3])


def added(row, above):
    """Returns the sums of the bytes of two rows, modulo 256."""
    low = int.from_bytes(b"\x7f" * len(row), "little")
    a, b = int.from_bytes(row, "little"), int.from_bytes(above, "little")
    return (((a & low) + (b & low)) ^ ((a ^ b) & ~low)).to_bytes(len(row), "little")


def averaged(row, above):
    """Returns one channel of a row without PNG's filter 3."""
    left, done = 0, bytearray()
    for value, up in zip(row, above):
        left = (value + (left + up) // 2) & 255
        done.append(left)
    return done


def paeth(row, above):
    """Returns one channel of a row without PNG's filter 4: each byte is added to the nearest to left + above - corner."""
    left, corner, done = 0, 0, bytearray()
    for value, up in zip(row, above):
        from_left, from_up = abs(up - corner), abs(left - corner)
        from_corner = abs(left + up - 2 * corner)
        left = (value + (left if from_left <= from_up and from_left <= from_corner else up if from_up <= from_corner else corner)) & 255
        corner = up
        done.append(left)
    return done


def unfiltered(kind, row, above):
    """Returns a row of a PNG file without its filter."""
    if kind == 0:
        return row
    if kind == 2:
        return added(row, above)
    done = bytearray(len(row))
    for channel in range(3):
        own = row[channel::3]
        done[channel::3] = (bytes(value & 255 for value in itertools.accumulate(own)) if kind == 1
                            else averaged(own, above[channel::3]) if kind == 3 else paeth(own, above[channel::3]))
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
        above = unfiltered(raw[begin], row, above)
        rows.append(above)
    return Picture(*size, tuple(rows))


def write_png(picture, file):
    """Writes a PNG file of 8-bit RGB, or of greys if its rows have one byte a pixel, without filters."""
    def chunk(kind, body):
        return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))

    colours = 0 if len(picture.rows[0]) == picture.width else 2
    head = struct.pack(">IIBBBBB", picture.width, picture.height, 8, colours, 0, 0, 0)
    rows = zlib.compress(b"".join(b"\0" + row for row in picture.rows))
    pathlib.Path(file).write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", rows) + chunk(b"IEND", b""))


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
