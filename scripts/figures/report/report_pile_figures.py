# SPDX-License-Identifier: Apache-2.0
"""The figures of docs/report about piles. Each function takes a table and returns a matplotlib figure."""

from matplotlib.ticker import FuncFormatter

from report.report_data import frontier, held, usual_size
from report.report_plot import MARKERS, PILES, SERIES, STYLES, label, legend_below, panels, percents, sizes_on


def pile_figure(draw, columns=4):
    """Calls draw(axis, pile, title) for a panel of each pile, with shares in percent. The legend has so many columns."""
    figure, axes = panels(2)
    for axis, (pile, title) in zip(axes, PILES.items()):
        draw(axis, pile, title)
        percents(axis)
    legend_below(figure, axes, columns)
    return figure


def work_precision(table):
    size = usual_size(table)

    def draw(axis, pile, title):
        for method, style in STYLES.items():
            rows = table.where(pile=pile, method=method, N=size)
            misplaced = [100 * row["misplaced"] for row in rows]
            axis.plot([row["seconds_median"] for row in rows], misplaced, label=method, **style)
            axis.fill_betweenx(misplaced, [row["seconds_min"] for row in rows], [row["seconds_max"] for row in rows],
                               color=style["color"], alpha=0.2, linewidth=0)
        label(axis, "time [s], one thread", "sand in the wrong place [%]", f"{title}, N = {size}")

    return pile_figure(draw)


def envelope(table):
    def draw(axis, pile, title):
        for method, style in STYLES.items():
            best = frontier(held(table.where(pile=pile, method=method)), "seconds_median", "misplaced")
            axis.plot([row["seconds_median"] for row in best], [100 * row["misplaced"] for row in best], label=method,
                      **style)
        label(axis, "least time over all N [s], one thread", "sand in the wrong place from then on [%]", title)

    return pile_figure(draw)


def error_at_rest(table):
    def draw(axis, pile, title):
        for method, style in STYLES.items():
            rows = table.where(pile=pile, method=method)
            axis.plot([row["N"] for row in rows], [100 * row["misplaced"] for row in rows], label=method, **style)
        label(axis, "N [cells]", "sand in the wrong place at rest [%]", title)
        sizes_on(axis, table.distinct("N", pile=pile))

    return pile_figure(draw)


def sweeps(table):
    figure, axes = panels(2)
    for axis, (pile, title) in zip(axes, PILES.items()):
        for method in table.distinct("method"):
            for band, line in ((0, "-"), (0.001, "--")):
                rows = table.where(pile=pile, method=method, band=band)
                style = dict(STYLES[method], linestyle=line)
                axis.plot([row["N"] for row in rows], [row["sweeps"] for row in rows],
                          label=f"{method}, band {band:g}", **style)
        label(axis, "N [cells]", "sweeps to rest", title)
        sizes_on(axis, table.distinct("N", pile=pile))
    legend_below(figure, axes, 3)
    return figure


def anisotropy(table):
    figure, axes = panels(2)
    size = table.distinct("N")[-1]
    for axis, (pile, title) in zip(axes, PILES.items()):
        for method in table.distinct("method"):
            rows = [row for row in table.where(pile=pile, method=method, N=size) if row["degrees"] <= 90]
            axis.plot([row["degrees"] for row in rows], [100 * row["radius_error"] for row in rows], label=method,
                      markevery=3, **STYLES[method])
        label(axis, "direction from the x axis [degrees]", "error of the radius at half height [%]",
              f"{title}, N = {size}", logx=False, logy=False)
        axis.set_xticks(range(0, 91, 15))
    legend_below(figure, axes, 3)
    return figure


def decay(table):
    figure, axes = panels(2)
    for axis, (column, name) in zip(axes, (("moved", "volume that moves per sweep, share of all"),
                                           ("to_rest", "distance to rest, share of all"))):
        for method in table.distinct("method"):
            rows = [row for row in table.where(pile="low", method=method) if row[column] > 0]
            axis.plot([row["sweeps"] for row in rows], [row[column] for row in rows], label=method, **STYLES[method])
        label(axis, "sweeps", name, f"{PILES['low']}, N = {table.distinct('N')[-1]}")
    legend_below(figure, axes)
    return figure


def height_bits(table):
    figure, axes = panels(2)
    sizes = table.distinct("N")
    for axis, column, name in ((axes[0], "misplaced", "sand in the wrong place [%]"),
                               (axes[1], "too_steep", "steepest slope above the talus [%]")):
        for size, colour, marker in zip(sizes, SERIES, MARKERS):
            for pile, line in (("low", "-"), ("tall", "--")):
                rows = table.where(pile=pile, N=size)
                rows = [row for row in rows if row[column] > 0]
                axis.plot([row["bits"] for row in rows], [100 * row[column] for row in rows], color=colour, marker=marker, linestyle=line,
                          label=f"{pile} pile, N = {size}")
        label(axis, "height unit: cell / 2^bits", name, logx=False)
        axis.set_xticks(range(8, 25, 4))
        axis.axvline(16, color="#777777", linewidth=1)
        percents(axis)
    legend_below(figure, axes, 3)
    return figure


def band(table):
    figure, axes = panels(2)
    for axis, column, name in ((axes[0], "sweeps", "sweeps to rest"),
                               (axes[1], "misplaced", "sand in the wrong place [%]")):
        for method in table.distinct("method"):
            for pile, line in (("low", "-"), ("tall", "--")):
                rows = table.where(pile=pile, method=method)
                scale = 100 if column == "misplaced" else 1
                axis.plot([max(row["band"], 3e-5) for row in rows], [scale * row[column] for row in rows],
                          label=f"{method}, {pile} pile", **dict(STYLES[method], linestyle=line))
        label(axis, "band, share of the talus (leftmost: no band)", name, f"N = {table.distinct('N')[-1]}")
        percents(axis)
    legend_below(figure, axes)
    return figure


def mass_drift(table):
    figure, axes = panels(2)
    for axis, datum in zip(axes, table.distinct("datum")):
        for method in table.distinct("method"):
            rows = [row for row in table.where(method=method, datum=datum) if row["drift"] != 0]
            if rows:
                axis.plot([row["sweeps"] for row in rows], [abs(row["drift"]) for row in rows], label=method,
                          **STYLES[method])
        axis.plot([], [], label="G: exactly 0", **STYLES["G"])
        label(axis, "sweeps", "volume lost or invented, share of all", f"ground at {datum:g} cells")
    legend_below(figure, axes, 3)
    return figure


def certificate(table):
    def draw(axis, pile, title):
        for method in table.distinct("method"):
            rows = table.where(pile=pile, method=method)
            for column, line in (("bound", "-"), ("truth", ":")):
                style = dict(STYLES[method], linestyle=line)
                axis.plot([row["N"] for row in rows], [100 * row[column] for row in rows],
                          label=f"{method}, {'proved' if column == 'bound' else 'true'}", **style)
        label(axis, "N [cells]", "squared distance to the projection,\nshare of that moved [%]", title)
        sizes_on(axis, table.distinct("N"))

    return pile_figure(draw, 3)


def budget(table):
    figure, axes = panels(2)
    for axis, (pile, title) in zip(axes, PILES.items()):
        parts = table.distinct("part", pile=pile)
        sizes = table.distinct("N", pile=pile)
        for i, (size, colour) in enumerate(zip(sizes, SERIES)):
            values = [100 * table.one("misplaced", pile=pile, N=size, part=part) for part in parts]
            places = [row + (i - (len(sizes) - 1) / 2) * 0.25 for row in range(len(parts))]
            axis.barh(places, values, height=0.22, color=colour, label=f"N = {size}")
        label(axis, "sand in the wrong place [%]", "", title, logy=False)
        axis.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
        axis.set_yticks(range(len(parts)), parts if axis is axes[0] else [""] * len(parts))
        axis.invert_yaxis()
    legend_below(figure, axes)
    return figure
