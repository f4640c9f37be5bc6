"""How particles, walls and captions look, the same in every figure, and how a figure is written."""

import io
import sys
from pathlib import Path

try:
    import matplotlib
except ImportError:
    print(f"{Path(sys.argv[0]).name}: no matplotlib; install it with: apt-get install python3-matplotlib",
          file=sys.stderr)
    sys.exit(2)

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import EllipseCollection
from matplotlib.colors import to_rgb
from matplotlib.patches import Polygon
from PIL import Image  # comes with matplotlib

from studies.study import InputError

SMALL = 0.13  # radius of a particle, cm: neighbours on ring 1 just touch
LARGE = 2.5 * SMALL  # the paper's factor
RING_COLOURS = {1: "#2b5c8a", 2: "#4fa3a5", 3: "#e08e45"}
GREY = "#c9ccd1"
INK = "#22262b"
MARK = "#c1121f"  # the radius that shows the spin
COLOURS = 128  # of a picture
MOST_BYTES = 200_000  # of a picture: results/ is to weigh little

plt.rcParams.update(
    {
        "font.family": "DejaVu Sans",
        "font.size": 9,
        "text.color": INK,
        "axes.edgecolor": "#8a9099",
        "axes.labelcolor": INK,
        "axes.linewidth": 0.6,
        "axes.titlesize": 9,
        "xtick.color": "#5a6068",
        "ytick.color": "#5a6068",
        "xtick.labelsize": 8,
        "ytick.labelsize": 8,
        "savefig.dpi": 130,
    }
)


def draw_ball(axes, frame, radius, colours=None, **style):
    """One disc a particle, its radius in cm, coloured by ring. Every other disc of a ring lies on
    top, so that no seam shows where the ring closes."""
    colours = colours or RING_COLOURS
    for ring in sorted(set(frame.ring), reverse=True):
        on_ring = np.flatnonzero(frame.ring == ring)
        on_ring = np.concatenate([on_ring[::2], on_ring[1::2]])
        size = np.full(len(on_ring), 2.0 * radius)
        discs = EllipseCollection(
            size,
            size,
            np.zeros_like(size),
            units="xy",
            offsets=np.column_stack([frame.x[on_ring], frame.y[on_ring]]),
            transOffset=axes.transData,
            facecolors=colours[ring],
            **({"edgecolors": "white", "linewidths": 0.15, "zorder": 3} | style),
        )
        axes.add_collection(discs)


def outline(frame):
    """x and y of the outer ring, closed."""
    outer = np.flatnonzero(frame.ring == frame.ring.max())
    closed = np.append(outer, outer[0])
    return frame.x[closed], frame.y[closed]


def draw_spin_mark(axes, frame, **style):
    """The radius to one particle of the outer ring, at the top in the beginning."""
    outer = np.flatnonzero(frame.ring == frame.ring.max())
    top = outer[len(outer) // 4]
    centre = frame.x.mean(), frame.y.mean()
    axes.plot(
        [centre[0], frame.x[top]],
        [centre[1], frame.y[top]],
        **({"color": MARK, "linewidth": 1.4, "solid_capstyle": "round", "zorder": 5} | style),
    )
    axes.plot(frame.x[top], frame.y[top], "o", color=MARK, markersize=3.5, zorder=6)


WALL_DEPTH = 0.8  # how far walls are hatched, cm


def draw_wall(axes, front, back):
    """A wall whose surface runs along the points `front`, hatched as far as the points `back`."""
    axes.add_patch(
        Polygon(
            [*front, *reversed(back)],
            facecolor="#f1f2f4",
            edgecolor="#9aa0a8",
            hatch="////",
            linewidth=0.0,
            zorder=1,
        )
    )
    axes.plot(*zip(*front), color=INK, linewidth=1.2, zorder=2, solid_capstyle="butt")


def draw_floor(axes, left, right):
    """The X axis as a wall."""
    draw_wall(axes, [(left, 0.0), (right, 0.0)], [(left, -WALL_DEPTH), (right, -WALL_DEPTH)])


def set_view(axes, x_range, y_range, ticks=5.0):
    """Equal axes over these ranges (cm), a tick every `ticks` cm."""
    axes.set_aspect("equal")
    axes.set_xlim(*x_range)
    axes.set_ylim(*y_range)
    axes.xaxis.set_major_locator(matplotlib.ticker.MultipleLocator(ticks))
    axes.yaxis.set_major_locator(matplotlib.ticker.MultipleLocator(ticks))
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)


def faded(strength):
    """The rings' colours, mixed with white: 1 as they are, 0 white."""
    rgb = {ring: np.array(to_rgb(colour)) for ring, colour in RING_COLOURS.items()}
    return {ring: 1.0 - strength * (1.0 - colour) for ring, colour in rgb.items()}


def set_caption(figure, text, **where):
    """The line above a figure."""
    figure.suptitle(text, **({"fontsize": 10.5, "x": 0.5} | where))


def save(figure, path, dpi=None):
    """The figure as a PNG. InputError if it is too heavy for results/."""
    pixels = io.BytesIO()
    figure.savefig(pixels, **({"dpi": dpi} if dpi else {}))
    plt.close(figure)
    write_png(Image.open(pixels), path)


def slim_png(path):
    """The same picture with a palette, if it has none."""
    image = Image.open(path)
    if image.mode != "P":
        image.load()
        write_png(image, path)


def write_png(image, path):
    """These drawings have few colours: a palette makes the file a half to a quarter as large."""
    pixels = io.BytesIO()
    image.convert("RGB").quantize(COLOURS, dither=Image.Dither.NONE).save(pixels, format="PNG", optimize=True)
    if pixels.tell() > MOST_BYTES:
        raise InputError(f"{path}: {pixels.tell()} bytes; allowed is at most {MOST_BYTES}")
    temporary = path.with_name(f".{path.name}.tmp")
    temporary.write_bytes(pixels.getvalue())
    temporary.replace(path)
