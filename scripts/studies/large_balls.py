#!/usr/bin/python3
"""Makes the table and the picture of a Google Benchmark JSON of bounce_bench_large.

  scripts/studies/large_balls.py FILE.json DIR    writes DIR/large-balls.md and .png
"""

import math
import statistics
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from pictures import drawing
from studies import benchmarks, study
from studies.study import InputError

FIGURES = ("ns_per_particle_step", "x_papers_ball", "sweep_ns_per_particle_step", "sweep_x_papers_ball",
           "memory_bytes_per_s", "memory_ns_per_particle_step", "build_s")
COLOURS = {1: "#2b5c8a", 2: "#e08e45"}  # by threads


def read(path):
    """Its context, by (particles, threads) the median of each figure over the repetitions, and how many those are."""
    data = benchmarks.read(path)
    repetitions = {}
    for name, same in benchmarks.rows(data).items():
        words = dict(word.split(":") for word in name.split("/") if ":" in word)
        for run in same:
            if run.get("error_occurred"):
                raise InputError(f"{path}: {name}: {run.get('error_message')}")
            for figure in FIGURES:
                value = run.get(figure)
                if not (isinstance(value, (int, float)) and math.isfinite(value) and value > 0.0):
                    raise InputError(f"{path}: {name}: {figure} is {value}")
        repetitions[int(words["threads"]), int(words["particles"])] = same
    if not repetitions:
        raise InputError(f"{path}: no rows")
    medians = {(particles, threads): {figure: statistics.median(run[figure] for run in same) for figure in FIGURES}
               for (threads, particles), same in sorted(repetitions.items())}
    return data["context"], medians, min(len(same) for same in repetitions.values())


def table(context, rows, repetitions):
    """The Markdown of it."""
    head = ["particles", "threads", "tiles, ns", "×", "plain sweep, ns", "×", "memory alone, ns", "memory, GB/s",
            "built in, s"]
    lines = [[f"{particles:,}".replace(",", " "), f"{threads}", f"{row['ns_per_particle_step']:.2f}",
              f"{row['x_papers_ball']:.2f}", f"{row['sweep_ns_per_particle_step']:.2f}",
              f"{row['sweep_x_papers_ball']:.2f}", f"{row['memory_ns_per_particle_step']:.2f}",
              f"{row['memory_bytes_per_s'] / 1e9:.1f}", f"{row['build_s']:.2g}"]
             for (particles, threads), row in rows.items()]
    return "\n".join([
        "# Large balls\n",
        f"Three rings, a particle-step; medians of {repetitions} repetitions of {context.get('turns', '?')} turns. "
        "× is the ratio to the paper's ball",
        "of 360 by one thread, made turn by turn. Tiles: as the plan runs it, up to 16 stages on a tile in cache; "
        "plain sweep: the same",
        "kernel, once through memory a stage, with the same bits. Memory alone: 64 bytes at the rate at which "
        "memory was read and written",
        "in place in the same turn.\n",
        study.table(head, lines),
        "![A particle-step's time over the number of particles](large-balls.png)\n",
        f"Made by `scripts/studies/large_balls.sh` {benchmarks.origin_text(context)}.\n"])


def draw(context, rows):
    """Cost against number of particles: tiles, plain sweep, memory alone."""
    figure, axes = drawing.plt.subplots(figsize=(7.2, 5.2), layout="constrained")
    for threads in sorted({threads for _, threads in rows}):
        sizes = [particles for particles, of in rows if of == threads]
        word = f"{threads} thread{'s' if threads > 1 else ''}"
        for name, label, style in (("ns_per_particle_step", "tiles in cache", {"marker": "o", "linewidth": 1.6}),
                                   ("sweep_ns_per_particle_step", "plain sweep", {"marker": "s", "linestyle": "--"}),
                                   ("memory_ns_per_particle_step", "memory alone", {"linestyle": ":"})):
            axes.plot(sizes, [rows[size, threads][name] for size in sizes], color=COLOURS.get(threads, drawing.INK),
                      markersize=4, label=f"{label}, {word}", **({"linewidth": 1.1} | style))
    base = rows.get((360, 1))
    if base:
        axes.axhline(base["ns_per_particle_step"], color=drawing.GREY, zorder=0)
        axes.annotate("the paper's ball by one thread", (0.35, base["ns_per_particle_step"]),
                      xycoords=("axes fraction", "data"), ha="left", va="bottom", fontsize=7.5, color="#5a6068")
    axes.set_xscale("log")
    axes.set_yscale("log")
    for axis in (axes.yaxis.set_major_formatter, axes.yaxis.set_minor_formatter):
        axis("{x:g}")
    axes.set_xlabel("particles")
    axes.set_ylabel("ns a particle-step")
    axes.grid(color="#e6e8eb", linewidth=0.6, which="both")
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.14), ncols=2, frameon=False, fontsize=8)
    drawing.set_caption(figure, f"Three rings of 120 to 3.3 million columns ({context['cpu']})")
    return figure


def main():
    if len(sys.argv) != 3:
        raise InputError(__doc__.strip())
    context, rows, repetitions = read(sys.argv[1])
    folder = Path(sys.argv[2])
    figure = draw(context, rows)
    try:
        drawing.save(figure, folder / "large-balls.png")
        study.write_whole(folder / "large-balls.md", table(context, rows, repetitions))
    except OSError as error:
        raise InputError(f"{folder}: cannot be written: {error.strerror}") from error


if __name__ == "__main__":
    study.run(main)
