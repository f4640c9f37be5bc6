#!/usr/bin/python3
"""Draws the paper's Figures 1-13, and an overview, from run directories of bounce.

Pictures of results/ come from clean trees only: a run whose commit is unknown or ends in -dirty, or
runs of several commits, need --allow-dirty. origin.json, beside the pictures, says what they were
made from.
"""

import json
import shlex
import sys

from pictures import ball, drawing, falls, overview, throws
from pictures.paper import check_is_example
from pictures.run import read_run
from studies import study
from studies.study import InputError

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
    parser = study.parser_of(__doc__.splitlines()[0], "the run directories example-1 ... example-7",
                             out="results/figures")
    parser.add_argument("--only", type=int, nargs="+", choices=sorted(FIGURES), metavar="N", default=list(FIGURES),
                        help="these figures; 0 is the overview")
    return parser.parse_args()


def read_examples(folder, numbers):
    """The runs by example; InputError with a line for each that cannot be drawn."""
    runs, troubles = {}, []
    for number in sorted(numbers):
        try:
            runs[number] = read_run(folder / f"example-{number}")
            check_is_example(runs[number], number)
        except InputError as error:
            troubles.append(str(error))
    if troubles:
        lines = "\n  ".join(["runs missing or not fit to draw:", *troubles])
        raise InputError(f"{lines}\nscripts/start.sh makes them all.")
    return runs


def check_clean(runs, drawn_by):
    """InputError unless all was made from one commit, and drawn from one, with nothing changed."""
    for run in runs.values():
        study.check_clean(run.path, run.record["origin"]["commit"])
    study.check_clean("scripts/", drawn_by)
    study.one_commit(run.record["origin"]["commit"] for run in runs.values())


def origin(runs, drawn_by, pictures):
    """What stands in origin.json."""

    def only(key):
        found = sorted({run.record["origin"][key] for run in runs.values()})
        return found[0] if len(found) == 1 else found

    return {
        "commit": only("commit"),
        "drawn_by_commit": drawn_by,
        "date": study.now(),
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


def make(numbers, runs, drawn_by, folder):
    """Draws into the folder; beside the pictures what they were made from."""
    names = []
    for number in numbers:
        name, _, draw = FIGURES[number]
        drawing.save(draw(runs), folder / name)
        names.append(name)
    text = json.dumps(origin(runs, drawn_by, names), indent=2, ensure_ascii=False)
    study.write_whole(folder / "origin.json", text + "\n")


def main():
    arguments = read_arguments()
    numbers = list(dict.fromkeys(arguments.only))
    runs = read_examples(arguments.runs, {n for i in numbers for n in FIGURES[i][1]})
    drawn_by = study.scripts_commit()
    if not arguments.allow_dirty:
        check_clean(runs, drawn_by)
    study.publish(arguments.out, lambda folder: make(numbers, runs, drawn_by, folder))
    print(f"{len(numbers)} pictures and origin.json in {arguments.out}")


if __name__ == "__main__":
    study.run(main)
