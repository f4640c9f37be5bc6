"""The edge of stability: the plane of E and time step, and the margin through a bounce."""

import csv
import math
from dataclasses import dataclass

import numpy as np

from pictures import drawing
from pictures.drawing import plt
from pictures.run import RunError

METHOD_COLOURS = ["#2b5c8a", "#e08e45", "#4fa3a5", "#7a5195", "#6b8e23", "#a05a2c"]
STABLE, UNSTABLE = "#eef4f0", "#f7ecea"


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
    """RunError if the folder holds no sweep, or one with a number that is none."""
    path = folder / "edge.csv"
    try:
        with open(path, newline="") as file:
            rows = list(csv.DictReader(file))
        for row in rows:
            for key, text in row.items():
                if key not in TEXTS:
                    row[key] = float(text) if text else math.nan
    except (OSError, TypeError, ValueError) as error:
        raise RunError(f"{path}: cannot be read: {error}") from error
    if not rows or any(key not in rows[0] for key in (*TEXTS, "E", "dt", "stable", "unstable")):
        raise RunError(f"{path}: no rows of bounce stability")
    return Sweep(path, rows)


def methods(sweep):
    return list(dict.fromkeys(row["method"] for row in sweep.rows))


def plane(sweep, examples):
    """Stable and unstable steps over E; `examples`: number to (E, dt)."""
    figure, axes = plt.subplots(figsize=(8.2, 6.0), layout="constrained")
    e = np.array(sorted(row["E"] for row in sweep.where(passage="flight", sought="dt")))
    product = product_of(sweep, methods(sweep)[0])
    e_line = np.geomspace(e[0] / 3, e[-1] * 30, 50)
    low, high = 2e-7, 0.2
    edge = product / np.sqrt(e_line)
    axes.fill_between(e_line, low, edge, color=STABLE, zorder=0)
    axes.fill_between(e_line, edge, high, color=UNSTABLE, zorder=0)
    axes.text(20, 2e-5, "stable", fontsize=13, color="#5f8a70")
    axes.text(2e7, 6e-3, "unstable", fontsize=13, color="#b0645c")
    by_product = {}  # methods with the same limit share a line
    for method in methods(sweep):
        by_product.setdefault(f"{product_of(sweep, method):.4g}", []).append(method)
    for number, (text, names) in enumerate(by_product.items()):
        axes.plot(e_line, float(text) / np.sqrt(e_line), zorder=2,
                  color=METHOD_COLOURS[number % len(METHOD_COLOURS)] if number else drawing.INK,
                  linewidth=0.8 if number else 1.1,
                  label=f"predicted: Δt √E = {text} ({', '.join(names)})")
    for number, method in enumerate(methods(sweep)):
        colour = METHOD_COLOURS[number % len(METHOD_COLOURS)]
        size = 7.5 - 2.5 * number / max(len(methods(sweep)) - 1, 1)
        for passage, marker in (("flight", "o"), ("bounce", "v")):
            rows = sweep.where(method=method, passage=passage, sought="dt")
            if passage == "bounce":
                own = {row["speed"] for row in sweep.where(passage="bounce", sought="E")}
                gravity = {row["g"] for row in sweep.where(passage="bounce", sought="E")}
                rows = [row for row in rows if row["speed"] in own and row["g"] in gravity]
            rows = [row for row in rows if row["outcome"] == "found"]
            axes.plot([row["E"] for row in rows], [row["stable"] for row in rows], marker,
                      markerfacecolor="none" if passage == "flight" else colour,
                      markeredgecolor=colour, markersize=size if passage == "flight" else 3.0,
                      linewidth=0, zorder=3, label=f"{method}, measured: {passage}")
    draw_slope(axes, product)
    draw_fixed_step(axes, sweep)
    draw_examples(axes, examples)
    axes.set(xscale="log", yscale="log", xlim=(e_line[0], e_line[-1]), ylim=(low, high),
             xlabel="E", ylabel="time step Δt, s")
    axes.legend(frameon=False, loc="upper right", fontsize=8)
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)
    drawing.set_caption(figure, "How large a time step is stable?")
    return figure


def product_of(sweep, method):
    """Δt √E of the predicted edge of free flight."""
    flights = sweep.where(method=method, passage="flight", sought="dt")
    return float(np.median([row["predicted"] * math.sqrt(row["E"]) for row in flights]))


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
    """The line of the fixed step, to the largest E that is stable on it."""
    rows = [row for row in sweep.where(passage="flight", sought="E") if row["outcome"] == "found"]
    if not rows:
        return
    largest = max(rows, key=lambda row: row["stable"])
    axes.axhline(largest["dt"], color=drawing.MARK, linewidth=0.8, linestyle=(0, (4, 3)), zorder=1)
    axes.plot(largest["stable"], largest["dt"], "D", color=drawing.MARK, markersize=6, zorder=5)
    axes.annotate(f"Δt = {power_of_ten(largest['dt'])} s fails\nabove E = {power_of_ten(largest['stable'])}",
                  (largest["stable"], largest["dt"]), xytext=(-14, -27), textcoords="offset points",
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
