#!/usr/bin/python3
"""Keeps the reference solutions that scripts/studies/reference.sh has put into runs/, and makes their table.

  scripts/studies/reference.py SCENE...    takes these scenes from RUNS/reference-SCENE
  scripts/studies/reference.py             the table once more, from OUT/reference alone

Writes OUT/reference/SCENE (observables.json, before-impact.csv, final.csv, scene.toml) and OUT/reference.md, of all
scenes that are there. From clean commits only, unless --allow-dirty.
"""

import json
import shutil
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from studies import study
from studies.study import InputError

FILES = ("observables.json", "before-impact.csv", "final.csv", "scene.toml")
SHOWN = ("end_height", "end_speed", "rebound_height", "energy_lost", "greatest_flattening")


def read(folder):
    path = folder / "observables.json"
    try:
        found = json.loads(path.read_text())
        for name in ("observables", "growth", "origin", "end_position_error"):
            found[name]
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise InputError(f"{path}: cannot be read: {error}") from error
    return found


def cell(quantity):
    if quantity["value"] is None or quantity["error"] is None:
        return "-"
    return f"{quantity['value']:.10g} ± {quantity['error']:.0e}"


def row_of(scene, found):
    growth = found["growth"]
    factor = growth["factor"]
    return [scene, *(cell(found["observables"][name]) for name in SHOWN), f"{found['end_position_error']:.0e}",
            "-" if factor is None else f"{factor:.1e}", found["origin"]["commit"]]


def markdown(all_found):
    head = ["scene", "height, cm", "speed, cm/s", "rebound, cm", "energy lost, erg", "flattening",
            "places at the end, cm", "growth", "at commit"]
    return "\n".join([
        "# Reference solutions\n",
        "The centre's height and speed at the end, greatest height after the lowest, energy lost, greatest flattening, "
        "each ± its error bar (what the two solutions differ by, or twice that); the largest difference of a particle's place at the end; by how much "
        "a start disturbed by 1e-10 of the shortest bond is farther off at the end. Where that is large, two courses "
        "may agree by chance, and the error bars of `bounce accuracy`, of three courses, are the better ones.\n",
        study.table(head, [row_of(scene, found) for scene, found in all_found.items()]),
        "Made by `scripts/studies/reference.sh`; all observables, the ball before the impact and at the end, origin: "
        "`results/reference/`.",
        "",
    ])


def make(arguments, folder):
    if (arguments.out / "reference").is_dir():
        shutil.copytree(arguments.out / "reference", folder / "reference")
    for scene in arguments.scenes:
        source, place = arguments.runs / f"reference-{scene}", folder / "reference" / scene
        found = read(source)
        if not arguments.allow_dirty:
            study.check_clean(source, found["origin"]["commit"])
        place.mkdir(parents=True, exist_ok=True)
        for name in FILES:
            shutil.copy(source / name, place / name)
    if not (folder / "reference").is_dir():
        raise InputError(f"{arguments.out / 'reference'}: no scene there, and none is named")
    kept = {place.name: read(place) for place in sorted((folder / "reference").iterdir())}
    study.write_whole(folder / "reference.md", markdown(kept))


def main():
    arguments = study.scene_parser(__doc__.splitlines()[0], "reference").parse_args()
    study.publish(arguments.out, lambda folder: make(arguments, folder))
    print(f"reference.py: {arguments.out}/reference.md and {arguments.out}/reference")


if __name__ == "__main__":
    study.run(main)
