# SPDX-License-Identifier: Apache-2.0
"""What the report says beside each figure: every number in it comes out of the tables."""

from dataclasses import dataclass
from typing import Callable, Optional

from latency import HEADER as LATENCY_HEADER, cells as latency_cells
from report_data import held, least_seconds, markdown, percent, seconds
from report_tin import tin_piles, tin_simplify, tin_tool

PUBLIC = ["float32 N4 in place", "float32 N4 Jacobi", "float32 N8 Jacobi", "float32 N8 sqrt2 Jacobi"]
OURS = ["G", "settle"]
WANTED = [0.1, 0.044, 0.04, 0.035, 0.03, 0.02, 0.014, 0.01, 0.005, 0.002, 0.001, 5e-4, 2e-4, 1e-4]  # errors


@dataclass
class Section:
    title: str
    figure: Optional[str]  # the function in report_figures, and the picture's name
    needs: list  # tables; the figure is drawn from the first
    reading: Callable


def work_precision(tables):
    table = tables["work-precision"]
    size = 128 if 128 in table.distinct("N") else table.distinct("N")[-1]
    best = {m: table.values("misplaced", pile="low", method=m, N=size)[-1] for m in OURS + PUBLIC}
    floors = ", ".join(f"{percent(best[m])} ({m})" for m in PUBLIC)
    return (f"The same pile from the same start, one point per sample of the run, at one N. On the low pile G comes to "
            f"{percent(best['G'])} and settle to {percent(best['settle'])}; the public rules stop at {floors}, however "
            f"long they run. Their error is in the shape: a diamond or an octagon is no circle at any N.")


def first_at(table, size):
    """Whether on fields of this size G takes less time than every public rule for every error below 4.4 %, N4's."""
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
            # An error that nobody reaches on these fields is nobody's loss.
            won.append(public is None or (ours is not None and ours <= public))
        last_lost = max((i for i, good in enumerate(won) if not good), default=-1)
        reach = min(row["misplaced"] for m in PUBLIC for row in runs[m])
        claim = (f"at every error of this table from {percent(wanted[last_lost + 1])} down" if last_lost + 1 < len(wanted)
                 else "at no error of this table")
        parts.append(f"**The {pile} pile.** G or settle takes less time than every public rule {claim}; below "
                     f"{percent(reach)} no public rule arrives at all.\n\n" + markdown(["at most"] + methods, rows))
    return ("What is the least time, over all N and all lengths of the run, for a wanted error? A coarse pile that has "
            "come to rest competes with a fine one that has not. An error counts from where the run never exceeds it "
            "again: eight neighbours without weights pass by the right pile on their way to the wrong one (the dip in the "
            "figure above), and nobody can know when to stop. *never*: no N and no time is enough.\n\n" +
            (f"At one N, from {first[0]} on, G takes less time than every public rule for every error of these tables below "
             "4.4 %, which is N4's own.\n\n" if first else "") + "\n\n".join(parts))


def error_at_rest(tables):
    table = tables["error-at-rest"]
    lines = []
    for pile in table.distinct("pile"):
        for method in ["G", "G plain", "settle", "N4"] + PUBLIC:
            rows = table.where(pile=pile, method=method)
            last = rows[-1]
            lines.append([pile, method, last["N"], percent(last["misplaced"]), f"{last['largest']:.2g}",
                          f"{last['apex']:+.2g}", f"{last['order']:.2f}", last["sweeps"]])
    return ("At rest, and for as long as floats creep after half as many sweeps as there are cells. G and settle converge "
            "with N; the largest error stays within a fraction of a cell, at the kinks of the profile, where a mean over "
            "a cell cannot be stable. The public rules keep their error at every N (order 0), and their largest error "
            "grows with N. At the largest N of each:\n\n" +
            markdown(["pile", "method", "N", "sand in the wrong place", "largest error [cell]", "apex error [cell]",
                      "order in N", "sweeps"], lines))


def sweeps(tables):
    table = tables["sweeps"]
    size = table.distinct("N", pile="low")[-1]
    plain = table.one("sweeps", pile="low", method="G plain", band=0, N=size)
    g = table.one("sweeps", pile="low", method="G", band=0, N=size)
    banded = table.one("sweeps", pile="low", method="G plain", band=0.001, N=size)
    return (f"Plain G needs sweeps as N²; inertia makes that {plain / g:.0f} times fewer at N = {size} ({g} for {plain}). "
            f"A band of 10⁻³ leaves plain G at {banded} sweeps, because sand that slides stops at the talus all the same.")


def anisotropy(tables):
    table = tables["anisotropy"]
    size = table.distinct("N")[-1]

    def worst(pile, method):
        return max(abs(value) for value in table.values("radius_error", pile=pile, method=method, N=size))

    lines = [[m] + [percent(worst(p, m)) for p in ("low", "tall")] for m in table.distinct("method")]
    return ("Where the pile's flank crosses half of its height, by direction; a quarter of the circle, the others are its "
            "mirror images. Largest error of the radius in any direction:\n\n" +
            markdown(["method", f"low pile, N = {size}", f"tall pile, N = {size}"], lines))


def decay(tables):
    table = tables["decay"]

    def reach(method, share):
        return next(row["sweeps"] for row in table.where(pile="low", method=method) if row["to_rest"] < share)

    return (f"How the low pile comes to rest. To within 0.1 % of where each will rest: {reach('G', 1e-3)} sweeps of G, "
            f"{reach('G plain', 1e-3)} of plain G, {reach('N4', 1e-3)} of N4. Integers end: the curves stop because "
            "nothing moves any more; in floats the last creep goes on.")


def height_bits(tables):
    table = tables["height-bits"]
    size = table.distinct("N", pile="low")[-1]

    def at(bits):
        return table.one("misplaced", pile="low", N=size, bits=bits)

    return (f"The same pile in coarser and finer height units; the line marks the 2⁻¹⁶ cells in use. From 16 to the "
            f"finest unit that fits the error of the low pile at N = {size} changes from {percent(at(16), 4)} to "
            f"{percent(table.where(pile='low', N=size)[-1]['misplaced'], 4)}: the grid decides, not the unit. At 8 bits "
            f"it is {percent(at(8))}.")


def band(tables):
    table = tables["band"]

    def at(method, width, column):
        return table.one(column, pile="low", method=method, band=width)

    return (f"Hysteresis is physics: sand starts to slide at a steeper angle than it comes to rest at. The pile of sand that "
            f"slid does not depend on the band: its error is {percent(at('G', 0, 'misplaced'), 3)} without a band and "
            f"{percent(at('G', 0.1, 'misplaced'), 3)} with 0.1, after {at('G', 0, 'sweeps')} and {at('G', 0.1, 'sweeps')} "
            f"sweeps of G.")


def edit(tables):
    table = tables["edit"]
    large = table.distinct("N")[-1]

    def gain(size, radius):
        return (table.one("ms_median", N=size, radius=radius, blocks="full") /
                table.one("ms_median", N=size, radius=radius, blocks="active"))

    return (f"One press into level sand and 16 sweeps. With active blocks the time depends on the tool and not on the "
            f"field; visiting every block instead takes {gain(large, 12):.0f} times as long at N = {large} with a tool of "
            f"12 cells, and gives the same sand bit for bit.")


def dig(tables):
    table = tables["dig"]
    lines = []
    for row in table.rows:
        lines.append([row["N"], row["R"], row["cells_per_step"], row["sweeps_per_step"], f"{row['ms_p50']:.2f}",
                      f"{row['ms_p99']:.2f}", percent(row["misplaced_held"]), percent(row["misplaced_lifted"]),
                      f"{row['bank']:.0f}", f"{row['bank_reach']:.0f}", row["steps_after"]])
    idle = max(table.values("idle_us"))
    return ("A sphere with its centre at the level of the sand, dragged along the diagonal for 200 steps. *Behind the "
            "hand*: sum of |height − height once settled| over that of |the latter − level|, with the tool held where it "
            "stands; *lifted*: without it, so that the hole it leaves has to fill too. *Bank*: the highest sand over the "
            "level; *reach*: how far from the stroke's line sand stands half a cell higher than once settled. *After*: "
            "steps after lifting until 1 % is left. Lines mark 2 ms and 10 %. A step of settled sand takes at most "
            f"{idle:.1f} µs.\n\n" +
            markdown(["N", "R [cells]", "cells/step", "sweeps/step", "p50 [ms]", "p99 [ms]", "behind", "lifted",
                      "bank [cells]", "reach [cells]", "after"], lines))


def throughput(tables):
    table = tables["throughput"]
    size = 512 if 512 in table.distinct("N") else table.distinct("N")[-1]
    lines = [[v, f"{table.one('ns_per_cell_median', variant=v, N=size):.2f}",
              f"{table.one('times_copy', variant=v, N=size):.1f}"] for v in table.distinct("variant")]
    return (f"A field in which everything moves; wall time where there are several threads. *copy* reads and writes one number per cell in the same run: "
            f"the memory's roofline. Sweeps compute square roots and are far from it. Threads pay from about N = 256 on, "
            f"and only where their cores are idle; on a shared machine they were not always. At N = {size}:\n\n" +
            markdown(["variant", "ns per cell", "times the copy"], lines))


def mass_drift(tables):
    table = tables["mass-drift"]

    def worst(datum):
        return max(abs(row["drift"]) for row in table.where(datum=datum) if row["method"] in PUBLIC)

    ours = max(abs(row["drift"]) for row in table.where(method="G"))
    return (f"Sand that floats lose or invent: up to {worst(0):.1e} of it with the ground at 0, and {worst(1000):.1e} with "
            f"the ground at 1000 cells, as a survey's is. G's drift is {ours:g}, for as long as it runs: what leaves a cell "
            "is the integer that enters the next.")


def certificate(tables):
    table = tables["certificate"]
    size = table.distinct("N")[-1]

    def row(method):
        return table.where(pile="low", method=method, N=size)[0]

    coarsest = table.where(pile="low", method="G")[0]
    return (f"What the fluxes prove about the distance to the right pile, and the distance itself, without knowing the "
            f"former. On the low pile at N = {size}: settle {percent(row('settle')['bound'])} proved, "
            f"{percent(row('settle')['truth'])} true; plain G {percent(row('G plain')['bound'])} and "
            f"{percent(row('G plain')['truth'])}; N4 {percent(row('N4')['bound'])} and {percent(row('N4')['truth'])}. "
            "The bound is never below the truth. With cells of half the size it falls to about a quarter where the rest "
            f"state is the right one (from N = {coarsest['N']} to {size} by a factor of {coarsest['bound'] / row('G')['bound']:.1f} "
            "for G); N4's cannot fall below its truth, which stays.")


def budget(tables):
    table = tables["budget"]
    size = table.distinct("N", pile="low")[-1]

    def part(name):
        return percent(table.one("misplaced", pile="low", N=size, part=name))

    return (f"One pile's error, taken apart: the grid gives {part('grid')} at N = {size} (low pile), the band {part('band')}, "
            f"the height unit {part('bits')}, and stopping at half of the sweeps {part('iteration 50 %')}. The last bar is "
            "the default as a whole.")


def rest(tables):
    rows = tables["rest"].rows + tables["rest-moving"].rows
    lines = [[r["field"], r["method"], r["N"], r["runs"], r["sweeps"], f"{r['seconds_median']:.3g}",
              f"{r['seconds_min']:.3g} … {r['seconds_max']:.3g}", f"{r['ratio']:.1f}", percent(r["error"])]
             for r in rows]
    return ("Seconds to rest against plain G with full sweeps and without band, the reference; the ratio is how many times "
            "faster. The bumpy slope is a plane three times as steep as the talus in a closed box, where every cell moves; "
            "its error is the distance to settle's result over the sand moved, since rough fields have no closed form. A "
            "slow method is run fewer times.\n\n" +
            markdown(["field", "method", "N", "runs", "sweeps", "median [s]", "least … most [s]", "ratio", "error"], lines))


def parts(tables):
    table = tables["parts"]
    lines = [[r["N"], r["ground"], r["state"], f"{r['us_median']:.3g}", r["sweeps"], f"{r['bytes'] / 2**20:.1f}"]
             for r in table.rows]
    return ("What a scene does not need it does not pay for: without bedrock no array for it and a law without the layer's "
            "limiter; settled sand takes no sweep, whatever the field's size.\n\n" +
            markdown(["N", "bedrock", "state", "µs per step of 16 sweeps", "sweeps run", "memory [MiB]"], lines))


def stability(tables):
    table, sweep = tables["stability"], tables["guarded-sweep"]
    apart = max(abs(r["textbook"] / r["theory"] - 1) for r in table.rows)
    least = min(r["bears"] for r in table.rows)
    lines = []
    for name in sweep.distinct("arm"):
        for hand in sweep.distinct("hand"):
            rows = sweep.where(arm=name, hand=hand)
            trials = sum(r["trials"] for r in rows)
            lines.append([name, hand, trials, f"{sum(r['rest'] * r['trials'] for r in rows):.0f}",
                          f"{max(r['force'] for r in rows):.3g} of {rows[0]['max_force']:g} N",
                          percent(max(r["deviation"] for r in rows)), percent(min(r["unlimited"] for r in rows)),
                          f"{sum(r['literal_rest'] * r['trials'] for r in rows):.0f}",
                          f"{max(r['literal_force'] for r in rows):.3g} N"])
    return (f"The stiffest spring on which an arm comes to rest, by its damping. Mass and damping alone diverge within "
            f"{percent(apart)} of b/(T/2 + t_d). A coarse encoder moves the limit of the whole arm down, Coulomb's "
            f"friction and a motor that saturates move it up: what a Touch bears beyond the theory it owes to its 0.26 N of "
            f"friction. Behind the guards an arm rests whatever a law asks for (tried up to {least:.3g} N/m), because it "
            f"gets half of what the theory allows, or of what its maker does.\n\nThe first paper's constants in full, over "
            f"damping, delay, depth and speed; *unlimited* is the least share of ticks in the sand in which nothing but "
            f"the lowered constants acts, and there the force differs from the law by at most the *deviation*:\n\n" +
            markdown(["arm", "", "trials", "guarded: rest", "most force", "deviation", "unlimited", "literal: rest",
                      "most asked"], lines))


def explain(tables):
    table = tables["explain"]
    lines = []
    for r in table.rows:
        cost = "" if r["cost"] == "" else f"{r['cost']:.4g} µs" if r["unit"] == "us" else f"{r['cost'] / 1024:.0f} KiB"
        lines.append([r["kind"], r["part"], r["used"], cost, r["why"]])
    scene = next(note for note in table.notes if note.startswith("scene: "))
    return (f"`sandwall-bench explain SCENE` says of any scene what it loads and runs, and what it leaves out; here for "
            f"`scenes/dunes.toml` ({scene[7:]}). Libraries are those of this program; a render rank maps MPI and Mesa "
            "besides.\n\n" + markdown(["kind", "part", "used", "cost", "why"], lines))


def detail(tables):
    rows = [[f"{r['N']}²", f"{r['bound']:g}", f"{r['ms_median']:.1f} ({r['ms_min']:.1f} – {r['ms_max']:.1f})",
             f"{r['ratio']:.2f}", percent(r["bad"]), f"{r['mean']:.2f}", f"{r['triangles'] / 1000:.0f} k",
             percent(r["coarse"], 3)] for r in tables["detail"].rows]
    return ("One eye of a tile of 1024 × 768 pixels, drawn whole by llvmpipe while the head moves, dunes with a furrow. The "
            "bound is how far a level of detail may shift any sand in the picture; bound 0 draws every cell, and ratio and "
            "errors are against it, in the same run.\n\n" +
            markdown(["field", "bound [pixel]", "draw [ms]", "ratio", "pixels beyond 8 levels", "mean difference [level]",
                      "triangles", "chunks above level 0"], rows))


def force_rate(tables):
    table = tables["force-rate"]
    rate = min(table.distinct("rate"), key=lambda r: abs(r - 60))
    lines = [[r["law"], r["method"], f"{r['rms']:.3g}", percent(r["share"]), f"{r['most']:.2g}", f"{r['jump']:.2g}",
              f"{r['truth_jump']:.2g}", f"{r['us_median']:.2g}", f"{r['us_p99']:.2g}"]
             for r in table.rows if r["rate"] == rate]
    return ("What is felt between two surfaces of the sand, against the law evaluated at every tick on that tick's sand, "
            "while the hand writes, presses and lifts; *jump* is the most that the force changes from a tick to the next. "
            "*local* is the default. *local at once*, without its recovery, is the most exact and leaps at every surface; what recovery "
            "is for is stability, and [figures.md](../figures.md#the-stiffest-spring) says how much there is of that: "
            "hold and eq. 9 bear 60 and 31 N/m where local bears 1000. The second law pays most for it: its control points "
            "lie where the tool cuts a wall a cell thick, whose unrest recovery turns into an error of one sign. Where that "
            f"counts more than stiffness, a scene takes hold or eq. 9. At {rate:g} surfaces per second:\n\n" +
            markdown(["law", "method", "RMS error [N]", "share", "most [N]", "jump [N]", "jump of truth [N]", "µs per tick",
                      "p99 [µs]"], lines))


def force_work(tables):
    lines = [[r["law"], f"{r['slope']:g}", f"{r['shallow']:g}", f"{1e3 * r['net']:.3g}", percent(r["share"])]
             for r in tables["force-work"].rows]
    return ("Once round a circle that stands on the slope, a radius across, in sand that lies still; friction apart. On "
            "level sand neither law does work on a path that closes. On a slope neither has a potential: the first turns "
            "its force with the depth, the second pushes aside by the depth. Negative: the hand loses. The other way "
            "round it gains as much, which is what the passivity observer is for.\n\n" +
            markdown(["law", "slope", "least depth [R]", "net work [mN · scene unit]", "share of what is exchanged"], lines))


def latency(tables):
    if "latency" not in tables:
        return "Left out of the quick report: `sandwall-bench latency` measures it, in some ten minutes."
    table = tables["latency"]
    return ("Half of the round trip of a test message as long as a step's, at random times, until the wall has swapped and until "
            "the master has it; [what each column is](../latency.md).\n\n" +
            markdown(LATENCY_HEADER, [latency_cells(row) for row in table.rows]) + "\n\n" +
            "\n".join(f"- {note}" for note in table.notes if not note.startswith(("command: ", "date: "))) +
            f"\n\n*[latency](data/latency.csv): `{table.fact('command')}`*")


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
    verdict = ("one hash per scheme over all of them" if all(len(found) == 1 for found in seen.values())
               else "**they differ**")
    text = (f"300 random drags on a field of odd sides, by every build that is there: {verdict}.\n\n" +
            markdown(["compiler", "flags", "scheme", "code paths", "threads", "blocks", "hash"], lines))
    if "ranks" in tables:
        rows = [[r["ranks"], f"{r['session_hash']}", f"{r['replay_hash']}", r["divergences"]]
                for r in tables["ranks"].rows]
        text += ("\n\nWhole sessions of 60 steps: every rank compares its hash with the others' in every frame, and one "
                 "process that replays the journal must come to the same.\n\n" +
                 markdown(["render ranks", "hash of the session", "hash of the replay", "divergences"], rows))
    return text


SECTIONS = [
    Section("Error against time, at one N", "work_precision", ["work-precision"], work_precision),
    Section("Least time for a wanted error", "envelope", ["work-precision"], envelope),
    Section("Seconds to rest", None, ["rest", "rest-moving"], rest),
    Section("Error at rest against N", "error_at_rest", ["error-at-rest"], error_at_rest),
    Section("Sweeps to rest against N", "sweeps", ["sweeps"], sweeps),
    Section("Roundness", "anisotropy", ["anisotropy"], anisotropy),
    Section("How motion dies down", "decay", ["decay"], decay),
    Section("Height bits", "height_bits", ["height-bits"], height_bits),
    Section("The hysteresis band", "band", ["band"], band),
    Section("One edit", "edit", ["edit"], edit),
    Section("Digging", "dig", ["dig"], dig),
    Section("Throughput", "throughput", ["throughput"], throughput),
    Section("Mass", "mass_drift", ["mass-drift"], mass_drift),
    Section("The certificate", "certificate", ["certificate"], certificate),
    Section("Where one pile's error comes from", "budget", ["budget"], budget),
    Section("Springs that an arm bears", "stability", ["stability", "guarded-sweep"], stability),
    Section("What a scene does not need", None, ["parts"], parts),
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
