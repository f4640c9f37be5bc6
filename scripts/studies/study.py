"""The studies of several scenes, as scripts/accuracy.sh and contact.sh put them into runs/."""

import argparse
import os
import shutil
import tempfile
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


def check_clean(folder, commit):
    if "dirty" in commit or commit == "unknown":
        raise RunError(f"{folder}: commit {commit}: allowed is a clean commit")


def read_studies(arguments, name):
    """Scene to study. RunError if one is not of a clean commit, unless --allow-dirty."""
    found = {}
    for scene in arguments.scenes:
        folder = arguments.runs / f"{name}-{scene}"
        found[scene] = accuracy.read_study(folder)
        if not arguments.allow_dirty:
            check_clean(folder, found[scene].origin["commit"])
    return found


def publish(out, names, make):
    """`make(folder)` puts the files and folders of these names into a new folder; then they replace those in `out`."""
    out.mkdir(parents=True, exist_ok=True)
    partial = Path(tempfile.mkdtemp(prefix=".partial-", dir=out))
    try:
        make(partial)
        for name in names:
            if (out / name).is_dir():
                shutil.rmtree(out / name)
            os.replace(partial / name, out / name)
    finally:
        shutil.rmtree(partial, ignore_errors=True)


def one_commit(all_studies):
    """RunError if the studies are not of one commit: some rows are compared across scenes, or told with one origin."""
    commits = sorted({study.origin["commit"] for study in all_studies})
    if len(commits) > 1:
        raise RunError(f"commits {', '.join(commits)}: allowed is one clean commit for all")
