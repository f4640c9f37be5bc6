#!/usr/bin/python3
"""Checks the error bars of bounce reference: each figure against a solution of ten times the effort.

For each scene: `bounce reference SCENE`, and once more with a tenth of the fixed step and ten times the samples. A bar
holds if the finer value lies within it (within both bars together, as the finer one is not exact either). Writes
OUT/bars.md; exit code 1 if a bar does not hold. A scene takes from minutes to hours.
"""

import argparse
import json
import subprocess
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from studies import study
from studies.study import ROOT

EFFORT = 10.0
EVERY = 0.01  # s


def read_arguments():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    add = parser.add_argument
    add("--bounce", type=Path, default=ROOT / "build/release/bounce", metavar="PROGRAM")
    add("--out", type=Path, default=ROOT / "results", metavar="DIR", help="[results]")
    add("--t-end", default=None, metavar="T", help="end of the time, s [the scene's]")
    add("scenes", nargs="*", metavar="SCENE", default=[f"example-{n}" for n in range(1, 8)])
    return parser.parse_args()


def solve(arguments, scene, folder, *options):
    """observables.json of a solution."""
    more = ["--t-end", arguments.t_end] if arguments.t_end else []
    done = subprocess.run([arguments.bounce, "reference", scene, "--out", folder, *more, *options],
                          capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise study.InputError(f"{scene}: {done.stderr.strip()}")
    return json.loads((folder / "observables.json").read_text(encoding="utf-8"))


def verdict(value, bar, finer, finer_bar):
    """Of numbers or None; NaN never holds."""
    if value is None or finer is None:
        return "none in either" if value is finer else "DOES NOT HOLD"
    if bar is None:
        return "no bar"
    return "holds" if abs(value - finer) <= bar + (finer_bar or 0.0) else "DOES NOT HOLD"


def rows_of(scene, plain, fine):
    rows = []
    for name, figure in plain["observables"].items():
        other = fine["observables"][name]
        says = verdict(figure["value"], figure["error"], other["value"], other["error"])
        if says == "none in either":
            continue
        off = "-" if None in (figure["value"], other["value"]) else f"{abs(figure['value'] - other['value']):.1e}"
        value = "-" if figure["value"] is None else f"{figure['value']:.13g}"
        bar = "-" if figure["error"] is None else f"{figure['error']:.1e}"
        rows.append([scene, name, value, bar, off, figure["unit"], says])
    return rows


def main():
    arguments = read_arguments()
    rows, origin = [], None
    for scene in arguments.scenes:
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            plain = solve(arguments, scene, folder / "plain", "--every", str(EVERY))
            step = plain["fixed"]["step"] / EFFORT
            fine = solve(arguments, scene, folder / "fine", "--every", str(EVERY / EFFORT), "--step", str(step))
        rows += rows_of(Path(scene).stem, plain, fine)
        origin = plain["origin"]
        print(f"bars.py: {scene}", flush=True)
    head = ["scene", "figure", "value", "bar", "finer is off by", "unit", ""]
    study.write_whole(
        arguments.out / "bars.md",
        "# Error bars of the references\n\nEach figure of a reference, its error bar, and how far a solution of ten "
        f"times the effort is off.\n\n{study.table(head, rows)}\nMade by `scripts/studies/bars.py` at commit "
        f"{origin['commit']}, {study.now()}, on {origin['cpu']}, {origin['compiler']}, {origin['flags']}.\n")
    print(f"bars.py: {arguments.out}/bars.md")
    return 1 if any(row[-1] == "DOES NOT HOLD" for row in rows) else 0


if __name__ == "__main__":
    study.run(main)
