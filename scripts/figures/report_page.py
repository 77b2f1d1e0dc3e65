#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Draws the curves and writes the report's README.md from the tables of scripts/report.sh.

A section whose tables are missing or faulty is replaced by one line that names the table. The exit status is then 1.

usage: scripts/figures/report_page.py DATA OUT
"""

import pathlib
import sys

from report_data import Table, TableFault
from report_text import SECTIONS

HEAD = """# Report: run time and error of the sand

After reading this page you know the error and the run time of every scheme, and you can measure them again.

    scripts/report.sh --quick   # measures smaller fields with fewer runs, in less than five minutes
    scripts/report.sh           # measures everything: some 50 minutes on two quiet cores, plus the curves of a TIN
    scripts/report.sh --draw    # only draws and writes, from the tables that exist

`{script}` writes this page; do not edit it. The tables were measured from {first} to {last}, {machines}. The compiler was
{compiler} with `{flags}`, the code path {path}. Times are CPU time of one thread, unless a section names another time. They
are medians; the tables also have the least and the most. The machine is shared, so trust ratios within one table more than
times. The tables are in [data](data). The head of each has the command that made it, its seed and the definitions of its
columns. All sentences about results are computed from these tables.

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
        named.setdefault(table.fact("machine", "an unknown machine").partition(",")[0], []).append(name)
    usual, *others = sorted(named, key=lambda machine: len(named[machine]), reverse=True)
    return "; ".join([f"most of them on {usual}" if others else f"on {usual}"] +
                     [f"on {other}: {', '.join(named[other])}" for other in others])


def read_tables(data):
    """Returns the tables of a folder by name, and why others cannot be read, by name."""
    tables, faults = {}, {}
    for path in sorted(data.glob("*.csv")):
        try:
            tables[path.stem] = Table(path)
        except TableFault as fault:
            faults[path.stem] = str(fault)
    return tables, faults


def head_of(tables):
    some = next((table for table in tables.values() if table.fact("compiler", "")), None)
    dates = sorted(table.fact("date")[:10] for table in tables.values() if table.fact("date", ""))
    facts = {name: some.fact(name, "unknown").strip() if some else "unknown" for name in ("compiler", "flags", "code path")}
    return HEAD.format(script="scripts/report.sh", first=dates[0] if dates else "never", last=dates[-1] if dates else "never",
                       machines=machines_of(tables) if tables else "nowhere", compiler=facts["compiler"], flags=facts["flags"],
                       path=facts["code path"])


def body_of(section, tables, out, draw):
    """Returns text and commands of a section, and draws its picture. Raises TableFault if the tables cannot support it."""
    used = [tables[name] for name in section.needs]
    text = [section.text(tables) + "\n"]
    if section.figure:
        picture = f"{section.figure}.png"
        try:
            draw(section.figure, used[0], out / picture)
        except (ArithmeticError, LookupError, TypeError, ValueError) as error:
            raise TableFault(f"{used[0].path.name}: cannot be drawn ({type(error).__name__}: {error})") from error
        text.insert(0, f"![{section.title}]({picture})\n")
    commands = " · ".join(f"[{t.path.stem}](data/{t.path.name}): `{t.fact('command')}`" for t in used if t.fact("command", ""))
    return text + ([f"*{commands}*\n"] if commands else [])


def page(data, out, draw, sections=SECTIONS):
    """Returns the text of the page, and a line for each section that could not be written."""
    tables, faults = read_tables(data)
    text, complaints = [], []
    for section in sections:
        text.append(f"## {section.title}\n")
        try:
            for name in section.needs:
                if name not in tables:
                    raise TableFault(faults.get(name) or f"{name}.csv: is missing; scripts/report.sh measures it")
            text += body_of(section, tables, out, draw)
        except TableFault as fault:
            complaints.append(f"{section.title}: {fault}")
            text.append(f"**This section is missing.** {fault}\n")
    missing = ["**Missing on this page:**\n" + "".join(f"- {complaint}\n" for complaint in complaints)] if complaints else []
    return "\n".join([head_of(tables), *missing, *text]), complaints


def draw_figure(name, table, file):
    """Draws the figure `name` of report_figures into a file."""
    import report_figures  # needs matplotlib, which the text does not
    figure = getattr(report_figures, name)(table)
    try:
        # Stronger compression, without loss.
        figure.savefig(file, bbox_inches="tight", pil_kwargs={"optimize": True})
    finally:
        report_figures.plt.close(figure)


def main():
    if len(sys.argv) != 3:
        print("usage: scripts/figures/report_page.py DATA OUT", file=sys.stderr)
        return 2
    data, out = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
    text, complaints = page(data, out, draw_figure)
    (out / "README.md").write_text(text)
    for complaint in complaints:
        print(f"report.sh: {complaint}", file=sys.stderr)
    return 1 if complaints else 0


if __name__ == "__main__":
    sys.exit(main())
