# SPDX-License-Identifier: Apache-2.0
"""Text of the report on arms, forces and the time from hand to wall."""

from latency import HEADER as LATENCY_HEADER, cells as latency_cells
from report_data import markdown, percent


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
    return (f"The figure shows, over the damping, the stiffest spring on which an arm comes to rest. An arm of mass and damping "
            f"alone diverges at a stiffness within {percent(apart)} of b/(T/2 + t_d). A coarse encoder lowers the limit of the whole arm. "
            "Coulomb friction and a motor that saturates raise it: a Touch bears more than the theory because of its 0.26 N "
            "of friction. Behind the guards an arm rests whatever stiffness a law requests (tried up to "
            f"{least:.3g} N/m). The reason is that the arm gets half of the stiffness that the theory allows, or half of what "
            "its maker allows.\n\nThe table has trials with the full constants of Dorjgotov et al. 2007, over damping, delay, "
            "depth and speed. The columns *guarded* have the law behind the guards, and *literal* the law as its paper has it. "
            "The column *unlimited* has the least share of ticks in the sand in which only the lowered constants act. In these ticks the force differs "
            "from the law by at most the *deviation*:\n\n" +
            markdown(["arm", "hand", "trials", "guarded: rest", "guarded: largest force", "deviation", "unlimited",
                      "literal: rest", "literal: largest force asked"], lines))


def force_rate(tables):
    table = tables["force-rate"]
    rate = min(table.distinct("rate"), key=lambda r: abs(r - 60))
    lines = [[r["law"], r["method"], f"{r['rms']:.3g}", percent(r["share"]), f"{r['most']:.2g}", f"{r['jump']:.2g}",
              f"{r['truth_jump']:.2g}", f"{r['us_median']:.2g}", f"{r['us_p99']:.2g}"]
             for r in table.rows if r["rate"] == rate]
    return ("The hand writes, presses and lifts. The force that it feels between two surfaces of the sand is compared with the "
            "law, evaluated at every tick on that tick's sand. The *jump* is the largest change of the force from a tick to the "
            "next. The method *local* is the default.\n\nThe method *local at once* has no recovery. It is the most exact, and "
            "leaps at every surface. Recovery makes the arm stable: hold and eq. 9 bear 60 and 31 N/m where local bears 1000 "
            "([figures.md](../figures.md#the-stiffest-spring)). The law of control points loses most accuracy by it. Its "
            "points are where the tool cuts a wall of one cell's thickness. Recovery turns the unrest of that wall into an "
            "error of one sign. If accuracy counts more than stiffness, a scene takes hold or eq. 9. "
            f"At {rate:g} surfaces per second:\n\n" +
            markdown(["law", "method", "RMS error [N]", "share", "most [N]", "jump [N]", "jump of truth [N]", "µs per tick",
                      "p99 [µs]"], lines))


def force_work(tables):
    lines = [[r["law"], f"{r['slope']:g}", f"{r['shallow']:g}", f"{1e3 * r['net']:.3g}", percent(r["share"])]
             for r in tables["force-work"].rows]
    return ("The tool moves once round an upright circle on the slope, one radius across, in still sand and without friction. "
            "On level sand neither law does work on a closed path. On a slope neither law has a potential: *repulse* turns its "
            "force with the depth, and *control points* push aside by the depth. At negative work the hand loses energy. In "
            "the other direction it gains as much, which is why there is a passivity observer.\n\n" +
            markdown(["law", "slope", "least depth [R]", "net work [mN · scene unit]", "share of the work exchanged"], lines))


def latency(tables):
    if "latency" not in tables:
        return "The quick report leaves this out. `sandwall-bench latency` measures it in about ten minutes."
    table = tables["latency"]
    return ("A test message as long as a step's is sent at random times. The table has half of its round trip: until the wall "
            "has swapped, and until the master has the message. [latency.md](../latency.md) explains the columns.\n\n" +
            markdown(LATENCY_HEADER, [latency_cells(row) for row in table.rows]) + "\n\n" +
            "\n".join(f"- {note}" for note in table.notes if not note.startswith(("command: ", "date: "))) +
            f"\n\n*[latency](data/latency.csv): `{table.fact('command')}`*")
