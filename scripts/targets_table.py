#!/usr/bin/python3
"""Prints what was aimed at and what was reached, as a Markdown table, from the raw results in DIR:
throughput.json, left_out.json, large-balls.json and peers.json. What was not measured is said so.
"""
import json
import math
import pathlib
import statistics
import sys


def load(folder, name):
    path = folder / name
    return json.loads(path.read_text(encoding="utf-8")) if path.is_file() else None


def rows_of(data):
    """Medians of a Google Benchmark's figures, by the row's name and its number of threads."""
    found = {}
    for run in data["benchmarks"] if data else ():
        if run["run_type"] == "iteration" and not run.get("error_occurred"):
            name, _, rest = run["run_name"].partition("/threads:")
            found.setdefault((name.split("/iterations")[0], rest.split("/")[0]), []).append(run)
    return {key: {figure: statistics.median(run[figure] for run in same)
                  for figure, value in same[0].items() if isinstance(value, (int, float))}
            for key, same in found.items()}


def figure(rows, name, threads, key):
    return rows.get((name, str(threads)), {}).get(key, math.nan)


def ratio(rows, over, under, key="x_oracle_O3"):
    """Of two rows' speeds. Both are ratios to the same oracle, so the clock falls out."""
    return figure(rows, *over, key) / figure(rows, *under, key)


def faster_than(peers, bounce, lammps):
    """Median over the rounds of bounce's steps/s over LAMMPS's; rows are (program, cores)."""
    speeds = {(row["program"], row["cores"]): row["steps_per_second"] for row in peers["rows"]} if peers else {}
    if bounce not in speeds or lammps not in speeds:
        return math.nan
    return statistics.median(a / b for a, b in zip(speeds[bounce], speeds[lammps]))


def targets(folder):
    """What is asked for, the figure asked, whether more is better, the figure reached."""
    fast = rows_of(load(folder, "throughput.json"))
    left_out = rows_of(load(folder, "left_out.json"))
    large = rows_of(load(folder, "large-balls.json"))
    peers = load(folder, "peers.json")
    shake = figure(fast, "ring avx512", 2, "hand_shake_ns")
    shaken = "" if math.isnan(shake) else f" (hand-shake of {shake:.0f} ns)"
    tabulated = "LAMMPS, tabulated bonds"
    for vector, least in (("avx512", 18), ("avx2", 9)):
        yield f"ring {vector}, one core: × oracle -O3", least, True, figure(fast, f"ring {vector}", 1, "x_oracle_O3")
    yield "ring avx512, one core: × oracle -Ofast", 10, True, figure(fast, "ring avx512", 1, "x_oracle_Ofast")
    for vector in ("avx512", "avx2"):
        yield (f"ring {vector}, one core: part of the port limit", 0.7, True,
               figure(fast, f"ring {vector}", 1, "part_of_port_limit"))
    yield ("half the ball where it is symmetric: × the full ball", 1.7, True,
           figure(left_out, "the other half of the ball: ring for mirror", "", "gain"))
    for vector in ("avx512", "avx2"):
        yield (f"ring {vector}, two cores on one ball: × one{shaken}", 1.4, True,
               ratio(fast, (f"ring {vector}", 2), (f"ring {vector}", 1)))
    yield "Example 1 as auto runs it: × oracle -O3", 35, True, figure(fast, "auto auto, example-1", 0, "x_oracle_O3")
    yield ("ring avx512, four threads on two cores: × one thread", 0.5, True,
           ratio(fast, ("ring avx512", 4), ("ring avx512", 1)))
    for vector in ("avx512", "avx2"):
        yield (f"ensemble {vector}, a scene: × ring", 1.0, True,
               ratio(fast, (f"64 balls ensemble {vector}", 1), (f"ring {vector}", 1)))
        yield (f"ensemble {vector}, two threads: × one", 1.9, True,
               ratio(fast, (f"64 balls ensemble {vector}", 2), (f"64 balls ensemble {vector}", 1)))
    for threads in (1, 2):
        yield (f"a particle-step of 10 million, {threads} thread{'s' * (threads > 1)}: × of 360", 1.5, False,
               figure(large, "particles:10000200", threads, "x_papers_ball"))
    yield ("steps/s of leapfrog, one core: × LAMMPS, tabulated bonds", 40, True,
           faster_than(peers, ("bounce, leapfrog", 1), (tabulated, 1)))
    yield ("steps/s of leapfrog, two cores: × LAMMPS, tabulated bonds", 40, True,
           faster_than(peers, ("bounce, leapfrog", 2), (tabulated, 2)))


def verdict(asked, more, reached):
    if not math.isfinite(reached):
        return "not measured | "
    met = reached >= asked if more else reached <= asked
    return f"{reached:.2f} | {'met' if met else '**not met**'}"


def main():
    if len(sys.argv) != 2:
        sys.exit("usage: targets_table.py DIR")
    folder = pathlib.Path(sys.argv[1])
    print("# What was aimed at and what was reached\n")
    print("| what | aimed at | reached | |")
    print("| --- | --- | --- | --- |")
    for what, asked, more, reached in targets(folder):
        sign = "at least" if more else "at most"
        print(f"| {what} | {sign} {asked:g} | {verdict(asked, more, reached)} |")
    print("\nMade by `scripts/targets_table.py` from the raw results of the tables below, each with its origin.")


main()
