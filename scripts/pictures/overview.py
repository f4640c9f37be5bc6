"""One figure the paper has not: height and energies of Examples 1 and 2 against time."""

from pictures import drawing
from pictures.drawing import plt
from pictures.falls import values

LINES = {  # column of monitor.csv -> label, colour
    "kinetic": ("kinetic", "#e08e45"),
    "gravity": ("gravity", "#2b5c8a"),
    "bond": ("bonds", "#4fa3a5"),
    "total": ("total", drawing.INK),
}


def overview(runs):
    """Height of the centre above, energies relative to the start below."""
    figure, (heights, energies) = plt.subplots(
        2, 2, figsize=(9.6, 6.0), sharex=True, sharey="row", layout="constrained"
    )
    for column, number in enumerate((1, 2)):
        run = runs[number]
        time = run.monitor["t"]
        heights[column].plot(time, run.monitor["cy"], color=drawing.INK, linewidth=1.4)
        heights[column].fill_between(time, run.monitor["lowest"], color=drawing.GREY, alpha=0.5)
        heights[column].set_title(f"Example {number}: {values(run)}")
        for name, (label, colour) in LINES.items():
            energies[column].plot(time, run.monitor[name], color=colour, linewidth=1.2, label=label)
        energies[column].set_xlabel("t, s")
        for axes in (heights[column], energies[column]):
            axes.grid(color="#e6e8eb", linewidth=0.6)
            axes.set_xlim(0.0, time[-1])
            for side in ("top", "right"):
                axes.spines[side].set_visible(False)
    heights[0].set_ylim(bottom=0.0)
    heights[0].set_ylabel("height of the centre, cm\n(grey: gap below the ball)")
    energies[0].set_ylabel("energy since the start\ng cm²/s²")
    energies[0].legend(frameon=False, loc="upper left")
    drawing.set_caption(figure, "The bounce of a soft and of a stiff ball")
    return figure
