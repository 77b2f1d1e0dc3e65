#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes a plausible recording of a hand that draws a stroke list: about 1 kHz, in millimetres, z up.

It has properties of a real recording that a script device lacks: smooth accelerations, tremor, a position sensor with steps
of 0.1 mm, and late ticks. The mean period is 1.017 ms, the 99th percentile 2.3 ms; rare gaps last up to 20 ms.
"""
import math
import pathlib
import random
import sys

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "launcher"))
from base.command_line import Parser, above

STROKES = pathlib.Path(__file__).resolve().parents[2] / "haptic_bridge" / "devices" / "gis.strokes"

MM_PER_HALF_SIDE = 100.0  # the written word is about 180 mm wide
MM_PER_RADIUS = 4.0       # 0.04 half sides, as in scenes/writing.toml
DEPTH_MM = 0.5 * MM_PER_RADIUS
LIFT_MM = 3.0 * MM_PER_RADIUS
TREMOR_MM = 0.12          # amplitude on each axis, at 8 to 12 Hz
RESOLUTION_MM = 0.1


def read_strokes(path):
    """Returns the strokes of a stroke list (docs/devices.md) as lists of points. Arcs are cut into short lines."""
    strokes = []
    with open(path, encoding="utf-8") as file:
        for number, line in enumerate(file, 1):
            words = line.split("#")[0].split()
            if not words:
                continue
            try:
                values = [float(word) for word in words[1:]]
                if not all(map(math.isfinite, values)):
                    raise ValueError
                if words[0] == "stroke":
                    strokes.append([])
                elif words[0] == "point":
                    strokes[-1].append((values[0], values[1]))
                elif words[0] == "arc":
                    cx, cy, rx, ry, begin, end = values
                    count = max(1, math.ceil(abs(end - begin) / 5))
                    for i in range(count + 1):
                        angle = math.radians(begin + (end - begin) * i / count)
                        strokes[-1].append((cx + rx * math.cos(angle), cy + ry * math.sin(angle)))
            except (ValueError, IndexError):
                sys.exit(f"{path}:{number}: cannot be read: {line.strip()}; write stroke, point X Y or arc CX CY RX RY BEGIN END")
    if not strokes or not all(strokes):
        sys.exit(f"{path}: has no strokes or an empty stroke; add points")
    return strokes


def minimum_jerk(share):
    """Returns the share of its way that a hand has moved after `share` of its time (Flash and Hogan 1985)."""
    return share ** 3 * (10 - 15 * share + 6 * share * share)


def along(points, share):
    """Returns the point at `share` of the length of a polyline."""
    lengths = [math.dist(a, b) for a, b in zip(points, points[1:])]
    wanted = share * sum(lengths)
    for start, end, length in zip(points, points[1:], lengths):
        if wanted <= length and length > 0:
            return tuple(a + (b - a) * wanted / length for a, b in zip(start, end))
        wanted -= length
    return points[-1]


def moves(strokes, seconds):
    """Returns (duration [s], function from share to (x, y, z) [mm]) of every move. The durations add up to `seconds`."""
    result = []

    def add(weight, points):
        result.append((weight, lambda share, p=tuple(points): along(p, minimum_jerk(share))))

    surface = [[(x * MM_PER_HALF_SIDE, y * MM_PER_HALF_SIDE, -DEPTH_MM) for x, y in stroke] for stroke in strokes]
    for i, stroke in enumerate(surface):
        above = (stroke[0][0], stroke[0][1], LIFT_MM)
        if i == 0:
            add(25, [above, above])
        else:
            left = surface[i - 1][-1]
            high = (left[0], left[1], LIFT_MM)
            add(25, [left, high])
            add(25 + 0.5 * math.dist(high, above), [high, above])
        add(25, [above, stroke[0]])
        add(40 + sum(math.dist(a, b) for a, b in zip(stroke, stroke[1:])), stroke)
    last = surface[-1][-1]
    add(25, [last, (last[0], last[1], LIFT_MM)])
    total = sum(weight for weight, _ in result)
    return [(weight * seconds / total, place) for weight, place in result]


def period(luck):
    """Returns a random time to the next tick [s]."""
    draw = luck.random()
    if draw < 0.0004:
        return luck.uniform(0.005, 0.020)
    if draw < 0.012:
        return luck.uniform(0.0018, 0.0026)
    return max(8e-6, luck.gauss(0.001, 0.00006))


def main():
    parser = Parser(description=__doc__.splitlines()[0])
    parser.add_argument("output", help="CSV to write: time,x,y,z in seconds and millimetres")
    parser.add_argument("--strokes", default=STROKES)
    parser.add_argument("--seconds", type=above(float, 0), default=12.0, help="duration of the recording [s] (default: 12)")
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    luck = random.Random(options.seed)
    tremor = [(luck.uniform(8, 12), luck.uniform(0, 2 * math.pi)) for _ in range(3)]
    plan = moves(read_strokes(options.strokes), options.seconds)
    lines = ["time,x,y,z"]
    time, begin, index = 0.0, 0.0, 0
    while index < len(plan):
        duration, place = plan[index]
        if time >= begin + duration:
            begin += duration
            index += 1
            continue
        where = place((time - begin) / duration)
        shaken = [w + TREMOR_MM * math.sin(2 * math.pi * hertz * time + phase)
                  for w, (hertz, phase) in zip(where, tremor)]
        steps = [round(value / RESOLUTION_MM) * RESOLUTION_MM for value in shaken]
        lines.append(f"{time:.6f}," + ",".join(f"{value:.1f}" for value in steps))
        time += period(luck)
    try:
        with open(options.output, "w", encoding="utf-8") as file:
            file.write("\n".join(lines) + "\n")
    except OSError as error:
        sys.exit(f"{options.output}: {error.strerror}")


if __name__ == "__main__":
    main()
