#!/usr/bin/python3
"""Kills runs at random moments and goes on with them: is anything lost, or there twice?

    scripts/studies/kills.py [--kills N] [--seed S] [--out DIR] [--allow-dirty]

Each case is a run beside one that is killed (SIGKILL) or stopped (SIGTERM, SIGINT, SIGHUP) and resumed, with any number of
threads and any vectors, until it is complete; all files of both are compared byte for byte. From a clean tree
writes results/kills.md. Exit code 1 if a byte differs. 500 kills take some 3 minutes.
"""

import argparse
import json
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from studies import study
from studies.study import ROOT

BOUNCE = ROOT / "build/release/bounce"
TO_THE_FLOOR = ["--set", "ball.centre=[0, 7.02]", "--set", "ball.velocity=[0, -1]", "--set", "output.frames_every=0.013",
                "--set", "output.monitor_every=0.003"]
# What is run, its words, and the end, s: about half a second of computing each.
CASES = (
    ("mirror, the paper's scheme", ["example-2", "--kernel", "mirror"], 1.5),
    ("ring, the listing's frames", ["example-2", "--kernel", "ring", "--listing-frames"], 1.2),
    ("ring, friction and a throw", ["example-5", "--kernel", "ring"], 1.2),
    ("annulus", ["example-2", "--kernel", "annulus"], 0.8),
    ("csr", ["example-2", "--kernel", "csr"], 0.4),
    ("strict", ["example-2", "--kernel", "strict"], 0.06),
    ("oracle", ["example-2", "--kernel", "oracle"], 0.06),
    ("ring, every reflection booked", ["example-2", "--kernel", "ring", "--ledger"], 0.05),
    ("mirror, leapfrog, resolved contact", ["example-2", "--kernel", "mirror", "--set", "time.method=leapfrog", "--set",
                                            "wall.contact=resolved"], 1.5),
    ("csr, PEFRL", ["example-2", "--kernel", "csr", "--set", "time.method=pefrl"], 0.1),
    ("ring, Blanes and Moan's method, located contact", ["example-5", "--set", "time.method=blanes-moan-6", "--set",
                                                         "wall.contact=located", "--set", "time.step=2e-5"], 0.3),
)
SIGNALS = (signal.SIGKILL, signal.SIGKILL, signal.SIGKILL, signal.SIGTERM, signal.SIGINT, signal.SIGHUP)
SAME = ("status", "steps", "state_hash", "bounce", "ledger", "stability", "energies_at_start")


def read_arguments():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--kills", type=int, default=500, help="at least so many [500]")
    parser.add_argument("--seed", type=int, default=1, help="of the moments [1]")
    parser.add_argument("--out", type=Path, default=ROOT / "results", metavar="DIR", help="where kills.md goes [results]")
    parser.add_argument("--allow-dirty", action="store_true", help="write it for a changed tree, too")
    arguments = parser.parse_args()
    if arguments.kills < 1:
        parser.error("allowed is --kills from 1")
    return arguments


def step_of(folder, name):
    """Of the checkpoint that is there; -1 without."""
    for place in (folder / f"{name}.part", folder / name):
        if (place / "checkpoint").exists():
            head = (place / "checkpoint").read_bytes().split(b"\n", 2)[1]
            return json.loads(head)["step"]
    return -1


class Stopped:
    """A run that is stopped again and again."""

    def __init__(self, folder, words, draw):
        self.folder, self.words, self.draw = folder, words, draw
        self.kills, self.before, self.patience = 0, -1, 0.08
        self.complete = False

    def go_on(self):
        stopped = step_of(self.folder, "cut")
        words = ["resume", "cut", "-q", "--checkpoint-every", "0.01"]
        if stopped < 0:
            words = [*self.words, "--out", "cut"]
        elif "oracle" not in self.words:  # which has neither
            words += ["--threads", self.draw.choice("012"), "--vector", self.draw.choice(("auto", "avx2"))]
        process = subprocess.Popen([BOUNCE, *words], cwd=self.folder, stderr=subprocess.PIPE, text=True)
        time.sleep(self.draw.uniform(0, self.patience))
        process.send_signal(self.draw.choice(SIGNALS))
        message = process.communicate()[1]
        code = process.returncode
        if code == 0:
            self.complete = True
            return
        if code not in (-signal.SIGKILL, 128 + signal.SIGTERM, 128 + signal.SIGINT, 128 + signal.SIGHUP,
                        -signal.SIGTERM, -signal.SIGINT, -signal.SIGHUP):
            raise AssertionError(f"bounce {' '.join(words)}: exit code {code}: {message}")
        self.kills += 1
        now = step_of(self.folder, "cut")
        if now <= self.before:
            self.patience *= 1.3  # a busy machine
        self.before = now


def differences(whole, cut):
    names = sorted(path.name for path in whole.iterdir())
    if names != sorted(path.name for path in cut.iterdir()):
        yield f"files {names} and {sorted(path.name for path in cut.iterdir())}"
    for name in names:
        if name not in ("run.json", "checkpoint") and (whole / name).read_bytes() != (cut / name).read_bytes():
            yield name
    first, second = (json.loads((folder / "run.json").read_text()) for folder in (whole, cut))
    yield from (f"run.json: {key}" for key in SAME if first[key] != second[key])


def run_case(folder, case, kills, draw):
    """Rows' numbers: kills, runs brought to their end, and what differed."""
    words = ["run", *case[1], "-q", "--checkpoint-every", "0.01", "--t-end", str(case[2]), *TO_THE_FLOOR]
    subprocess.run([BOUNCE, *words, "--out", "whole"], cwd=folder, check=True)
    made, runs, found = 0, 0, []
    while made < kills:
        stopped = Stopped(folder, words, draw)
        while not stopped.complete:
            stopped.go_on()
        made, runs = made + stopped.kills, runs + 1
        found += differences(folder / "whole", folder / "cut")
        shutil.rmtree(folder / "cut")
    return made, runs, found


def main():
    arguments = read_arguments()
    commit = subprocess.run([BOUNCE, "--version"], check=True, capture_output=True, text=True).stdout.split("commit ")[1]
    commit = commit.split(")")[0]
    if not arguments.allow_dirty:
        study.check_clean("build/release/bounce", commit)
    draw = random.Random(arguments.seed)
    each = -(-arguments.kills // len(CASES))
    rows, lost, total = [], 0, 0
    for case in CASES:
        with tempfile.TemporaryDirectory() as folder:
            made, runs, found = run_case(Path(folder), case, each, draw)
        total, lost = total + made, lost + len(found)
        rows.append([case[0], f"`bounce run {' '.join(case[1])} --t-end {case[2]} …`", str(made), str(runs),
                     ", ".join(found) or "nothing"])
        print(" | ".join(rows[-1]), flush=True)
    text = (f"# Killed runs\n\nRuns killed at random moments ({total} times; of six signals three SIGKILL, the others SIGTERM, "
            "SIGINT, SIGHUP) and gone on\nwith by `bounce resume`, each time with another number of threads and vector width. "
            "In the end all files were compared\nwith those of a run that was never stopped, byte for byte: state, rows, "
            "frames, ledgers.\n\n"
            + study.table(["case", "run", "kills", "runs", "differs"], rows)
            + f"\nA checkpoint was written every 0.01 s. Made by `scripts/studies/kills.py --kills {arguments.kills} --seed "
              f"{arguments.seed}`, bounce commit {commit}, {study.now()}.\n")
    arguments.out.mkdir(parents=True, exist_ok=True)
    study.write_whole(arguments.out / "kills.md", text)
    study.follow(arguments.out)
    print(f"{total} kills, {lost} differences: {arguments.out / 'kills.md'}")
    return 1 if lost else 0


if __name__ == "__main__":
    study.run(main)
