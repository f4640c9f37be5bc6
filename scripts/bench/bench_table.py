#!/usr/bin/python3
"""Prints a Google Benchmark JSON of bounce_bench as a Markdown table, with its origin."""

import math
import statistics
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from studies import benchmarks, study
from studies.benchmarks import cell

HEAD = ["row", "scene", "threads", "ns/step", "10^6 particle-steps/s", "10^6 bonds/s", "port limit", "hand-shake, ns",
        "× oracle -O3", "× oracle -Ofast", "difference, cm"]


def medians(data):
    """A row's repetitions as one run: the median of each figure, or the repetition that failed."""
    for same in benchmarks.rows(data).values():
        failed = [run for run in same if run.get("error_occurred")]
        keys = [key for key, value in same[0].items() if isinstance(value, (int, float))]
        yield failed[0] if failed else same[0] | {key: statistics.median(run[key] for run in same) for key in keys}


def rows(data):
    for run in medians(data):
        name, _, rest = run["run_name"].partition("/threads:")
        head = [name.partition(", ")[0], run.get("label", ""), rest.split("/")[0]]
        if run.get("error_occurred"):
            yield [*head, "ERROR: " + run["error_message"], *[""] * 7]
            continue
        yield [
            *head,
            cell(run.get("ns_per_step"), ".0f"),
            cell(run.get("particles_per_s", math.nan) / 1e6, ".0f"),
            cell(run.get("bonds_per_s", math.nan) / 1e6, ".0f"),
            cell(run.get("part_of_port_limit"), ".0%"),
            cell(run.get("hand_shake_ns"), ".0f"),
            cell(run.get("x_oracle_O3"), ".2f"),
            cell(run.get("x_oracle_Ofast"), ".2f"),
            cell(run.get("difference_cm"), ".1e"),
        ]


def main():
    if len(sys.argv) != 2:
        raise study.InputError("usage: bench_table.py FILE.json")
    data = benchmarks.read(sys.argv[1])
    repetitions = max((run.get("repetitions", 1) for run in data["benchmarks"]), default=1)
    print("# Throughput\n")
    print(f"Per step of one ball; medians of {repetitions} repetitions, all rows' in random order, of 7 turns each.",
          "× is the")
    print("ratio to the scalar oracle compiled with the flags named, made turn by turn; times swing with the clock.")
    print("Port limit: the part reached of the multiply-add rate measured in the same turn, for kernels whose")
    print("operations are counted; particle-steps and bonds are the whole ball's, also where half is stepped.")
    print("Hand-shake: from one core to the other and back, for threads that share a ball, in the same turns.")
    print("The last column is the largest difference from the oracle's positions after 1000 steps.\n")
    print(study.table(HEAD, rows(data)))
    print(benchmarks.left_out_text(data), end="")
    print(f"Made by `scripts/bench.sh` {benchmarks.origin_text(data['context'])} (oracles: -march=native).")
    if any(run.get("error_occurred") for run in data["benchmarks"]):
        sys.exit("bench_table.py: a row's state is wrong")


if __name__ == "__main__":
    study.run(main)
