#!/usr/bin/python3
"""What the monitor, with its cheap ledger, costs of a run: pairs of runs, the default cadence against start and end.

    scripts/monitor_cost.py [--pairs N] [--scene NAME] [--steps N] [--allow-dirty]

Prints a table; from a clean tree also writes results/monitor_cost.md, for README. Some 40 s on an idle machine.
"""

import argparse
import json
import statistics
import subprocess
import sys
import tempfile
from datetime import datetime, timezone
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
BOUNCE = ROOT / "build/release/bounce"
ALLOWED = 0.02  # of a run: issue 4, point 1


def read_arguments():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--pairs", type=int, default=15, help="at least 7 [15]")
    parser.add_argument("--scene", default="example-2", help="[example-2]")
    parser.add_argument("--steps", type=int, default=3_000_000, help="of each run [3000000]")
    parser.add_argument("--allow-dirty", action="store_true", help="only print")
    arguments = parser.parse_args()
    if arguments.pairs < 7 or arguments.steps < 100_000:
        parser.error("allowed is --pairs from 7 and --steps from 100000")
    return arguments


def run(folder, arguments, sampled):
    """run.json of a run on one thread; without samples between its start and its end unless `sampled`."""
    out = Path(folder) / ("sampled" if sampled else "bare")
    command = [BOUNCE, "run", arguments.scene, "--quiet", "--force", "--threads", "1", "--steps",
               str(arguments.steps), "--out", out]
    if not sampled:
        command += ["--set", "output.monitor_every=1e6"]
    subprocess.run(command, check=True, capture_output=True)
    return json.loads((out / "run.json").read_text())


def main():
    arguments = read_arguments()
    ratios, bare_seconds = [], []
    with tempfile.TemporaryDirectory() as folder:
        for pair in range(arguments.pairs + 1):
            order = (True, False) if pair % 2 else (False, True)
            records = {sampled: run(folder, arguments, sampled) for sampled in order}
            if records[True]["state_hash"] != records[False]["state_hash"]:
                sys.exit("monitor_cost.py: the samples changed the run")
            if pair == 0:
                continue  # warms up
            bare_seconds.append(records[False]["wall_seconds"])
            ratios.append(records[True]["wall_seconds"] / records[False]["wall_seconds"] - 1.0)
    ratios.sort()
    quarter = len(ratios) // 4
    median = statistics.median(ratios)
    origin = records[True]["origin"]
    text = (f"The monitor and its ledger at the default cadence, one sample each 0.01 s, take **{median:.1%}** of a run "
            f"(median of {len(ratios)} pairs of runs of {arguments.steps} steps of {arguments.scene}, one thread, "
            f"against runs that sample only start and end, which take {statistics.median(bare_seconds):.2f} s; quartiles "
            f"{ratios[quarter]:.1%} and {ratios[-1 - quarter]:.1%}; plan {records[True]['plan']['kernel']}, "
            f"{records[True]['plan']['vector']}).\n\n"
            f"Made by `scripts/monitor_cost.py` at commit {origin['commit']}, "
            f"{datetime.now(timezone.utc):%Y-%m-%dT%H:%M:%SZ}, on {origin['cpu']}, {origin['compiler']}, "
            f"{origin['flags']}.\n")
    print(text, flush=True)
    if not arguments.allow_dirty:
        changes = subprocess.run(["git", "-C", ROOT, "status", "--porcelain"], check=True, capture_output=True)
        if changes.stdout or origin["commit"].endswith("-dirty"):
            sys.exit("monitor_cost.py: not written: the tree has or had changes (--allow-dirty only prints)")
        (ROOT / "results/monitor_cost.md").write_text("# What the monitor costs\n\n" + text)
    if not median < ALLOWED:
        sys.exit(f"monitor_cost.py: that is not under {ALLOWED:.0%}")


main()
