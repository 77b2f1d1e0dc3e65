# SPDX-License-Identifier: Apache-2.0
"""Draws the curves and writes the report's README.md from the tables of scripts/report.sh.

A section whose tables are missing or faulty is replaced by one line that names the table.
"""

import os

from report.report_data import Table, TableFault, markdown
from report.report_measure import minutes, total
from report.report_parts import Old, release

HEAD = """# Report: run time and error of the sand

After reading this page you know the error and the run time of every scheme, and you can measure them again.

    scripts/report.sh --quick   # measures smaller fields with fewer runs into out/report; takes about {quick}
    scripts/report.sh           # measures the tables that are missing or old; all of them take about {full} on {cores} cores
    scripts/report.sh --list    # prints which tables are missing or old, and the time that they take
    scripts/report.sh --check   # measures the smallest N of each table again, and compares; at most two minutes for each, after building
    scripts/report.sh --draw    # only draws and writes, from the tables that exist

`scripts/report.sh` writes this page; do not edit it. If it is interrupted, the next call continues. The tables were measured from
{first} to {last}, {machines}. The compiler was {compiler}. Its flags were {flags}. The code path was {path}. Times are CPU time of one
thread, unless a section names another time. They are medians; the tables also have the least and the most. {load} The tables are in
[data](data). The head of each has the command that made it, its seed and the definitions of its columns.
[Tables](#tables) has the release and the load of each. All sentences about results are computed from the tables.

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


def groups_of(tables, value_of):
    """Returns the names of tables by what `value_of` says of them, the largest group first. Tables without a value are left out."""
    named = {}
    for name, table in tables.items():
        if value := value_of(table):
            named.setdefault(value, []).append(name)
    return dict(sorted(named.items(), key=lambda group: len(group[1]), reverse=True))


def machines_of(tables):
    """Returns a phrase with the machine that measured most tables, and with each other machine and its tables."""
    usual, *others = groups_of(tables, lambda table: table.fact("machine", "an unknown machine").partition(",")[0]).items()
    return "; ".join([f"most of them on {usual[0]}" if others else f"on {usual[0]}"] +
                     [f"on {other}: {', '.join(names)}" for other, names in others])


def builds_of(tables, fact, mark=""):
    """Returns a phrase with the compiler, flags or code path of most tables, and with each other one and its tables."""
    if not (groups := groups_of(tables, lambda table: table.fact(fact, "").strip())):
        return "unknown"
    usual, *others = groups.items()
    return "; ".join([f"{mark}{usual[0]}{mark}" + (" for most tables" if others else "")] +
                     [f"{mark}{other}{mark} for {', '.join(names)}" for other, names in others])


def load_of(tables):
    """Returns a sentence about the load of the machine while the tables were measured."""
    loads = {name: float(table.fact("load").split()[0]) for name, table in tables.items() if table.fact("load", "")}
    without = f" It is unknown for {len(tables) - len(loads)} tables." if len(loads) < len(tables) else ""
    if not loads:
        return "The load of the machine is unknown, so trust ratios within one table more than times."
    most = max(loads, key=loads.get)
    return f"The load average of the machine before a part was at most {loads[most]:.2f} ({most}).{without}"


def read_tables(data):
    """Returns the tables of a folder by name, and why others cannot be read, by name."""
    tables, faults = {}, {}
    for path in sorted(data.glob("*.csv")):
        try:
            tables[path.stem] = Table(path)
        except TableFault as fault:
            faults[path.stem] = str(fault)
    return tables, faults


def head_of(tables, parts, out):
    cores = len(os.sched_getaffinity(0))
    dates = sorted(table.fact("date")[:10] for table in tables.values() if table.fact("date", ""))
    quick, full = (minutes(total([part for part in parts if part.options(small) is not None], out / "data", small, cores))
                   for small in (True, False))
    return HEAD.format(quick=quick, full=full, cores=cores, first=dates[0] if dates else "never", last=dates[-1] if dates else "never",
                       machines=machines_of(tables) if tables else "nowhere", compiler=builds_of(tables, "compiler"),
                       flags=builds_of(tables, "flags", "`"), path=builds_of(tables, "code path"), load=load_of(tables))


def replace_file(file, write):
    """Calls write(path) for a file beside `file`, and gives it the name of `file` when it is whole."""
    beside = file.with_name(f".new.{file.name}")
    try:
        write(beside)
        beside.rename(file)
    finally:
        beside.unlink(missing_ok=True)


def body_of(section, tables, out, draw):
    """Returns text and commands of a section, and draws its picture. Raises TableFault if the tables cannot support it."""
    used = [tables[name] for name in section.needs]
    text = [section.text(tables) + "\n"]
    if section.figure:
        picture = f"{section.figure}.png"
        try:
            replace_file(out / picture, lambda file: draw(section.figure, used[0], file))
        except (ArithmeticError, LookupError, TypeError, ValueError) as error:
            raise TableFault(f"{used[0].path.name}: cannot be drawn ({type(error).__name__}: {error})") from error
        text.insert(0, f"![{section.title}]({picture})\n")
    commands = " · ".join(f"[{t.path.stem}](data/{t.path.name}): `{t.fact('command')}`" for t in used if t.fact("command", ""))
    return text + ([f"*{commands}*\n"] if commands else [])


def table_of_tables(tables, why, parts, now):
    """Returns the section about the tables themselves. `why` says by name why tables are not those of the present sources."""
    names = [part.name for part in parts]
    rows, outdated = [], []
    for name in names + [name for name in tables if name not in names]:
        table = tables.get(name)
        reason = why.get(name)
        state = (f"old: another {reason.fact}" if isinstance(reason, Old) else reason or
                 ("valid" if name in names else "of no part of this report"))
        facts = [table.fact(fact, "–") if table else "–" for fact in ("date", "release", "commit", "load", "took")]
        if state == "valid" and facts[1] != now:
            outdated.append(name)
            state = f"valid, with the times of release {facts[1]}"
        rows.append([name, facts[0][:10], *facts[1:], state])
    valid = [row for row in rows if row[-1].startswith("valid")]
    times = f" Times of a release other than {now}, so that they are old: {', '.join(outdated)}." if outdated else f" Their times are those of release {now}."
    return ("## Tables\n\nA table is valid if its command, the sources that measure it and the version of the algorithm are the present "
            f"ones. {len(valid)} of {len(rows)} tables are valid.{times if valid else ''}\n\n" +
            markdown(["table", "measured", "release", "commit", "load average", "took", "state"], rows) + "\n")


def page(out, draw, sections, parts, why=None, now=None):
    """Returns the text of the page, and a line for each section or table that is missing.

    `why` has by name why a table is missing or old, and `now` is the present release. A section of tables that belong to no part is left out.
    """
    tables, faults = read_tables(out / "data")
    why = {**(why or {}), **faults}
    names = [part.name for part in parts]
    text, complaints = [], []
    for section in sections:
        text.append(f"## {section.title}\n")
        missing = [name for name in section.needs if name not in tables]
        if missing and not set(missing) & set(names):
            text.append("The quick report leaves this out.\n")
            continue
        try:
            for name in missing:
                raise TableFault(why.get(name) or f"{name}.csv: is missing; scripts/report.sh measures it")
            text += body_of(section, tables, out, draw)
        except TableFault as fault:
            complaints.append(f"{section.title}: {fault}")
            text.append(f"**This section is missing.** {fault}\n")
    needed = {name for section in sections for name in section.needs}
    complaints += [str(why.get(name) or f"{name}.csv: is missing") for name in names if name not in tables and name not in needed]
    lines = ["**Missing on this page:**\n" + "".join(f"- {complaint}\n" for complaint in complaints)] if complaints else []
    return "\n".join([head_of(tables, parts, out), *lines, *text, table_of_tables(tables, why, parts, now or release())]), complaints


def draw_figure(name, table, file):
    """Draws the figure `name` of report_pile_figures or report_step_figures into a file."""
    from report import report_pile_figures, report_step_figures  # these need matplotlib, which the text does not
    from report.report_plot import plt
    functions = {**vars(report_pile_figures), **vars(report_step_figures)}
    figure = functions[name](table)
    try:
        # Stronger compression, without loss.
        figure.savefig(file, format="png", bbox_inches="tight", pil_kwargs={"optimize": True})
    finally:
        plt.close(figure)


def write_page(out, sections, parts, why, now, draw=draw_figure):
    """Writes the page and its pictures. Returns a line for each section or table that is missing."""
    try:
        text, complaints = page(out, draw, sections, parts, why, now)
        replace_file(out / "README.md", lambda file: file.write_text(text))
        return complaints
    except OSError as error:
        return [f"{error.filename or out}: cannot be written ({error.strerror}); make room on the disk"]
