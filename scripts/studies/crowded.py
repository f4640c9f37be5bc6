#!/usr/bin/python3
"""What it costs to ask for more threads than there are cores: runs on one core, beside those of one thread.

    scripts/studies/crowded.py [--rounds N] [--seconds S] [--allow-dirty]

Each round runs every kernel on one core with 1, 16 and 256 threads asked for; a ratio is of two runs of the
same round, so a clock that swings or a neighbour that computes hits both. Prints the table; from a clean tree
also writes results/crowded.md. Exit code 1 if a median is over 2. Some 2 minutes.
"""

import argparse
import json
import os
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from studies import study
from studies.study import ROOT

BOUNCE = ROOT / "build/release/bounce"
ALLOWED = 2.0  # times one thread's time
CASES = (("mirror", "example-2"), ("ring", "example-2"), ("annulus", "example-2"), ("csr", "example-2"),
         ("annulus", "annulus"), ("csr", "annulus"))
ASKED = (1, 16, 256)


def read_arguments():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--rounds", type=int, default=7, help="at least 7 [7]")
    parser.add_argument("--seconds", type=float, default=0.5, help="of a run of one thread, about [0.5]")
    parser.add_argument("--allow-dirty", action="store_true", help="only print")
    arguments = parser.parse_args()
    if arguments.rounds < 7 or not arguments.seconds > 0.0:
        parser.error("allowed is --rounds from 7 and --seconds above 0")
    return arguments


def run(folder, case, threads, steps):
    """Seconds on the clock and of the processor that stepping took, and run.json."""
    kernel, scene = case
    words = [BOUNCE, "run", scene, "--quiet", "--force", "--kernel", kernel, "--threads", str(threads), "--steps",
             str(steps), "--out", Path(folder) / "run", "--set", "output.monitor_every=1e6"]
    before = os.times()
    subprocess.run(words, check=True, capture_output=True)
    after = os.times()
    record = json.loads((Path(folder) / "run/run.json").read_text())
    used = after.children_user + after.children_system - before.children_user - before.children_system
    return record["wall_seconds"], used, record


def steps_for(folder, case, seconds):
    steps = 100
    while True:
        took = run(folder, case, 1, steps)[0]
        if took > 0.2 * seconds or steps >= 10_000_000:
            return max(100, int(steps * seconds / took))
        steps *= 4


def measure(folder, case, arguments):
    """A row of the table, and the greatest median in it."""
    steps = steps_for(folder, case, arguments.seconds)
    rounds = [{asked: run(folder, case, asked, steps) for asked in ASKED} for _ in range(arguments.rounds)]
    if len({record["state_hash"] for each in rounds for *_, record in each.values()}) > 1:
        sys.exit("crowded.py: the number of threads changed the bits")
    row, medians = [case[0], case[1], str(rounds[0][1][2]["particles"]), f"{1e6 * rounds[0][1][0] / steps:.2f}"], []
    for asked in ASKED[1:]:
        clock, used = (statistics.median(each[asked][k] / each[1][k] for each in rounds) for k in (0, 1))
        row += [str(rounds[0][asked][2]["plan"]["threads"]), f"{clock:.2f}", f"{used:.2f}"]
        medians += [clock, used]
    return row, max(medians)


def main():
    arguments = read_arguments()
    os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})
    started = time.monotonic()
    with tempfile.TemporaryDirectory() as folder:
        rows, greatest = zip(*(measure(folder, case, arguments) for case in CASES))
        origin = run(folder, CASES[0], 1, 100)[2]["origin"]
    head = ["kernel", "scene", "particles", "µs a step, 1 thread"]
    for asked in ASKED[1:]:
        head += [f"{asked} asked for: run", "clock, ×", "processor, ×"]
    text = (f"Threads that share a core wait for each other's turn at every stage, so no more are started than the "
            f"process has cores. Here it has one: × is the time to the one that one thread takes, by the clock and by "
            f"the processor, the median of {arguments.rounds} rounds.\n\n{study.table(head, rows)}\n"
            f"Made by `scripts/studies/crowded.py` at commit {origin['commit']}, {study.now()}, on {origin['cpu']}, "
            f"{origin['compiler']}, {origin['flags']}, in {time.monotonic() - started:.0f} s.\n")
    print(text, flush=True)
    if not arguments.allow_dirty:
        if study.git("status", "--porcelain") != "" or origin["commit"].endswith("-dirty"):
            sys.exit("crowded.py: not written: the tree has or had changes (--allow-dirty only prints)")
        study.write_whole(ROOT / "results/crowded.md", "# More threads than cores\n\n" + text)
        study.follow(ROOT / "results")
    if not max(greatest) <= ALLOWED:
        sys.exit(f"crowded.py: a median is over {ALLOWED:.0f}")


if __name__ == "__main__":
    main()
