"""The studies of several scenes, as scripts/accuracy.sh and contact.sh put them into runs/."""

import argparse
from pathlib import Path

from pictures import accuracy
from pictures.run import RunError

OBSERVABLES = ("height", "speed", "rebound", "contact_time", "energy_lost", "flattening")


def read_arguments(description, name):
    """--runs, --out, --allow-dirty and scenes, of a script that reads RUNS/NAME-SCENE."""
    root = Path(__file__).resolve().parent.parent.parent
    parser = argparse.ArgumentParser(description=description)
    add = parser.add_argument
    add("--runs", type=Path, default=root / "runs", metavar="DIR", help=f"holds {name}-SCENE [runs]")
    add("--out", type=Path, default=root / "results", metavar="DIR", help="[results]")
    add("--allow-dirty", action="store_true", help="take studies of changed trees, too")
    add("scenes", nargs="+", metavar="SCENE")
    return parser.parse_args()


def read_studies(arguments, name):
    """Scene to study. RunError if they are not of one clean commit, unless --allow-dirty."""
    found = {scene: accuracy.read_study(arguments.runs / f"{name}-{scene}") for scene in arguments.scenes}
    commits = sorted({study.origin["commit"] for study in found.values()})
    if not arguments.allow_dirty and (len(commits) > 1 or "dirty" in commits[0] or commits[0] == "unknown"):
        raise RunError(f"{arguments.runs}: commits {', '.join(commits)}: allowed is one clean commit for all")
    return found
