# SPDX-License-Identifier: Apache-2.0
"""Text of the report on steps, pictures and builds. Every number and every result in it comes from the tables."""

import math

from report.report_claims import count_of, listing, times
from report.report_data import IN_TIME, built, markdown, percent, rounded
from report.report_parts import PRESETS


def edit(tables):
    table = tables["edit"]
    sizes = table.distinct("N")

    def ms(size, radius, blocks):
        return table.positive("ms_median", N=size, radius=radius, blocks=blocks)

    radii = [r for r in table.distinct("radius", N=sizes[0]) if r in table.distinct("radius", N=sizes[-1])]
    across = max(max(ms(sizes[-1], r, "active"), ms(sizes[0], r, "active")) / min(ms(sizes[-1], r, "active"), ms(sizes[0], r, "active"))
                 for r in radii)
    tools = max(ms(sizes[-1], r, "active") for r in radii) / min(ms(sizes[-1], r, "active") for r in radii)
    depends = "has one N here, so that nothing is known about the field" if len(sizes) < 2 else "depends on the tool, and hardly on the field" if across < 2 <= tools else "depends on the field, too" if across >= 2 else "hardly depends on tool or field"
    pairs = [(size, r) for size in sizes for r in table.distinct("radius", N=size)]
    equal = count_of(pairs, lambda pair: len(table.distinct("hash", N=pair[0], radius=pair[1])) == 1, "pair")
    return (f"The figure shows the time for one press into level sand and 16 sweeps. With active blocks the time {depends}: from "
            f"N = {sizes[0]} to {sizes[-1]} it changes by a factor of at most {across:.2g}, and from the smallest tool to the largest by "
            f"{tools:.2g}. Visiting all blocks instead takes {times(ms(sizes[-1], 12, 'full'), ms(sizes[-1], 12, 'active'))} as long "
            f"at N = {sizes[-1]} with a tool of 12 cells. "
            f"Both ways give the same hash of the sand in {equal} of N and tool.")


def dig(tables):
    table = tables["dig"]
    size = table.distinct("N")[-1]
    of_tin = max(table.values("N", sand="TIN"))
    shown = [row for row in table.some(cells_per_step=1.5) if row["N"] == (of_tin if row["sand"] == "TIN" else size)]
    lines = [[row["sand"], row["N"], row["R"], row["cells_per_step"], row["sweeps_per_step"], f"{row['ms_p50']:.2f}", f"{row['ms_p99']:.2f}",
              percent(row["misplaced_held"]), percent(row["misplaced_lifted"]), f"{row['bank']:.0f}", f"{row['bank_reach']:.0f}",
              row["steps_after"]] for row in shown]
    idle = max(table.values("idle_us"))
    tools = dict.fromkeys((row["sand"], row["N"], row["R"]) for row in shown)
    return ("A sphere is dragged along the diagonal for 200 steps, with its centre at the level of the sand.\n\n"
            "- *behind*: sand behind the hand. This is the sum of |height − height once settled|, divided by the sum of "
            "|height once settled − level|. The tool stays in the sand.\n"
            "- *lifted*: the same sum after the tool is lifted, so that the hole it leaves has to fill too.\n"
            "- *bank*: height of the highest sand above the level.\n"
            "- *reach*: largest distance from the stroke's line at which sand is half a cell higher than once settled.\n"
            "- *after*: steps after lifting until 1 % is left.\n"
            "- *TIN*: points about one cell apart, whose heights are compared at the middles of cells.\n\n"
            f"Lines in the figure mark {IN_TIME} ms and 10 %. A step of settled sand takes at most {idle:.1f} µs. The table has the rows of "
            f"1.5 cells per step on the largest grid and on TINs; [data](data/dig.csv) has all. The least sand behind the hand, "
            f"of the rows in which 99 % of the steps take {IN_TIME} ms or less: {'; '.join(best_in_time(table, *tool) for tool in tools)}.\n\n" +
            markdown(["sand", "N", "R [cells]", "cells/step", "sweeps/step", "p50 [ms]", "p99 [ms]", "behind", "lifted",
                      "bank [cells]", "reach [cells]", "after"], lines))


def large_tools(tables):
    table = tables["large-tools"]
    rows = built(table.rows)
    full = {case_of(row): row for row in table.rows if row["law"] == "all sweeps"}
    lines = []
    for row in rows:
        one = full.get(case_of(row))
        lines.append([row["place"], row["tool"], row["N"], row["R"], row["law"], f"{one['ms_p50']:.3g}" if one else "",
                      f"{row['ms_p50']:.3g}", f"{row['ms_p99']:.3g}"] +
                     ([f"{row['ratio']:.2g}", f"{row['behind']:.2g} %", f"{row['at_end']:.2g} %", f"{row['of_full']:.3g}"] if one else [""] * 4) +
                     [row["steps_to_rest"], f"{row['rest_ms'] / 1e3:.2g}"])
    spheres = [row for row in rows if row["tool"] == "sphere" and row["place"] == "level"]
    first, last = (min(spheres, key=lambda row: row["R"]), max(spheres, key=lambda row: row["R"]))
    compared = [row for row in rows if row["behind"] != ""]
    exponent = math.log(last["ms_p50"] / first["ms_p50"]) / math.log(last["R"] / first["R"]) if last["R"] > first["R"] else 0
    return (f"A hand digs along a circle for 40 steps and lifts the tool ([docs/sand.md](../sand.md#large-tools)). The reference has "
            "R²/6 sweeps a step and no coarse cells.\n\n"
            "- *law*: coarse levels, each with the side of its cells and its sweeps, as it is built.\n"
            "- *reference*: time of a step of the reference; *p50*, *p99*: as it is built; *ratio*: p50 divided by *reference*.\n"
            "- *behind*, *at the end*: sand in another place than in the reference, at the end of the stroke and at rest.\n"
            "- *highest*: highest sand at the end of the stroke, divided by that of the reference.\n"
            "- *to rest*: steps and CPU time after lifting; 4000 steps are the most that are measured.\n\n"
            f"The time of a step grows with R^{exponent:.2g} from R = {first['R']:g} to {last['R']:g}. At most "
            f"{max(row['behind'] for row in compared):.2g} % of the sand is in another place behind the hand, and "
            f"{max(row['at_end'] for row in compared):.2g} % at rest. In the figure, *one more level* has finer coarse cells too, *near* has a patch that is half a radius smaller on "
            "each side, and *capped* as many sweeps as a step without a movement, and no coarse cells.\n\n" +
            markdown(["place", "tool", "N", "R [cells]", "law", "reference [ms]", "p50 [ms]", "p99 [ms]", "ratio", "behind", "at the end",
                      "highest", "steps to rest", "to rest [s]"], lines))


def case_of(row):
    return row["place"], row["tool"], row["N"], row["R"]


def best_in_time(table, of_kind, size, radius):
    rows = [row for row in table.some(N=size, R=radius, sand=of_kind) if row["ms_p99"] <= IN_TIME]
    tool = f"R = {radius:g} on the {of_kind} of N = {size}"
    if not rows:
        return f"{tool}, no row is so fast"
    best = min(rows, key=lambda row: row["misplaced_held"])
    return f"{tool}, {percent(best['misplaced_held'])} with {best['sweeps_per_step']} sweeps per step"


def held_tools(tables):
    table = tables["held-tools"]
    steepest, longest = max(table.values("slope")), max(table.values("seconds"))
    lines = []
    for sand, tool in dict.fromkeys((row["sand"], row["tool"]) for row in table.rows):
        rows = [row for row in table.some(sand=sand, tool=tool) if row["seconds"] == longest]
        rested = [row["seconds"] for row in table.some(sand=sand, tool=tool, slope=steepest) if row["at_rest"]]
        lines.append([sand, tool] + [f"{row['past']:.3g}" for row in rows] + [f"{max(row['slid'] for row in rows):.3g}"] +
                     [f"{rested[0]:g} s" if rested else "no", f"{max(row['ms'] for row in rows):.0f}"])
    most = max((row for row in table.rows if row["tool"] != "wall"), key=lambda row: row["past"])
    wall = max(row["past"] for row in table.some(sand=most["sand"], tool="wall"))
    slopes = [f"slope {slope:g} [cell³]" for slope in table.distinct("slope")]
    return ("A tool of 6 cells is pressed into a slope and held. How much sand runs past it? The figure has the steepest slope, "
            f"{steepest:g}, where the talus is 0.6745. In the first four seconds the sand slides that "
            "the press has thrown up. The volume counts from then on. A wall in the place of the circle is the reference. After "
            f"{longest:g} s at most {most['past']:.3g} cell³ have run past a tool ({most['tool']}, {most['sand']}, slope "
            f"{most['slope']:g}), and {wall:.3g} cell³ past the wall there. The last three columns have the most that slid in the first "
            "four seconds, the time from then until rest on the steepest slope, and the longest run time of the steps:\n\n" +
            markdown(["sand", "tool", *slopes, "slid before [cell³]", "at rest", "run time [ms]"], lines))


def throughput(tables):
    table = tables["throughput"]
    sizes = table.distinct("N")
    size = 512 if 512 in sizes else sizes[-1]
    lines = [[v, f"{table.one('ns_per_cell_median', variant=v, N=size):.2f}",
              f"{table.one('times_copy', variant=v, N=size):.1f}"] for v in table.distinct("variant", N=size)]
    threads = ""
    if table.where(variant="G 2 threads") and table.where(variant="loop 2 threads"):
        def gain(row, at):
            return table.positive("ns_per_cell_median", variant=row, N=at) / table.positive("ns_per_cell_median", variant=f"{row} 2 threads", N=at)
        helps = [at for at in sizes if gain("G", at) > 1.05]
        threads = (f"Two threads sweep G faster by more than 5 % at N = {listing(helps)}; at N = {sizes[-1]} it is {gain('G', sizes[-1]):.2f} "
                   f"times as fast, and the loop without memory {gain('loop', sizes[-1]):.2f} times. ")
    return ("In this field everything moves, except in the rows *lumps*. In those, one lump per 128 × 128 cells slides. The time is per "
            "cell of the whole field. With several threads the times are wall time. The row *copy* reads and writes one number per cell "
            "in the same run. This is the memory's roofline. The row *loop* computes one random number per cell without memory. It shows "
            f"what threads can gain on this machine. {threads}At N = {size} a "
            f"sweep of G takes {table.one('ns_per_cell_median', variant='G', N=size):.3g} ns per cell, "
            f"{table.one('times_copy', variant='G', N=size):.3g} times the copy:\n\n" +
            markdown(["variant", "ns per cell", "times the copy"], lines))


def parts(tables):
    table = tables["parts"]
    lines = [[r["N"], r["ground"], r["state"], rounded(r["us_median"], 3), r["sweeps"], f"{r['bytes'] / 2**20:.1f}"]
             for r in table.rows]
    size = table.distinct("N")[-1]
    settled = table.some(state="settled")

    def rock(column, state):
        return times(table.one(column, ground="bedrock", state=state, N=size), table.positive(column, ground="none", state=state, N=size))

    return ("What does a scene pay for parts that it does not need? Without bedrock, there is no array for it, and the law has no "
            f"limiter of the layer. At N = {size} bedrock takes {rock('bytes', 'settled')} the memory, and a step in which everything "
            f"moves {rock('us_median', 'everything moving')} the time. Settled sand takes "
            f"{listing(dict.fromkeys(r['sweeps'] for r in settled))} sweeps, and at most "
            f"{max(r['us_median'] for r in settled):.3g} µs.\n\n" +
            markdown(["N", "bedrock", "state", "µs per step of 16 sweeps", "sweeps run", "memory [MiB]"], lines))


def explain(tables):
    table = tables["explain"]
    lines = []
    for r in table.rows:
        cost = "" if r["cost"] == "" else f"{r['cost']:.4g} µs" if r["unit"] == "us" else f"{r['cost'] / 1024:.0f} KiB"
        lines.append([r["kind"], r["part"], r["used"], cost, r["why"]])
    costs = {part: table.one("cost", kind="step", part=part) for part in ("settled; hovering", "everything moving")}
    return (f"`sandwall-bench explain SCENE` prints for any scene what it loads and runs, and what it leaves out. The table is "
            f"for `scenes/dunes.toml` ({table.fact('scene')}). Its libraries are those of the program `sandwall-bench`. A render rank "
            f"also maps MPI and Mesa. A step of settled sand takes {costs['settled; hovering']:.3g} µs there, and one in which everything "
            f"moves {costs['everything moving']:.4g} µs.\n\n" + markdown(["kind", "part", "used", "cost", "why"], lines))


def detail(tables):
    table = tables["detail"]
    rows = [[f"{r['N']}²", f"{r['bound']:g}", f"{r['ms_median']:.1f} ({r['ms_min']:.1f} – {r['ms_max']:.1f})",
             f"{r['ratio']:.2f}", percent(r["bad"]), f"{r['mean']:.2f}", f"{r['triangles'] / 1000:.0f} k",
             percent(r["coarse"], 3)] for r in table.rows]
    size = table.distinct("N")[-1]
    half = table.some(N=size, bound=0.5)[0]
    return ("llvmpipe draws one eye of a whole tile of 1024 × 768 pixels, while the head moves over dunes with a furrow. The "
            "bound is how far a level of detail may shift any sand in the picture. Bound 0 draws all cells. Ratio and errors "
            f"compare with bound 0 in the same run. On {size}² cells a bound of half a pixel takes {half['ratio']:.2f} of the time, and "
            f"changes {percent(half['bad'])} of the pixels by more than 8 levels.\n\n" +
            markdown(["field", "bound [pixel]", "draw [ms]", "ratio", "pixels beyond 8 levels", "mean difference [level]",
                      "triangles", "chunks above level 0"], rows))


def hashes(tables):
    lines, seen = [], {}
    builds = {name: table for name, table in tables.items() if name.startswith("hashes-")}
    for table in builds.values():
        for scheme in table.distinct("scheme"):
            found = table.distinct("hash", scheme=scheme)
            seen.setdefault(scheme, set()).update(found)
            lines.append([table.fact("compiler"), f"`{table.fact('flags').split('-Werror')[-1].strip()}`", scheme,
                          ", ".join(map(str, table.distinct("code_path"))), ", ".join(map(str, table.distinct("threads"))),
                          ", ".join(map(str, table.distinct("block"))), " ".join(map(str, found))])
    verdict = ("**the hashes differ**" if any(len(found) > 1 for found in seen.values()) else
               "each scheme has one hash over all of them" if len(builds) == len(PRESETS) else
               "each scheme has one hash there, and the other builds are missing")
    text = (f"{len(builds)} of {len(PRESETS)} builds have computed 300 random drags on a field with odd sides: {verdict}.\n\n" +
            markdown(["compiler", "flags", "scheme", "code paths", "threads", "blocks", "hash"], lines))
    if "ranks" in tables:
        table = tables["ranks"]
        same = count_of(table.rows, lambda r: r["session_hash"] == r["replay_hash"] and r["divergences"] == 0, "session")
        rows = [[r["ranks"], f"{r['session_hash']}", f"{r['replay_hash']}", r["divergences"]] for r in table.rows]
        text += ("\n\nIn whole sessions of 60 steps, ranks compare their hashes in each frame. One process then replays the "
                 f"journal. It gets the same hash, and no rank differs, in {same}.\n\n" +
                 markdown(["render ranks", "hash of the session", "hash of the replay", "divergences"], rows))
    return text
