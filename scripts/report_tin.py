# SPDX-License-Identifier: Apache-2.0
"""What the report says of TINs."""

from report_data import markdown, percent, seconds


def tin_piles(tables):
    table = tables["tin-piles"]
    size = table.distinct("N")[-1]
    lines = []
    for pile in table.distinct("pile"):
        for mesh in table.distinct("mesh"):
            rows = table.where(pile=pile, mesh=mesh, N=size)
            errors = [row["error"] for row in rows]
            iterations, sweeps = ([row[what] for row in rows] for what in ("iterations", "sweeps"))
            lines.append([pile, mesh, rows[0]["vertices"], percent(min(errors)), percent(max(errors)),
                          f"{min(iterations)} … {max(iterations)}", f"{min(sweeps)} … {max(sweeps)}", seconds(max(row["seconds"] for row in rows)),
                          "yes" if all(row["settled"] and row["exact"] for row in rows) else "**no**"])
    return ("The same piles on a [TIN](../tin.md) of about a vertex a cell: on a square lattice (regular), on one whose "
            "vertices are moved by up to a quarter of a cell (jittered), the two turned by 0, 9, 22.5 and 45 degrees, and "
            "on independent places (random). Radius and height are 0.25 N and 0.15 N of the low pile, 0.15 N and 0.45 N "
            "of the tall one; the error is integrated over the triangles. Sand settles by a projection's iterations, then by "
            "sweeps. At "
            f"N = {size}, over all turns:\n\n" +
            markdown(["pile", "mesh", "vertices", "least error", "largest error", "iterations", "sweeps", "at most", "at rest, volume exact"],
                     lines))


def tin_simplify(tables):
    table = tables["tin-simplify"]
    lines = []
    for size in table.distinct("columns"):
        for row in table.where(columns=size):
            lines.append([f"{size}²", row["vertices"], percent(row["share"]), percent(row["max"] / row["relief"]),
                          percent(row["rms"] / row["relief"]), percent(row["grid_max"] / row["relief"]),
                          percent(row["grid_rms"] / row["relief"]), f"{row['ms_median']:.0f}"])
    one = table.where(columns=table.distinct("columns")[-1], share=0.01)[0]
    return ("How near a TIN of few vertices comes to a raster of dunes: greedy insertion, vertical errors over all samples "
            "as a share of the relief, beside a regular grid of as many samples. With 1 % of the samples the largest "
            f"error of {one['columns']}² dunes is {percent(one['max'] / one['relief'])} of the relief, a regular grid's "
            f"{percent(one['grid_max'] / one['relief'])}. "
            "[figures.md](../figures.md#few-vertices-on-real-ground) has real terrain.\n\n" +
            markdown(["dunes", "vertices", "share", "max", "RMS", "grid: max", "grid: RMS", "ms"], lines))


def tin_tool(tables):
    lines = [[r["what"], r["tool"], r["refined"], r["vertices"], r["near"], f"{r['ms_median']:.2f}",
              f"{r['ms_p99']:.2f}", f"{r['ms_max']:.2f}"] for r in tables["tin-imprint"].rows]
    rows = tables["tin-active"].rows
    first, again = sorted(r["first_ms"] for r in rows), sorted(r["again_ms"] for r in rows)
    moved = sum(r["moved"] for r in rows) / len(rows)
    return ("What a tool of 16.8 cells costs in a TIN, sweeps apart: an *imprint* somewhere else, its outline's edges "
            "constrained, and a step of a *drag* of 1.5 cells. *Near*: vertices below the tool and beside it.\n\n" +
            markdown(["what", "tool", "refined", "vertices", "near", "p50 [ms]", "p99 [ms]", "max [ms]"], lines) +
            f"\n\n100 sweeps after a cone of {rows[0]['raised']} vertices has been put down, of which on average "
            f"{moved:.0f} move: {first[len(first) // 2]:.2f} ms where the mesh's weights are new, "
            f"{again[len(again) // 2]:.2f} ms where they are known (medians).")
