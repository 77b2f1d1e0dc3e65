#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Draws the curves and writes the report's README.md from the tables of scripts/report.sh.

usage: scripts/report_plots.py DATA OUT
"""

import pathlib
import sys

import report_figures as figures
from report_text import SECTIONS
from report_data import Table

HEAD = """# Report: what the sand costs, and how right it is

Written by `{script}`, never by hand, from tables measured from {first} to {last}: {machines}. Compiled by {compiler} with
`{flags}`, code path {path}. Times are CPU time of one thread unless a section says otherwise, medians with least and most in the tables; the machine
is shared, so trust ratios within one table more than times. The tables are in [data](data), each with the command that
made it, its seed and the definitions of its columns at its head.

**The piles.** A cylinder of sand on level ground in a box of N × N cells, talus 45°, without band unless said. The *low*
one (height 0.6 of the radius, radius 0.3 N) becomes a frustum, the *tall* one (height twice the radius, radius 0.25 N)
a cone; both are known in closed form. *Sand in the wrong place* is the sum of |height − analytic mean over the cell|
over the pile's volume.

**The methods.** *G*: the default, isotropic fluxes with inertia. *G plain*: the same without inertia. *settle*: the dual
projection. *N4* is the four-neighbour rule in integers, and the four *float32* ones are the explicit talus rules in common
use, in place or Jacobi, four or eight neighbours, the diagonal ones with or without a √2. These five are written for this
comparison alone (`bench/sand/integer_n4.cpp`, `bench/sand/baseline_schemes.cpp`): whole rows, vectorised, with the flags
and instruction sets of our own sweeps.
"""


def machines_of(tables):
    """Which machine measured which tables: the usual one, and the others with the tables that are theirs."""
    named = {}
    for name, table in tables.items():
        if table.states("machine"):
            named.setdefault(table.fact("machine").partition(",")[0], []).append(name)
    usual, *others = sorted(named, key=lambda machine: len(named[machine]), reverse=True)
    return "; ".join([usual] + [f"{', '.join(named[other])} on {other}" for other in others])


def main():
    if len(sys.argv) != 3:
        print("usage: scripts/report_plots.py DATA OUT", file=sys.stderr)
        return 2
    data, out = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
    tables = {path.stem: Table(path) for path in sorted(data.glob("*.csv"))}
    # Tables of an older report lack the newest curves, and can be drawn all the same.
    missing = {name for section in SECTIONS for name in section.needs if name not in tables}
    for name in sorted(missing):
        print(f"report_plots.py: {data} has no {name}.csv, and its section is left out; scripts/report.sh measures it",
              file=sys.stderr)

    if "error-at-rest" not in tables:  # the head is taken from it
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
            # A palette keeps a picture below 100 kB, and no line is lost.
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
