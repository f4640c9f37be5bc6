"""Figures 5-9: the balls that fall from rest, a panel a time."""

import string

from pictures import drawing
from pictures.drawing import plt
from pictures.paper import EXAMPLES


def values(run):
    """E and g of a run, for captions."""
    gravity = -run.scene["gravity"]["acceleration"][1]
    return f"E = {run.scene['law']['elasticity']:g}, g = {gravity:g} cm/s²"


def panels(run, number, caption, shape, size, x_range, y_range):
    """One panel for each of the example's times, row by row, all to the same scale."""
    figure, all_axes = plt.subplots(
        *shape, figsize=size, sharex=True, sharey=True, layout="constrained"
    )
    for letter, time, axes in zip(string.ascii_lowercase, EXAMPLES[number].times, all_axes.flat):
        drawing.set_view(axes, x_range, y_range)
        drawing.draw_floor(axes, *x_range)
        drawing.draw_ball(axes, run.at(time), drawing.LARGE, linewidths=0.1)
        axes.set_title(f"({letter})  t = {time:g} s")
    for axes in all_axes.flat[-shape[1] :]:
        axes.set_xlabel("cm")
    drawing.set_caption(figure, f"{caption}: {values(run)}")
    return figure


def example_1(runs):
    """Figure 5."""
    caption = "Figure 5, Example 1: a soft ball falls"
    return panels(runs[1], 1, caption, (2, 3), (8.6, 6.1), (-9.5, 9.5), (-0.8, 18.0))


def example_1_flattened(runs):
    """Figure 6: Figure 5(d) with small particles."""
    run = runs[1]
    figure, axes = plt.subplots(figsize=(7.4, 6.2), layout="constrained")
    x_range = (-9.5, 9.5)
    drawing.set_view(axes, x_range, (-0.8, 14.0))
    drawing.draw_floor(axes, *x_range)
    drawing.draw_ball(axes, run.at(9.0), drawing.SMALL)
    axes.set_xlabel("cm")
    drawing.set_caption(figure, f"Figure 6, Example 1 at t = 9 s, small particles: {values(run)}")
    return figure


def example_2(runs):
    """Figure 7."""
    caption = "Figure 7, Example 2: a stiff ball falls and stays round"
    return panels(runs[2], 2, caption, (2, 3), (8.6, 6.1), (-9.5, 9.5), (-0.8, 18.0))


def example_3(runs):
    """Figure 8."""
    caption = "Figure 8, Example 3: a soft ball collapses under strong gravity"
    return panels(runs[3], 3, caption, (1, 3), (9.6, 3.8), (-12.5, 12.5), (-0.8, 23.0))


def example_4(runs):
    """Figure 9."""
    caption = "Figure 9, Example 4: a stiff ball bounces under strong gravity"
    return panels(runs[4], 4, caption, (3, 5), (10.6, 8.3), (-9.5, 9.5), (-0.8, 23.0))
