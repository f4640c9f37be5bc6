"""Figures 10-13: the balls that travel, several times along one axis."""

import numpy as np

from pictures import drawing
from pictures.drawing import plt
from pictures.falls import values
from pictures.paper import EXAMPLES


def left_to_right(run, number, caption):
    """All times at their true x along one axis. Balls next in time overlap, so they are drawn in two
    rows: in each every other ball in colour, those between in outline."""
    times = EXAMPLES[number].times
    frames = [run.at(time) for time in times]
    x_range = (min(f.x.min() for f in frames) - 1.0, max(f.x.max() for f in frames) + 1.0)
    y_range = (-0.8, max(f.y.max() for f in frames) + 2.2)
    width = 11.0  # inches, and the height that two rows to this scale need
    height = 2.0 * width * (y_range[1] - y_range[0]) / (x_range[1] - x_range[0]) + 0.8
    figure, rows = plt.subplots(2, 1, figsize=(width, height), sharex=True, layout="constrained")
    for row, axes in enumerate(rows):
        drawing.set_view(axes, x_range, y_range)
        drawing.draw_floor(axes, *x_range)
        for i, frame in enumerate(frames):
            if i % 2 != row:
                axes.plot(*drawing.outline(frame), color=drawing.GREY, linewidth=0.8, zorder=2)
                continue
            drawing.draw_ball(axes, frame, drawing.LARGE, linewidths=0.1)
            drawing.draw_spin_mark(axes, frame)
            top = frame.y.max() + 0.7
            axes.text(frame.x.mean(), top, f"t = {times[i]:g}", ha="center", va="bottom")
    rows[-1].set_xlabel("cm")
    note = "every other time in colour; the red radius goes to the same particle"
    rows[0].set_title(note, loc="left")
    drawing.set_caption(figure, f"{caption}: {values(run)}")
    return figure


def example_5(runs):
    """Figure 10."""
    return left_to_right(runs[5], 5, "Figure 10, Example 5: thrown onto an axis with friction")


def example_6(runs):
    """Figure 11."""
    return left_to_right(runs[6], 6, "Figure 11, Example 6: thrown onto a frictionless axis")


def incline_axes(axes, x_range, y_range):
    """The X axis and the incline x + y = 0 that falls to meet it at the origin."""
    drawing.set_view(axes, x_range, y_range)
    left, right, depth = x_range[0], x_range[1], drawing.WALL_DEPTH
    across = depth * np.sqrt(2.0)  # the depth of the incline, measured along y
    drawing.draw_wall(
        axes,
        [(left, -left), (0.0, 0.0), (right, 0.0)],
        [(left, -left - across), (depth - across, -depth), (right, -depth)],
    )


def example_7_start(runs):
    """Figure 12."""
    run = runs[7]
    figure, axes = plt.subplots(figsize=(6.4, 5.1), layout="constrained")
    incline_axes(axes, (-17.0, 10.0), (-0.8, 19.0))
    drawing.draw_ball(axes, run.at(0.0), drawing.LARGE)
    axes.set_xlabel("cm")
    caption = "Figure 12, Example 7: on a frictionless incline of 45°"
    drawing.set_caption(figure, f"{caption}: {values(run)}")
    return figure


def draw_trajectory(axes, run, times):
    """The ball at all times, the later the stronger in colour, and the path of its centre."""
    incline_axes(axes, (-17.0, 22.0), (-0.8, 19.0))
    axes.plot(run.monitor["cx"], run.monitor["cy"], color=drawing.MARK, linewidth=1.2, zorder=6)
    for time in times:
        frame = run.at(time)
        strength = 0.3 + 0.7 * time / times[-1]
        colours = drawing.faded(strength)
        drawing.draw_ball(axes, frame, drawing.SMALL, colours, zorder=3 + strength)
        centre = frame.x.mean(), frame.y.mean()
        axes.plot(*centre, "o", color=drawing.MARK, markersize=4, zorder=6)
        axes.annotate(
            f"t = {time:g}",
            centre,
            xytext=(0, -12),
            textcoords="offset points",
            ha="center",
            va="center",
            zorder=7,
            bbox={"facecolor": "white", "edgecolor": "none", "alpha": 0.85, "pad": 1.0},
        )
    axes.set_title("the later the stronger in colour; red: path of the centre", loc="left")


def example_7(runs):
    """Figure 13: the trajectory as one drawing, then each of its times alone."""
    run, times = runs[7], EXAMPLES[7].times
    figure = plt.figure(figsize=(9.6, 7.7), layout="constrained")
    grid = figure.add_gridspec(2, len(times), height_ratios=(2.3, 1.0))
    draw_trajectory(figure.add_subplot(grid[0, :]), run, times)
    for i, time in enumerate(times):
        axes = figure.add_subplot(grid[1, i])
        incline_axes(axes, (-10.0, 18.0), (-0.8, 19.0))
        drawing.draw_ball(axes, run.at(time), drawing.LARGE, linewidths=0.1)
        drawing.draw_spin_mark(axes, run.at(time))
        axes.set_title(f"t = {time:g} s")
        axes.set_xlabel("cm")
    caption = "Figure 13, Example 7: down the incline and off the axis"
    drawing.set_caption(figure, f"{caption}: {values(run)}")
    return figure
