#!/usr/bin/python3
"""Sets bounce beside LAMMPS on the same ball: first that it is the same physics, then steps a second.

  scripts/peers/compare.py [SCENE]      measures
  scripts/peers/compare.py --page       the table once more, from OUT/peers.json alone

Writes results/peers.json (raw figures, with their origin) and results/peers.md (the table). From a clean tree only, on an otherwise idle machine. LAMMPS's files, made from
the scene, stay in build/peers.

flying_ball.py reads the ball from bounce; lammps.py gives it to LAMMPS; agreement.py compares the
flights; timing.py times them. Exit code: 1 if the physics differs or LAMMPS
fails, 2 if nothing can be compared.
"""

import argparse
import json
import math
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

try:
    import numpy  # noqa: F401, here for its message
except ImportError:
    sys.stderr.write("compare.py: no numpy; install it with: apt-get install python3-numpy\n")
    sys.exit(2)

from peers import agreement, lammps, report, timing
from peers.flying_ball import PeerError, ask, read_ball
from studies import study
from studies.study import ROOT, InputError


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
    add("--out", type=Path, default=ROOT / "results", metavar="DIR", help="where the two files go [results]")
    add("--allow-dirty", action="store_true", help="take a tree with uncommitted changes, too")
    add("--page", action="store_true", help="only makes the table anew, of what --out holds")
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


def find_bounce(arguments):
    """The program, and its commit, which must be that of the tree, without changes."""
    if not arguments.allow_dirty and study.git("status", "--porcelain") != "":
        raise PeerError("the tree has uncommitted changes; results come from clean trees (--allow-dirty)")
    program = arguments.bounce
    if program is None:
        subprocess.run([ROOT / "scripts" / "build.sh", "release", "bounce"], check=True, stdout=sys.stderr)
        program = ROOT / "build" / "release" / "bounce"
    program = program.resolve()
    first = ask([program, "--version"]).splitlines()[0]
    commit = first.partition("(commit ")[2].rstrip(")")
    if not arguments.allow_dirty and commit != study.git("rev-parse", "--short=12", "HEAD"):
        raise PeerError(f"{program} is of commit {commit}, the tree is not: build it anew, or --allow-dirty")
    return program, commit


def origin(arguments, bounce_run, commit, found):
    """What stands at the head of peers.json."""
    theirs = bounce_run["origin"]
    return {
        "commit": commit,
        "date": study.now(),
        "cpu": theirs["cpu"],
        "cores": theirs["cores"],
        "compiler": theirs["compiler"],
        "flags": theirs["flags"],
        "lammps": found.version,
        "command": shlex.join(["scripts/peers/compare.py", *sys.argv[1:]]),
        "scene": arguments.scene,
        "settings": arguments.set,
    }


def make(record, folder):
    study.write_whole(folder / "peers.json", json.dumps(record, indent=2, ensure_ascii=False) + "\n")
    study.write_whole(folder / "peers.md", report.table(record))


def old_record(out):
    try:
        return json.loads((out / "peers.json").read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise InputError(f"{out / 'peers.json'}: cannot be read: {error}") from error


def main():
    arguments = read_arguments()
    record = old_record(arguments.out) if arguments.page else measure(arguments)
    study.publish(arguments.out, lambda folder: make(record, folder))
    study.follow(arguments.out)
    print(report.table(record))


def measure(arguments):
    found = lammps.find_lammps(arguments.lammps)
    bounce, commit = find_bounce(arguments)
    work = ROOT / "build" / "peers"
    shutil.rmtree(work, ignore_errors=True)
    ball = read_ball(bounce, arguments.scene, arguments.settings, work / "start")
    agreed = agreement.compare_flights(bounce, found, ball, arguments, work)
    print("\n".join(report.agreement_lines(agreed)), file=sys.stderr)

    subjects = [*timing.lammps_subjects(found, ball, arguments.entries, work),
                *timing.bounce_subjects(bounce, arguments, work)]
    rates = timing.time_rounds(subjects, arguments.rounds, arguments.seconds, ball.flight_steps())
    run = json.loads((work / "start" / "run.json").read_text())
    return {
        "origin": origin(arguments, run, commit, found),
        "agreement": agreed,
        "rows": [{"program": subject.program, "cores": subject.cores, "how": subject.how, "steps": subject.steps,
                  "steps_per_second": rate} for subject, rate in zip(subjects, rates)],
    }


if __name__ == "__main__":
    try:
        main()
    except InputError as error:
        print(f"compare.py: {error}", file=sys.stderr)
        sys.exit(2)
    except (agreement.Disagreement, lammps.LammpsFailed) as error:
        print(f"compare.py: {error}", file=sys.stderr)
        sys.exit(1)
    except subprocess.CalledProcessError as error:
        print(f"compare.py: {Path(error.cmd[0]).name} failed", file=sys.stderr)
        sys.exit(2)
