"""Error against run time, from bounce accuracy: of each method the frontier over its contact rules, steps and
tolerances."""

import math

import numpy as np
from matplotlib.patheffects import withStroke
from matplotlib.ticker import LogLocator

from pictures import drawing
from pictures.drawing import plt

COLOURS = {"listing": "#2b5c8a", "leapfrog": "#e08e45", "yoshida-4": "#4fa3a5", "pefrl": "#7a5195",
           "blanes-moan-4": "#6b8e23", "blanes-moan-6": "#a05a2c", "conservative": "#8a9099"}
GSL = "#3d405b"
MARKERS = {"resolved": {"marker": "o", "markersize": 3},
           "listing": {"marker": "x", "markersize": 4, "linestyle": ":"},
           "located": {"marker": "s", "markersize": 3, "linestyle": "--"}}
PANELS = {
    "position": "particles just before\nthe impact, cm",
    "height": "height of the centre\nat the end, cm",
    "energy_lost": "energy lost\nat the end, erg",
    "contact_time": "time in contact, s",
    "flattening": "greatest flattening",
    "energy": "energy at any time, erg",
}
HEADLINE = ("position", "height", "energy_lost")
HEADLINE_METHODS = ("listing", "leapfrog", "pefrl", "blanes-moan-6")
NAMES = {"listing": "paper's scheme"}  # in the headline, whose readers do not know the names of the methods


def colour_of(method):
    return COLOURS.get(method, GSL)


def style_of(contact):
    return MARKERS[contact]


def label_of(method, contact):
    return f"{method}, {contact}"


def lines_of(study, only=None):
    """Name to (methods, colour): a line a method, one for all of GSL's."""
    found = {method: ((method,), colour_of(method)) for method in study.methods()
             if not method.startswith("gsl-") and (only is None or method in only)}
    gsl = tuple(method for method in study.methods() if method.startswith("gsl-"))
    return found | ({"GSL's solvers": (gsl, GSL)} if gsl else {})


def frontiers_of(study, name, lines):
    """Line to its points. Where a method is off by far more than the paper's program, nobody wants it."""
    papers = study.papers()
    worst = 300.0 * max(papers[f"error_{name}"], study.bar[f"error_{name}"]) if papers else math.inf
    found = {label: [(seconds, error) for seconds, error in study.frontier(methods, name) if 0.0 < error <= worst]
             for label, (methods, _) in lines.items()}
    return {label: points for label, points in found.items() if points}


def draw_panel(axes, study, name, lines):
    """Frontiers, the paper's program, and in grey what the reference does not know."""
    frontiers = frontiers_of(study, name, lines)
    axes.set_title(PANELS[name], loc="left", fontsize=9.5)
    if not frontiers:
        axes.text(0.5, 0.5, "nothing to show:\nit starts at a wall", transform=axes.transAxes, ha="center", va="center",
                  color="#5a6068")
        axes.set_axis_off()
        return
    axes.set(xscale="log", yscale="log")
    for label, points in frontiers.items():
        axes.plot(*zip(*points), color=lines[label][1], linewidth=1.5, marker="o", markersize=2.2, label=label,
                  zorder=3)
    if study.papers():
        axes.plot(study.papers_seconds(), study.papers()[f"error_{name}"], marker="*", markersize=13, label="_",
                  color=drawing.MARK, markeredgecolor="white", markeredgewidth=0.6, linestyle="none", zorder=6)
    low, high = axes.get_ylim()
    known = study.bar[f"error_{name}"]
    if known > 0.0:
        low = min(low, known * (known / high) ** 0.09)
        axes.axhspan(low / 10, known, color="#e6e8eb", zorder=0, linewidth=0)
    axes.set_ylim(low, high)
    axes.minorticks_off()
    if high / low < 100.0:  # powers of ten alone would be one or two
        axes.yaxis.set_major_locator(LogLocator(subs=(1, 2, 5)))
        axes.yaxis.set_major_formatter("{x:g}")
    axes.grid(color="#eceef0", linewidth=0.5)
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)


def set_costs(panels, study, names, lines):
    """The same run times in all panels."""
    seconds = [point[0] for name in names for points in frontiers_of(study, name, lines).values() for point in points]
    if study.papers():
        seconds.append(study.papers_seconds())
    if seconds:
        for axes in panels.flat:
            axes.set_xlim(min(seconds) / 2.5, max(seconds) * 2.5)


def place_names(axes, size):
    """The name of each line beside it, where it covers least of lines, stars and other text: tried are places along
    the line."""
    named = [line for line in axes.lines if not line.get_label().startswith("_")]
    if not named:
        return
    to_pixels, renderer = axes.transData.transform, axes.figure.canvas.get_renderer()
    frame_box = axes.get_window_extent().padded(-0.4 * size)
    taken = [text.get_window_extent(renderer).extents for text in axes.texts]
    for star in (line for line in axes.lines if line.get_marker() == "*"):
        x, y = to_pixels((star.get_xdata()[0], star.get_ydata()[0]))
        taken.append((x - size, y - size, x + size, y + size))
    texts = [axes.text(0, 0, line.get_label(), color=line.get_color(), fontsize=size, fontweight="bold", zorder=7,
                       path_effects=[withStroke(linewidth=2.5, foreground="white")]) for line in named]
    boxes = [text.get_window_extent(renderer) for text in texts]
    dense = [dense_line(to_pixels(line.get_xydata())) for line in named]
    others = [np.vstack([np.empty((0, 2)), *dense[:i], *dense[i + 1:]]) for i in range(len(dense))]
    placed = [None] * len(named)
    for _ in range(3):  # again, as those placed first did not know of the others
        for i, box in enumerate(boxes):
            names = [*taken, *(place for j, place in enumerate(placed) if place and j != i)]
            placed[i] = min(candidates(dense[i], box.width, box.height),
                            key=lambda place: cost_of(place, dense[i], others[i], names, frame_box))
    for text, place in zip(texts, placed):
        text.set_position(axes.transData.inverted().transform(place[:2]))


def dense_line(corners, spacing=4.0):
    """Points along a line of these corners, every few pixels."""
    corners = np.asarray(corners, dtype=float)
    parts = [corners[:1]]
    for a, b in zip(corners, corners[1:]):
        count = max(1, int(np.hypot(*(b - a)) / spacing))
        parts.append(a + (b - a) * np.linspace(0, 1, count + 1)[1:, None])
    return np.vstack(parts)


def candidates(line, width, height):
    """Boxes (left, bottom, right, top) beside points of the line."""
    for x, y in line[::3]:
        for gap in (0.5 * height, 1.0 * height):
            for left in (x + gap, x - gap - width):
                for bottom in (y + gap, y - gap - height, y - 0.5 * height):
                    yield left, bottom, left + width, bottom + height
            for bottom in (y + gap, y - gap - height):
                yield x - 0.5 * width, bottom, x + 0.5 * width, bottom + height


def cost_of(box, own, others, names, frame_box):
    """How bad a place for a name is: near other lines than its own, over names, off the panel, far from the middle."""
    left, bottom, right, top = box
    height = top - bottom
    to_own, to_others = distances(box, own), distances(box, others)
    cost = 20.0 * (np.count_nonzero(to_own < 0.35 * height) + np.count_nonzero(to_others < 0.2 * height))
    cost += 3.0 * np.count_nonzero(to_others < 0.7 * height)
    if len(others) and to_others.min() < to_own.min():  # it would be read as that line's
        cost += 300.0
    cost += 10.0 * sum(max(0.0, min(right, name[2]) - max(left, name[0])) *
                       max(0.0, min(top, name[3]) - max(bottom, name[1])) for name in names)
    cost += 50.0 * (max(0.0, frame_box.x0 - left) + max(0.0, right - frame_box.x1) +
                    max(0.0, frame_box.y0 - bottom) + max(0.0, top - frame_box.y1))
    middle = own[len(own) // 2]
    return cost + 0.1 * math.hypot(0.5 * (left + right) - middle[0], 0.5 * (bottom + top) - middle[1])


def distances(box, points):
    """Of the points from the box, pixels; 0 within."""
    x, y = points.T
    across = np.maximum(np.maximum(box[0] - x, x - box[2]), 0.0)
    return np.hypot(across, np.maximum(np.maximum(box[1] - y, y - box[3]), 0.0))


def draw_same_in_bounce(axes, study, name):
    """The paper's scheme, contact and step, as bounce runs them."""
    papers, seconds = study.papers(), study.papers_seconds()
    error = papers[f"error_{name}"]
    axes.plot([papers["seconds"], seconds], [error, error], color=drawing.MARK, linewidth=0.9,
              linestyle=(0, (1, 2)), zorder=4)
    axes.plot([papers["seconds"]], [error], marker="*", markersize=10, markerfacecolor="white", color=drawing.MARK,
              zorder=6)


def headline(study, title, below):
    """Three panels for README, at its width."""
    figure, panels = plt.subplots(1, len(HEADLINE), figsize=(9.0, 4.1), sharex=True, layout="constrained")
    figure.get_layout_engine().set(rect=(0, 0, 1, 0.89))
    times = study.papers_seconds() / study.papers()["seconds"]
    for (x, y), side, text, style in (
            ((0.012, 0.985), "left", title, {"fontsize": 11.5, "fontweight": "bold"}),
            ((0.012, 0.925), "left", below, {"color": "#5a6068"}),
            ((0.992, 0.98), "right", "\N{BLACK STAR} the paper's program", {"color": drawing.MARK}),
            ((0.992, 0.925), "right", f"\N{WHITE STAR} its scheme and steps in bounce: {times:.0f} times sooner",
             {"color": drawing.MARK})):
        figure.text(x, y, text, ha=side, va="top", **({"fontsize": 8.5} | style))
    lines = {NAMES.get(method, method): line for method, line in lines_of(study, HEADLINE_METHODS).items()}
    draw_panels(panels, study, HEADLINE, lines)
    for axes, name in zip(panels, HEADLINE):
        draw_same_in_bounce(axes, study, name)
    panels[0].annotate("the reference knows no better", (0.99, 0.02), xycoords="axes fraction", ha="right", va="bottom",
                       fontsize=7, color="#5a6068")
    name_lines(panels, 8.5)
    return figure


def figure_of(study, title):
    """All methods in all panels."""
    figure, panels = plt.subplots(2, 3, figsize=(10.0, 7.2), sharex=True, layout="constrained")
    drawing.set_caption(figure, title)
    draw_panels(panels, study, PANELS, lines_of(study))
    name_lines(panels, 7.5)
    return figure


def draw_panels(panels, study, names, lines):
    rows = np.atleast_2d(panels)
    for axes in rows[-1]:
        axes.set_xlabel("run time on one core, s")
    for row in rows:
        row[0].set_ylabel("error")
    panels.flat[0].set_xscale("log")
    set_costs(panels, study, names, lines)
    for axes, name in zip(panels.flat, names):
        draw_panel(axes, study, name, lines)


def name_lines(panels, size):
    panels.flat[0].figure.canvas.draw()  # now the panels have their places
    for axes in panels.flat:
        place_names(axes, size)
