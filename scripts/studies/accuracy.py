#!/usr/bin/python3
"""Draws error against run time and makes its table, from what scripts/accuracy.sh has put into runs/.

Writes OUT/accuracy/: of each named scene accuracy.csv, table.txt, scene.toml and origin.json, and a picture as PNG and
SVG; and OUT/accuracy.md (for README), the table of these and of all scenes that OUT/accuracy holds already. From
studies of clean commits only, unless --allow-dirty.
"""

import math
import shutil
import sys

try:
    from pictures import accuracy, studies
    from pictures.drawing import plt
    from pictures.run import RunError
except ImportError as missing:
    sys.exit(f"accuracy.py: {missing}; install it with: apt-get install python3-matplotlib")


def told(error, bar):
    return f"< {bar:.1e}" if error <= bar else f"{error:.1e}"


def row_of(scene, study):
    """A line of the table: the paper's program and the cheapest setting as good."""
    papers, best = study.papers(), study.origin.get("best")
    if not papers or not best:
        return [scene, "-", "-", "-", "-", "-", told(math.nan, study.bar["error_height"]), "-"]
    names = ("method", "contact", "precision", "dt")
    row = next(row for row in study.rows if all(row[name] == best[name] for name in names))
    setting = accuracy.label_of(*(best[name] for name in names[:3]))
    bar = study.bar["error_height"]
    return [scene, f"{study.origin['oracle_seconds']:.3g}", told(papers["error_height"], bar),
            f"{setting}, {best['dt']:.3g}", f"{row['seconds']:.2g}",
            told(row["error_height"], bar), f"{bar:.1e}",
            f"**{study.origin['oracle_seconds'] / row['seconds']:.0f}**"]


def markdown(found):
    head = ["scene", "paper's program, s", "its error, cm", "cheapest setting as good: method, contact, Δt",
            "run, s", "its error, cm", "known to, cm", "times sooner", "at commit"]
    lines = [head, ["---"] * len(head),
             *([*row_of(scene, study), study.origin["commit"]] for scene, study in found.items())]
    machines = sorted({study.origin["cpu"] for study in found.values()})
    return "\n".join([
        "# Error against run time\n",
        "The paper's program is the listing's scheme and contact with Δt = 1e-6 s on the oracle. As good: in each "
        f"of {', '.join(studies.OBSERVABLES)}, no further from the reference. Errors shown are those of the height "
        "of the centre at the end. One core; known to: what the reference courses differ by.\n",
        "".join("| " + " | ".join(line) + " |\n" for line in lines),
        "".join(f"![{scene}](results/accuracy/{scene}.png)\n" for scene in list(found)[:2]),
        f"Made by `scripts/accuracy.sh` at the commits named, on {', '.join(machines)}; all rows, the other pictures and "
        "each scene's date: `results/accuracy/`.",
        "",
    ])


def put(scene, study, source, folder):
    """A scene's files and pictures."""
    place = folder / scene
    shutil.rmtree(place, ignore_errors=True)
    place.mkdir()
    for name in ("accuracy.csv", "table.txt", "origin.json", "scene.toml"):
        shutil.copy(source / name, place / name)
    figure = accuracy.figure_of(study, f"{scene}: error against cost (grey: not known; balls that blew up are left out)")
    for kind in ("png", "svg"):
        figure.savefig(folder / f"{scene}.{kind}", metadata={"Date": None} if kind == "svg" else None)
    plt.close(figure)


def make(arguments, folder):
    new = studies.read_studies(arguments, "accuracy")
    all_scenes = folder / "accuracy"
    if (arguments.out / "accuracy").is_dir():
        shutil.copytree(arguments.out / "accuracy", all_scenes)
    else:
        all_scenes.mkdir()
    for scene, study in new.items():
        put(scene, study, arguments.runs / f"accuracy-{scene}", all_scenes)
    found = {place.name: accuracy.read_study(place) for place in sorted(all_scenes.iterdir()) if place.is_dir()}
    (folder / "accuracy.md").write_text(markdown(found), encoding="utf-8")


def main():
    arguments = studies.read_arguments(__doc__.splitlines()[0], "accuracy")
    studies.publish(arguments.out, ("accuracy", "accuracy.md"), lambda folder: make(arguments, folder))
    print(f"accuracy.py: {arguments.out}/accuracy.md and {arguments.out}/accuracy")


if __name__ == "__main__":
    try:
        main()
    except RunError as error:
        print(f"accuracy.py: {error}", file=sys.stderr)
        sys.exit(2)
