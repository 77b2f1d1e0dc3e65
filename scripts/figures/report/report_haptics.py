# SPDX-License-Identifier: Apache-2.0
"""Text of the report on arms, forces and the time from hand to wall. Every result in it comes from the tables."""

from report.report_claims import count_of, listing, times
from report.report_data import markdown, percent
from sessions.latency import HEADER as LATENCY_HEADER, cells as latency_cells

MOST_TRIED = 1e6  # [N/m], the stiffest law that the curve `stability` tries


def stability(tables):
    table, sweep = tables["stability"], tables["guarded-sweep"]
    apart = max(abs(r["textbook"] / table_positive(table, r, "theory") - 1) for r in table.rows)
    least = min(table.rows, key=lambda r: r["bears"])
    bears = (f"an arm rests with each stiffness that was tried, up to {MOST_TRIED:.3g} N/m" if least["bears"] >= MOST_TRIED else
             f"the arm {least['arm']} stops resting above {least['bears']:.3g} N/m (b = {least['b']:g})")
    most = max(r["guarded"] / r["theory"] for r in table.rows)

    def literal(name):
        ratios = [r["literal"] / r["theory"] for r in table.some(arm=name)]
        return f"{name} {min(ratios):.2g} to {max(ratios):.2g}"

    lines = []
    for name in sweep.distinct("arm"):
        for hand in sweep.distinct("hand", arm=name):
            rows = sweep.some(arm=name, hand=hand)
            lines.append([name, hand, sum(r["trials"] for r in rows), f"{sum(r['rest'] * r['trials'] for r in rows):.0f}",
                          f"{max(r['force'] for r in rows):.3g} of {rows[0]['max_force']:g} N",
                          percent(max(r["deviation"] for r in rows)), percent(min(r["unlimited"] for r in rows)),
                          f"{sum(r['literal_rest'] * r['trials'] for r in rows):.0f}",
                          f"{max(r['literal_force'] for r in rows):.3g} N"])
    trials, guarded, bare = (sum(r[what] if what == "trials" else r[what] * r["trials"] for r in sweep.rows)
                             for what in ("trials", "rest", "literal_rest"))
    return (f"The figure shows, over the damping, the stiffest spring on which an arm comes to rest. An arm of mass and damping "
            f"alone diverges at a stiffness within {percent(apart)} of b/(T/2 + t_d). The limit of a whole arm, with its encoder, friction "
            f"and motor, is so many times that: {listing(map(literal, table.distinct('arm')))}. Behind the guards {bears}. The guards "
            f"allow at most {most:.2g} of the stiffness of the theory.\n\nThe table has trials with the full constants of Dorjgotov "
            "et al. 2007, over damping, delay, depth and speed. The columns *guarded* have the law behind the guards, and *literal* the "
            "law as its paper has it. The column *unlimited* has the least share of ticks in the sand in which the lowered constants act "
            "alone. In these ticks the force differs from the law by at most the *deviation*. "
            f"Behind the guards {guarded:.0f} of {trials} trials come to rest, and with the literal law {bare:.0f}:\n\n" +
            markdown(["arm", "hand", "trials", "guarded: rest", "guarded: largest force", "deviation", "unlimited",
                      "literal: rest", "literal: largest force asked"], lines))


def table_positive(table, row, column):
    return table.positive(column, arm=row["arm"], delay=row["delay"], b=row["b"])


def force_rate(tables):
    table = tables["force-rate"]
    rate = min(table.distinct("rate"), key=lambda r: abs(r - 60))
    lines = [[r["law"], r["method"], f"{r['rms']:.3g}", percent(r["share"]), f"{r['most']:.2g}", f"{r['jump']:.2g}",
              f"{r['truth_jump']:.2g}", f"{r['us_median']:.2g}", f"{r['us_p99']:.2g}"]
             for r in table.some(rate=rate)]

    def of_law(law):
        rows = table.some(law=law, rate=rate)
        exact, smooth = min(rows, key=lambda r: r["rms"]), min(rows, key=lambda r: r["jump"])
        local = table.some(law=law, rate=rate, method="local")[0]
        return (f"With the law *{law}* the smallest error has *{exact['method']}* ({percent(exact['share'])}, with jumps of {exact['jump']:.2g} N), "
                f"and the smallest jumps *{smooth['method']}* ({smooth['jump']:.2g} N, with an error of {percent(smooth['share'])}). The error "
                f"of the default is {times(local['rms'], exact['rms'])} the smallest one.")

    return ("The hand writes, presses and lifts. The force that it feels between two surfaces of the sand is compared with the "
            "law, evaluated in each tick on that tick's sand. The *jump* is the largest change of the force from a tick to the "
            "next. The method *local* is the default, and *local at once* is the same without recovery. Recovery is there for "
            "the stability of the arm: [figures.md](../figures.md#the-stiffest-spring) has the stiffest spring of each method. A scene "
            f"can take another method. At {rate:g} surfaces per second:\n\n" +
            " ".join(of_law(law) for law in table.distinct("law", rate=rate)) + "\n\n" +
            markdown(["law", "method", "RMS error [N]", "share", "most [N]", "jump [N]", "jump of truth [N]", "µs per tick",
                      "p99 [µs]"], lines))


def force_work(tables):
    table = tables["force-work"]
    lines = [[r["law"], f"{r['slope']:g}", f"{r['shallow']:g}", f"{1e3 * r['net']:.3g}", percent(r["share"])]
             for r in table.rows]

    def of_law(law):
        level = max(r["share"] for r in table.some(law=law, slope=0))
        slopes = [r for r in table.some(law=law) if r["slope"] > 0]
        if level > 1e-6:
            return f"The work of *{law}* is up to {percent(level)} on level sand already"
        if not slopes or max(r["share"] for r in slopes) < 1e-6:
            return f"The work of *{law}* is rounding everywhere, so that it has a potential"
        return (f"The work of *{law}* on level sand is rounding ({percent(level)}), and up to "
                f"{percent(max(r['share'] for r in slopes))} on a slope, where it has no potential. The hand loses energy in "
                f"{count_of(slopes, lambda r: r['net'] < 0, 'turn')}")

    return ("The tool moves once round an upright circle on the slope, one radius across, in still sand and without friction. "
            f"{'. '.join(map(of_law, table.distinct('law')))}. In the other direction of the circle the sign of the work changes: "
            "[forces.md](../forces.md) explains the passivity observer.\n\n" +
            markdown(["law", "slope", "least depth [R]", "net work [mN · scene unit]", "share of the work exchanged"], lines))


def latency(tables):
    table = tables["latency"]
    slowest = max(table.rows, key=lambda r: r["wall_mean"])
    faster = count_of(table.rows, lambda r: r["wall_mean"] < r["paper_mean"], "row")
    return ("A test message as long as a step's is sent at random times. The table has half of its round trip: until the wall "
            "has swapped, and until the master has the message. [latency.md](../latency.md) explains the columns. The mean until the "
            f"wall has swapped is below that of Dorjgotov et al. 2007 in {faster}, and at most {slowest['wall_mean']:.1f} ms "
            f"({slowest['wall']}, {slowest['link']}, {slowest['load']}).\n\n" +
            markdown(LATENCY_HEADER, [latency_cells(row) for row in table.rows]) + "\n\n" +
            "\n".join(f"- {note}" for note in table.notes if not note.startswith(HEAD)))


HEAD = ("command: ", "date: ", "release: ", "commit: ", "source: ", "algorithm: ", "load: ", "took: ", "seed: ")
