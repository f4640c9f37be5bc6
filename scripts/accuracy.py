#!/usr/bin/python3
"""Draws error against run time and makes its table, from what scripts/accuracy.sh has put into runs/.

Writes OUT/accuracy.md (for README) and OUT/accuracy/: each study's accuracy.csv, table.txt, scene.toml and
origin.json, and a picture as PNG and SVG. From studies of one clean commit only, unless --allow-dirty.
"""

import argparse
import math
import os
import shutil
import sys
import tempfile
from pathlib import Path

try:
    from pictures import accuracy
    from pictures.drawing import plt
    from pictures.run import RunError
except ImportError as missing:
    sys.exit(f"accuracy.py: {missing}; install it with: apt-get install python3-matplotlib")

OBSERVABLES = ("height", "speed", "rebound", "contact_time", "energy_lost", "flattening")


def read_arguments():
    root = Path(__file__).resolve().parent.parent
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    add = parser.add_argument
    add("--runs", type=Path, default=root / "runs", metavar="DIR", help="holds accuracy-SCENE [runs]")
    add("--out", type=Path, default=root / "results", metavar="DIR", help="[results]")
    add("--allow-dirty", action="store_true", help="take studies of changed trees, too")
    add("scenes", nargs="+", metavar="SCENE")
    return parser.parse_args()


def told(error, bar):
    return f"< {bar:.1e}" if error <= bar else f"{error:.1e}"


def row_of(scene, study):
    """A line of the table: the paper's program and the cheapest setting as good."""
    papers, best = study.papers(), study.origin.get("best")
    if not papers or not best:
        return [scene, "-", "-", "-", "-", "-", told(math.nan, study.bar["error_height"]), "-"]
    row = next(r for r in study.rows if r["method"] == best["method"] and r["contact"] == best["contact"]
               and r["dt"] == best["dt"])
    bar = study.bar["error_height"]
    return [scene, f"{study.origin['oracle_seconds']:.3g}", told(papers["error_height"], bar),
            f"{best['method']}, {best['contact']}, {best['dt']:.3g}", f"{row['seconds']:.2g}",
            told(row["error_height"], bar), f"{bar:.1e}",
            f"**{study.origin['oracle_seconds'] / row['seconds']:.0f}**"]


def markdown(studies):
    head = ["scene", "paper's program, s", "its error, cm", "cheapest setting as good: method, contact, Δt",
            "run, s", "its error, cm", "known to, cm", "times sooner"]
    lines = [head, ["---"] * len(head), *(row_of(scene, study) for scene, study in studies.items())]
    some = next(iter(studies.values())).origin
    return "\n".join([
        "# Error against run time\n",
        "The paper's program is the listing's scheme and contact with Δt = 1e-6 s on the oracle. As good: in each "
        f"of {', '.join(OBSERVABLES)}, no further from the reference. Errors shown are those of the height of the "
        "centre at the end. One core; known to: what the two references differ by.\n",
        "".join("| " + " | ".join(line) + " |\n" for line in lines),
        "".join(f"![{scene}](results/accuracy/{scene}.png)\n" for scene in list(studies)[:2]),
        f"Made by `scripts/accuracy.sh` at commit {some['commit']}, {some['date']}, on {some['cpu']}; all rows, and "
        "the other pictures: `results/accuracy/`.",
        "",
    ])


def make(arguments, folder):
    studies = {}
    (folder / "accuracy").mkdir()
    for scene in arguments.scenes:
        source = arguments.runs / f"accuracy-{scene}"
        studies[scene] = study = accuracy.read_study(source)
        first = next(iter(studies.values())).origin["commit"]
        if not arguments.allow_dirty and (study.origin["commit"] != first or "dirty" in first or first == "unknown"):
            raise RunError(f"{source}: commit {study.origin['commit']}: allowed is one clean commit for all")
        place = folder / "accuracy" / scene
        place.mkdir()
        for name in ("accuracy.csv", "table.txt", "origin.json", "scene.toml"):
            shutil.copy(source / name, place / name)
        figure = accuracy.figure_of(study, f"{scene}: error against cost (grey: not known to the reference)")
        for kind in ("png", "svg"):
            figure.savefig(folder / "accuracy" / f"{scene}.{kind}",
                           metadata={"Date": None} if kind == "svg" else None)
        plt.close(figure)
    (folder / "accuracy.md").write_text(markdown(studies), encoding="utf-8")


def main():
    arguments = read_arguments()
    arguments.out.mkdir(parents=True, exist_ok=True)
    partial = Path(tempfile.mkdtemp(prefix=".partial-", dir=arguments.out))
    try:
        make(arguments, partial)
        shutil.rmtree(arguments.out / "accuracy", ignore_errors=True)
        for name in ("accuracy", "accuracy.md"):
            os.replace(partial / name, arguments.out / name)
    finally:
        shutil.rmtree(partial, ignore_errors=True)
    print(f"accuracy.py: {arguments.out}/accuracy.md and {arguments.out}/accuracy")


if __name__ == "__main__":
    try:
        main()
    except RunError as error:
        print(f"accuracy.py: {error}", file=sys.stderr)
        sys.exit(2)
