"""The edge of stability: the plane of E and time step, and the margin through a bounce."""

import csv
import math
from dataclasses import dataclass

import numpy as np
from matplotlib.lines import Line2D

from pictures import drawing
from pictures.drawing import plt
from studies.study import InputError

METHOD_COLOURS = ["#2b5c8a", "#e08e45", "#4fa3a5", "#7a5195", "#6b8e23", "#a05a2c"]
STABLE, BETWEEN, UNSTABLE = "#eef4f0", "#faf6e6", "#f7ecea"


@dataclass
class Sweep:
    """edge.csv of bounce stability, a dictionary a row; columns that hold numbers as numbers."""

    path: object
    rows: list

    def where(self, **wanted):
        """Rows with these values, at the sweep's own criterion and disturbance unless named."""
        usual = {key: self.rows[0][key] for key in ("growth", "periods", "disturbed")}
        wanted = usual | wanted
        return [row for row in self.rows if all(row[key] == value for key, value in wanted.items())]


TEXTS = ("method", "passage", "sought", "outcome")


def read_sweep(folder):
    """InputError if the folder holds no sweep, or one with a number that is none."""
    path = folder / "edge.csv"
    try:
        with open(path, newline="") as file:
            rows = list(csv.DictReader(file))
        for row in rows:
            for key, text in row.items():
                if key not in TEXTS:
                    row[key] = float(text) if text else math.nan
    except (OSError, TypeError, ValueError) as error:
        raise InputError(f"{path}: cannot be read: {error}") from error
    if not rows or any(key not in rows[0] for key in (*TEXTS, "E", "dt", "predicted", "strict", "stable")):
        raise InputError(f"{path}: no rows of bounce stability")
    return Sweep(path, rows)


def methods(sweep):
    return list(dict.fromkeys(row["method"] for row in sweep.rows))


def plane(sweep, examples):
    """Stable and unstable steps over E; `examples`: number to (E, dt). Below it Δt √E, magnified."""
    figure, (axes, zoom) = plt.subplots(2, 1, figsize=(8.6, 9.4), sharex=True, layout="constrained",
                                        height_ratios=(1.5, 1.0))
    flights = sweep.where(passage="flight", sought="dt")
    e = sorted(row["E"] for row in flights)
    e_line = np.geomspace(e[0] / 3, e[-1] * 300, 50)
    low, high = 1e-7, 0.2
    products = {method: product_of(sweep, method) for method in methods(sweep)}
    least, most = (choice(products.values()) / np.sqrt(e_line) for choice in (min, max))
    axes.fill_between(e_line, low, least, color=STABLE, zorder=0)
    axes.fill_between(e_line, least, most, color=BETWEEN, zorder=0, linewidth=0)
    axes.fill_between(e_line, most, high, color=UNSTABLE, zorder=0)
    axes.text(20, 2e-5, "stable", fontsize=13, color="#5f8a70")
    axes.text(1e4, 1.2e-2, "unstable", fontsize=13, color="#b0645c")
    zoom.axhspan(0.0, min(products.values()), color=STABLE, zorder=0)
    zoom.axhspan(min(products.values()), max(products.values()), color=BETWEEN, zorder=0, linewidth=0)
    zoom.axhspan(max(products.values()), 10.0, color=UNSTABLE, zorder=0)
    for number, method in enumerate(methods(sweep)):
        draw_method(axes, zoom, sweep, method, number, e_line)
    name_strict_limits(zoom, sweep)
    draw_slope(axes, min(products.values()))
    draw_fixed_step(axes, sweep)
    draw_examples(axes, examples)
    axes.set(xscale="log", yscale="log", xlim=(e_line[0], e_line[-1]), ylim=(low, high),
             ylabel="time step Δt, s")
    axes.legend(handles=legend_of(axes), frameon=False, loc="upper right", fontsize=8)
    zoom.set(yscale="log", ylim=(0.55 * min(products.values()), 1.35 * max(products.values())),
             xlabel="E", ylabel="Δt √E")
    ticks = sorted({float(f"{value:.3g}") for value in
                    [*products.values(), *(product_of(sweep, method, "strict") for method in products)]})
    ticks = [tick for i, tick in enumerate(ticks) if i == 0 or tick > 1.07 * ticks[i - 1]]
    zoom.set_yticks(ticks, [f"{tick:g}" for tick in ticks])
    zoom.minorticks_off()
    for panel in (axes, zoom):
        for side in ("top", "right"):
            panel.spines[side].set_visible(False)
    drawing.set_caption(figure, "How large a time step is stable? Between the lines: by method. Below: times √E")
    return figure


def draw_method(axes, zoom, sweep, method, number, e_line):
    """Predicted lines and measured edges of a method in both panels; its name stands in the lower one."""
    colour = METHOD_COLOURS[number % len(METHOD_COLOURS)]
    product, strict = product_of(sweep, method), product_of(sweep, method, "strict")
    axes.plot(e_line, product / np.sqrt(e_line), color=colour, linewidth=0.9, zorder=2, label=method)
    zoom.axhline(product, color=colour, linewidth=0.9, zorder=2)
    if strict < 0.98 * product:
        zoom.axhline(strict, color=colour, linewidth=1.1, linestyle=(0, (2, 2 + number)), zorder=2)
    # Methods with the same edge: one name after the other, the later marker within the earlier.
    same = [other for other in methods(sweep)[:number] if abs(product_of(sweep, other) / product - 1.0) < 0.02]
    indent = 5.4 * sum(len(other) + 2 for other in same)
    right = 1.7 * max(row["E"] for row in sweep.where(passage="flight", sought="dt"))
    # Below the line where a strict limit, which is named above its line, is just above.
    crowded = any(1.0 < product_of(sweep, other, "strict") / product < 1.15 for other in methods(sweep))
    zoom.annotate(method, (right, product), xytext=(indent, -11 if crowded else 3),
                  textcoords="offset points", fontsize=8.5, color=colour)
    own = sweep.where(passage="bounce", sought="E")
    speeds, gravities = {row["speed"] for row in own}, {row["g"] for row in own}
    for passage, marker in (("flight", "o"), ("bounce", "v")):
        rows = [row for row in sweep.where(method=method, passage=passage, sought="dt")
                if row["outcome"] == "found"
                and (passage == "flight" or (row["speed"] in speeds and row["g"] in gravities))]
        style = {"markerfacecolor": "none" if passage == "flight" else colour, "markeredgecolor": colour,
                 "linewidth": 0, "zorder": 3,
                 "markersize": 3.0 if passage == "bounce" else 4.0 if same else 5.5}
        elasticity = np.array([row["E"] for row in rows])
        stable = np.array([row["stable"] for row in rows])
        axes.plot(elasticity, stable, marker, **style)
        zoom.plot(elasticity, stable * np.sqrt(elasticity), marker, **style)
    # Strict limits as long flights show them.
    rows = [row for row in longer_flights(sweep, method) if row["outcome"] == "found"]
    zoom.plot([row["E"] for row in rows], [row["stable"] * math.sqrt(row["E"]) for row in rows], "X",
              color=colour, markersize=7, zorder=4)


def name_strict_limits(zoom, sweep):
    """Above the dotted lines, which lie near each other."""
    apart = [method for method in methods(sweep)
             if product_of(sweep, method, "strict") < 0.98 * product_of(sweep, method)]
    if not apart:
        return
    place = max(product_of(sweep, method, "strict") for method in apart)
    right = 1.7 * max(row["E"] for row in sweep.where(passage="flight", sought="dt"))
    zoom.annotate("dotted: strict limits of\n" + ",\n".join(apart), (right, place), xytext=(0, 4),
                  textcoords="offset points", fontsize=7.5, color="#5a6068")


def legend_of(axes):
    """The methods' lines, highest edge first, then the markers."""
    lines = sorted((line for line in axes.lines if not line.get_label().startswith("_")),
                   key=lambda line: -line.get_ydata()[0])
    grey = {"color": "#5a6068", "linewidth": 0}
    return [*lines,
            Line2D([], [], marker="o", markerfacecolor="none", label="measured in free flight", **grey),
            Line2D([], [], marker="v", markersize=3.5, label="measured through a bounce", **grey),
            Line2D([], [], marker="X", label="strict limit, measured by long flights (below)", **grey)]


def longer_flights(sweep, method):
    """Flights by which the strict limit is measured: neither the criterion nor ten times of it."""
    usual = sweep.rows[0]
    return [row for row in sweep.rows
            if row["method"] == method and row["passage"] == "flight" and row["growth"] == usual["growth"]
            and row["disturbed"] == usual["disturbed"]
            and row["periods"] not in (0.1 * usual["periods"], usual["periods"], 10 * usual["periods"])]


def product_of(sweep, method, which="predicted"):
    """Δt √E of the predicted edge of free flight."""
    flights = sweep.where(method=method, passage="flight", sought="dt")
    return float(np.median([row[which] * math.sqrt(row["E"]) for row in flights]))


def power_of_ten(value):
    """2.34e9 as 2.34 · 10⁹, 1e-6 as 10⁻⁶."""
    digits, power = f"{value:.2e}".split("e")
    digits = digits.rstrip("0").rstrip(".")
    raised = str(int(power)).translate(str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"))
    return f"10{raised}" if digits == "1" else f"{digits} · 10{raised}"


def draw_slope(axes, product):
    """A triangle below the line: two decades of E, one of the step."""
    e = np.array([1e5, 1e7, 1e5, 1e5])
    step = 0.45 * product * np.array([1e5**-0.5, 1e7**-0.5, 1e7**-0.5, 1e5**-0.5])
    axes.plot(e, step, color="#8a9099", linewidth=0.8, zorder=2)
    axes.text(1.35e5, 1.25 * step[1], "slope −½", fontsize=8, color="#5a6068")


def draw_fixed_step(axes, sweep):
    """The line of the fixed step, and the largest E on it that is stable for the first method."""
    rows = [row for row in sweep.where(passage="flight", sought="E") if row["outcome"] == "found"]
    if not rows:
        return
    largest = rows[0]
    axes.axhline(largest["dt"], color=drawing.MARK, linewidth=0.8, linestyle=(0, (4, 3)), zorder=1)
    axes.plot(largest["stable"], largest["dt"], "D", color=drawing.MARK, markersize=6, zorder=5)
    axes.annotate(f"Δt = {power_of_ten(largest['dt'])} s fails\nabove E = {power_of_ten(largest['stable'])}\n({largest['method']})",
                  (largest["stable"], largest["dt"]), xytext=(-14, -30), textcoords="offset points",
                  ha="right", va="center", fontsize=8.5, color=drawing.MARK)


def draw_examples(axes, examples):
    """The paper's runs; several have the same E and step."""
    places = {}
    for number, place in sorted(examples.items()):
        places.setdefault(place, []).append(str(number))
    for (e, step), numbers in places.items():
        axes.plot(e, step, "s", color=drawing.INK, markersize=5.5, zorder=5)
        word = "Example" if len(numbers) == 1 else "Examples"
        axes.annotate(f"{word}\n{', '.join(numbers)}", (e, step), xytext=(0, 9),
                      textcoords="offset points", ha="center", va="bottom", fontsize=8)


def margin(runs):
    """Part of the stable step used, and the height of the ball's centre, over time;
    `runs`: label to run, the softest impact first."""
    figure, (parts, heights) = plt.subplots(
        2, 1, figsize=(8.2, 5.6), sharex=True, layout="constrained", height_ratios=(2.2, 1.0))
    for number, (label, run) in enumerate(runs.items()):
        colour = METHOD_COLOURS[number]
        time = run.monitor["t"]
        part = run.monitor["stable_part"]
        worst = int(np.argmax(part))
        greatest = part[worst] / part[0]
        parts.plot(time, part / part[0], color=colour, linewidth=1.0,
                   label=f"{label}: at most {greatest:.3f}")
        parts.plot(time[worst], greatest, "o", color=colour, markersize=4.5)
        heights.plot(time, run.monitor["cy"], color=colour, linewidth=1.1)
        heights.axhline(0.0, color=drawing.INK, linewidth=1.0)
    parts.set_ylabel("part of the stable step used,\nover that at the start")
    parts.legend(frameon=False, loc="upper left")
    heights.set_ylabel("height of the\ncentre, cm")
    heights.set_xlabel("t, s")
    for axes in (parts, heights):
        axes.grid(color="#e6e8eb", linewidth=0.6)
        axes.set_xlim(0.0, max(run.monitor["t"][-1] for run in runs.values()))
        for side in ("top", "right"):
            axes.spines[side].set_visible(False)
    first = next(iter(runs.values()))
    e, step = first.scene["law"]["elasticity"], first.scene["time"]["step"]
    drawing.set_caption(figure, "An impact brings the edge nearer, and the vibrations it leaves keep it "
                                f"there (E = {e:g}, Δt = {power_of_ten(step)} s)")
    return figure
