#!/usr/bin/python3
"""Prints a Google Benchmark JSON of bounce_left_out as a Markdown table, with its origin."""

import math
import statistics
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from studies import benchmarks, study


def main():
    if len(sys.argv) != 2:
        raise study.InputError("usage: left_out_table.py FILE.json")
    data = benchmarks.read(sys.argv[1])
    gains = {name.split("/")[0]: [run.get("gain", math.nan) for run in same]
             for name, same in benchmarks.rows(data).items()}
    if not gains or not all(math.isfinite(gain) for same in gains.values() for gain in same):
        raise study.InputError(f"{sys.argv[1]}: a row has no gain")
    print("# What leaving out saves\n")
    print("Time of a step with it / without it, one ball in the air, one thread but where a row says otherwise;")
    print(f"median, least and greatest of {len(next(iter(gains.values())))} repetitions, each the median of 401 pairs",
          "of 200 steps")
    print("taken in turns.\n")
    print(study.table(["left out", "gain", "least", "greatest"],
                      ([name, f"{statistics.median(same):.2f}", f"{min(same):.2f}", f"{max(same):.2f}"]
                       for name, same in gains.items())))
    print(benchmarks.left_out_text(data), end="")
    print(f"Made by `scripts/bench.sh` {benchmarks.origin_text(data['context'])}.")


if __name__ == "__main__":
    study.run(main)
