# SPDX-License-Identifier: Apache-2.0
"""Text of the report beside each figure. Every number in it comes from the tables."""

from dataclasses import dataclass
from typing import Callable, Optional

from report_data import held, least_seconds, markdown, percent, seconds
from report_haptics import force_rate, force_work, latency, stability
from report_tin import tin_piles, tin_simplify, tin_tool

PUBLIC = ["float32 N4 in place", "float32 N4 Jacobi", "float32 N8 Jacobi", "float32 N8 sqrt2 Jacobi"]
OURS = ["G", "settle"]
WANTED = [0.1, 0.044, 0.04, 0.035, 0.03, 0.02, 0.014, 0.01, 0.005, 0.002, 0.001, 5e-4, 2e-4, 1e-4]  # the errors in the tables of least time


@dataclass
class Section:
    title: str
    figure: Optional[str]  # name of the function in report_figures and of the picture; None: no figure
    needs: list  # names of the tables; the figure is drawn from the first
    reading: Callable


def work_precision(tables):
    table = tables["work-precision"]
    size = 128 if 128 in table.distinct("N") else table.distinct("N")[-1]
    best = {m: table.values("misplaced", pile="low", method=m, N=size)[-1] for m in OURS + PUBLIC}
    floors = ", ".join(f"{percent(best[m])} ({m})" for m in PUBLIC)
    return (f"The figure shows the same pile from the same start at one N, with one point per sample of the run. On the low "
            f"pile, G comes to {percent(best['G'])} and settle to {percent(best['settle'])}. The public rules stop at "
            f"{floors}, however long they run. Their error is in the shape: a diamond or an octagon never becomes a circle, "
            "at any N.")


def first_at(table, size):
    """Whether G on fields of this size takes less time than every public rule at each error below 4.4 %, at which N4 stops."""
    for pile in table.distinct("pile", N=size):
        runs = {m: held(table.where(pile=pile, method=m, N=size)) for m in ["G"] + PUBLIC}
        for error in WANTED:
            ours, *public = (least_seconds(runs[m], error) for m in ["G"] + PUBLIC)
            reached = [value for value in public if value is not None]
            if error < 0.044 and reached and (ours is None or ours > min(reached)):
                return False
    return True


def envelope(tables):
    table = tables["work-precision"]
    parts = []
    sizes = table.distinct("N")
    first = [size for size in sizes if all(first_at(table, n) for n in sizes if n >= size)]
    for pile in table.distinct("pile"):
        methods = ["G", "G plain", "settle", "N4"] + PUBLIC
        wanted = WANTED
        runs = {m: held(table.where(pile=pile, method=m)) for m in methods}
        rows, won = [], []
        for error in wanted:
            least = {m: least_seconds(runs[m], error) for m in methods}
            if any(value is not None for value in least.values()):
                rows.append([percent(error)] + [seconds(least[m]) for m in methods])
            ours = min((least[m] for m in OURS if least[m] is not None), default=None)
            public = min((least[m] for m in PUBLIC if least[m] is not None), default=None)
            # If no public rule reaches an error on these fields, this project has not lost there.
            won.append(public is None or (ours is not None and ours <= public))
        last_lost = max((i for i, good in enumerate(won) if not good), default=-1)
        reach = min(row["misplaced"] for m in PUBLIC for row in runs[m])
        claim = (f"at every error of this table from {percent(wanted[last_lost + 1])} down" if last_lost + 1 < len(wanted)
                 else "at no error of this table")
        parts.append(f"**The {pile} pile.** G or settle takes less time than every public rule {claim}. No public rule "
                     f"reaches an error below {percent(reach)}.\n\n" + markdown(["error at most"] + methods, rows))
    return ("How long does a method need for a wanted error, at its best N and length of the run? A coarse pile that has come "
            "to rest competes with a fine one that has not. An error counts from the point where the run never exceeds it "
            "again. Eight neighbours without weights pass by the right pile on their way to the wrong one: this is the dip in the "
            "figure above. A user cannot know when to stop. The entry *never* means that the method does not reach this "
            "error, at any N or time.\n\n" +
            (f"At one N, from {first[0]} on, G takes less time than every public rule at every error of these tables below "
             "4.4 %. N4 itself comes to rest above 4.4 %.\n\n" if first else "") + "\n\n".join(parts))


def error_at_rest(tables):
    table = tables["error-at-rest"]
    lines = []
    for pile in table.distinct("pile"):
        for method in ["G", "G plain", "settle", "N4"] + PUBLIC:
            rows = table.where(pile=pile, method=method)
            last = rows[-1]
            lines.append([pile, method, last["N"], percent(last["misplaced"]), f"{last['largest']:.2g}",
                          f"{last['apex']:+.2g}", f"{last['order']:.2f}", last["sweeps"]])
    return ("The figure shows the error at rest. A method in floats may creep without end: it stops after half as many sweeps "
            "as there are cells. G and settle converge with N. Their largest error stays within a fraction of a cell. It is "
            "at the kinks of the profile, because a mean over a cell cannot be stable there. The public rules keep their "
            "error at every N (order 0), and their largest error grows with N. At the largest N of each method:\n\n" +
            markdown(["pile", "method", "N", "sand in the wrong place", "largest error [cell]", "apex error [cell]",
                      "order in N", "sweeps"], lines))


def sweeps(tables):
    table = tables["sweeps"]
    size = table.distinct("N", pile="low")[-1]
    plain = table.one("sweeps", pile="low", method="G plain", band=0, N=size)
    g = table.one("sweeps", pile="low", method="G", band=0, N=size)
    banded = table.one("sweeps", pile="low", method="G plain", band=0.001, N=size)
    return (f"The sweeps of plain G grow with N². Inertia makes them {plain / g:.0f} times fewer at N = {size}: {g} instead of "
            f"{plain}. With a band of 10⁻³ plain G still needs {banded} sweeps, because sand that slides stops at the talus "
            "with a band too.")


def anisotropy(tables):
    table = tables["anisotropy"]
    size = table.distinct("N")[-1]

    def worst(pile, method):
        return max(abs(value) for value in table.values("radius_error", pile=pile, method=method, N=size))

    lines = [[m] + [percent(worst(p, m)) for p in ("low", "tall")] for m in table.distinct("method")]
    return ("The figure shows in each direction the radius at which the pile's flank crosses half of its height. It shows "
            "a quarter of the circle, because the other quarters are mirror images. The table has the largest error of the "
            "radius in any direction:\n\n" +
            markdown(["method", f"low pile, N = {size}", f"tall pile, N = {size}"], lines))


def decay(tables):
    table = tables["decay"]

    def reach(method, share):
        return next(row["sweeps"] for row in table.where(pile="low", method=method) if row["to_rest"] < share)

    return (f"The figure shows how the low pile comes to rest. To come within 0.1 % of its own state at rest, G takes "
            f"{reach('G', 1e-3)} sweeps, plain G {reach('G plain', 1e-3)} and N4 {reach('N4', 1e-3)}. Curves of integers "
            "end, because no sand moves any more. In floats the last creep continues.")


def height_bits(tables):
    table = tables["height-bits"]
    size = table.distinct("N", pile="low")[-1]

    def at(bits):
        return table.one("misplaced", pile="low", N=size, bits=bits)

    return (f"The figure shows the same pile in coarser and finer height units. The line marks the unit in use, 2⁻¹⁶ cells. From "
            f"16 bits to the finest unit that fits, the error of the low pile at N = {size} changes from "
            f"{percent(at(16), 4)} to {percent(table.where(pile='low', N=size)[-1]['misplaced'], 4)}: the grid decides, not "
            f"the unit. At 8 bits the error is {percent(at(8))}.")


def band(tables):
    table = tables["band"]

    def at(method, width, column):
        return table.one(column, pile="low", method=method, band=width)

    return (f"Hysteresis is physics: the angle at which sand starts to slide is steeper than the angle at which it comes to "
            f"rest. A pile of sand that has slid does not depend on the band. Its error is "
            f"{percent(at('G', 0, 'misplaced'), 3)} without a band and {percent(at('G', 0.1, 'misplaced'), 3)} with a band of "
            f"0.1, after {at('G', 0, 'sweeps')} and {at('G', 0.1, 'sweeps')} sweeps of G.")


def edit(tables):
    table = tables["edit"]
    large = table.distinct("N")[-1]

    def gain(size, radius):
        return (table.one("ms_median", N=size, radius=radius, blocks="full") /
                table.one("ms_median", N=size, radius=radius, blocks="active"))

    return (f"The figure shows the time for one press into level sand and 16 sweeps. With active blocks the time depends on the "
            f"tool, and not on the field. Visiting every block instead takes {gain(large, 12):.0f} times as long at "
            f"N = {large} with a tool of 12 cells. Both give the same sand, bit for bit.")


def dig(tables):
    table = tables["dig"]
    lines = []
    for row in table.rows:
        lines.append([row["N"], row["R"], row["cells_per_step"], row["sweeps_per_step"], f"{row['ms_p50']:.2f}",
                      f"{row['ms_p99']:.2f}", percent(row["misplaced_held"]), percent(row["misplaced_lifted"]),
                      f"{row['bank']:.0f}", f"{row['bank_reach']:.0f}", row["steps_after"]])
    idle = max(table.values("idle_us"))
    return ("A sphere is dragged along the diagonal for 200 steps, with its centre at the level of the sand.\n\n"
            "- *behind*: sand behind the hand. This is the sum of |height − height once settled|, divided by the sum of "
            "|height once settled − level|. The tool stays in the sand.\n"
            "- *lifted*: the same sum after the tool is lifted, so that the hole it leaves has to fill too.\n"
            "- *bank*: height of the highest sand above the level.\n"
            "- *reach*: largest distance from the stroke's line at which sand is half a cell higher than once settled.\n"
            "- *after*: steps after lifting until 1 % is left.\n\n"
            f"Lines in the figure mark 2 ms and 10 %. A step of settled sand takes at most {idle:.1f} µs.\n\n" +
            markdown(["N", "R [cells]", "cells/step", "sweeps/step", "p50 [ms]", "p99 [ms]", "behind", "lifted",
                      "bank [cells]", "reach [cells]", "after"], lines))


def throughput(tables):
    table = tables["throughput"]
    size = 512 if 512 in table.distinct("N") else table.distinct("N")[-1]
    lines = [[v, f"{table.one('ns_per_cell_median', variant=v, N=size):.2f}",
              f"{table.one('times_copy', variant=v, N=size):.1f}"] for v in table.distinct("variant")]
    return ("In this field everything moves, except in the rows *lumps*: there one lump per 128 × 128 cells slides, and the "
            "time is that per cell of the whole field. With several threads the times are wall time. *copy* reads and writes one "
            "number per cell in the same run: it is the memory's roofline. *loop* computes one random number per cell without "
            "memory: so much can threads gain on this machine. Threads help from about N = 256 on, and only if their cores are "
            f"idle. On a shared machine the cores were not always idle. At N = {size}:\n\n" +
            markdown(["variant", "ns per cell", "times the copy"], lines))


def mass_drift(tables):
    table = tables["mass-drift"]

    def worst(datum):
        return max(abs(row["drift"]) for row in table.where(datum=datum) if row["method"] in PUBLIC)

    ours = max(abs(row["drift"]) for row in table.where(method="G"))
    return (f"Rules in floats lose or create sand: up to {worst(0):.1e} of it with the ground at 0. With the ground at 1000 cells, "
            f"as in a survey, it is up to {worst(1000):.1e}. The drift of G is {ours:g}, however long it "
            "runs: the integer that leaves one cell is the integer that enters the next.")


def certificate(tables):
    table = tables["certificate"]
    size = table.distinct("N")[-1]

    def row(method):
        return table.where(pile="low", method=method, N=size)[0]

    coarsest = table.where(pile="low", method="G")[0]
    return (f"The fluxes prove a bound on the distance to the right pile, without knowing that pile. The figure shows the bound "
            f"and the true distance. On the low pile at N = {size}, settle has a bound of {percent(row('settle')['bound'])} "
            f"and a distance of {percent(row('settle')['truth'])}. Plain G has {percent(row('G plain')['bound'])} and "
            f"{percent(row('G plain')['truth'])}. N4 has {percent(row('N4')['bound'])} and {percent(row('N4')['truth'])}. "
            "The bound is never below the distance. If the sand rests in the right state, cells of half the size reduce the "
            f"bound to about a quarter. From N = {coarsest['N']} to {size}, G's bound falls by a factor of "
            f"{coarsest['bound'] / row('G')['bound']:.1f}. N4's bound cannot fall below its distance, which stays.")


def budget(tables):
    table = tables["budget"]
    size = table.distinct("N", pile="low")[-1]

    def part(name):
        return percent(table.one("misplaced", pile="low", N=size, part=name))

    return (f"The figure splits one pile's error into its parts. For the low pile at N = {size}, the grid gives {part('grid')}, "
            f"the band {part('band')}, the height unit {part('bits')}, and stopping at half of the sweeps "
            f"{part('iteration 50 %')}. The last bar is the default as a whole.")


def rest(tables):
    rows = tables["rest"].rows + tables["rest-moving"].rows
    lines = [[r["field"], r["method"], r["N"], r["runs"], r["sweeps"], f"{r['seconds_median']:.3g}",
              f"{r['seconds_min']:.3g} … {r['seconds_max']:.3g}", f"{r['ratio']:.1f}", percent(r["error"])]
             for r in rows]
    return ("The table has the seconds until the sand rests. The reference is plain G with full sweeps and without band. The "
            "ratio is how many times faster a method is. The bumpy slope is a plane three times as steep as the talus in a "
            "closed box, where every cell moves. Rough fields have no closed form. Their error is the distance to settle's "
            "result, divided by the sand moved. A slow method is run fewer times.\n\n" +
            markdown(["field", "method", "N", "runs", "sweeps", "median [s]", "least … most [s]", "ratio", "error"], lines))


def parts(tables):
    table = tables["parts"]
    lines = [[r["N"], r["ground"], r["state"], f"{r['us_median']:.3g}", r["sweeps"], f"{r['bytes'] / 2**20:.1f}"]
             for r in table.rows]
    return ("A scene does not pay for parts that it does not need. Without bedrock, there is no array for it, and the law has no "
            "limiter of the layer. Settled sand takes no sweep, whatever the size of the field.\n\n" +
            markdown(["N", "bedrock", "state", "µs per step of 16 sweeps", "sweeps run", "memory [MiB]"], lines))


def explain(tables):
    table = tables["explain"]
    lines = []
    for r in table.rows:
        cost = "" if r["cost"] == "" else f"{r['cost']:.4g} µs" if r["unit"] == "us" else f"{r['cost'] / 1024:.0f} KiB"
        lines.append([r["kind"], r["part"], r["used"], cost, r["why"]])
    scene = next(note for note in table.notes if note.startswith("scene: "))
    return (f"`sandwall-bench explain SCENE` prints for any scene what it loads and runs, and what it leaves out. The table is "
            f"for `scenes/dunes.toml` ({scene[7:]}). Its libraries are those of the program `sandwall-bench`. A render rank "
            "also maps MPI and Mesa.\n\n" + markdown(["kind", "part", "used", "cost", "why"], lines))


def detail(tables):
    rows = [[f"{r['N']}²", f"{r['bound']:g}", f"{r['ms_median']:.1f} ({r['ms_min']:.1f} – {r['ms_max']:.1f})",
             f"{r['ratio']:.2f}", percent(r["bad"]), f"{r['mean']:.2f}", f"{r['triangles'] / 1000:.0f} k",
             percent(r["coarse"], 3)] for r in tables["detail"].rows]
    return ("llvmpipe draws one eye of a whole tile of 1024 × 768 pixels, while the head moves over dunes with a furrow. The "
            "bound is how far a level of detail may shift any sand in the picture. Bound 0 draws every cell. Ratio and errors "
            "compare with bound 0 in the same run.\n\n" +
            markdown(["field", "bound [pixel]", "draw [ms]", "ratio", "pixels beyond 8 levels", "mean difference [level]",
                      "triangles", "chunks above level 0"], rows))


def hashes(tables):
    lines, seen = [], {}
    for name, table in tables.items():
        if name.startswith("hashes-"):
            for scheme in table.distinct("scheme"):
                hashes_found = table.distinct("hash", scheme=scheme)
                seen.setdefault(scheme, set()).update(hashes_found)
                lines.append([table.fact("compiler"), f"`{table.fact('flags').split('-Werror')[-1].strip()}`", scheme,
                              ", ".join(map(str, table.distinct("code_path"))),
                              ", ".join(map(str, table.distinct("threads"))),
                              ", ".join(map(str, table.distinct("block"))), " ".join(map(str, hashes_found))])
    verdict = ("each scheme has one hash over all builds" if all(len(found) == 1 for found in seen.values())
               else "**the hashes differ**")
    text = (f"Every build that exists has computed 300 random drags on a field with odd sides: {verdict}.\n\n" +
            markdown(["compiler", "flags", "scheme", "code paths", "threads", "blocks", "hash"], lines))
    if "ranks" in tables:
        rows = [[r["ranks"], f"{r['session_hash']}", f"{r['replay_hash']}", r["divergences"]]
                for r in tables["ranks"].rows]
        text += ("\n\nIn whole sessions of 60 steps, every rank compares its hash with the others' in every frame. One process "
                 "then replays the journal, and must get the same hash.\n\n" +
                 markdown(["render ranks", "hash of the session", "hash of the replay", "divergences"], rows))
    return text


SECTIONS = [
    Section("Error against time, at one N", "work_precision", ["work-precision"], work_precision),
    Section("Least time for a wanted error", "envelope", ["work-precision"], envelope),
    Section("Seconds to rest", None, ["rest", "rest-moving"], rest),
    Section("Error at rest against N", "error_at_rest", ["error-at-rest"], error_at_rest),
    Section("Sweeps to rest against N", "sweeps", ["sweeps"], sweeps),
    Section("Roundness", "anisotropy", ["anisotropy"], anisotropy),
    Section("Motion until rest", "decay", ["decay"], decay),
    Section("Height bits", "height_bits", ["height-bits"], height_bits),
    Section("The hysteresis band", "band", ["band"], band),
    Section("One edit", "edit", ["edit"], edit),
    Section("Digging", "dig", ["dig"], dig),
    Section("Throughput", "throughput", ["throughput"], throughput),
    Section("Mass", "mass_drift", ["mass-drift"], mass_drift),
    Section("The certificate", "certificate", ["certificate"], certificate),
    Section("The parts of one pile's error", "budget", ["budget"], budget),
    Section("Springs that an arm bears", "stability", ["stability", "guarded-sweep"], stability),
    Section("Parts that a scene does not need", None, ["parts"], parts),
    Section("A scene explained", None, ["explain"], explain),
    Section("Picture error against draw time", "detail", ["detail"], detail),
    Section("Force between surfaces", "force_rate", ["force-rate"], force_rate),
    Section("Work of the force", None, ["force-work"], force_work),
    Section("Piles on a TIN", "tin_piles", ["tin-piles"], tin_piles),
    Section("A TIN of a raster", "tin_simplify", ["tin-simplify"], tin_simplify),
    Section("A tool in a TIN", None, ["tin-imprint", "tin-active"], tin_tool),
    Section("From the hand to the wall", None, [], latency),
    Section("One hash", None, [], hashes),
]
