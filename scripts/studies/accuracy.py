#!/usr/bin/python3
"""Draws error against run time and makes its table, from what scripts/studies/accuracy.sh has put into runs/.

  scripts/studies/accuracy.py SCENE...    takes these scenes from RUNS/accuracy-SCENE
  scripts/studies/accuracy.py             all pictures and the page once more, from OUT/accuracy alone

Writes OUT/accuracy/: of each scene accuracy.csv, scene.toml, origin.json and a picture, and headline.png; and
OUT/accuracy.md, the table of these and of all scenes that OUT/accuracy holds already. From studies of clean commits
only, unless --allow-dirty.
"""

import math
import shutil
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from pictures import accuracy, drawing
from studies import errors, study

FILES = ("accuracy.csv", "origin.json", "scene.toml")
HEADLINE = ("example-2", "Example 2: the error of an answer, and what it costs",
            "A line: the best of a method over contact rules and time steps.")


def told(error, bar):
    return f"< {bar:.1e}" if error <= bar else f"{error:.1e}"


def row_of(scene, found):
    """A line of the table: the paper's program and the cheapest setting as good."""
    papers, best = found.papers(), found.origin.get("best")
    bar, commit = found.bar["error_height"], found.origin["commit"]
    if not papers or not best or best.get("precision", "double") != "double":
        return [scene, "-", "-", "-", "-", "-", told(math.nan, bar), "-", commit]
    row = next(row for row in found.rows if all(row[name] == best[name] for name in ("method", "contact", "dt")))
    return [scene, f"{found.papers_seconds():.3g}", told(papers["error_height"], bar),
            f"{accuracy.label_of(best['method'], best['contact'])}, {best['dt']:.3g}", f"{row['seconds']:.2g}",
            told(row["error_height"], bar), f"{bar:.1e}", f"**{found.papers_seconds() / row['seconds']:.0f}**", commit]


def left_out_text(found):
    left_out = sum(each.left_out for each in found.values())
    if not left_out:
        return []
    return ["At these commits the program had single and compensated precision, too. It no longer has them: their "
            f"{left_out} rows are left out of table and pictures.\n"]


def markdown(found):
    head = ["scene", "paper's program, s", "its error, cm", "cheapest setting as good: method, contact, Δt",
            "run, s", "its error, cm", "known to, cm", "times sooner", "at commit"]
    machines = sorted({each.origin["cpu"] for each in found.values()})
    picture = [f"![{HEADLINE[1]}](accuracy/headline.png)\n"] if HEADLINE[0] in found else []
    return "\n".join([
        "# Error against run time\n",
        *picture,
        "The paper's program is the listing's scheme and contact with Δt = 1e-6 s on the oracle. As good: in each "
        f"of {', '.join(errors.OBSERVABLES)}, no further from the reference. Errors shown are those of the height "
        "of the centre at the end. One core; known to: what the reference courses differ by.\n",
        study.table(head, [row_of(scene, each) for scene, each in found.items()]),
        "A picture of all methods and errors: " +
        ", ".join(f"[{scene}](accuracy/{scene}.png)" for scene in found) +
        ". A line is the best of a method over its contact rules, steps and tolerances: no cheaper row is as good. "
        "Where it reaches the grey band, it is as good as the reference is known.\n",
        *left_out_text(found),
        f"Made by `scripts/studies/accuracy.sh` at the commits named, on {', '.join(machines)}; all rows and each "
        "scene's date: `results/accuracy/`.",
        "",
    ])


def draw(found, folder):
    for scene, each in found.items():
        title = f"{scene}: error against run time (star: the paper's program; grey: the reference knows no better)"
        drawing.save(accuracy.figure_of(each, title), folder / f"{scene}.png")
        if scene == HEADLINE[0] and each.papers():
            drawing.save(accuracy.headline(each, *HEADLINE[1:]), folder / "headline.png", dpi=200)


def make(arguments, folder):
    old, place = arguments.out / "accuracy", folder / "accuracy"
    new = errors.read_studies(arguments, "accuracy")
    sources = {path.name: path for path in old.iterdir() if path.is_dir()} if old.is_dir() else {}
    sources |= {scene: arguments.runs / f"accuracy-{scene}" for scene in new}
    if not sources:
        raise study.InputError(f"{old}: no scene there, and none is named")
    for scene, source in sorted(sources.items()):
        (place / scene).mkdir(parents=True)
        for name in FILES:
            shutil.copy(source / name, place / scene / name)
    found = {scene: errors.read_study(place / scene) for scene in sorted(sources)}
    if arguments.scenes:
        for picture in old.glob("*.png"):
            shutil.copy(picture, place / picture.name)
    draw(new or found, place)
    study.write_whole(folder / "accuracy.md", markdown(found))


def main():
    arguments = study.scene_parser(__doc__.splitlines()[0], "accuracy").parse_args()
    study.publish(arguments.out, lambda folder: make(arguments, folder))
    print(f"accuracy.py: {arguments.out}/accuracy.md and {arguments.out}/accuracy")


if __name__ == "__main__":
    study.run(main)
