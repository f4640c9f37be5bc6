"""Error against run time and against force evaluations, from bounce accuracy."""

import csv
import json
import math
import statistics
from dataclasses import dataclass

from pictures import drawing
from pictures.drawing import plt
from pictures.run import RunError

COLOURS = ["#2b5c8a", "#e08e45", "#4fa3a5", "#7a5195", "#6b8e23", "#a05a2c", "#8a9099", "#c1121f",
           "#d4a5c9", "#3d405b", "#b5a642", "#00798c"]
STYLES = {"resolved": {"marker": "o", "markersize": 3},
          "listing": {"marker": "x", "markersize": 4, "linestyle": ":"},
          "located": {"marker": "s", "markersize": 3, "linestyle": "--"}}
# Over the contact's, for what is not in double precision.
PRECISIONS = {"double": {}, "compensated": {"marker": "^", "markersize": 4, "linestyle": "-."},
              "single": {"marker": "v", "markersize": 4, "linestyle": (0, (5, 1, 1, 1, 1, 1))}}
TEXTS = ("method", "contact", "precision", "kernel", "note")
PANELS = {
    "position": "largest position error\njust before the impact, cm",
    "height": "height of the centre\nat the end, cm",
    "energy_lost": "energy lost\nat the end, erg",
    "contact_time": "time in contact, s",
    "flattening": "greatest flattening",
    "energy": "energy, largest error\nat any time, erg",
}


@dataclass
class Study:
    """accuracy.csv: the reference's error bar and a dictionary a row; origin.json."""

    bar: dict
    rows: list
    origin: dict

    def lines(self):
        """(method, contact, precision) to its rows."""
        found = {}
        for row in self.rows:
            found.setdefault((row["method"], row["contact"], row["precision"]), []).append(row)
        return found

    def most_energy(self):
        """Errors of energy beyond it, erg, are those of balls that have blown up: the rest would be squeezed into
        a corner beside them."""
        known = [row["error_energy"] for row in self.rows if math.isfinite(row["error_energy"])]
        return 1e4 * statistics.median(known) if known else math.inf

    def papers(self):
        """The paper's program: listing, its contact, 1e-6 s; None without it."""
        return next((row for row in self.rows if row["method"] == row["contact"] == "listing"
                     and row["precision"] == "double" and abs(row["dt"] / 1e-6 - 1.0) < 1e-9), None)


def read_study(folder):
    """RunError if the folder holds no study, or one with a number that is none."""
    path = folder / "accuracy.csv"
    try:
        with open(path, newline="") as file:
            rows = list(csv.DictReader(file, restval=None))
        for row in rows:
            for key, text in row.items():
                if text is None:
                    raise ValueError(f"a row without {key}")
                if key not in TEXTS:
                    row[key] = float(text) if text else math.nan
        origin = json.loads((folder / "origin.json").read_text())
    except (OSError, TypeError, ValueError) as error:
        raise RunError(f"{path}: cannot be read: {error}") from error
    wanted = ("precision", "dt", "seconds", "evaluations", *(f"error_{name}" for name in PANELS))
    if len(rows) < 2 or rows[0].get("method") != "reference" or any(key not in rows[0] for key in wanted):
        raise RunError(f"{path}: no rows of bounce accuracy")
    return Study(rows[0], rows[1:], origin)


def style_of(contact, precision):
    return STYLES[contact] | PRECISIONS[precision]


def label_of(method, contact, precision):
    return f"{method}, {contact}" + ("" if precision == "double" else f", {precision}")


def draw_panel(axes, study, cost, name, colours):
    key, most = f"error_{name}", study.most_energy()
    for (method, contact, precision), all_rows in study.lines().items():
        # Beyond the edge of stability, or where the error is 0, there is nothing to show.
        rows = sorted((r for r in all_rows if math.isfinite(r[key]) and r[key] > 0 and r["error_energy"] <= most),
                      key=lambda r: r[cost])
        label = label_of(method, contact, precision)
        if not any(r["error_height"] < math.inf for r in all_rows):
            label += " (not finished)"
        axes.plot([r[cost] for r in rows], [r[key] for r in rows], color=colours[method], linewidth=1.0, label=label,
                  **style_of(contact, precision))
    if not any(0 < r[key] < math.inf for r in study.rows):
        axes.text(0.5, 0.5, f"{PANELS[name]}:\nnothing to show, it starts at a wall", transform=axes.transAxes,
                  ha="center", va="center", color="#5a6068", fontsize=8)
        axes.set_axis_off()
        return
    papers = study.papers()
    if papers:
        oracle = study.origin.get("oracle_seconds") or papers["seconds"]
        axes.plot([oracle if cost == "seconds" else papers[cost]], [papers[key]], marker="*", markersize=11,
                  color=drawing.MARK, linestyle="none", zorder=5, label="the paper's program, 1e-6 s")
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.grid(color="#e6e8eb", linewidth=0.5)
    if study.bar[key] > 0:
        low, high = axes.get_ylim()
        axes.axhspan(min(low, study.bar[key] / 10), study.bar[key], color="#e6e8eb", zorder=0)
        axes.set_ylim(max(low, study.bar[key] / 3), high)
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)


def draw_guides(axes):
    """Slopes of the orders, over evaluations."""
    low, high = axes.get_ylim()
    left, right = axes.get_xlim()
    for order, label in ((1, "1"), (2, "2"), (4, "4"), (6, "6")):
        start = (left * (right / left) ** 0.62, high / 1.5)
        x = [start[0], start[0] * 10 ** (0.9 / order)]
        axes.plot(x, [start[1], start[1] * 10 ** -0.9], color="#8a9099", linewidth=0.8)
        # The two steepest end side by side.
        axes.annotate(label, (x[1], start[1] * 10 ** -0.9), fontsize=6.5, color="#5a6068",
                      ha="right" if order == 6 else "left")
    axes.set_xlim(left, right)
    axes.set_ylim(low, high)


def figure_of(study, title):
    """A row of panels over run time, one over evaluations."""
    methods = list(dict.fromkeys(row["method"] for row in study.rows))
    colours = {method: COLOURS[i % len(COLOURS)] for i, method in enumerate(methods)}
    # The last row is the legend's, of three columns.
    legend_height = 0.4 + 0.18 * math.ceil((len(study.lines()) + 1) / 3)
    figure, panels = plt.subplots(len(PANELS) + 1, 2, figsize=(10.0, 2.6 * len(PANELS) + legend_height),
                                  layout="constrained", sharey="row",
                                  gridspec_kw={"height_ratios": [2.6] * len(PANELS) + [legend_height]})
    *panels, below = panels
    for row, (name, label) in zip(panels, PANELS.items()):
        for axes, cost in zip(row, ("seconds", "evaluations")):
            draw_panel(axes, study, cost, name, colours)
        if row[1].axison:
            draw_guides(row[1])
        row[0].set_ylabel(label)
    panels[-1][0].set_xlabel("run time on one thread, s")
    panels[-1][1].set_xlabel("force evaluations (short lines: orders 1, 2, 4, 6)")
    for axes in below:
        axes.axis("off")
    legend = below[0].legend(*panels[-1][0].get_legend_handles_labels(), loc="upper left", ncols=3, frameon=False,
                             fontsize=8)
    legend.set_in_layout(False)  # it is wider than its panel
    drawing.set_caption(figure, title)
    return figure
