#!/usr/bin/python3
"""Prints a Google Benchmark JSON of bounce_left_out as a Markdown table, with its origin."""
import json
import math
import statistics
import sys


def gains(runs):
    """Each row's repetitions of its gain, in the order in which the rows were registered."""
    found = {}
    for run in runs:
        if run["run_type"] == "iteration":
            gain = run.get("gain", math.nan)
            found.setdefault((run["family_index"], run["run_name"].split("/")[0]), []).append(gain)
    for (_, name), same in sorted(found.items()):
        yield name, same


def main():
    if len(sys.argv) != 2:
        sys.exit("usage: left_out_table.py FILE.json")
    with open(sys.argv[1], encoding="utf-8") as file:
        data = json.load(file)
    rows = list(gains(data["benchmarks"]))
    if not rows or not all(math.isfinite(gain) for _, same in rows for gain in same):
        sys.exit("left_out_table.py: a row has no gain")
    context = data["context"]
    print("# What leaving out saves\n")
    print("Time of a step with it / without it, one ball in the air, one thread but where a row says otherwise;")
    print(f"median, least and greatest of {len(rows[0][1])} repetitions, each the median of 401 pairs of 200 steps")
    print("taken in turns.\n")
    print("| left out | gain | least | greatest |")
    print("| --- | --- | --- | --- |")
    for name, same in rows:
        print(f"| {name} | {statistics.median(same):.2f} | {min(same):.2f} | {max(same):.2f} |")
    print(f"\nMade by `scripts/bench.sh` at commit {context['commit']}, {context['date']}, on "
          f"{context['cpu']}, {context['compiler']}, {context['flags']}.")


main()
