"""Figures 1-4: the ball at rest, and who is neighbour to whom."""

import numpy as np

from pictures import drawing
from pictures.drawing import plt
from pictures.run import Frame


def ball_at_origin(runs):
    """The ball of Example 2's start, its centre moved to the origin."""
    start = runs[2].at(0.0)
    centre = runs[2].scene["ball"]["centre"]
    return Frame(0.0, start.x - centre[0], start.y - centre[1], start.ring)


def bare_axes(size, x_range, y_range):
    figure, axes = plt.subplots(figsize=size, layout="constrained")
    drawing.set_view(axes, x_range, y_range, ticks=2.0)
    return figure, axes


def points(runs):
    """Figure 1: the 360 points and the sense in which they are numbered."""
    ball = ball_at_origin(runs)
    figure, axes = bare_axes((5.6, 5.8), (-8.6, 8.6), (-8.6, 8.6))
    for ring, colour in drawing.RING_COLOURS.items():
        on_ring = ball.ring == ring
        axes.plot(ball.x[on_ring], ball.y[on_ring], ".", color=colour, markersize=2.6)
        first = np.flatnonzero(on_ring)[0]
        axes.plot(ball.x[first], ball.y[first], "o", color=colour, markersize=5)
        radius = np.hypot(ball.x[first], ball.y[first])
        numbers = f"ring {ring}, r = {radius:.0f} cm: {first + 1}–{first + on_ring.sum()}"
        axes.text(0.0, 1.0 - 0.8 * ring, numbers, color=colour, ha="center")
    axes.text(0.0, 1.2, "360 points", ha="center")
    angle = np.radians(np.linspace(8.0, 40.0, 30))
    axes.plot(7.9 * np.cos(angle), 7.9 * np.sin(angle), color=drawing.INK, linewidth=1.0)
    axes.annotate(
        "",
        xy=7.9 * np.array([np.cos(angle[-1] + 0.04), np.sin(angle[-1] + 0.04)]),
        xytext=7.9 * np.array([np.cos(angle[-1]), np.sin(angle[-1])]),
        arrowprops={"arrowstyle": "-|>", "color": drawing.INK},
    )
    axes.set_xlabel("cm")
    drawing.set_caption(figure, "Figure 1: the 360 points, numbered counter-clockwise")
    return figure


def discs(runs, radius, caption):
    figure, axes = bare_axes((5.0, 5.2), (-8.0, 8.0), (-8.0, 8.0))
    drawing.draw_ball(axes, ball_at_origin(runs), radius)
    axes.set_xlabel("cm")
    drawing.set_caption(figure, caption)
    return figure


def small_particles(runs):
    """Figure 2."""
    return discs(runs, drawing.SMALL, "Figure 2: the ball, small particles")


def large_particles(runs):
    """Figure 3."""
    return discs(runs, drawing.LARGE, "Figure 3: the ball, particles 2.5 times as large")


def neighbours(ball, particle):
    """By the paper's definition: the two nearest on the particle's own ring and on each ring beside
    it."""
    distance = np.hypot(ball.x - ball.x[particle], ball.y - ball.y[particle])
    distance[particle] = np.inf
    found = []
    for ring in (ball.ring[particle] - 1, ball.ring[particle], ball.ring[particle] + 1):
        candidates = np.flatnonzero(ball.ring == ring)
        found.extend(candidates[np.argsort(distance[candidates])[:2]])
    return found


def neighbours_of_each_ring(runs):
    """Figure 4 (the paper's text calls it Figure 5)."""
    ball = ball_at_origin(runs)
    figure, all_axes = plt.subplots(1, 3, figsize=(9.6, 4.0), layout="constrained")
    for ring, axes in zip((1, 2, 3), all_axes):
        drawing.set_view(axes, (-1.35, 1.35), (4.6, 7.5), ticks=1.0)
        drawing.draw_ball(axes, ball, 0.05, {1: drawing.GREY, 2: drawing.GREY, 3: drawing.GREY})
        particle = np.flatnonzero(ball.ring == ring)[30]  # at the top
        own = neighbours(ball, particle)
        for other in own:
            ends = [particle, other]
            axes.plot(ball.x[ends], ball.y[ends], color=drawing.INK, linewidth=1.1, zorder=2)
        for i in [particle, *own]:
            style = {"facecolor": drawing.RING_COLOURS[ball.ring[i]], "zorder": 4}
            style |= {"edgecolor": drawing.MARK, "linewidth": 1.8} if i == particle else {}
            axes.add_patch(plt.Circle((ball.x[i], ball.y[i]), 0.09, **style))
            if i == particle:  # its number stands in the title
                continue
            above = ball.ring[i] >= ring
            axes.annotate(
                f"{i + 1}",
                (ball.x[i], ball.y[i]),
                xytext=(0, 14 if above else -14),
                textcoords="offset points",
                ha="center",
                va="center",
                fontsize=8,
            )
        axes.set_title(f"particle {particle + 1} of ring {ring}: {len(own)} neighbours")
        axes.set_xlabel("cm")
    drawing.set_caption(figure, "Figure 4: the neighbours of one particle of each ring")
    return figure
