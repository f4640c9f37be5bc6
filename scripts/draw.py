#!/usr/bin/python3
"""Draws any run of bounce: the ball at the times that were kept, and the height of its centre over time.

    scripts/draw.py RUN [RUN ...]      a directory that bounce run has written; the picture is RUN/picture.png

More balls: bounce run ... --set output.frames_every=0.5 (s); of many, ten are drawn.
"""

import sys
from pathlib import Path

import numpy as np

from pictures import drawing
from pictures.drawing import plt
from pictures.run import read_run
from studies import study
from studies.study import InputError

MOST_BALLS = 10


def some_of(frames):
    """At most MOST_BALLS, the first and the last among them, evenly between."""
    at = np.linspace(0, len(frames) - 1, min(MOST_BALLS, len(frames))).round().astype(int)
    return [frames[i] for i in at]


def draw_walls(axes, walls, x_range, y_range):
    """Each wall's line across the view; the ball stays on the side that its normal points to."""
    far = 2.0 * (x_range[1] - x_range[0] + y_range[1] - y_range[0])
    middle = np.array([np.mean(x_range), np.mean(y_range)])
    for wall in walls:
        normal = np.array(wall["normal"], dtype=float)
        normal /= np.hypot(*normal)
        along = np.array([-normal[1], normal[0]])
        foot = middle - (middle @ normal - wall["offset"]) * normal
        front = [foot - far * along, foot + far * along]
        drawing.draw_wall(axes, front, [point - drawing.WALL_DEPTH * normal for point in front])


def figure_of(run):
    frames = some_of(run.frames)
    x_range = min(f.x.min() for f in frames) - 1.5, max(f.x.max() for f in frames) + 1.5
    y_range = min(f.y.min() for f in frames) - 1.5, max(f.y.max() for f in frames) + 1.5
    shape = (x_range[1] - x_range[0]) / (y_range[1] - y_range[0])
    rows = -(-len(frames) // 6)
    columns = -(-len(frames) // rows)
    width = min(2.2, 3.0 * shape)
    figure = plt.figure(figsize=(max(6.0, columns * width + 0.8), rows * (width / shape + 0.4) + 2.4),
                        layout="constrained")
    balls, curve = figure.subfigures(2, 1, height_ratios=[rows * (width / shape + 0.4), 2.0])
    panels = balls.subplots(rows, columns, sharex=True, sharey=True, squeeze=False).ravel()
    for axes, frame in zip(panels, frames):
        drawing.set_view(axes, x_range, y_range)
        draw_walls(axes, run.scene.get("wall", []), x_range, y_range)
        drawing.draw_ball(axes, frame, drawing.SMALL)
        axes.set_title(f"t = {frame.time:g} s")
    for axes in panels[len(frames):]:
        axes.axis("off")
    axes = curve.subplots()
    axes.plot(run.monitor["t"], run.monitor["cy"], color=drawing.RING_COLOURS[1], linewidth=1.2)
    axes.set(xlabel="time, s", ylabel="height of the centre, cm")
    axes.grid(color="#eceef0")
    drawing.set_caption(figure, run.scene["title"] or run.path.name)
    return figure


def main():
    names = sys.argv[1:]
    if not names or any(name.startswith("-") for name in names):
        print(__doc__, file=sys.stderr)
        return 0 if names in (["-h"], ["--help"]) else 2
    for name in names:
        path = Path(name) / "picture.png"
        if (Path(name) / "run.json").is_file() and not (Path(name) / "frames.extxyz").is_file():
            raise InputError(f"{name}: no balls were kept; run it with --set output.frames_every=0.5 or so (s)")
        figure = figure_of(read_run(Path(name)))
        drawing.save(figure, path)
        print(path)
    return 0


if __name__ == "__main__":
    study.run(main)
