"""What the scripts of the studies share: their options, what they refuse, tables, and files that appear whole."""

import argparse
import os
import shutil
import subprocess
import sys
import tempfile
from datetime import datetime, timezone
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent


class InputError(Exception):
    """What cannot be used; the message names it and says what can."""


def run(main):
    """Ends the script with what `main` returns; with one line and exit code 2 if its input cannot be used."""
    try:
        sys.exit(main())
    except InputError as error:
        print(f"{Path(sys.argv[0]).name}: {error}", file=sys.stderr)
        sys.exit(2)


def parser_of(description, holds, out="results"):
    """--runs (which holds so and so), --out, --allow-dirty."""
    parser = argparse.ArgumentParser(description=description)
    add = parser.add_argument
    add("--runs", type=Path, default=ROOT / "runs", metavar="DIR", help=f"holds {holds} [runs]")
    add("--out", type=Path, default=ROOT / out, metavar="DIR", help=f"where what it makes goes [{out}]")
    add("--allow-dirty", action="store_true", help="take what was made from changed trees, too")
    return parser


def scene_parser(description, name):
    """The same of a script that reads RUNS/NAME-SCENE; scenes are named on the command line. None: once more from OUT."""
    parser = parser_of(description, f"{name}-SCENE")
    parser.add_argument("scenes", nargs="*", metavar="SCENE", help="none: once more from what --out holds")
    return parser


def check_clean(made_by, commit):
    if "dirty" in commit or commit == "unknown":
        raise InputError(f"{made_by}: commit {commit}: allowed is a clean commit, or --allow-dirty")


def one_commit(commits):
    """InputError if there are several: rows are compared with each other, or told with one origin."""
    found = sorted(set(commits))
    if len(found) > 1:
        raise InputError(f"commits {', '.join(found)}: allowed is one clean commit for all")


def git(*words):
    """What git prints; None if it fails."""
    done = subprocess.run(["git", "-C", ROOT, *words], capture_output=True, text=True, check=False)
    return done.stdout.strip() if done.returncode == 0 else None


def scripts_commit():
    """The commit of the scripts, -dirty if they have changes."""
    changes, commit = git("status", "--porcelain", "--", "scripts"), git("rev-parse", "--short=12", "HEAD")
    if changes is None or commit is None:
        return "unknown"
    return commit + ("-dirty" if changes else "")


def now():
    return datetime.now(timezone.utc).strftime("%Y-%m-%dT%H:%M:%SZ")


def table(head, rows):
    """Markdown."""
    return "".join("| " + " | ".join(line) + " |\n" for line in [head, ["---"] * len(head), *rows])


def write_whole(path, text):
    temporary = path.with_name(f".{path.name}.tmp")
    temporary.write_text(text, encoding="utf-8")
    os.replace(temporary, path)


def publish(out, make):
    """`make(folder)` puts files and folders into a new folder; then all of them replace those in `out`."""
    try:
        out.mkdir(parents=True, exist_ok=True)
        partial = Path(tempfile.mkdtemp(prefix=".partial-", dir=out))
    except OSError as error:
        raise InputError(f"--out {out}: cannot be written: {error.strerror}") from error
    try:
        make(partial)
        for path in sorted(partial.iterdir()):
            place = out / path.name
            if place.is_dir():
                shutil.rmtree(place)
            os.replace(path, place)
    finally:
        shutil.rmtree(partial, ignore_errors=True)


def follow(out):
    """After new results in results/: README's numbers and the index follow them."""
    if out.resolve() == ROOT / "results":
        for script in ("readme_numbers.py", "studies/index.py"):
            subprocess.run([ROOT / "scripts" / script], check=True)
