#!/usr/bin/python3
"""Makes the table and the picture of a Google Benchmark JSON of bounce_bench_large.

  scripts/large_balls.py FILE.json DIR    writes DIR/large-balls.md, .png and .svg
"""
import json
import math
import statistics
import sys
from pathlib import Path

FIGURES = ("ns_per_particle_step", "x_papers_ball", "sweep_ns_per_particle_step", "sweep_x_papers_ball",
           "memory_bytes_per_s", "memory_ns_per_particle_step", "build_s")
TARGET = 1.5  # of the largest ball's cost to the paper's ball's
COLOURS = {1: "#2b5c8a", 2: "#e08e45"}  # by threads


class InputError(Exception):
    """A file that cannot be used; the message says which and why."""


def read(path):
    """Its context, and by (particles, threads) the median of each figure over the repetitions."""
    try:
        data = json.loads(Path(path).read_text(encoding="utf-8"))
        runs = [run for run in data["benchmarks"] if run["run_type"] == "iteration"]
        context = data["context"]
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise InputError(f"{path}: not a result of bounce_bench_large: {error}") from error
    repetitions = {}
    for run in runs:
        words = dict(word.split(":") for word in run["run_name"].split("/") if ":" in word)
        key = int(words["particles"]), int(words["threads"])
        if run.get("error_occurred"):
            raise InputError(f"{path}: {run['run_name']}: {run.get('error_message')}")
        for figure in FIGURES:
            value = run.get(figure)
            if not (isinstance(value, (int, float)) and math.isfinite(value) and value > 0.0):
                raise InputError(f"{path}: {run['run_name']}: {figure} is {value}")
        repetitions.setdefault(key, []).append(run)
    if not repetitions:
        raise InputError(f"{path}: no rows")
    return context, {key: {figure: statistics.median(run[figure] for run in same) for figure in FIGURES}
                     for key, same in sorted(repetitions.items(), key=lambda item: (item[0][1], item[0][0]))}, \
        min(len(same) for same in repetitions.values())


def table(context, rows, repetitions):
    """The Markdown of it."""
    lines = [
        "# Large balls", "",
        f"Three rings, a particle-step; medians of {repetitions} repetitions of {context.get('turns', '?')} turns. "
        "× is the ratio to the paper's ball",
        "of 360 by one thread, made turn by turn. Tiles: as the plan runs it, up to 16 stages on a tile in cache; "
        "plain sweep: the same",
        "kernel, once through memory a stage, with the same bits. Memory alone: 64 bytes at the rate at which "
        "memory was read and written",
        "in place in the same turn.", "",
        "| particles | threads | tiles, ns | × | plain sweep, ns | × | memory alone, ns | memory, GB/s | built in, s |",
        "| --- | --- | --- | --- | --- | --- | --- | --- | --- |"]
    for (particles, threads), row in rows.items():
        count = f"{particles:,}".replace(",", " ")
        lines.append(
            f"| {count} | {threads} | {row['ns_per_particle_step']:.2f} | {row['x_papers_ball']:.2f} | "
            f"{row['sweep_ns_per_particle_step']:.2f} | {row['sweep_x_papers_ball']:.2f} | "
            f"{row['memory_ns_per_particle_step']:.2f} | {row['memory_bytes_per_s'] / 1e9:.1f} | {row['build_s']:.2g} |")
    lines += ["", f"Made by `scripts/large_balls.sh` at commit {context['commit']}, {context['date']}, on "
              f"{context['cpu']} ({context['num_cpus']} cores), {context['compiler']}, {context['flags']}."]
    return "\n".join(lines) + "\n"


def draw(context, rows):
    """Cost against number of particles: tiles, plain sweep, memory alone."""
    try:
        from pictures import drawing
    except ImportError as missing:
        raise InputError(f"{missing}; install it with: apt-get install python3-matplotlib") from missing
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
        axes.axhline(TARGET * base["ns_per_particle_step"], color=drawing.GREY, zorder=0)
        axes.annotate(f"{TARGET} × the paper's ball by one thread", (0.3, TARGET * base["ns_per_particle_step"]),
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
        (folder / "large-balls.md").write_text(table(context, rows, repetitions), encoding="utf-8")
        for kind in ("png", "svg"):
            figure.savefig(folder / f"large-balls.{kind}",
                           metadata={"Date": None} if kind == "svg" else None)
    except OSError as error:
        raise InputError(f"{folder}: cannot be written: {error.strerror}") from error


if __name__ == "__main__":
    try:
        main()
    except InputError as error:
        print(f"large_balls.py: {error}", file=sys.stderr)
        sys.exit(2)
