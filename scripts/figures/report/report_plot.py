# SPDX-License-Identifier: Apache-2.0
"""Colours, axes and legends of the figures of docs/report."""

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
from matplotlib.ticker import FuncFormatter, NullFormatter

# Okabe and Ito's colours, because colour-blind readers can distinguish them. Markers and lines differ in grey prints too.
STYLES = {
    "G": dict(color="#0072B2", marker="o", linestyle="-"),
    "G plain": dict(color="#56B4E9", marker="s", linestyle="--"),
    "settle": dict(color="#009E73", marker="D", linestyle="-"),
    "N4": dict(color="#E69F00", marker="^", linestyle="--"),
    "float32 N4 in place": dict(color="#D55E00", marker="v", linestyle=":"),
    "float32 N4 Jacobi": dict(color="#CC79A7", marker="P", linestyle=":"),
    "float32 N8 Jacobi": dict(color="#000000", marker="x", linestyle=":"),
    "float32 N8 sqrt2 Jacobi": dict(color="#777777", marker="*", linestyle="-."),
}
SERIES = ["#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#000000"]
MARKERS = ["o", "s", "^", "D", "v", "P"]
PILES = {"low": "low pile, H/R = 0.6", "tall": "tall pile, H/R = 2"}

plt.rcParams.update({"font.size": 9, "axes.grid": True, "grid.alpha": 0.3, "lines.markersize": 4, "legend.fontsize": 8,
                     "axes.titlesize": 10, "figure.dpi": 100, "savefig.dpi": 100, "lines.linewidth": 1.4})


def panels(count, height=3.9):
    figure, axes = plt.subplots(1, count, figsize=(4.6 * count, height), squeeze=False, constrained_layout=True)
    return figure, axes[0]


def label(axis, x, y, title="", logx=True, logy=True):
    axis.set_xlabel(x)
    axis.set_ylabel(y)
    axis.set_title(title)
    if logx:
        axis.set_xscale("log")
    if logy:
        axis.set_yscale("log")


def sizes_on(axis, sizes):
    """Labels a logarithmic axis with these sizes."""
    axis.set_xticks(sizes)
    axis.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axis.xaxis.set_minor_formatter(NullFormatter())
    axis.tick_params(axis="x", which="minor", length=0)


def percents(axis):
    """Writes the numbers of the vertical axis without exponents, also those between powers of ten where few of these are shown."""
    axis.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    low, high = axis.get_ylim()
    if axis.get_yscale() == "log" and high < 10 * low:
        axis.yaxis.set_minor_formatter(FuncFormatter(lambda value, _: f"{value:g}"))


def legend_below(figure, axes, columns=4):
    """Draws one legend for all panels below them, with each curve once."""
    entries = {}
    for axis in axes:
        for handle, name in zip(*axis.get_legend_handles_labels()):
            entries.setdefault(name, handle)
    figure.legend(entries.values(), entries.keys(), loc="upper center", bbox_to_anchor=(0.5, 0.0), ncol=columns,
                  frameon=False)
