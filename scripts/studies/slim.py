#!/usr/bin/python3
"""Brings results into the form in which they are kept; what is so already stays as it is.

  scripts/studies/slim.py FILE ...

A Google Benchmark's JSON keeps its origin, the repetitions and the figures that tables and comparisons are made from,
to six digits; rows of what the program no longer has go, and the file says so. scripts/bench.sh and large_balls.sh do
that to what they measure. A PNG gets a palette. In a page (.md) pictures are named from the page's own folder, and
scripts by where they stand now. The last two are for results that earlier commits have made.
"""

import argparse
import re
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from studies import benchmarks, study
from studies.study import ROOT, InputError

# Of results made before that day: part of a row's name, and what it was.
GONE_SINCE = "2026-11-28"
GONE = {r"\bensemble\b": "an ensemble of balls, one a lane",
        r", (single|compensated)\b": "single and compensated precision",
        r"^free flight\b": "free flight, which left the wall test out while no particle could reach a wall",
        r"^(walls in other directions|a second wall|friction and restitution of the wall)\b":
            "kernels compiled for the form of the walls"}


def rounded(value):
    return float(f"{value:.6g}") if isinstance(value, float) else value


def slim(data):
    """A benchmark's JSON without what nobody reads."""
    kept, gone = [], list(data["context"].get("left_out", []))
    patterns = GONE if data["context"].get("date", "") < GONE_SINCE else {}
    for run in data["benchmarks"]:
        what = next((what for pattern, what in patterns.items() if re.search(pattern, run["run_name"])), None)
        if what:
            gone.append(what)
        elif run["run_type"] == "iteration":
            kept.append({key: rounded(run[key]) for key in (*benchmarks.ROW, *benchmarks.FIGURES) if key in run})
    context = {key: data["context"][key] for key in benchmarks.CONTEXT if key in data["context"]}
    if gone:
        context["left_out"] = sorted(set(gone))
    return {"context": context, "benchmarks": kept}


def page(text):
    """A page with today's names of pictures and scripts."""
    moved = "|".join(re.escape(path.name) for path in (ROOT / "scripts" / "studies").iterdir())
    return re.sub(rf"`scripts/({moved})", r"`scripts/studies/\1", text.replace("](results/", "]("))


def handle(path):
    if path.suffix == ".json":
        benchmarks.write(slim(benchmarks.read(path)), path)
    elif path.suffix == ".png":
        from pictures import drawing  # benchmarks need no matplotlib

        drawing.slim_png(path)
    elif path.suffix == ".md":
        study.write_whole(path, page(path.read_text(encoding="utf-8")))
    else:
        raise InputError(f"{path}: allowed are .json, .png and .md")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("files", nargs="+", type=Path, metavar="FILE")
    for path in parser.parse_args().files:
        try:
            handle(path)
        except OSError as error:
            raise InputError(f"{path}: {error.strerror or error}") from error


if __name__ == "__main__":
    study.run(main)
