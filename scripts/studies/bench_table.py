#!/usr/bin/python3
"""Prints a Google Benchmark JSON of bounce_bench as a Markdown table, with its origin."""
import json
import math
import statistics
import sys


def cell(value, form):
    """A number as text; a missing or non-finite one is a dash, never a plausible figure."""
    if not isinstance(value, (int, float)) or not math.isfinite(value):
        return "-"
    return format(value, form)


def medians(runs):
    """A row's repetitions as one run: the median of each figure, or the repetition that failed."""
    repetitions = {}
    for run in runs:
        if run["run_type"] == "iteration":
            repetitions.setdefault(run["run_name"], []).append(run)
    # In the order in which they were registered, not in which they ran.
    for same in sorted(repetitions.values(), key=lambda same: same[0]["family_index"]):
        failed = [run for run in same if run.get("error_occurred")]
        if failed:
            yield failed[0]
            continue
        keys = [key for key, value in same[0].items() if isinstance(value, (int, float))]
        yield same[0] | {key: statistics.median(run[key] for run in same) for key in keys}


def rows(runs):
    for run in medians(runs):
        name, _, rest = run["run_name"].partition("/threads:")
        threads = rest.split("/")[0]
        limit = run.get("part_of_port_limit")
        name, *more = name.split(", ")
        precision = next((word for word in more if word in ("compensated", "single")), "double")
        scene = run.get("label", "")
        if run.get("error_occurred"):
            yield [name, precision, scene, threads, "ERROR: " + run["error_message"], *[""] * 7]
            continue
        yield [
            name,
            precision,
            scene,
            threads,
            cell(run.get("ns_per_step"), ".0f"),
            cell(run.get("particles_per_s", math.nan) / 1e6, ".0f"),
            cell(run.get("bonds_per_s", math.nan) / 1e6, ".0f"),
            cell(limit, ".0%"),
            cell(run.get("hand_shake_ns"), ".0f"),
            cell(run.get("x_oracle_O3"), ".2f"),
            cell(run.get("x_oracle_Ofast"), ".2f"),
            cell(run.get("difference_cm"), ".1e"),
        ]


def main():
    if len(sys.argv) != 2:
        sys.exit("usage: bench_table.py FILE.json")
    with open(sys.argv[1], encoding="utf-8") as file:
        data = json.load(file)
    context = data["context"]
    repetitions = max((run.get("repetitions", 1) for run in data["benchmarks"]), default=1)
    print("# Throughput\n")
    print(f"Per step of one ball; medians of {repetitions} repetitions, all rows' in random order, of 7 turns each. × is the")
    print("ratio to the scalar oracle compiled with the flags named, made turn by turn; times swing with the clock.")
    print("Port limit: the part reached of the multiply-add rate measured in the same turn, for kernels whose")
    print("operations are counted; particle-steps and bonds are the whole ball's, also where half is stepped.")
    print("Hand-shake: from one core to the other and back, for threads that share a ball, in the same turns.")
    print("The last column is the largest difference from the oracle's positions after 1000 steps.\n")
    print("| row | precision | scene | threads | ns/step | 10^6 particle-steps/s | 10^6 bonds/s | port limit | hand-shake, ns | × oracle -O3 | "
          "× oracle -Ofast | difference, cm |")
    print("|" + " --- |" * 12)
    for row in rows(data["benchmarks"]):
        print("| " + " | ".join(row) + " |")
    print(f"\nMade by `scripts/bench.sh` at commit {context['commit']}, {context['date']}, on "
          f"{context['cpu']} ({context['num_cpus']} cores), {context['compiler']}, "
          f"{context['flags']} (oracles: -march=native).")
    if any(run.get("error_occurred") for run in data["benchmarks"]):
        sys.exit("bench_table.py: a row's state is wrong")


main()
