#!/usr/bin/python3
"""Checks bounce advise: what it forecasts for the height of the centre, against what then comes out.

For each scene and asked error: `bounce run SCENE --error X`, its height at the end against the reference in
RESULTS/accuracy/SCENE, its run time, the median of 7 of the same, against the forecast. Writes OUT/advice.md. Exit
code 1 if an error came out larger than three times the asked one.
"""

import argparse
import csv
import json
import re
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from studies import study
from studies.study import ROOT

RUNS = 7

FORECAST = re.compile(r"method ([\w-]+), contact (\w+), time step (\S+) s\n"
                      r"forecast: error of height (\S+) cm .*known to (\S+)\), run (\S+) s")


def read_arguments():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    add = parser.add_argument
    add("--bounce", type=Path, default=ROOT / "build/release/bounce", metavar="PROGRAM")
    add("--results", type=Path, default=ROOT / "results", metavar="DIR", help="holds accuracy/SCENE [results]")
    add("--out", type=Path, default=ROOT / "results", metavar="DIR", help="[results]")
    add("--errors", default="1e-2,1e-3,1e-4,1e-6", help="asked, cm [1e-2,1e-3,1e-4,1e-6]")
    add("scenes", nargs="*", metavar="SCENE", default=[f"example-{n}" for n in range(1, 8)])
    return parser.parse_args()


def reference_height(folder):
    with open(folder / "accuracy.csv", newline="") as file:
        row = next(csv.DictReader(file))
    return float(row["height"]), float(row["error_height"])


def without_output(folder):
    """Options: looks and frames at the start and the end alone, as the forecast is of a run without output."""
    text = (folder / "scene.toml").read_text()
    end = re.search(r"^end = (\S+)", text, re.MULTILINE)[1]
    frames = "frames_every" if re.search(r"^frames_every", text, re.MULTILINE) else "frames_at"
    frames += f"={end}" if frames == "frames_every" else f"=[0.0, {end}]"
    return ["--set", f"output.monitor_every={end}", "--set", f"output.{frames}"]


def verdict(error, asked, bar, took):
    if not error <= 3.0 * asked + bar:  # nor a NaN
        return "MISSED"
    if not bar <= 3.0 * asked:
        return "not known well enough to tell"
    return "as asked" if 0.5 <= took <= 2.0 else "as asked, not in time"


def seconds_again(arguments, run, more):
    """The run's time, and of as many more of the same scene: one alone tells little of some milliseconds."""
    times = []
    for _ in range(more):
        subprocess.run([arguments.bounce, "run", run / "scene.toml", "--out", run.with_name("again"), "--force",
                        "--threads", "1", "--quiet"], capture_output=True, check=True)
        times.append(json.loads((run.with_name("again") / "run.json").read_text())["wall_seconds"])
    return times


def row_of(arguments, scene, asked, folder):
    height, bar = reference_height(arguments.results / "accuracy" / scene)
    run = folder / f"{scene}-{asked}"
    done = subprocess.run([arguments.bounce, "run", scene, "--error", asked, "--out", run, "--threads", "1",
                           *without_output(arguments.results / "accuracy" / scene)],
                          capture_output=True, text=True, check=False)
    if done.returncode == 2 and "nothing reaches it" in done.stderr:
        floor = re.search(r"reach is (\S+) cm", done.stderr)
        return [scene, asked, "refused", "-", "-", f"{bar:.1e}", "-", "-", f"nothing known to reach below {floor[1]} cm"]
    if done.returncode != 0:
        sys.exit(f"advice.py: {scene}: {done.stderr}")
    record = json.loads((run / "run.json").read_text())
    method, contact, step, forecast, _, seconds = FORECAST.search(record["advice"]).groups()
    with open(run / "monitor.csv", newline="") as file:
        last = list(csv.DictReader(file))[-1]
    error = abs(float(last["cy"]) - height)
    took = statistics.median([record["wall_seconds"], *seconds_again(arguments, run, RUNS - 1)]) / float(seconds)
    return [scene, asked, f"{method}, {contact}, {float(step):.3g}", forecast, f"{error:.1e}", f"{bar:.1e}", seconds,
            f"{took:.2f}", verdict(error, float(asked), bar, took)]


def origin_text(arguments, folder):
    """Of the program, as a run of one step tells it."""
    subprocess.run([arguments.bounce, "run", arguments.scenes[0], "--steps", "1", "--out", folder / "origin", "--quiet"],
                   capture_output=True, check=True)
    origin = json.loads((folder / "origin" / "run.json").read_text())["origin"]
    return f"at commit {origin['commit']}, {study.now()}, on {origin['cpu']}, {origin['compiler']}, {origin['flags']}"


def main():
    arguments = read_arguments()
    head = ["scene", "asked, cm", "advised: method, contact, Δt", "forecast", "came out", "known to", "run, s, forecast",
            "took / forecast", ""]
    with tempfile.TemporaryDirectory() as folder:
        rows = [row_of(arguments, scene, asked, Path(folder))
                for scene in arguments.scenes for asked in arguments.errors.split(",")]
        made = origin_text(arguments, Path(folder))
    study.write_whole(
        arguments.out / "advice.md",
        f"# Advice\n\nErrors of the height of the centre at the end, cm.\n\n{study.table(head, rows)}\n"
        f"Made by `scripts/studies/advice.py` {made}.\n")
    study.follow(arguments.out)
    print(f"advice.py: {arguments.out}/advice.md")
    return 1 if any(row[-1] == "MISSED" for row in rows) else 0


if __name__ == "__main__":
    sys.exit(main())
