#!/usr/bin/python3
"""What the monitor, with its cheap ledger, costs of a run: against runs that sample only start and end.

    scripts/studies/monitor_cost.py [--rounds N] [--scene NAME] [--steps N] [--allow-dirty]

The cost is smaller than what the clock swings by from run to run, so beside runs at the default cadence
there are some with ten times as many samples, whose cost is divided by ten. Prints the result; from a
clean tree also writes results/monitor_cost.md. Some 40 s on an idle machine.
"""

import argparse
import json
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from studies import study
from studies.study import ROOT

BOUNCE = ROOT / "build/release/bounce"
ALLOWED = 0.02  # of a run
CADENCES = {"bare": "1e6", "default": "0.01", "dense": "0.001"}  # output.monitor_every, s
DENSER = 10


def read_arguments():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--rounds", type=int, default=21, help="of three runs each, at least 7 [21]")
    parser.add_argument("--scene", default="example-2", help="[example-2]")
    parser.add_argument("--steps", type=int, default=1_500_000, help="of each run [1500000]")
    parser.add_argument("--allow-dirty", action="store_true", help="only print")
    arguments = parser.parse_args()
    if arguments.rounds < 7 or arguments.steps < 100_000:
        parser.error("allowed is --rounds from 7 and --steps from 100000")
    return arguments


def run(folder, arguments, cadence):
    """run.json of a run on one thread."""
    out = Path(folder) / cadence
    subprocess.run([BOUNCE, "run", arguments.scene, "--quiet", "--force", "--threads", "1", "--steps",
                    str(arguments.steps), "--out", out, "--set", f"output.monitor_every={CADENCES[cadence]}"],
                   check=True, capture_output=True)
    return json.loads((out / "run.json").read_text())


def measure(arguments):
    """run.json of each round's runs, by cadence."""
    with tempfile.TemporaryDirectory() as folder:
        run(folder, arguments, "default")  # warms up
        for number in range(arguments.rounds):
            order = list(CADENCES) if number % 2 else list(reversed(CADENCES))
            records = {cadence: run(folder, arguments, cadence) for cadence in order}
            if len({record["state_hash"] for record in records.values()}) > 1:
                sys.exit("monitor_cost.py: the samples changed the run")
            yield records


def shares(rounds, cadence):
    """What a cadence adds to the bare run: median and quartiles of the rounds' ratios."""
    found = sorted(records[cadence]["wall_seconds"] / records["bare"]["wall_seconds"] - 1.0 for records in rounds)
    quarter = len(found) // 4
    return [statistics.median(found), found[quarter], found[-1 - quarter]]


def main():
    arguments = read_arguments()
    rounds = list(measure(arguments))
    last = rounds[-1]["default"]
    direct = shares(rounds, "default")
    median, low, high = (share / DENSER for share in shares(rounds, "dense"))
    bare = statistics.median(records["bare"]["wall_seconds"] for records in rounds)
    origin = last["origin"]
    text = (f"The monitor and its ledger at the default cadence, a sample each 0.01 s, take **{median:.1%}** of a run "
            f"(quartiles {low:.1%} and {high:.1%}; a tenth of what ten times as many samples take). Measured directly: "
            f"{direct[0]:.1%} (quartiles {direct[1]:.1%} and {direct[2]:.1%}, the swing of the clock). Medians of "
            f"{len(rounds)} rounds of {arguments.steps} steps of {arguments.scene}, kernel {last['plan']['kernel']}, "
            f"{last['plan']['vector']}, one thread, over runs that sample only start and end ({bare:.2f} s).\n\n"
            f"Made by `scripts/studies/monitor_cost.py` at commit {origin['commit']}, "
            f"{study.now()}, on {origin['cpu']}, {origin['compiler']}, "
            f"{origin['flags']}.\n")
    print(text, flush=True)
    if not arguments.allow_dirty:
        if study.git("status", "--porcelain") != "" or origin["commit"].endswith("-dirty"):
            sys.exit("monitor_cost.py: not written: the tree has or had changes (--allow-dirty only prints)")
        study.write_whole(ROOT / "results/monitor_cost.md", "# What the monitor costs\n\n" + text)
        study.follow(ROOT / "results")
    if not median < ALLOWED:
        sys.exit(f"monitor_cost.py: that is not under {ALLOWED:.0%}")


if __name__ == "__main__":
    main()
