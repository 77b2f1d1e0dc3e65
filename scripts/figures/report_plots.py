#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Draws the curves and writes the report's README.md from the tables of scripts/report.sh.

usage: scripts/figures/report_plots.py DATA OUT
"""

import pathlib
import sys

import report_figures as figures
from report_text import SECTIONS
from report_data import Table

HEAD = """# Report: run time and error of the sand

After reading this page you know the error and the run time of every scheme, and you can measure them again.

    scripts/report.sh --quick   # measures smaller fields with fewer runs, in less than five minutes
    scripts/report.sh           # measures everything: some 50 minutes on two quiet cores, plus the curves of a TIN
    scripts/report.sh --draw    # only draws and writes, from the tables that exist

`{script}` writes this page; do not edit it. The tables were measured from {first} to {last}, {machines}. The compiler was
{compiler} with `{flags}`, the code path {path}. Times are CPU time of one thread, unless a section names another time. They
are medians; the tables also have the least and the most. The machine is shared, so trust ratios within one table more than
times. The tables are in [data](data). The head of each has the command that made it, its seed and the definitions of its
columns.

**The piles.** Each pile is a cylinder of sand on level ground in a box of N × N cells, with a talus of 45°. The band is 0
unless a section gives another. The *low* cylinder has radius 0.3 N and a height of 0.6 radii, and becomes a frustum. The *tall*
cylinder has radius 0.25 N and a height of two radii, and becomes a cone. Both results are known in closed form. The error
*sand in the wrong place* is the sum of |height − analytic mean over the cell|, divided by the pile's volume.

**The methods.**
- *G* is the default: isotropic fluxes with inertia.
- *G plain* is G without inertia.
- *settle* is the dual projection.
- *N4* is the four-neighbour rule in integers.
- The four *float32* methods are the explicit talus rules in common use; the sections call them the public rules. They work
  in place or by Jacobi, with four or eight neighbours, the diagonal ones with or without a √2.

N4 and the float32 methods were written for this comparison only (`bench/sand/integer_n4.cpp`,
`bench/sand/baseline_schemes.cpp`): whole rows, vectorised, with the flags and instruction sets of our own sweeps.
"""


def machines_of(tables):
    """Returns a phrase with the machine that measured most tables, and with each other machine and its tables."""
    named = {}
    for name, table in tables.items():
        if table.states("machine"):
            named.setdefault(table.fact("machine").partition(",")[0], []).append(name)
    usual, *others = sorted(named, key=lambda machine: len(named[machine]), reverse=True)
    return "; ".join([f"most of them on {usual}" if others else f"on {usual}"] +
                     [f"on {other}: {', '.join(named[other])}" for other in others])


def main():
    if len(sys.argv) != 3:
        print("usage: scripts/figures/report_plots.py DATA OUT", file=sys.stderr)
        return 2
    data, out = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
    tables = {path.stem: Table(path) for path in sorted(data.glob("*.csv"))}
    # The tables of an older report lack the newest curves. The other curves can still be drawn.
    missing = {name for section in SECTIONS for name in section.needs if name not in tables}
    for name in sorted(missing):
        print(f"report_plots.py: {data}/{name}.csv is missing, so its section is left out; scripts/report.sh measures it",
              file=sys.stderr)

    if "error-at-rest" not in tables:  # the head of the page takes compiler and flags from it
        return 2
    some = tables["error-at-rest"]
    dates = sorted(table.fact("date")[:10] for table in tables.values() if table.states("date"))
    text = [HEAD.format(script="scripts/report.sh", first=dates[0], last=dates[-1], machines=machines_of(tables),
                        compiler=some.fact("compiler"), flags=some.fact("flags").strip(), path=some.fact("code path"))]
    for section in SECTIONS:
        if missing.intersection(section.needs):
            continue
        used = [tables[name] for name in section.needs]
        text.append(f"## {section.title}\n")
        if section.figure:
            picture = f"{section.figure}.png"
            figure = getattr(figures, section.figure)(used[0])
            # Stronger compression, without loss.
            figure.savefig(out / picture, bbox_inches="tight", pil_kwargs={"optimize": True})
            figures.plt.close(figure)
            text.append(f"![{section.title}]({picture})\n")
        text.append(section.reading(tables) + "\n")
        commands = " · ".join(f"[{t.path.stem}](data/{t.path.name}): `{t.fact('command')}`" for t in used
                              if any(note.startswith("command: ") for note in t.notes))
        if commands:
            text.append(f"*{commands}*\n")
    (out / "README.md").write_text("\n".join(text))
    return 0


if __name__ == "__main__":
    sys.exit(main())
