# SPDX-License-Identifier: Apache-2.0
"""Text of the report on piles in the grid. Every number and every result in it comes from the tables."""

from report.report_claims import compared, convergence, count_of, growth, listing, times
from report.report_data import held, least_seconds, markdown, percent, seconds, usual_size

PUBLIC = ["float32 N4 in place", "float32 N4 Jacobi", "float32 N8 Jacobi", "float32 N8 sqrt2 Jacobi"]
OURS = ["G", "settle"]
METHODS = ["G", "G plain", "settle", "N4"] + PUBLIC
WANTED = [0.1, 0.044, 0.04, 0.035, 0.03, 0.02, 0.014, 0.01, 0.005, 0.002, 0.001, 5e-4, 2e-4, 1e-4]  # the errors in the tables of least time


def stopped(rows):
    """Whether a run is at rest, or has changed its error by less than 1 % since half of its sweeps."""
    last = rows[-1]
    half = [row for row in rows if 2 * row["sweeps"] <= last["sweeps"]]
    return bool(last["at_rest"]) or bool(half) and abs(half[-1]["misplaced"] / last["misplaced"] - 1) < 0.01


def work_precision(tables):
    table = tables["work-precision"]
    size = usual_size(table)
    runs = {m: table.some(pile="low", method=m, N=size) for m in METHODS}
    last = {m: rows[-1]["misplaced"] for m, rows in runs.items()}
    ends = listing(f"{percent(last[m])} ({m})" for m in PUBLIC)
    passes = [m for m in METHODS if min(row["misplaced"] for row in runs[m]) < 0.8 * last[m]]
    dips = listing(f"{m} comes to {percent(min(row['misplaced'] for row in runs[m]))} on its way to {percent(last[m])}" for m in passes)
    return (f"The figure shows the same pile from the same start at one N, with one point per sample of the run. On the low "
            f"pile G ends at {percent(last['G'])} and settle at {percent(last['settle'])}. The public rules end at {ends}. With "
            f"{count_of(PUBLIC, lambda m: stopped(runs[m]), 'rule')} the run has come to rest, or has changed its error by less than "
            f"1 % since half of its sweeps. "
            f"The error of G is {percent(last['G'])}; it is {compared(last['G'], {m: last[m] for m in PUBLIC})}." +
            (f" Some runs pass by a smaller error than that at their end: {dips}." if passes else ""))


def errors_won(table, size):
    """Returns the largest wanted error from which on down G takes less time than each public rule, or None."""
    won = None
    for error in reversed(WANTED):
        for pile in table.distinct("pile", N=size):
            ours, *public = (least_seconds(held(table.some(pile=pile, method=m, N=size)), error) for m in ["G"] + PUBLIC)
            reached = [value for value in public if value is not None]
            if reached and (ours is None or ours > min(reached)):
                return won
        won = error
    return won


def claim(least):
    """Returns where G or settle takes less time than the public rules. `least`: by wanted error, the least times by method."""
    won = []
    for error in WANTED:
        ours, public = (min((least[error][m] for m in some if least[error][m] is not None), default=None) for some in (OURS, PUBLIC))
        # If no public rule reaches an error on these fields, this project has not lost there.
        won.append(public is None or (ours is not None and ours <= public))
    last_lost = max((i for i, good in enumerate(won) if not good), default=-1)
    return (f"at the errors of this table from {percent(WANTED[last_lost + 1])} down" if last_lost + 1 < len(WANTED)
            else "at no error of this table")


def envelope(tables):
    table = tables["work-precision"]
    parts = []
    for pile in table.distinct("pile"):
        runs = {m: held(table.some(pile=pile, method=m)) for m in METHODS}
        least = {error: {m: least_seconds(runs[m], error) for m in METHODS} for error in WANTED}
        rows = [[percent(error)] + [seconds(least[error][m]) for m in METHODS]
                for error in WANTED if any(value is not None for value in least[error].values())]
        reach = {m: min(row["misplaced"] for row in runs[m]) for m in METHODS}
        parts.append(f"**The {pile} pile.** G or settle takes less time than the public rules {claim(least)}. The smallest error of a "
                     f"public rule is {percent(min(reach[m] for m in PUBLIC))}, and of G or settle "
                     f"{percent(min(reach[m] for m in OURS))}.\n\n" + markdown(["error at most"] + METHODS, rows))
    won = {size: errors_won(table, size) for size in table.distinct("N")}
    at_one = listing(f"{'no error' if won[size] is None else percent(won[size])} at N = {size}" for size in won)
    return ("How long does a method need for a wanted error, at its best N and length of the run? A coarse pile that has come "
            "to rest competes with a fine one that has not. An error counts from the point where the run does not exceed it "
            "again, because a user cannot know when to stop. The entry *never* means that the method does not reach this error in "
            f"this table.\n\nAt one N, G takes less time than the public rules from this error down: {at_one}.\n\n" +
            "\n\n".join(parts))


def error_at_rest(tables):
    table = tables["error-at-rest"]
    lines, orders = [], {}
    largest = {m: [] for m in METHODS}
    for pile in table.distinct("pile"):
        for method in METHODS:
            rows = table.some(pile=pile, method=method)
            last = rows[-1]
            orders.setdefault(method, []).extend(row["order"] for row in rows[1:])
            largest[method].append([row["largest"] for row in rows])
            lines.append([pile, method, last["N"], percent(last["misplaced"]), f"{last['largest']:.2g}",
                          f"{last['apex']:+.2g}", "–" if len(rows) < 2 else f"{last['order']:.2f}", last["sweeps"]])
    words = ". ".join(f"That of {m} {convergence(orders[m])}" for m in METHODS)
    ours = max(value for m in OURS for values in largest[m] for value in values)
    rises = [m for m in PUBLIC if all(values[-1] > 1.5 * values[0] for values in largest[m])]
    return ("The figure shows the error at rest. A method in floats may creep without end: it stops after half as many sweeps "
            f"as there are cells. What happens to the error as N doubles? {words}. The largest error of a cell is up to "
            f"{ours:.2g} cells with G and settle. It rises from the smallest N to the largest by more than half with "
            f"{listing(rises)} of the public rules. At the largest N of each method:\n\n" +
            markdown(["pile", "method", "N", "sand in the wrong place", "largest error [cell]", "apex error [cell]",
                      "order in N", "sweeps"], lines))


def sweeps(tables):
    table = tables["sweeps"]
    size = table.distinct("N", pile="low", method="G plain")[-1]
    rows = table.some(pile="low", method="G plain", band=0)
    plain, g = table.positive("sweeps", pile="low", method="G plain", band=0, N=size), table.positive("sweeps", pile="low", method="G", band=0, N=size)
    banded = table.one("sweeps", pile="low", method="G plain", band=0.001, N=size)
    growing = f"The sweeps of plain G grow {growth(rows[-1]['exponent'])} from the last N to this one. " if len(rows) > 1 else ""
    return (f"The figure shows how many sweeps bring the sand to rest. At N = {size} plain G takes {plain} sweeps on the low pile, and "
            f"G, with inertia, {g}. The sweeps of plain G are {times(plain, g)} those of G. {growing}With a band of 10⁻³ plain G "
            f"takes {banded}, {times(banded, plain)} those without a band.")


def anisotropy(tables):
    table = tables["anisotropy"]
    size = table.distinct("N")[-1]

    def worst(pile, method):
        return max(abs(value) for value in table.values("radius_error", pile=pile, method=method, N=size))

    def shape(method):
        rows = [row for row in table.some(pile="low", method=method, N=size) if row["degrees"] <= 90]
        widest, narrowest = (pick(rows, key=lambda row: row["radius_error"]) for pick in (max, min))
        apart = (1 + widest["radius_error"]) / (1 + narrowest["radius_error"]) - 1
        return f"{percent(apart)} for {method} (widest at {widest['degrees']:g}°, narrowest at {narrowest['degrees']:g}°)"

    methods = table.distinct("method", N=size)
    lines = [[m] + [percent(worst(p, m)) for p in ("low", "tall")] for m in methods]
    return ("The figure shows in each direction the radius at which the pile's flank crosses half of its height. It shows "
            "a quarter of the circle, because the other quarters are mirror images. The widest radius of the low pile exceeds its "
            f"narrowest by {listing(map(shape, methods))}. The table has the largest error of the radius in any direction:\n\n" +
            markdown(["method", f"low pile, N = {size}", f"tall pile, N = {size}"], lines))


def decay(tables):
    table = tables["decay"]

    def reach(method):
        found = [row["sweeps"] for row in table.some(pile="low", method=method) if row["to_rest"] < 1e-3]
        return f"{found[0]} sweeps with {method}" if found else f"more sweeps than the table has with {method}"

    def end(method):
        last = table.some(pile="low", method=method)[-1]
        still = f"{last['moved']:.1e} of the volume moves in a sweep" if last["moved"] > 0 else "the sand rests"
        return f"{method}: {percent(last['to_rest'])} from it after {last['sweeps']} sweeps, where {still}"

    methods = table.distinct("method")
    return ("The figure shows how the low pile comes to rest. The distance to its own state at rest falls below 0.1 % after "
            f"{listing(map(reach, methods))}. The ends of the curves: {'; '.join(map(end, methods))}.")


def height_bits(tables):
    table = tables["height-bits"]
    size = table.distinct("N", pile="low")[-1]
    finest = table.some(pile="low", N=size)[-1]

    def at(bits):
        return table.positive("misplaced", pile="low", N=size, bits=bits)

    change = finest["misplaced"] / at(16) - 1
    decides = ("So the grid decides, not the unit" if abs(change) < 0.05 else "So the unit counts, too")
    return (f"The figure shows the same pile in coarser and finer height units. The line marks the unit in use, 2⁻¹⁶ cells. From "
            f"16 bits to {finest['bits']}, the error of the low pile at N = {size} changes from {percent(at(16), 4)} to "
            f"{percent(finest['misplaced'], 4)}, by {percent(change)} of itself. {decides}. At 8 bits the error is {percent(at(8))}, "
            f"{times(at(8), at(16))} that at 16.")


def band(tables):
    table = tables["band"]

    def at(width, column):
        return table.one(column, pile="low", method="G", band=width)

    none, wide = table.positive("misplaced", pile="low", method="G", band=0), at(0.1, "misplaced")
    depends = "hardly depends" if abs(wide / none - 1) < 0.05 else "depends"
    return (f"Hysteresis is physics: the angle at which sand starts to slide is steeper than the angle at which it comes to "
            f"rest. The pile of sand that has slid {depends} on the band: its error is {percent(none, 3)} without a band and "
            f"{percent(wide, 3)} with a band of 0.1, after {at(0, 'sweeps')} and {at(0.1, 'sweeps')} sweeps of G.")


def mass_drift(tables):
    table = tables["mass-drift"]

    def worst(methods, datum):
        return max((abs(row["drift"]) for row in table.some(datum=datum) if row["method"] in methods), default=0)

    ours = max(worst(["G"], datum) for datum in table.distinct("datum"))
    longest = max(row["sweeps"] for row in table.some(method="G"))
    floats = listing(f"{worst(PUBLIC, datum):.1e} of it with the ground at {datum} cells" for datum in table.distinct("datum"))
    why = ", because the integer that leaves one cell is the integer that enters the next" if ours == 0 else ""
    return (f"Rules in floats lose or create sand by rounding: up to {floats}. In a survey, the ground may well be at 1000 cells. The "
            f"drift of G is {'exactly 0' if ours == 0 else f'up to {ours:.1e}'} in up to {longest} sweeps{why}.")


def certificate(tables):
    table = tables["certificate"]
    sizes = table.distinct("N")

    def row(method, size=sizes[-1]):
        return table.some(pile="low", method=method, N=size)[0]

    lines = listing(f"{percent(row(m)['bound'])} and {percent(row(m)['truth'])} with {m}" for m in table.distinct("method"))
    falls = [f"from {percent(row(m, sizes[0])['bound'])} to {percent(row(m)['bound'])} with {m}" for m in ("G", "settle", "N4")]
    return ("The fluxes prove a bound on the distance to the right pile, without knowing that pile. The figure shows the bound "
            f"and the true distance. On the low pile at N = {sizes[-1]} the bound and the distance are {lines}. The bound is at "
            f"least the distance in {count_of(table.rows, lambda r: r['bound'] >= r['truth'], 'row')}. From N = {sizes[0]} to "
            f"{sizes[-1]} the bound goes {listing(falls)}.")


def budget(tables):
    table = tables["budget"]
    size = table.distinct("N", pile="low")[-1]
    rows = [row for row in table.some(pile="low", N=size) if not row["part"].startswith("all")]
    largest = max((row for row in rows if not row["part"].startswith("iteration")), key=lambda row: row["misplaced"])
    return (f"The figure splits one pile's error into its parts. For the low pile at N = {size}: "
            f"{', '.join(row_name(row) + ' ' + percent(row['misplaced']) for row in rows)}. At rest, the largest part is "
            f"{row_name(largest)}. The last bar is the default as a whole.")


def row_name(row):
    return {"bits": "the height unit", "iteration 25 %": "stopping at a quarter of the sweeps", "iteration 50 %": "at half",
            "iteration 90 %": "at nine tenths"}.get(row["part"], f"the {row['part']}")


def rest(tables):
    rows = tables["rest"].rows + tables["rest-moving"].rows
    lines = [[r["field"], r["method"], r["N"], r["runs"], r["sweeps"], f"{r['seconds_median']:.3g}",
              f"{r['seconds_min']:.3g} … {r['seconds_max']:.3g}", "–" if r["ratio"] == "" else f"{r['ratio']:.1f}", percent(r["error"])]
             for r in rows]
    fastest = []
    for field, size in dict.fromkeys((r["field"], r["N"]) for r in rows):
        of_field = [r for r in rows if (r["field"], r["N"]) == (field, size)]
        best = min(of_field, key=lambda r: r["seconds_median"])
        fastest.append(f"{best['method']} on the {field} at N = {size} ({best['seconds_median']:.3g} s)")
    return ("The table has the seconds until the sand rests. The reference is plain G with full sweeps and without band. The "
            "ratio is how many times faster than the reference a method is. The bumpy slope is a plane three times as steep as the "
            "talus in a closed box. It has no closed form: its error is the distance to settle's result, divided by the sand moved. "
            f"The least median has {listing(fastest)}.\n\n" +
            markdown(["field", "method", "N", "runs", "sweeps", "median [s]", "least … most [s]", "ratio", "error"], lines))
