"""Steps a second of LAMMPS and bounce, in rounds: in each, every program runs once, in an order of its own.

A ratio is made within a round, so that a clock that swings from round to round reaches both its
terms. Start-up does not count: LAMMPS's loop time, bounce's wall_seconds with its monitor at start
and end only. Every run stays in free flight.
"""

import os
import random
import sys
from dataclasses import dataclass
from typing import Callable

from peers.flying_ball import run_bounce
from peers.lammps import Bonds, run_lammps
from studies.benchmarks import PINNED

TABLE, HARMONIC = "LAMMPS, tabulated bonds", "LAMMPS, harmonic bonds"


@dataclass
class Subject:
    """What is timed; `seconds` runs so many steps and says how long they took."""

    program: str
    cores: int
    how: str  # options; of bounce, what run.json says it did
    seconds: Callable
    steps: int = 0


def lammps_subjects(lammps, ball, entries, folder):
    for name, bonds in ((TABLE, Bonds(entries)), (HARMONIC, Bonds(0))):
        for way in ("serial", *lammps.ways_to_two_cores()):
            how = {"serial": "serial", "mpi": "2 MPI ranks", "omp": "-sf omp -pk omp 2"}[way]
            here = folder / f"timed-{bonds.entries or 'harmonic'}-{way}"

            def seconds(steps, bonds=bonds, way=way, here=here):
                return run_lammps(lammps, ball, bonds, steps, here, way)

            yield Subject(name, 1 if way == "serial" else 2, how, seconds)


def bounce_subjects(bounce, arguments, folder):
    """As a user runs it, then by LAMMPS's scheme as the plan decides, on one core and two, and by ring."""
    leapfrog = ["--set", "time.method=leapfrog"]
    ways = [(f"bounce run {arguments.scene}", []),
            ("bounce, leapfrog", [*leapfrog, "--threads", "1"]),
            ("bounce, leapfrog", [*leapfrog, "--threads", "2"]),
            ("bounce, leapfrog, ring", [*leapfrog, "--threads", "1", "--kernel", "ring"])]
    for number, (name, words) in enumerate(ways):
        subject = Subject(name, 0, "", lambda steps: 0.0)

        def seconds(steps, subject=subject, number=number, words=words):
            run = run_bounce(bounce, arguments.scene, steps, folder / f"timed-bounce-{number}",
                             [*arguments.settings, *words])
            plan = run.record["plan"]
            subject.cores = plan["threads"]
            subject.how = f"{run.record['method']}, {plan['kernel']}, {plan['vector']}"
            return run.record["wall_seconds"]

        subject.seconds = seconds
        yield subject


def time_rounds(subjects, rounds, seconds, most_steps):
    """Steps a second: a list a subject, an entry a round. Each run takes about so many seconds."""
    os.environ.update(PINNED)
    for subject in subjects:
        steps = 2000
        while subject.seconds(steps) < 0.2 and steps < most_steps:
            steps = min(4 * steps, most_steps)
        subject.steps = max(1000, min(most_steps, int(steps * seconds / subject.seconds(steps))))
    rates = [[] for _ in subjects]
    for number in range(rounds):
        order = list(range(len(subjects)))
        random.Random(number).shuffle(order)
        for at in order:
            rates[at].append(subjects[at].steps / subjects[at].seconds(subjects[at].steps))
        print(f"round {number + 1} of {rounds}", file=sys.stderr)
    return rates

