#!/usr/bin/python3
"""Draws the paper's Figures 1-13, and an overview, from run directories of bounce.

Pictures of results/ come from clean trees only: a run whose commit is unknown or ends in -dirty, or
runs of several commits, need --allow-dirty. origin.json, beside the pictures, says what they were
made from.
"""

import argparse
import io
import json
import os
import shlex
import shutil
import subprocess
import sys
import tempfile
from datetime import datetime, timezone
from pathlib import Path

try:
    from PIL import Image  # comes with matplotlib

    from pictures import ball, falls, overview, throws
    from pictures.drawing import plt
    from pictures.paper import check_is_example
    from pictures.run import RunError, read_run
except ImportError as missing:
    sys.exit(f"figures.py: {missing}; install it with: apt-get install python3-matplotlib")

# Number: file name, examples it is drawn from, function. 0 is the overview, no figure of the paper.
FIGURES = {
    1: ("figure-01.png", (2,), ball.points),
    2: ("figure-02.png", (2,), ball.small_particles),
    3: ("figure-03.png", (2,), ball.large_particles),
    4: ("figure-04.png", (2,), ball.neighbours_of_each_ring),
    5: ("figure-05.png", (1,), falls.example_1),
    6: ("figure-06.png", (1,), falls.example_1_flattened),
    7: ("figure-07.png", (2,), falls.example_2),
    8: ("figure-08.png", (3,), falls.example_3),
    9: ("figure-09.png", (4,), falls.example_4),
    10: ("figure-10.png", (5,), throws.example_5),
    11: ("figure-11.png", (6,), throws.example_6),
    12: ("figure-12.png", (7,), throws.example_7_start),
    13: ("figure-13.png", (7,), throws.example_7),
    0: ("bounce-overview.png", (1, 2), overview.overview),
}


def read_arguments():
    root = Path(__file__).resolve().parent.parent
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    add = parser.add_argument
    add("--runs", type=Path, default=root / "runs", metavar="DIR",
        help="holds the run directories example-1 ... example-7 [runs]")
    add("--out", type=Path, default=root / "results" / "figures", metavar="DIR",
        help="where the pictures go [results/figures]")
    add("--only", type=int, nargs="+", choices=sorted(FIGURES), metavar="N",
        default=list(FIGURES), help="these figures; 0 is the overview")
    add("--allow-dirty", action="store_true",
        help="draw runs of changed trees or several commits, too")
    return parser.parse_args()


def read_examples(folder, numbers):
    """The runs by example; RunError with a line for each that cannot be drawn."""
    runs, troubles = {}, []
    for number in sorted(numbers):
        try:
            runs[number] = read_run(folder / f"example-{number}")
            check_is_example(runs[number], number)
        except RunError as error:
            troubles.append(str(error))
    if troubles:
        lines = "\n  ".join(["runs missing or not fit to draw:", *troubles])
        raise RunError(f"{lines}\nscripts/start.sh makes them all.")
    return runs


def script_commit():
    """The commit of the scripts that draw, -dirty if they have changes."""

    def git(*words):
        command = ["git", "-C", str(Path(__file__).resolve().parent), *words]
        return subprocess.run(command, capture_output=True, text=True, check=True).stdout.strip()

    try:
        changes = git("status", "--porcelain", "--", ".")
        return git("rev-parse", "--short=12", "HEAD") + ("-dirty" if changes else "")
    except (OSError, subprocess.CalledProcessError):
        return "unknown"


def check_clean(runs, drawn_by):
    """RunError unless all was made from one commit, and drawn from one, with nothing changed."""
    commits = {run.record["origin"]["commit"] for run in runs.values()}
    for commit in sorted(commits | {drawn_by}):
        if commit == "unknown" or commit.endswith("-dirty"):
            what = "scripts/" if commit == drawn_by and commit not in commits else "the runs"
            raise RunError(
                f"commit of {what}: {commit}; allowed is a commit without changes, or --allow-dirty"
            )
    if len(commits) > 1:
        found = ", ".join(sorted(commits))
        raise RunError(f"commits of the runs: {found}; allowed is a single one, or --allow-dirty")


def origin(runs, drawn_by, pictures):
    """What stands in origin.json."""

    def only(key):
        found = sorted({run.record["origin"][key] for run in runs.values()})
        return found[0] if len(found) == 1 else found

    return {
        "commit": only("commit"),
        "drawn_by_commit": drawn_by,
        "date": datetime.now(timezone.utc).strftime("%Y-%m-%dT%H:%M:%SZ"),
        "cpu": only("cpu"),
        "compiler": only("compiler"),
        "flags": only("flags"),
        "command": shlex.join(["scripts/figures.py", *sys.argv[1:]]),
        "runs": {
            f"example-{number}": {
                "state_hash": run.record["state_hash"],
                "steps": run.record["steps"],
                "steps_per_second": round(run.record["steps_per_second"]),
                "plan": f"{run.record['plan']['kernel']}, {run.record['plan']['vector']}",
                "date": run.record["origin"]["date"],
                "command": run.record["command"],
            }
            for number, run in runs.items()
        },
        "pictures": pictures,
    }


def draw_all(numbers, runs, folder):
    """Draws into the folder; the names of the pictures."""
    names = []
    for number in numbers:
        name, _, draw = FIGURES[number]
        figure = draw(runs)
        pixels = io.BytesIO()
        figure.savefig(pixels)
        plt.close(figure)
        # These drawings have few colours; a palette halves the file.
        image = Image.open(pixels).convert("RGB").quantize(128, dither=Image.Dither.NONE)
        image.save(folder / name, optimize=True)
        names.append(name)
    return names


def main():
    arguments = read_arguments()
    numbers = list(dict.fromkeys(arguments.only))
    runs = read_examples(arguments.runs, {n for i in numbers for n in FIGURES[i][1]})
    drawn_by = script_commit()
    if not arguments.allow_dirty:
        check_clean(runs, drawn_by)
    try:
        arguments.out.mkdir(parents=True, exist_ok=True)
        # Beside their place: each appears there whole, by rename, and only if all are drawn.
        partial = Path(tempfile.mkdtemp(prefix=".partial-", dir=arguments.out))
    except OSError as error:
        raise RunError(f"--out {arguments.out}: cannot be written: {error.strerror}") from error
    try:
        names = draw_all(numbers, runs, partial)
        text = json.dumps(origin(runs, drawn_by, names), indent=2, ensure_ascii=False)
        (partial / "origin.json").write_text(text + "\n")
        for name in [*names, "origin.json"]:
            os.replace(partial / name, arguments.out / name)
    finally:
        shutil.rmtree(partial, ignore_errors=True)
    print(f"{len(names)} pictures and origin.json in {arguments.out}")


if __name__ == "__main__":
    try:
        main()
    except RunError as error:
        print(f"figures.py: {error}", file=sys.stderr)
        sys.exit(2)
