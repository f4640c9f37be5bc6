#!/usr/bin/python3
"""Sets bounce beside LAMMPS on the same ball: first that it is the same physics, then steps a second.

Writes results/peers.json (raw figures, with their origin) and results/peers.md (the table, which goes
into README, too). From a clean tree only, on an otherwise idle machine. LAMMPS's files, made from
the scene, stay in build/peers.

flying_ball.py reads the ball from bounce; lammps.py gives it to LAMMPS; agreement.py compares the
flights; timing.py times them. Exit code: 1 if the physics differs or LAMMPS
fails, 2 if nothing can be compared.
"""

import argparse
import json
import math
import os
import shlex
import shutil
import subprocess
import sys
from datetime import datetime, timezone
from pathlib import Path

TOP = Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(TOP / "scripts"))

try:
    import numpy  # noqa: F401, here for its message
except ImportError:
    sys.stderr.write("compare.py: no numpy; install it with: apt-get install python3-numpy\n")
    sys.exit(2)

from peers import agreement, lammps, report, timing
from peers.flying_ball import PeerError, ask, read_ball
from pictures.run import RunError


def read_arguments():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    add = parser.add_argument
    add("scene", nargs="?", default="example-2", help="built-in scene or scene file [example-2]")
    add("--set", action="append", default=[], metavar="KEY=VALUE", help="changes the scene, as for bounce run")
    add("--entries", type=at_least(1000), default=8000, metavar="N", help="of the table that is timed [8000]")
    add("--check-steps", type=at_least(1), default=100_000, metavar="N", help="of the common flight [100000]")
    add("--rounds", type=at_least(7), default=9, metavar="N", help="7 or more [9]")
    add("--seconds", type=positive, default=3.0, metavar="S", help="of each timed run, about [3]")
    add("--bounce", type=Path, metavar="FILE", help="the program; without it scripts/build.sh release builds it")
    add("--lammps", default="lmp", metavar="FILE", help="the program [lmp]")
    add("--out", type=Path, default=TOP / "results", metavar="DIR", help="where the two files go [results]")
    add("--allow-dirty", action="store_true", help="take a tree with uncommitted changes, too")
    arguments = parser.parse_args()
    arguments.settings = [word for setting in arguments.set for word in ("--set", setting)]
    return arguments


def at_least(least):
    def number(text):
        value = int(text)
        if value < least:
            raise argparse.ArgumentTypeError(f"{text}: allowed is {least} or more")
        return value

    return number


def positive(text):
    value = float(text)
    if not 0.0 < value < math.inf:
        raise argparse.ArgumentTypeError(f"{text}: allowed is a number above 0")
    return value


def git(*words):
    done = subprocess.run(["git", "-C", TOP, *words], capture_output=True, text=True, check=False)
    return done.stdout.strip() if done.returncode == 0 else None


def find_bounce(arguments):
    """The program, and its commit, which must be that of the tree, without changes."""
    if not arguments.allow_dirty and git("status", "--porcelain") != "":
        raise PeerError("the tree has uncommitted changes; results come from clean trees (--allow-dirty)")
    program = arguments.bounce
    if program is None:
        subprocess.run([TOP / "scripts" / "build.sh", "release", "bounce"], check=True, stdout=sys.stderr)
        program = TOP / "build" / "release" / "bounce"
    program = program.resolve()
    first = ask([program, "--version"]).splitlines()[0]
    commit = first.partition("(commit ")[2].rstrip(")")
    if not arguments.allow_dirty and commit != git("rev-parse", "--short=12", "HEAD"):
        raise PeerError(f"{program} is of commit {commit}, the tree is not: build it anew, or --allow-dirty")
    return program, commit


def origin(arguments, bounce_run, commit, found):
    """What stands at the head of peers.json."""
    theirs = bounce_run["origin"]
    return {
        "commit": commit,
        "date": datetime.now(timezone.utc).strftime("%Y-%m-%dT%H:%M:%SZ"),
        "cpu": theirs["cpu"],
        "cores": theirs["cores"],
        "compiler": theirs["compiler"],
        "flags": theirs["flags"],
        "lammps": found.version,
        "command": shlex.join(["scripts/peers/compare.py", *sys.argv[1:]]),
        "scene": arguments.scene,
        "settings": arguments.set,
    }


def write_whole(folder, texts):
    """All files or none: each is written beside its place, then renamed."""
    folder.mkdir(parents=True, exist_ok=True)
    for name, text in texts.items():
        (folder / f".{name}").write_text(text, encoding="utf-8")
    for name in texts:
        os.replace(folder / f".{name}", folder / name)


def main():
    arguments = read_arguments()
    found = lammps.find_lammps(arguments.lammps)
    bounce, commit = find_bounce(arguments)
    work = TOP / "build" / "peers"
    shutil.rmtree(work, ignore_errors=True)
    ball = read_ball(bounce, arguments.scene, arguments.settings, work / "start")
    agreed = agreement.compare_flights(bounce, found, ball, arguments, work)
    print("\n".join(report.agreement_lines(agreed)), file=sys.stderr)

    subjects = [*timing.lammps_subjects(found, ball, arguments.entries, work),
                *timing.bounce_subjects(bounce, arguments, work)]
    rates = timing.time_rounds(subjects, arguments.rounds, arguments.seconds, ball.flight_steps())
    run = json.loads((work / "start" / "run.json").read_text())
    record = {
        "origin": origin(arguments, run, commit, found),
        "agreement": agreed,
        "rows": [{"program": subject.program, "cores": subject.cores, "how": subject.how, "steps": subject.steps,
                  "steps_per_second": rate} for subject, rate in zip(subjects, rates)],
    }
    text = report.table(record)
    write_whole(arguments.out, {"peers.json": json.dumps(record, indent=2, ensure_ascii=False) + "\n",
                                "peers.md": text})
    if arguments.out.resolve() == TOP / "results":
        subprocess.run([TOP / "scripts" / "update_readme.py"], check=True)
    print(text)


if __name__ == "__main__":
    try:
        main()
    except (PeerError, RunError) as error:
        print(f"compare.py: {error}", file=sys.stderr)
        sys.exit(2)
    except (agreement.Disagreement, lammps.LammpsFailed) as error:
        print(f"compare.py: {error}", file=sys.stderr)
        sys.exit(1)
    except subprocess.CalledProcessError as error:
        print(f"compare.py: {Path(error.cmd[0]).name} failed", file=sys.stderr)
        sys.exit(2)
