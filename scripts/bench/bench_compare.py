#!/usr/bin/python3
"""Sets two throughput measurements side by side: each row faster, slower or not told apart.

  scripts/bench.sh --compare A B [--rounds N] [--rows REGEX]

A and B are two results of scripts/bench.sh (throughput.json), or two commits. Commits are built in
clones of their own under build/compare (kept for the next time) and run in turns.

The rule for two commits. In each round both run the row, one right after the other, now A first, now
B: a pair. A pair's ratio is A's time for a step over B's, so above 1 B is faster. Of n ratios the
interval from the k-th smallest to the k-th largest misses their true median only if of n coin throws
k - 1 or fewer fall on one side; k is the largest for which the chance of that is at most 2 %
(n = 7: k = 1, 1.6 %; n = 11: k = 2, 1.2 %; n = 15: k = 3, 0.7 %). B is faster or slower if the
interval lies on one side of 1 and the median is 2 % or more off 1. The chance holds for any noise, as
long as it is a coin throw which of a pair is the slower when both are the same program; the least
size makes false alarms rarer still.

The rule for two files. Their runs are not paired, so each is taken by its ratio to the oracle timed
in the same turn, which the clock does not reach; this supposes that both hold the same oracle. B is
faster or slower if by Mann and Whitney's rank test (exact, two-sided) samples of one distribution
are so far apart with a chance of at most 2 %, and the medians are 5 % or more apart: more than 2, as
what differs between two sessions (a neighbour on the core, a machine warmed up) shows in no
repetition. The row of that oracle itself is the measure and is not judged.

So each row is falsely told apart in at most 2 of 100 comparisons of a program with itself (of files:
as far as noise within a session goes); of 12 rows expect 0.2 at most.

Exit code: 0 if all rows were judged, 1 if one could not be (not finite, an error, too few), 2 for
bad input.
"""
import argparse
import json
import math
import os
import re
import statistics
import subprocess
import sys
from collections import namedtuple
from fractions import Fraction
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from studies import benchmarks, study
from studies.study import ROOT, InputError

FALSE_ALARM = Fraction(2, 100)  # a row's, at most
LEAST_OF_PAIRS = 0.02
LEAST_OF_FILES = 0.05
FEWEST = 7  # repetitions
MEASURE = "oracle -O3 -march=native"

# a, b: median figures; ratio: of B's speed to A's; evidence: what the verdict rests on.
Row = namedtuple("Row", "name a b ratio evidence verdict judged")


def coin_chance(n, k):
    """That of n coin throws k - 1 or fewer fall on one side."""
    return Fraction(2 * sum(math.comb(n, i) for i in range(k)), 2**n)


def interval_rank(n):
    """The k of the head; 0 if even all n ratios on one side would be no evidence."""
    return max((k for k in range(1, n // 2 + 1) if coin_chance(n, k) <= FALSE_ALARM), default=0)


def rank_chance(a, b):
    """Mann and Whitney's exact two-sided chance; ties count half, rounded against a finding."""
    m, n = len(a), len(b)
    u = sum(Fraction((y > x) - (y < x) + 1, 2) for x in a for y in b)
    u = math.ceil(min(u, m * n - u))
    # How many of all orders have each u: the coefficients of the Gaussian binomial.
    orders = [1] + [0] * (m * n)
    for i in range(1, m + 1):
        for at in range(m * n, n + i - 1, -1):
            orders[at] -= orders[at - n - i]
        for at in range(i, m * n + 1):
            orders[at] += orders[at - i]
    return min(Fraction(1), Fraction(2 * sum(orders[: u + 1]), math.comb(m + n, m)))


def unfit(figures):
    """Why these repetitions cannot be judged; empty if they can."""
    if not all(isinstance(f, (int, float)) and math.isfinite(f) and f > 0.0 for f in figures):
        return "CANNOT BE JUDGED: a repetition is no finite figure"
    if len(figures) < FEWEST:
        return f"CANNOT BE JUDGED: {len(figures)} repetitions, needed are {FEWEST}"
    return ""


def verdict(ratio, told_apart):
    if not told_apart:
        return "not told apart"
    return "faster" if ratio > 1.0 else "slower"


def judge_pairs(name, a, b):
    """Two commits' times, round by round."""
    trouble = unfit(a) or unfit(b) or (len(a) != len(b) and "CANNOT BE JUDGED: not as many of A as of B")
    if trouble:
        return Row(name, math.nan, math.nan, math.nan, "", trouble, False)
    ratios = sorted(x / y for x, y in zip(a, b))
    k = interval_rank(len(ratios))
    low, high = ratios[k - 1], ratios[-k]
    ratio = statistics.median(ratios)
    told = (low > 1.0 or high < 1.0) and abs(ratio - 1.0) >= LEAST_OF_PAIRS
    return Row(name, statistics.median(a), statistics.median(b), ratio, f"{low:.3f} to {high:.3f}",
               verdict(ratio, told), True)


def judge_files(name, a, b):
    """Two files' ratios to the oracle."""
    trouble = unfit(a) or unfit(b)
    if trouble:
        return Row(name, math.nan, math.nan, math.nan, "", trouble, False)
    first, second = statistics.median(a), statistics.median(b)
    ratio = second / first
    if name.startswith(MEASURE + "/"):
        return Row(name, first, second, ratio, "", "the measure", True)
    chance = rank_chance(a, b)
    told = chance <= FALSE_ALARM and abs(ratio - 1.0) >= LEAST_OF_FILES
    return Row(name, first, second, ratio, f"chance {float(chance):.2g}", verdict(ratio, told), True)


def repetitions(data, key):
    """A row's name to its figures, in the order in which the rows were registered; NaN stands for an error."""
    return {short(name): [math.nan if run.get("error_occurred") else run.get(key, math.nan) for run in same]
            for name, same in benchmarks.rows(data).items()}


def short(run_name):
    return run_name.partition("/iterations:")[0]


def read_file(path):
    data = benchmarks.read(path)
    return data["context"]["commit"], repetitions(data, "x_oracle_O3")


def compare_files(paths, wanted):
    (first, a), (second, b) = (read_file(path) for path in paths)
    heads = [f"{path} (commit {commit}), × oracle" for path, commit in zip(paths, (first, second))]
    return heads, judge_common(a, b, wanted, judge_files)


def judge_common(a, b, wanted, judge):
    """Rows of both, judged; rows of one alone, named."""
    rows = []
    for name in [*a, *(name for name in b if name not in a)]:
        if not wanted.search(name):
            continue
        if name in a and name in b:
            rows.append(judge(name, a[name], b[name]))
        else:
            only = "A" if name in a else "B"
            rows.append(Row(name, math.nan, math.nan, math.nan, "", f"only in {only}", True))
    if not any(not row.verdict.startswith("only in") for row in rows):
        raise InputError("A and B have no row in common")
    return rows


def output(*command, cwd=ROOT):
    """What a command prints. InputError if it fails."""
    done = subprocess.run(command, cwd=cwd, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise InputError(f"{' '.join(map(str, command))}: {done.stderr.strip() or done.stdout.strip()}")
    return done.stdout


def build(commit):
    """The benchmark program of this commit, from a clone of its own."""
    folder = ROOT / "build" / "compare" / commit[:12]
    if not folder.exists():
        folder.parent.mkdir(parents=True, exist_ok=True)
        partial = folder.with_name(f".{folder.name}-{os.getpid()}")
        output("git", "clone", "--quiet", "--shared", "--no-checkout", str(ROOT), str(partial))
        output("git", "checkout", "--quiet", "--detach", commit, cwd=partial)
        partial.rename(folder)
    if subprocess.run([folder / "scripts" / "build.sh", "release", "bounce_bench"], stdout=sys.stderr,
                      check=False).returncode != 0:
        raise InputError(f"commit {commit[:12]} does not build (in {folder})")
    return folder / "build" / "release" / "bounce_bench"


def time_row(program, run_name, commit):
    """Nanoseconds a step, by a process of its own; NaN if the row is an error."""
    escaped = re.sub(r"([][\\.^$*+?(){}|])", r"\\\1", run_name)
    done = subprocess.run([program, f"--benchmark_filter=^{escaped}$", "--benchmark_format=json"],
                          env=os.environ | benchmarks.PINNED, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise InputError(f"{program}: exit code {done.returncode} on {run_name}: {done.stderr.strip()}")
    data = json.loads(done.stdout)
    if data["context"]["commit"] != commit[:12]:
        raise InputError(f"{program} is of commit {data['context']['commit']}, not of {commit[:12]}; "
                         "remove its clone")
    return repetitions(data, "ns_per_step").get(short(run_name), [math.nan])[0]


def compare_commits(commits, rounds, wanted):
    programs = [build(commit) for commit in commits]
    names = [[name for name in output(program, "--benchmark_list_tests").splitlines()
              if wanted.search(short(name))] for program in programs]
    times = [{short(name): [] for name in side} for side in names]
    for number in range(rounds):
        for name in (name for name in names[0] if name in names[1]):
            for side in (0, 1) if number % 2 == 0 else (1, 0):
                times[side][short(name)].append(time_row(programs[side], name, commits[side]))
        print(f"round {number + 1} of {rounds}", file=sys.stderr)
    raw = ROOT / "build" / "compare" / f"{commits[0][:12]}-{commits[1][:12]}.json"
    study.write_whole(raw, json.dumps({"commits": commits, "ns_per_step": times}, indent=1) + "\n")
    print(f"raw times: {raw}", file=sys.stderr)
    return [f"{commit[:12]}, ns/step" for commit in commits], judge_common(*times, wanted, judge_pairs)


def find_commit(name):
    """Its full hash, or None."""
    done = subprocess.run(["git", "rev-parse", "--quiet", "--verify", "--end-of-options", f"{name}^{{commit}}"],
                          cwd=ROOT, capture_output=True, text=True, check=False)
    return done.stdout.strip() if done.returncode == 0 else None


def cell(value, form):
    return format(value, form) if math.isfinite(value) else "-"


def print_table(heads, rows):
    print(f"A: {heads[0]}\nB: {heads[1]}\n")
    print("| row | A | B | B's speed / A's | evidence | B is |")
    print("| --- | --- | --- | --- | --- | --- |")
    for row in rows:
        figures = [cell(row.a, ".5g"), cell(row.b, ".5g"), cell(row.ratio, ".3f")]
        print("| " + " | ".join([row.name, *figures, row.evidence or "-", row.verdict]) + " |")


def read_arguments():
    parser = argparse.ArgumentParser(prog="bench.sh --compare", description=__doc__.splitlines()[0])
    parser.add_argument("A", help="throughput.json, or a commit")
    parser.add_argument("B", help="the same kind of thing")
    parser.add_argument("--rounds", type=int, default=15, metavar="N", help="of two commits, 7 or more [15]")
    parser.add_argument("--rows", default="", metavar="REGEX", help="only rows whose name has a match")
    return parser.parse_args()


def main():
    arguments = read_arguments()
    if arguments.rounds < FEWEST:
        raise InputError(f"--rounds {arguments.rounds}: allowed is {FEWEST} or more")
    try:
        wanted = re.compile(arguments.rows)
    except re.error as error:
        raise InputError(f"--rows {arguments.rows}: not a regular expression: {error}") from error
    sides = [arguments.A, arguments.B]
    are_files = [Path(side).is_file() for side in sides]
    commits = [None if is_file else find_commit(side) for side, is_file in zip(sides, are_files)]
    for side, is_file, commit in zip(sides, are_files, commits):
        if not is_file and commit is None:
            raise InputError(f"{side}: neither a file nor a commit; allowed are two results of scripts/bench.sh "
                             "or two commits")
    if are_files[0] != are_files[1]:
        raise InputError(f"{sides[0]} and {sides[1]}: a file and a commit; allowed are two files, or two commits "
                         "(scripts/bench.sh makes a file of a commit)")
    if are_files[0]:
        heads, rows = compare_files(sides, wanted)
    else:
        heads, rows = compare_commits(commits, arguments.rounds, wanted)
    print_table(heads, rows)
    return 0 if all(row.judged for row in rows) else 1


if __name__ == "__main__":
    try:
        sys.exit(main())
    except InputError as problem:
        print(f"bench.sh --compare: {problem}", file=sys.stderr)
        sys.exit(2)
