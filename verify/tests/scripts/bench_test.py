#!/usr/bin/python3
"""The scripts that compare and tabulate timings, on made-up results; nothing is timed."""
import json
import math
import random
import subprocess
import tempfile
import unittest
from pathlib import Path

from scripts_folder import SCRIPTS, STUDIES, has_numpy, run_here

from bench import bench_compare

MEASURE = "oracle -O3 -march=native/threads:1"
RING = "ring avx2/threads:1"


def results(folder, name, rows):
    """A file as bench.sh writes it: row name to x_oracle_O3 of its repetitions."""
    runs = [{"run_name": f"{row}/iterations:7/manual_time", "run_type": "iteration", "family_index": index,
             "x_oracle_O3": figure}
            for index, (row, figures) in enumerate(rows.items()) for figure in figures]
    path = Path(folder) / name
    path.write_text(json.dumps({"context": {"commit": name}, "benchmarks": runs}))
    return str(path)


def noisy(centre, seed, count=15):
    """Repetitions that swing by a few per cent."""
    source = random.Random(seed)
    return [centre * math.exp(source.gauss(0.0, 0.02)) for _ in range(count)]


class CompareFiles(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def compare(self, a, b, *options):
        files = [results(self.folder, name, {MEASURE: noisy(1.0, 9), RING: row})
                 for name, row in (("a", a), ("b", b))]
        return self.run_script(*files, *options)

    def run_script(self, *words):
        done = subprocess.run([SCRIPTS / "bench.sh", "--compare", *words], capture_output=True, text=True,
                              check=False)
        return done.returncode, done.stdout, done.stderr

    def verdict(self, text, row=RING):
        lines = [line for line in text.splitlines() if line.startswith(f"| {row} |")]
        self.assertEqual(len(lines), 1, text)
        return lines[0].split(" | ")[-1].rstrip(" |")

    def test_same(self):
        code, text, _ = self.compare(noisy(12.0, 1), noisy(12.0, 1))
        self.assertEqual((code, self.verdict(text)), (0, "not told apart"))
        self.assertEqual(self.verdict(text, MEASURE), "the measure")

    def test_same_but_for_noise(self):
        self.assertEqual(self.verdict(self.compare(noisy(12.0, 1), noisy(12.0, 2))[1]), "not told apart")

    def test_slower_and_faster(self):
        fast, slow = noisy(12.0, 1), noisy(12.0 / 1.1, 2)
        self.assertEqual(self.verdict(self.compare(fast, slow)[1]), "slower")
        self.assertEqual(self.verdict(self.compare(slow, fast)[1]), "faster")

    def test_certain_but_small(self):
        self.assertEqual(self.verdict(self.compare([12.0] * 15, [11.9] * 15)[1]), "not told apart")

    def test_what_is_no_figure(self):
        for wrong in (math.nan, math.inf, 0.0, None):
            code, text, _ = self.compare(noisy(12.0, 1), [*noisy(12.0, 2), wrong])
            self.assertEqual(code, 1, wrong)
            self.assertIn("CANNOT BE JUDGED", self.verdict(text))

    def test_too_few(self):
        code, text, _ = self.compare(noisy(12.0, 1), noisy(12.0, 2, count=6))
        self.assertEqual(code, 1)
        self.assertIn("6 repetitions, needed are 7", self.verdict(text))

    def test_row_of_one_alone(self):
        a = results(self.folder, "a", {RING: noisy(12.0, 1), "csr avx2/threads:1": noisy(4.0, 1)})
        b = results(self.folder, "b", {RING: noisy(12.0, 2)})
        code, text, _ = self.run_script(a, b)
        self.assertEqual((code, self.verdict(text, "csr avx2/threads:1")), (0, "only in A"))

    def test_bad_input(self):
        good = results(self.folder, "a", {RING: noisy(12.0, 1)})
        torn = Path(self.folder) / "torn.json"
        torn.write_text('{"context": {')
        for words, complaint in (((good, str(torn)), "torn.json: not a result"),
                                 ((good, "no-such-thing"), "no-such-thing: neither a file nor a commit"),
                                 ((good, good, "--rounds", "3"), "allowed is 7 or more"),
                                 ((good, good, "--rows", "none"), "no row in common"),
                                 ((good, good, "--rows", "("), "not a regular expression")):
            code, text, complaints = self.run_script(*words)
            self.assertEqual((code, text), (2, ""), words)
            self.assertIn(complaint, complaints)


@unittest.skipUnless(has_numpy(), "no numpy (apt-get install python3-numpy)")
class LargeBalls(unittest.TestCase):
    """large_balls.py on made-up measurements."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def write(self, change=lambda run: None):
        runs = []
        for particles in (360, 10000200):
            for threads in (1, 2):
                for repetition in range(3):
                    run = {"run_name": f"particles:{particles}/threads:{threads}/iterations:9/manual_time",
                           "run_type": "iteration", "family_index": 0, "ns_per_particle_step": 2.0 + repetition,
                           "x_papers_ball": 1.25, "sweep_ns_per_particle_step": 9.0, "sweep_x_papers_ball": 4.5,
                           "memory_bytes_per_s": 8e9, "memory_ns_per_particle_step": 8.0, "build_s": 1.5}
                    change(run)
                    runs.append(run)
        context = {"commit": "c0ffee", "date": "today", "cpu": "a cpu", "num_cpus": 2, "compiler": "c",
                   "flags": "-O3", "turns": "9"}
        path = self.folder / "in.json"
        path.write_text(json.dumps({"context": context, "benchmarks": runs}))
        return path

    def run_script(self, path):
        done = run_here(STUDIES / "large_balls.py", path, self.folder)
        return done.returncode, done.stderr

    def test_table_and_pictures(self):
        self.assertEqual(self.run_script(self.write()), (0, ""))
        text = (self.folder / "large-balls.md").read_text()
        self.assertIn("| 10 000 200 | 2 | 3.00 | 1.25 | 9.00 | 4.50 | 8.00 | 8.0 | 1.5 |", text)
        self.assertIn("medians of 3 repetitions of 9 turns", text)
        self.assertIn("c0ffee", text)
        self.assertGreater((self.folder / "large-balls.png").stat().st_size, 10000)

    def test_what_is_no_figure(self):
        def nan(run):
            run["x_papers_ball"] = math.nan

        def missing(run):
            del run["build_s"]

        def failed(run):
            run["error_occurred"] = True
            run["error_message"] = "its state is not the plain sweep's"

        for change, complaint in ((nan, "x_papers_ball is nan"), (missing, "build_s is None"),
                                  (failed, "not the plain sweep's")):
            code, complaints = self.run_script(self.write(change))
            self.assertEqual(code, 2)
            self.assertIn(complaint, complaints)
            self.assertFalse((self.folder / "large-balls.md").exists())

    def test_bad_input(self):
        torn = self.folder / "torn.json"
        torn.write_text('{"context": {')
        code, complaints = self.run_script(torn)
        self.assertEqual(code, 2)
        self.assertIn("torn.json: not a result", complaints)


class Slim(unittest.TestCase):
    """What slim.py leaves of a benchmark's JSON."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.path = Path(folder.name) / "throughput.json"

    def write(self, date):
        names = ("ring avx2/threads:1", "64 balls ensemble avx2/threads:1", "ring avx2, single/threads:1")
        runs = [{"name": name, "run_name": name + "/iterations:7", "run_type": kind, "family_index": index,
                 "repetitions": 7, "cpu_time": 1.0, "label": "example-2", "x_oracle_O3": 12.3456789 + repetition,
                 "ns_per_step": math.nan}
                for index, name in enumerate(names) for kind in ("iteration", "aggregate") for repetition in range(7)]
        context = {"commit": "c0ffee", "date": date, "cpu": "a cpu", "num_cpus": 2, "compiler": "c", "flags": "-O3",
                   "caches": [1, 2, 3]}
        self.path.write_text(json.dumps({"context": context, "benchmarks": runs}, indent=2))

    def run_script(self, name, *words):
        return run_here(STUDIES / name, *words)

    def test_what_is_gone_goes_and_is_told(self):
        self.write("2026-11-27T16:04:22+00:00")
        self.assertEqual(self.run_script("slim.py", self.path).returncode, 0)
        data = json.loads(self.path.read_text())
        self.assertEqual({run["run_name"] for run in data["benchmarks"]}, {"ring avx2/threads:1/iterations:7"})
        self.assertEqual(set(data["benchmarks"][0]), {"run_name", "run_type", "family_index", "repetitions", "label",
                                                      "x_oracle_O3", "ns_per_step"})
        self.assertEqual(data["benchmarks"][0]["x_oracle_O3"], 12.3457)
        self.assertNotIn("caches", data["context"])
        once = self.path.read_text()
        self.assertEqual(self.run_script("slim.py", self.path).returncode, 0)
        self.assertEqual(self.path.read_text(), once)
        text = self.run_script("../bench/bench_table.py", self.path).stdout
        self.assertIn("of what the program no longer has: an ensemble of balls, one a lane; single and", text)
        self.assertIn("| ring avx2 | example-2 | 1 | - |", text)

    def test_of_today_nothing_is_gone(self):
        self.write("2026-11-29T00:00:00+00:00")
        self.assertEqual(self.run_script("slim.py", self.path).returncode, 0)
        self.assertEqual(len(json.loads(self.path.read_text())["benchmarks"]), 21)
        self.assertNotIn("no longer", self.run_script("../bench/bench_table.py", self.path).stdout)

    def test_the_comparison_reads_both_forms(self):
        self.write("2026-11-29T00:00:00+00:00")
        whole = self.path.with_name("whole.json")
        whole.write_text(self.path.read_text())
        self.run_script("slim.py", self.path)
        done = subprocess.run([SCRIPTS / "bench.sh", "--compare", whole, self.path], capture_output=True, text=True,
                              check=False)
        self.assertEqual((done.returncode, done.stdout.count("not told apart")), (0, 3), done.stderr)

    def test_bad_input(self):
        self.path.write_text("{}")
        for path, complaint in ((self.path, "not a result"), (self.path.with_name("none.json"), "not a result"),
                                (self.path.with_name("some.txt"), "allowed are .json, .png and .md")):
            done = self.run_script("slim.py", path)
            self.assertEqual((done.returncode, done.stdout), (2, ""))
            self.assertIn(complaint, done.stderr)


class Rule(unittest.TestCase):
    def test_ranks_of_the_head(self):
        known = {6: 0, 7: 1, 11: 2, 15: 3}  # of six throws even six heads come with 3.1 %
        self.assertEqual({n: bench_compare.interval_rank(n) for n in known}, known)
        self.assertAlmostEqual(float(bench_compare.coin_chance(7, 1)), 0.015625)
        self.assertAlmostEqual(float(bench_compare.coin_chance(11, 2)), 24 / 2048)

    def test_rank_chance(self):
        # Of the 70 orders of 4 and 4 one has all of a first (u = 0), and one more has u = 1; twice for b.
        self.assertAlmostEqual(float(bench_compare.rank_chance([1, 2, 3, 4], [5, 6, 7, 8])), 2 / 70)
        self.assertAlmostEqual(float(bench_compare.rank_chance([1, 2, 3, 5], [4, 6, 7, 8])), 4 / 70)
        self.assertEqual(bench_compare.rank_chance([1, 1, 1], [1, 1, 1]), 1)

    def test_false_alarms(self):
        # 2000 comparisons of a program with itself. Noise of 20 % dwarfs the least size, so it is the
        # rule alone that is tried: 40 alarms expected at most, 60 are three standard deviations more.
        judges = ((bench_compare.judge_pairs, 11), (bench_compare.judge_files, 15))
        for judge, count in judges:
            alarms = 0
            for seed in range(2000):
                source = random.Random(seed)
                a, b = ([math.exp(source.gauss(0.0, 0.2)) for _ in range(count)] for _ in "ab")
                alarms += judge(RING, a, b).verdict != "not told apart"
            self.assertGreater(alarms, 0)
            self.assertLessEqual(alarms, 60, judge.__name__)

    def test_pairs(self):
        times = noisy(800.0, 3, count=11)
        self.assertEqual(bench_compare.judge_pairs(RING, times, times).verdict, "not told apart")
        # 10 % slower under a clock that swings by a factor of two from pair to pair.
        swing = [t * (1 + n % 2) for n, t in enumerate(times)]
        slower = [1.1 * t for t in swing]
        self.assertEqual(bench_compare.judge_pairs(RING, swing, slower).verdict, "slower")
        self.assertEqual(bench_compare.judge_pairs(RING, slower, swing).verdict, "faster")
        little = [1.01 * t for t in swing]
        self.assertEqual(bench_compare.judge_pairs(RING, swing, little).verdict, "not told apart")
        for wrong in ([*swing[1:], math.nan], swing[1:]):
            self.assertFalse(bench_compare.judge_pairs(RING, swing, wrong).judged)


if __name__ == "__main__":
    unittest.main()
