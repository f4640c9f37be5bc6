#!/usr/bin/python3
"""Fills README.md's numbers in from results/, so that none of them is typed by hand.

  scripts/readme_numbers.py            writes README.md
  scripts/readme_numbers.py --check    changes nothing; names each number that differs

In README.md a number stands between <!-- n:NAME --> and <!-- /n -->. NUMBERS below says of each name what is
written there and where it comes from. Exit code: 0 good, 1 a number differs, is unknown, unused or not finite (then
nothing is written), 2 README.md cannot be read.
"""
import argparse
import csv
import json
import math
import os
import re
import statistics
import sys
from pathlib import Path

MARKER = re.compile(r"<!-- n:(\w+) -->([^<\n]*)<!-- /n -->")
SCENES = tuple(f"example-{number}" for number in range(1, 8))
TABULATED, HARMONIC = ("LAMMPS, tabulated bonds", 1), ("LAMMPS, harmonic bonds", 1)


class NoNumber(Exception):
    """Why a number cannot be had."""


def middle(values):
    """The median; NoNumber if there is no value or one that is not finite, which a median could hide."""
    values = list(values)
    if not values:
        raise NoNumber("no such row")
    if not all(math.isfinite(value) for value in values):
        raise NoNumber("a value is not finite")
    return statistics.median(values)


def only(rows, what):
    """The one row of several that is wanted."""
    rows = list(rows)
    if len(rows) != 1:
        raise NoNumber(f"{len(rows)} rows {what}, wanted is one")
    return rows[0]


class Results:
    """What is read from the folder results/. Every method gives one number or raises NoNumber."""

    def __init__(self, folder):
        self.folder = folder
        self.loaded = {}

    def text(self, name):
        try:
            return (self.folder / name).read_text(encoding="utf-8")
        except OSError as error:
            raise NoNumber(f"{self.folder / name}: {error.strerror}") from error

    def rows(self, name):
        return list(csv.DictReader(self.text(name).splitlines()))

    def json(self, name):
        if name not in self.loaded:
            self.loaded[name] = json.loads(self.text(name))
        return self.loaded[name]

    def benchmark(self, name, row, threads, figure):
        """Median over the repetitions of a row of Google Benchmark; where only that was kept, its own median."""
        same = [run for run in self.json(name)["benchmarks"]
                if run["run_name"].split("/iterations")[0] == f"{row}/threads:{threads}"]
        if any(run.get("error_occurred") for run in same):
            raise NoNumber(f"{name}: {row}, {threads} thread(s): its state is wrong")
        repetitions = [run for run in same if run.get("run_type") == "iteration"]
        medians = [run for run in same if run.get("aggregate_name") == "median"]
        return middle(run[figure] for run in repetitions or medians)

    def throughput(self, row, figure, threads=1):
        return self.benchmark("throughput.json", row, threads, figure)

    def times_lammps(self, program, lammps):
        """Median over the rounds of bounce's steps a second over LAMMPS's of the same round."""
        speeds = {(row["program"], row["cores"]): row["steps_per_second"] for row in self.json("peers.json")["rows"]}
        ours, theirs = speeds[program, 1], speeds[lammps]
        if len(ours) != len(theirs):
            raise NoNumber("peers.json: rounds are missing")
        return middle(a / b for a, b in zip(ours, theirs))

    def best(self, scene):
        """origin.json of an accuracy study: the paper's program, and the cheapest setting that is as good."""
        origin = self.json(f"accuracy/{scene}/origin.json")
        if origin["best"].get("precision", "double") != "double":
            raise NoNumber(f"{scene}: its cheapest setting is not in double precision, which bounce no longer has")
        return origin

    def sooner(self, scene):
        origin = self.best(scene)
        return origin["oracle_seconds"] / origin["best"]["seconds"]

    def height_error(self, scene, **wanted):
        """Of the accuracy study's row in double precision whose columns are these (numbers to the last digits)."""
        def fits(row):
            same = (math.isclose(float(row[key] or "nan"), value) if isinstance(value, float) else row[key] == value
                    for key, value in wanted.items())
            return row.get("precision") in (None, "", "double") and all(same)

        found = [row for row in self.rows(f"accuracy/{scene}/accuracy.csv") if fits(row)]
        return float(only(found, f"of {scene} with {wanted}")["error_height"])

    def papers_error(self, scene):
        return self.height_error(scene, method="listing", contact="listing", dt=1e-6)

    def best_error(self, scene):
        best = self.best(scene)["best"]
        return self.height_error(scene, **{key: best[key] for key in ("method", "contact", "dt")})

    def edge(self, scene, sought, **wanted):
        """The largest stable step (sought="dt") or E in free flight, by the usual criterion, of the listing's
        scheme."""
        wanted = wanted | {"growth": 100.0, "periods": 1000.0, "disturbed": 1e-6}
        found = [row for row in self.rows(f"stability/{scene}/edge.csv")
                 if (row["method"], row["passage"], row["sought"]) == ("listing", "flight", sought)
                 and all(math.isclose(float(row[key] or "nan"), value) for key, value in wanted.items())]
        return float(only(found, f"of {scene}: {sought} with {wanted}")["stable"])

    def equivalence_rows(self):
        """How many rows hold, if all do."""
        held = re.search(r"^equivalent: (\d+) of (\d+) rows hold$", self.text("equivalence.txt"), re.M)
        if not held or held[1] != held[2]:
            raise NoNumber("equivalence.txt: not all rows hold")
        return int(held[1])

    def extreme_rows(self):
        """How many rows did what is expected, if all did."""
        rows = self.rows("extremes.csv")
        if not rows or any(row["as_expected"] != "1" for row in rows):
            raise NoNumber("extremes.csv: not every row is as expected")
        return len(rows)


def two_digits(value):
    """1234.5 as 1,200; 0.01234 as 0.012."""
    digits = 1 - math.floor(math.log10(abs(value)))
    return f"{round(value, digits):,.{max(0, digits)}f}"


def whole(value):
    return f"{value:,.0f}"


def one_decimal(value):
    return f"{value:.1f}"


def power_of_ten(value):
    """2.34e9 as 2.3 × 10⁹."""
    factor, exponent = f"{value:.1e}".split("e")
    raised = str(int(exponent)).translate(str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"))
    return f"{factor} × 10{raised}"


# Name: how it is written, where it comes from.
NUMBERS = {
    # steps a second, one core, Example 1 as `auto` runs it (half the ball), and the whole ball
    "million_steps": (one_decimal, lambda r: 1e3 / r.throughput("auto auto, example-1", "ns_per_step", threads=0)),
    "auto_x_listing": (whole, lambda r: r.throughput("auto auto, example-1", "x_oracle_O3", threads=0)),
    "ring_x_listing": (whole, lambda r: r.throughput("ring avx512", "x_oracle_O3")),
    "ring_avx2_x_listing": (whole, lambda r: r.throughput("ring avx2", "x_oracle_O3")),
    "ring_port_limit": (whole, lambda r: 100.0 * r.throughput("ring avx512", "part_of_port_limit")),
    "half_x_lammps": (whole, lambda r: r.times_lammps("bounce, leapfrog", TABULATED)),
    "ring_x_lammps": (whole, lambda r: r.times_lammps("bounce, leapfrog, ring", TABULATED)),
    "half_x_harmonic": (whole, lambda r: r.times_lammps("bounce, leapfrog", HARMONIC)),
    # a particle-step in a ball of 10 million, over one in the paper's ball
    "ten_million_x_papers": (one_decimal, lambda r: r.benchmark(
        "large-balls.json", "particles:10000200", 1, "x_papers_ball")),
    # error against run time, of the height of the centre at the end
    "sooner": (two_digits, lambda r: r.sooner("example-2")),
    "sooner_least": (two_digits, lambda r: min(r.sooner(scene) for scene in SCENES)),
    "sooner_most": (two_digits, lambda r: max(r.sooner(scene) for scene in SCENES)),
    "papers_seconds": (whole, lambda r: r.best("example-2")["oracle_seconds"]),
    "best_seconds": (two_digits, lambda r: r.best("example-2")["best"]["seconds"]),
    "papers_error": (power_of_ten, lambda r: r.papers_error("example-2")),
    "best_error": (power_of_ten, lambda r: r.best_error("example-2")),
    "known_to": (power_of_ten, lambda r: r.height_error("example-2", method="reference")),
    # the edge of stability in free flight
    "edge_x_papers_step": (two_digits, lambda r: r.edge("example-2", "dt", E=16000.0) / 1e-6),
    "edge_root": (two_digits, lambda r: r.edge("example-2", "dt", E=16000.0) * math.sqrt(16000.0)),
    "edge_elasticity": (power_of_ten, lambda r: r.edge("example-2", "E", dt=1e-6)),
    # what holds
    "equivalence_rows": (whole, lambda r: r.equivalence_rows()),
    "extreme_rows": (whole, lambda r: r.extreme_rows()),
}


def written(name, results):
    """A number as README has it; NoNumber if it is unknown or not finite."""
    if name not in NUMBERS:
        raise NoNumber("README.md asks for it, and nothing is defined under that name")
    form, value_of = NUMBERS[name]
    try:
        value = value_of(results)
    except (KeyError, TypeError, ValueError, ZeroDivisionError) as error:
        raise NoNumber(f"{type(error).__name__}: {error}") from error
    if not math.isfinite(value) or value <= 0.0:  # all of them are above 0
        raise NoNumber(f"it is {value}")
    return form(value)


def filled(text, results):
    """The text with each number filled in, those that differ as (name, is, should be), and complaints."""
    differ, complaints, used = [], [], set()

    def fill(marker):
        name, old = marker.groups()
        used.add(name)
        try:
            new = written(name, results)
        except NoNumber as error:
            complaints.append(f"{name}: {error}")
            return marker[0]
        if new != old:
            differ.append((name, old, new))
        return f"<!-- n:{name} -->{new}<!-- /n -->"

    new_text = MARKER.sub(fill, text)
    complete = len(MARKER.findall(text))
    if text.count("<!-- n:") != complete or text.count("<!-- /n -->") != complete:
        complaints.append("README.md: a marker is torn; allowed is <!-- n:NAME -->NUMBER<!-- /n -->, on one line")
    if re.search(r"^\s*<!-- n:", text, re.M):
        complaints.append("README.md: a line begins with a marker, which Markdown takes for a block of HTML")
    complaints += [f"{name}: README.md does not use it" for name in NUMBERS if name not in used]
    return new_text, differ, complaints


def write_whole(path, text):
    temporary = path.with_name(f".{path.name}.tmp")
    temporary.write_text(text, encoding="utf-8")
    os.replace(temporary, path)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--check", action="store_true", help="change nothing; exit code 1 if a number differs")
    parser.add_argument("--top", type=Path, default=Path(__file__).resolve().parent.parent, metavar="DIR",
                        help="holds README.md and results/ [the repository]")
    arguments = parser.parse_args()
    readme = arguments.top / "README.md"
    try:
        text = readme.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        print(f"readme_numbers.py: {readme}: cannot be read: {error}", file=sys.stderr)
        return 2
    new_text, differ, complaints = filled(text, Results(arguments.top / "results"))
    for complaint in complaints:
        print(f"readme_numbers.py: {complaint}", file=sys.stderr)
    for name, old, new in differ if arguments.check else ():
        print(f"readme_numbers.py: {name}: README.md has {old or 'nothing'}, the results say {new} "
              "(scripts/readme_numbers.py writes it)", file=sys.stderr)
    if complaints or (arguments.check and differ):
        return 1
    if new_text != text:
        write_whole(readme, new_text)
    return 0


if __name__ == "__main__":
    sys.exit(main())
