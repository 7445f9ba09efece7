#!/usr/bin/env python3
# SPDX-FileCopyrightText: HandEyeCalibration contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Draws what study_segmentation measured, and prints it as a table: python3 plot_segmentation.py STUDY.csv PICTURE.png (needs matplotlib)."""
import csv
import statistics
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

LARGEST_BIAS_PX = 0.02
LARGEST_RATIO = 1.3
COLORS = {0.0: "tab:blue", 0.25: "tab:green", 0.5: "tab:red"}
MARKERS = {1.0: "o", 2.0: "s", 3.0: "^"}
TEXT = {"lens"}


def read(path):
    with open(path, newline="", encoding="utf-8") as file:
        rows = [{key: value if key in TEXT else float(value) for key, value in row.items()} for row in csv.DictReader(file)]
    if not rows:
        sys.exit(f"{path}: no line of the study in it")
    return rows


def draw_lens(axes, rows, hidden_shares, noises):
    """Bias and spread over the radius; the angles off the axis side by side at each radius."""
    angles = sorted({row["off_axis_deg"] for row in rows})
    for row in rows:
        if row["found"] < 2:
            continue
        aside = 1 + 0.05 * (angles.index(row["off_axis_deg"]) - (len(angles) - 1) / 2)
        radius = row["radius_px"] * aside
        style = {"color": COLORS.get(row["hidden_share"], "black"), "marker": MARKERS.get(row["noise"], "x"),
                 "linestyle": "none", "markersize": 4, "alpha": 0.75}
        axes[0].plot(radius, max(row["bias_px"], 5e-4), **style)
        axes[1].plot(radius, row["spread_px"], **style)
        axes[2].plot(radius, row["ratio"], **style)
    for hidden in hidden_shares:
        for noise in noises:
            bounds = sorted((row["radius_px"], row["bound_px"]) for row in rows
                            if row["hidden_share"] == hidden and row["noise"] == noise and row["off_axis_deg"] == angles[0])
            axes[1].plot(*zip(*bounds), color=COLORS.get(hidden, "black"), linewidth=0.8,
                         linestyle="-" if noise == noises[0] else "--")


def median_and_largest(rows, key, digits):
    values = [row[key] for row in rows]
    return f"{statistics.median(values):.{digits}f} ({max(values):.{digits}f})"


def print_table(rows):
    """A line for each radius and share that is hidden: medians over the other conditions, in brackets the largest."""
    print("| hidden | radius | found | bias px | spread px | bound px | spread over bound |\n|---|---|---|---|---|---|---|")
    for hidden in sorted({row["hidden_share"] for row in rows}):
        for radius in sorted({row["radius_px"] for row in rows}):
            some = [row for row in rows if row["hidden_share"] == hidden and row["radius_px"] == radius]
            if not some:
                continue
            found = 100 * sum(row["found"] for row in some) / sum(row["tried"] for row in some)
            spread, bound = (statistics.median(row[key] for row in some) for key in ("spread_px", "bound_px"))
            print(f"| {100 * hidden:g} % | {radius:g} | {found:.4g} % | {median_and_largest(some, 'bias_px', 4)} | {spread:.4f} | "
                  f"{bound:.4f} | {median_and_largest(some, 'ratio', 2)} |")
    print("\n| hidden | bias below the mark | spread within the mark |\n|---|---|---|")
    for hidden in sorted({row["hidden_share"] for row in rows}):
        some = [row for row in rows if row["hidden_share"] == hidden]
        bias = sum(row["bias_px"] < LARGEST_BIAS_PX for row in some)
        spread = sum(row["ratio"] <= LARGEST_RATIO for row in some)
        print(f"| {100 * hidden:g} % | {bias} of {len(some)} | {spread} of {len(some)} |")


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    rows = read(sys.argv[1])
    print_table(rows)
    lenses = list(dict.fromkeys(row["lens"] for row in rows))
    hidden_shares = sorted({row["hidden_share"] for row in rows})
    noises = sorted({row["noise"] for row in rows})
    figure, grid = plt.subplots(3, len(lenses), figsize=(4.2 * len(lenses), 9), sharex=True, sharey="row", squeeze=False)
    for column, lens in enumerate(lenses):
        axes = grid[:, column]
        draw_lens(axes, [row for row in rows if row["lens"] == lens], hidden_shares, noises)
        axes[0].axhline(LARGEST_BIAS_PX, color="black", linewidth=0.8, linestyle=":")
        axes[2].axhline(LARGEST_RATIO, color="black", linewidth=0.8, linestyle=":")
        axes[2].axhline(1, color="grey", linewidth=0.6)
        axes[0].set_title(lens)
        for axis in axes:
            axis.set_xscale("log")
            axis.set_yscale("log")
            axis.grid(True, which="both", linewidth=0.3)
        axes[2].set_yscale("linear")
        axes[2].set_xlabel("apparent radius (px)")
    grid[0, 0].set_ylabel("bias (px; dotted: the mark)")
    grid[1, 0].set_ylabel("spread (px; lines: the bound)")
    grid[2, 0].set_ylabel("spread over bound (dotted: the mark)")
    radii = sorted({row["radius_px"] for row in rows})
    grid[0, 0].set_xticks(radii, [f"{radius:g}" for radius in radii])
    grid[0, 0].minorticks_off()
    handles = [plt.Line2D([], [], color=COLORS.get(h, "black"), marker="s", linestyle="none", label=f"{100 * h:g} % hidden")
               for h in hidden_shares]
    handles += [plt.Line2D([], [], color="black", marker=MARKERS.get(n, "x"), linestyle="none", label=f"noise {n:g}")
                for n in noises]
    figure.legend(handles=handles, loc="lower center", ncol=len(handles), frameon=False)
    figure.tight_layout(rect=(0, 0.035, 1, 1))
    figure.savefig(sys.argv[2], dpi=90)


if __name__ == "__main__":
    main()
