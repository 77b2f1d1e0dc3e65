# SPDX-License-Identifier: Apache-2.0
"""The figures of docs/report about steps, forces and TINs. Each function takes a table and returns a matplotlib figure."""

from report.report_data import IN_TIME, built, tools_with_laws
from report.report_plot import MARKERS, PILES, SERIES, label, legend_below, panels, percents, sizes_on


def edit(table):
    figure, axes = panels(1)
    axis = axes[0]
    for size, colour, marker in zip(table.distinct("N"), SERIES, MARKERS):
        for blocks, line in (("active", "-"), ("full", "--")):
            rows = table.where(N=size, blocks=blocks)
            axis.plot([row["radius"] for row in rows], [row["ms_median"] for row in rows], color=colour, marker=marker,
                      linestyle=line, label=f"{blocks}, N = {size}")
    label(axis, "radius of the tool [cells]", "press and 16 sweeps [ms]")
    sizes_on(axis, table.distinct("radius"))
    percents(axis)
    legend_below(figure, axes, 3)
    return figure


def dig(table):
    figure, axes = panels(2)
    tools = {}  # the largest field for each kind of sand and each tool
    for row in table.where(cells_per_step=1.5):
        tool = (row["sand"], row["R"])
        tools[tool] = max(row["N"], tools.get(tool, 0))
    radii = sorted({radius for _, radius in tools}, reverse=True)
    for (sand, radius), size in tools.items():
        place = radii.index(radius)
        rows = table.where(N=size, R=radius, cells_per_step=1.5, sand=sand)
        for axis, x in ((axes[0], "ms_p99"), (axes[1], "sweeps_per_step")):
            axis.plot([row[x] for row in rows], [100 * row["misplaced_held"] for row in rows], color=SERIES[place % len(SERIES)],
                      marker=MARKERS[place % len(MARKERS)], linestyle="--" if sand == "TIN" else "-",
                      label=f"R = {radius:g}, {sand} of N = {size}")
        if (sand, radius) == ("grid", 12):
            for row in rows:
                axes[0].annotate(f"{row['sweeps_per_step']:g}", (row["ms_p99"], 100 * row["misplaced_held"]), fontsize=7,
                                 textcoords="offset points", xytext=(4, 4))
    label(axes[0], "time per step, 99th percentile [ms]", "sand behind the hand [%]", "1.5 cells per step; labels: sweeps per step")
    label(axes[1], "sweeps per step", "sand behind the hand [%]", "1.5 cells per step")
    axes[0].axvline(IN_TIME, color="#777777", linewidth=1)
    sizes_on(axes[1], table.distinct("sweeps_per_step"))
    for axis in axes:
        axis.axhline(10, color="#777777", linewidth=1)
        percents(axis)
    percents(axes[1])
    legend_below(figure, axes, 3)
    return figure


LAW_MARKERS = {"as it is built": "o", "one more level": "^", "near": "v", "capped": "X"}  # of large-tools


def kind_of_law(law, as_built):
    """Returns how a law of large-tools differs from the one that is built."""
    return "as it is built" if law == as_built else "near" if law.endswith(" near") else law if law == "capped" else "one more level"


def large_tools(table):
    figure, axes = panels(2)
    spheres = table.where(place="level", tool="sphere")
    as_built = {(row["N"], row["R"]): row["law"] for row in built(spheres)}
    for (size, radius), colour in zip(tools_with_laws(spheres), SERIES):
        axes[0].plot([], [], color=colour, marker="s", linestyle="none", label=f"R = {radius:g}, N = {size}")
        for row in table.where(place="level", tool="sphere", N=size, R=radius):
            if row["law"] != "all sweeps":
                axes[0].plot(row["ms_p50"], row["behind"], color=colour, linestyle="none", marker=LAW_MARKERS[kind_of_law(row["law"], as_built[size, radius])])
    for kind, marker in LAW_MARKERS.items():
        axes[0].plot([], [], color="#777777", marker=marker, linestyle="none", label=kind)
    label(axes[0], "time per step, median [ms]", "sand in another place than with all sweeps [%]", "error against time, spheres on level sand")
    for law, rows, colour, marker in (("all sweeps", [row for row in spheres if row["law"] == "all sweeps"], SERIES[1], MARKERS[1]),
                                      ("with coarse levels", built(spheres), SERIES[0], MARKERS[0])):
        axes[1].plot([row["R"] for row in rows], [row["ms_p50"] for row in rows], color=colour, marker=marker, linestyle="none", label=law)
    label(axes[1], "radius of the tool [cells]", "time per step, median [ms]", "cost, spheres on level sand")
    sizes_on(axes[1], sorted({row["R"] for row in spheres}))
    for axis in axes:
        percents(axis)
    legend_below(figure, axes, 4)
    return figure


LEAST_PAST = 1e-4  # [cell³], drawn where less has run past a held tool, because the axis has no 0


def held_tools(table):
    figure, axes = panels(3)
    slope = max(table.values("slope"))
    tools = {tool: place for place, tool in enumerate(table.distinct("tool"))}
    for axis, sand in zip(axes, table.distinct("sand")):
        for tool in table.distinct("tool", sand=sand):
            rows = table.where(sand=sand, tool=tool, slope=slope)
            axis.plot([row["ms"] for row in rows], [max(row["past"], LEAST_PAST) for row in rows], color=SERIES[tools[tool] % len(SERIES)],
                      marker=MARKERS[tools[tool] % len(MARKERS)], linestyle="--" if tool == "wall" else "-", label=tool)
        least = min(row["past"] for row in table.where(sand=sand, slope=slope))
        label(axis, "run time of the steps [ms]", "sand that has run past [cell³]",
              f"{sand}, slope {slope:g}" + (f"; less is drawn at {LEAST_PAST:g}" if least < LEAST_PAST else ""))
    legend_below(figure, axes, 5)
    return figure


def throughput(table):
    figure, axes = panels(1, 4.2)
    axis = axes[0]
    colours = {"copy": "#000000", "G": "#0072B2", "G plain": "#56B4E9", "G baseline x86-64": "#009E73",
               "float32 N4 in place": "#D55E00", "float32 N4 Jacobi": "#CC79A7", "float32 N8 sqrt2 Jacobi": "#777777",
               "G band": "#E69F00", "G lumps": "#882255", "G lumps band": "#F0E442", "loop": "#BBBBBB"}
    for variant, marker in zip(table.distinct("variant"), MARKERS * 4):
        rows = table.where(variant=variant)
        axis.plot([row["N"] for row in rows], [row["ns_per_cell_median"] for row in rows], marker=marker, label=variant,
                  color=colours.get(variant, "#0072B2"), linestyle=":" if "threads" in variant else "-")
    label(axis, "N [cells]", "time per cell and sweep [ns]")
    sizes_on(axis, table.distinct("N"))
    percents(axis)
    legend_below(figure, axes, 2)
    return figure


def stability(table):
    names = table.distinct("arm")
    figure, axes = panels(len(names))
    marks = {0: ("o", "-"), 1: ("^", "--")}
    for axis, name in zip(axes, names):
        for delay in table.distinct("delay"):
            rows = table.where(arm=name, delay=delay)
            b = [row["b"] for row in rows]
            marker, line = marks[delay]
            ticks = "no delay" if delay == 0 else "a tick of delay"
            axis.plot(b, [row["theory"] for row in rows], color="#777777", linestyle=line,
                      label=f"b/(T/2 + t_d), {ticks}")
            axis.plot(b, [row["textbook"] for row in rows], color="#000000", marker=marker, markerfacecolor="none",
                      markersize=7, linestyle="none", label=f"mass and damping alone, measured, {ticks}")
            axis.plot(b, [row["literal"] for row in rows], color="#D55E00", marker=marker, linestyle=line,
                      label=f"with encoder, friction and motor, measured, {ticks}")
            axis.plot(b, [row["guarded"] for row in rows], color="#0072B2", marker=marker, linestyle=line,
                      label=f"guarded: stiffness that any law gets, {ticks}")
        axis.axhline(6281, color="#009E73", linewidth=1, label="constants of Dorjgotov et al. 2007")
        label(axis, "damping b [N s/m]", "stiffness [N/m]", name)
        axis.set_ylim(10, 1e5)
    legend_below(figure, axes, 3)
    return figure


def detail(table):
    figure, axes = panels(2)
    for axis, (column, name, factor) in zip(axes, (("bad", "pixels beyond 8 levels [%]", 100),
                                                   ("mean", "mean difference [level]", 1))):
        for size, colour, marker in zip(table.distinct("N"), SERIES, MARKERS):
            rows = table.where(N=size)
            axis.plot([row["ratio"] for row in rows], [factor * row[column] for row in rows], color=colour, marker=marker,
                      label=f"{size}² cells")
            for row in rows:
                axis.annotate(f"{row['bound']:g} px", (row["ratio"], factor * row[column]), fontsize=7,
                              textcoords="offset points", xytext=(3, 3))
        label(axis, "draw time, share of bound 0", name, logx=False, logy=False)
    legend_below(figure, axes)
    return figure


def force_rate(table):
    figure, axes = panels(2)
    size = table.distinct("N")[0]
    for method, colour, marker in zip(table.distinct("method"), SERIES, MARKERS):
        for law, line in (("repulse", "-"), ("control points", "--")):
            # A method that sees every tick's sand has an error of 0, which a logarithmic axis cannot show.
            rows = [row for row in table.where(N=size, method=method, law=law) if row["share"] > 1e-9]
            for axis, x in zip(axes, ("rate", "us_median")):
                axis.plot([row[x] for row in rows], [100 * row["share"] for row in rows], color=colour, marker=marker,
                          linestyle=line, label=f"{method}, {law}")
    for axis, name in zip(axes, ("surfaces per second", "CPU time per tick, copy of the sand included [µs]")):
        label(axis, name, "error of the force, RMS [%]")
        percents(axis)
    axes[0].axvline(60, color="#777777", linewidth=1)
    sizes_on(axes[0], [15, 30, 60, 125, 250, 500, 1000])
    sizes_on(axes[1], [1, 2, 5, 10])
    legend_below(figure, axes, 2)
    return figure


def tin_piles(table):
    figure, axes = panels(2)
    names = {"low": PILES["low"], "tall": "tall pile, H/R = 3"}
    for mesh, colour, marker in zip(table.distinct("mesh"), SERIES, MARKERS):
        for pile, line in (("low", "-"), ("tall", "--")):
            sizes = table.distinct("N", mesh=mesh, pile=pile)
            turns = [table.where(mesh=mesh, pile=pile, N=size) for size in sizes]
            errors = [[100 * row["error"] for row in rows] for rows in turns]
            for axis, x in zip(axes, ("vertices", "seconds_median")):
                middle = [sum(row[x] for row in rows) / len(rows) for rows in turns]
                axis.plot(middle, [sum(some) / len(some) for some in errors], color=colour, marker=marker,
                          linestyle=line, label=f"{mesh} mesh, {names[pile]}")
                axis.fill_between(middle, [min(some) for some in errors], [max(some) for some in errors], color=colour,
                                  alpha=0.2, linewidth=0)
    label(axes[0], "vertices", "sand in the wrong place at rest [%]", "by the mesh; shaded: turned by 0 … 45°")
    label(axes[1], "time to rest [s], one thread", "sand in the wrong place at rest [%]", "by the time")
    for axis in axes:
        percents(axis)
    legend_below(figure, axes, 3)
    return figure


def tin_simplify(table):
    figure, axes = panels(3)
    for size, colour, marker in zip(table.distinct("columns"), SERIES, MARKERS):
        rows = table.where(columns=size)
        for axis, error, name in ((axes[0], "max", "largest error"), (axes[1], "rms", "RMS error")):
            for prefix, vertices, line, what in (("", "vertices", "-", "TIN"), ("grid_", "grid_vertices", "--", "grid")):
                axis.plot([row[vertices] for row in rows], [100 * row[prefix + error] / row["relief"] for row in rows],
                          color=colour, marker=marker, linestyle=line, label=f"{what} of {size}² samples")
            label(axis, "vertices", f"{name} [% of the relief]", name)
        for error, line, name in (("max", "-", "largest"), ("rms", ":", "RMS")):
            axes[2].plot([row["ms_median"] for row in rows], [100 * row[error] / row["relief"] for row in rows],
                         color=colour, marker=marker, linestyle=line, label=f"TIN of {size}² samples, {name} by the time")
    label(axes[2], "time [ms], one thread", "error [% of the relief]", "by the time it takes")
    for axis in axes:
        percents(axis)
    legend_below(figure, axes)
    return figure
