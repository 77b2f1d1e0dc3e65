# SPDX-License-Identifier: Apache-2.0
"""Text of the report on sand at the ends of its ranges. The verdicts are made from the figures of the table."""

from report.report_claims import count_of, listing
from report.report_data import markdown, rounded

MEASURES = {"slope": "slope over the talus", "face": "difference over the talus", "thickness": "thickness"}


def faults(row):
    """Returns what a world does that it must not do, as a list of phrases."""
    found = [] if row["at_rest"] else ["still moves"]
    if row["lost"] != 0:
        found.append(f"loses {row['lost']} units")
    if row["bound"] != "" and row["excess"] > row["bound"]:
        found.append("exceeds its bound")
    if row["stays"] and row["moved"] != 0:
        found.append("moves")
    if not row["stays"] and row["moved"] == 0:
        found.append("does not move")
    return found


def extremes(tables):
    table = tables["extremes"]
    lines = []
    for row in table.rows:
        wrong = faults(row)
        bound = "no motion" if row["stays"] else rounded(row["bound"], 4)
        lines.append([row["world"], f"{row['band']:g}", row["sweeps"], row["lost"], MEASURES[row["measure"]], rounded(row["start"], 4),
                      rounded(row["excess"], 4), bound, "no sand may move" if row["stays"] else row["why"],
                      f"**{listing(wrong)}**" if wrong else "holds"])
    bad = [row for row in table.rows if faults(row)]
    nearest = max((row for row in table.rows if row["bound"] != "" and not row["stays"]), key=lambda row: row["excess"] / row["bound"])
    named = f" The others: {listing(dict.fromkeys(row['world'] for row in bad))}." if bad else ""
    return ("These worlds are at the ends of the ranges of angles, heights, cells, layers and fields. All lengths are in units "
            "of 2⁻¹⁶ cells. The table has the excess over the talus at the start and at rest. It must be within the bound, "
            "all sand must be there or have left over an open rim, and stable sand must stay. The verdict *holds* is "
            f"found in {count_of(table.rows, lambda row: not faults(row), 'row')}.{named} Nearest to its bound is the world "
            f"*{nearest['world']}*, with {nearest['excess']:.4g} of {nearest['bound']:.4g} units. In the formulas, t is the talus as a "
            "difference of two cells, and band the share of it up to which sand at rest stays.\n\n" +
            markdown(["world", "band", "sweeps to rest", "lost", "what is bounded", "at the start", "at rest", "bound", "formula or reason",
                      "verdict"], lines))
