# SPDX-License-Identifier: Apache-2.0
"""Text of the report on TINs. Every result in it comes from the tables."""

from report.report_claims import count_of
from report.report_data import markdown, percent, seconds


def tin_piles(tables):
    table = tables["tin-piles"]
    size = table.distinct("N")[-1]
    lines = []
    for pile in table.distinct("pile"):
        for mesh in table.distinct("mesh"):
            rows = table.some(pile=pile, mesh=mesh, N=size)
            errors = [row["error"] for row in rows]
            iterations, sweeps = ([row[what] for row in rows] for what in ("iterations", "sweeps"))
            lines.append([pile, mesh, rows[0]["vertices"], percent(min(errors)), percent(max(errors)),
                          f"{min(iterations)} … {max(iterations)}", f"{min(sweeps)} … {max(sweeps)}",
                          seconds(max(row["seconds_median"] for row in rows)),
                          "yes" if all(row["settled"] and row["exact"] for row in rows) else "**no**"])
    rested = count_of(table.rows, lambda r: r["settled"] and r["exact"], "row")
    turned = max(max(errors) / min(errors) for errors in
                 (table.values("error", pile=line[0], mesh=line[1], N=size) for line in lines if line[1] != "random"))
    return ("This section has the piles on a [TIN](../tin.md) of about one vertex per cell. The regular mesh is a square lattice. "
            "The jittered mesh is a lattice whose vertices are moved by up to a quarter of a cell. The random mesh has "
            "vertices at independent places. The first two are turned by 0, 9, 22.5 and 45 degrees. The low pile has radius 0.25 N and "
            "height 0.15 N, the tall one 0.15 N and 0.45 N. The error is integrated over the triangles. Sand settles by iterations of "
            f"a projection, then by sweeps. It has come to rest, with its volume exact, in {rested} of the table. At N = {size} the "
            f"largest error of a mesh is up to {turned:.2f} times the least, as the mesh is turned:\n\n" +
            markdown(["pile", "mesh", "vertices", "least error", "largest error", "iterations", "sweeps", "longest time",
                      "at rest, volume exact"], lines))


def tin_simplify(tables):
    table = tables["tin-simplify"]
    lines = []
    for row in table.rows:
        lines.append([f"{row['columns']}²", row["vertices"], percent(row["share"]), percent(row["max"] / row["relief"]),
                      percent(row["rms"] / row["relief"]), percent(row["grid_max"] / row["relief"]),
                      percent(row["grid_rms"] / row["relief"]), f"{row['ms_median']:.0f}"])
    size = table.distinct("columns")[-1]
    one = table.some(columns=size, share=0.01)[0]
    relief = table.positive("relief", columns=size, share=0.01)
    nearer = count_of(table.rows, lambda r: r["max"] < r["grid_max"] and r["rms"] < r["grid_rms"], "row")
    return ("How near does a TIN of few vertices come to a raster of dunes? Greedy insertion makes the TIN. Errors are vertical, "
            "over all samples, as a share of the relief. The grid is a regular one of as many samples. With 1 % of the samples "
            f"the largest error of {size}² dunes is {percent(one['max'] / relief)} of the relief, and a "
            f"regular grid's is {percent(one['grid_max'] / relief)}. Both errors of the TIN are below those of the grid in {nearer}. "
            "[figures.md](../figures.md#few-vertices-on-real-ground) has real terrain.\n\n" +
            markdown(["dunes", "vertices", "share", "max", "RMS", "grid: max", "grid: RMS", "ms"], lines))


def tin_tool(tables):
    lines = [[r["what"], r["tool"], r["refined"], r["vertices"], r["near"], f"{r['ms_median']:.2f}",
              f"{r['ms_p99']:.2f}", f"{r['ms_max']:.2f}"] for r in tables["tin-imprint"].rows]
    rows = tables["tin-active"].rows
    first, again = sorted(r["first_ms"] for r in rows), sorted(r["again_ms"] for r in rows)
    moved = sum(r["moved"] for r in rows) / len(rows)
    return ("The table has the cost of a tool of 16.8 cells in a TIN, without sweeps. An *imprint* puts the tool at another place "
            "and constrains the edges of its outline. A *drag* is a step of 1.5 cells. *near* counts the vertices below the "
            "tool and beside it.\n\n" +
            markdown(["what", "tool", "refined", "vertices", "near", "p50 [ms]", "p99 [ms]", "max [ms]"], lines) +
            f"\n\nA second measurement puts down a cone of {rows[0]['raised']} vertices, and runs 100 sweeps, in which "
            f"{moved:.0f} vertices move on average. The sweeps take {first[len(first) // 2]:.2f} ms if the mesh's weights are "
            f"new, and {again[len(again) // 2]:.2f} ms if they are known (medians).")
