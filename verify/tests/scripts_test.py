#!/usr/bin/python3
"""The scripts that judge results, on made-up results; nothing is timed. BOUNCE_PROGRAM: path of bounce."""
import contextlib
import json
import math
import os
import random
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

SCRIPTS = Path(__file__).resolve().parent.parent.parent / "scripts"
sys.dont_write_bytecode = True
sys.path.insert(0, str(SCRIPTS))

import bench_compare

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


class LargeBalls(unittest.TestCase):
    """scripts/large_balls.py on made-up measurements."""

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
                           "run_type": "iteration", "ns_per_particle_step": 2.0 + repetition,
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
        done = subprocess.run([SCRIPTS / "large_balls.py", path, self.folder], capture_output=True, text=True,
                              check=False)
        return done.returncode, done.stderr

    def test_table_and_pictures(self):
        self.assertEqual(self.run_script(self.write()), (0, ""))
        text = (self.folder / "large-balls.md").read_text()
        self.assertIn("| 10 000 200 | 2 | 3.00 | 1.25 | 9.00 | 4.50 | 8.00 | 8.0 | 1.5 |", text)
        self.assertIn("medians of 3 repetitions of 9 turns", text)
        self.assertIn("c0ffee", text)
        self.assertGreater((self.folder / "large-balls.png").stat().st_size, 10000)
        self.assertIn("<svg", (self.folder / "large-balls.svg").read_text())

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


class Targets(unittest.TestCase):
    def rows(self, figures):
        with tempfile.TemporaryDirectory() as folder:
            results(folder, "throughput.json", figures)
            done = subprocess.run([SCRIPTS / "targets_table.py", folder], capture_output=True, text=True, check=True)
        return {line.split(" | ")[0].lstrip("| "): [cell.strip(" |") for cell in line.split(" | ")[2:]]
                for line in done.stdout.splitlines() if line.startswith("|")}

    def test_met_missed_and_not_measured(self):
        rows = self.rows({"ring avx512/threads:1": [20.0, 19.0, 21.0], "ring avx2/threads:1": [8.9] * 3,
                          "ring avx512/threads:4": [9.0] * 3, "auto auto, example-1/threads:0": [math.nan] * 3})
        self.assertEqual(rows["ring avx512, one core: × oracle -O3"], ["20.00", "met"])
        self.assertEqual(rows["ring avx2, one core: × oracle -O3"], ["8.90", "**not met**"])
        self.assertEqual(rows["ring avx512, four threads on two cores: × one thread"], ["0.45", "**not met**"])
        for missing in ("Example 1 as auto runs it: × oracle -O3", "ring avx512, one core: × oracle -Ofast"):
            self.assertEqual(rows[missing], ["not measured", ""])


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


def has_numpy():
    with contextlib.suppress(ImportError):
        import numpy  # noqa: F401

        return True
    return False


@unittest.skipUnless(has_numpy(), "no numpy (apt-get install python3-numpy)")
class Peers(unittest.TestCase):
    BOUNCE = os.environ.get("BOUNCE_PROGRAM")

    def test_without_lammps(self):
        done = subprocess.run([SCRIPTS / "peers" / "compare.py", "--lammps", "no-such-lammps"],
                              capture_output=True, text=True, check=False)
        self.assertEqual((done.returncode, done.stdout), (2, ""))
        self.assertIn("apt-get install lammps", done.stderr)

    def test_balls_are_those_of_bounce(self):
        from peers.flying_ball import read_ball

        scenes = [("example-2", []), ("example-5", []), ("law-2-4", []), ("large-ball", []),
                  ("example-1", ["--set", "constants=double", "--set", "law.p=1", "--set", "law.q=4.5"]),
                  ("example-6", ["--set", "ball.radii=[3.0, 4.0]", "--set", "law.rest=geometry",
                                 "--set", "ball.per_ring=50"])]
        for scene, settings in scenes:
            with tempfile.TemporaryDirectory() as folder:  # its bonds are checked on the way
                ball = read_ball(self.BOUNCE, scene, settings, Path(folder) / "run")
            for kind in ball.classes:
                scale = kind.attraction / kind.rest**kind.p
                self.assertLessEqual(abs(kind.force(kind.rest)), 1e-14 * scale)
                d = 1e-5 * kind.rest
                slope = (kind.force(kind.rest + d) - kind.force(kind.rest - d)) / (2 * d)
                self.assertLessEqual(abs(slope - kind.slope(kind.rest)), 1e-7 * abs(slope))
                pull = (kind.potential(kind.rest * 1.1 - d) - kind.potential(kind.rest * 1.1 + d)) / (2 * d)
                self.assertLessEqual(abs(pull - kind.force(kind.rest * 1.1)), 1e-7 * scale)

    def test_wrong_bonds_are_noticed(self):
        import numpy as np
        from peers import flying_ball

        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "run"
            ball = flying_ball.read_ball(self.BOUNCE, "example-2", [], path)
            run = flying_ball.read_run(path)
        for change in ((0, 0, 1), (1, 2, 130)):  # a class swapped; a bond to another particle
            bonds = ball.bonds.copy()
            bonds[change[0]][0 if change[0] == 0 else 2] = change[2]
            wrong = flying_ball.Ball(**{**vars(ball), "bonds": bonds})
            with self.assertRaises(flying_ball.PeerError):
                flying_ball.check_bonds(wrong, run)
        nowhere = flying_ball.Ball(**{**vars(ball), "x": np.full(len(ball.x), math.nan)})
        with self.assertRaises(flying_ball.PeerError):
            flying_ball.check_bonds(nowhere, run)

    def test_flight_ends_at_the_wall(self):
        from peers.flying_ball import read_ball

        with tempfile.TemporaryDirectory() as folder:
            ball = read_ball(self.BOUNCE, "example-2", [], Path(folder) / "run")
        fall = math.sqrt(2 * 0.95 * 3.0 / 0.098)  # s, for 95 % of 3 cm
        self.assertAlmostEqual(ball.flight_steps() * 1e-6, fall, places=5)

    def test_agreement_fails_when_it_must(self):
        import numpy as np
        from peers import agreement

        def record(difference=1e-11, bound=1e-10, order=3.9, harmonic=1e-6):
            tables = [{"entries": 250, "difference_cm": 1e-9, "bound_cm": 1e-8},
                      {"entries": 8000, "difference_cm": difference, "bound_cm": bound}]
            return {"steps": 1, "tables": tables, "order": order, "harmonic_difference_cm": harmonic}

        agreement.check(record())
        for wrong in ({"difference": 2e-10}, {"difference": math.nan}, {"bound": math.nan}, {"order": 2.9},
                      {"order": math.nan}, {"harmonic": 5e-10}, {"harmonic": math.nan}):
            with self.assertRaises(agreement.Disagreement, msg=wrong):
                agreement.check(record(**wrong))
        lost = np.array([[0.0, 0.0, 0.0], [0.0, math.nan, 0.0]])
        self.assertTrue(math.isnan(agreement.apart(np.zeros((2, 3)), lost)))


@unittest.skipUnless(has_numpy(), "no numpy (apt-get install python3-numpy)")
class Stability(unittest.TestCase):
    def test_bad_input(self):
        with tempfile.TemporaryDirectory() as folder:
            done = subprocess.run([SCRIPTS / "stability.py", "--runs", folder, "--out", Path(folder) / "out"],
                                  capture_output=True, text=True, check=False)
            self.assertEqual((done.returncode, done.stdout), (2, ""))
            self.assertIn("example-1: no run there", done.stderr)
            self.assertEqual(list((Path(folder) / "out").iterdir()), [])
        done = subprocess.run([SCRIPTS / "stability.sh", "--no-such"], capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 2)

    def test_sweeps_are_read_and_drawn(self):
        from pictures import edge
        from pictures.run import RunError

        with tempfile.TemporaryDirectory() as folder:
            sweep = ["stability", "example-2", "--flight-only", "--e", "10,1e5", "--methods",
                     "leapfrog,blanes-moan-4", "--no-disturbed", "--periods", "250", "--out", f"{folder}/sweep"]
            subprocess.run([os.environ["BOUNCE_PROGRAM"], *sweep], capture_output=True, check=True)
            read = edge.read_sweep(Path(folder) / "sweep")
            self.assertEqual(edge.methods(read), ["leapfrog", "blanes-moan-4"])
            self.assertEqual(len(read.where(method="leapfrog", passage="flight", sought="dt")), 3)
            # The strict limit below the edge by the criterion, and the flights that measure it.
            strict, by_criterion = (edge.product_of(read, "blanes-moan-4", which) for which in ("strict", "predicted"))
            self.assertLess(strict, 0.7 * by_criterion)
            self.assertEqual(edge.longer_flights(read, "leapfrog"), [])
            self.assertEqual(len(edge.longer_flights(read, "blanes-moan-4")), 1)
            # A table of each; where the edge moves with the criterion, a row that says so.
            import stability
            lines = stability.flight_table({"s": read}).splitlines()
            self.assertEqual(len(lines), 4)
            self.assertIn("(2400 periods)", lines[3])
            for row in read.rows:
                if row["growth"] == 1000 and row["method"] == "leapfrog":
                    row["stable"] = math.nan
            self.assertIn("| s | leapfrog | flight | 1000 |", stability.criterion_text({"s": read}))
            axes = edge.plane(read, {2: (16000.0, 1e-6)}).axes[0]
            self.assertEqual((axes.get_xscale(), axes.get_yscale()), ("log", "log"))
            (Path(folder) / "edge.csv").write_text("method,E\nleapfrog,ten\n")
            with self.assertRaises(RunError):
                edge.read_sweep(Path(folder))


@unittest.skipUnless(has_numpy(), "no numpy (apt-get install python3-numpy)")
class Contact(unittest.TestCase):
    """contact.py and accuracy.py, on made-up rows of bounce accuracy."""

    NAMES = ("height", "speed", "rebound", "contact_time", "energy_lost", "flattening")
    HEAD = ["method", "contact", "precision", "dt", "tolerance", "steps", "evaluations", "kernel", "seconds",
            "error_position", *(f"error_{name}" for name in NAMES), "error_energy", "error_energy_free", *NAMES, "note"]

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def row(self, method, contact, step, error, precision="double", note=""):
        return [method, contact, precision, str(step), "", "1", "1", "ring", "1.0", "1e-9", *[str(error)] * 6, "1e-9",
                "1e-9", *[str(5.0 + error)] * 6, note]

    def study(self, name, rows, commit="abc"):
        place = self.folder / "runs" / name
        place.mkdir(parents=True)
        lines = [self.HEAD, self.row("reference", "", "", 1e-12, precision=""), *rows]
        (place / "accuracy.csv").write_text("".join(",".join(line) + "\n" for line in lines))
        (place / "table.txt").write_text("")
        (place / "scene.toml").write_text("")
        best = {"method": "leapfrog", "contact": "listing", "precision": "single", "dt": 1e-4, "seconds": 1.0}
        (place / "origin.json").write_text(json.dumps({"commit": commit, "date": "today", "cpu": "some",
                                                       "oracle_seconds": 100.0, "best": best}))

    def rows(self, resolved_step=1e-4):
        """The paper's rule is off by 1000 dt, the resolved by dt^2 x 1000."""
        return [*(self.row("listing", "listing", step, 1e3 * step) for step in (1e-4, 1e-5, 1e-6, 1e-7)),
                self.row("leapfrog", "resolved", resolved_step, 1e-5),
                self.row("leapfrog", "resolved", 1e-4, 1e-2, precision="compensated"),
                self.row("leapfrog", "listing", 1e-4, 1e-3, precision="single"),
                self.row("gsl-bsimp", "located", "nan", math.inf, note='"too long, said ""it"""')]

    def located(self, *more, scenes="a", commit="abc"):
        """The other study that contact.py reads."""
        rows = [self.row("leapfrog", "resolved", 1e-4, 7.0),  # of the same step as in contact-a, which counts
                self.row("leapfrog", "located", 1e-4, 1e-5), self.row("blanes-moan-6", "resolved", 1e-4, 1e-6),
                self.row("blanes-moan-6", "resolved", 1e-5, 1e-5), self.row("blanes-moan-6", "located", 1e-4, 1e-7)]
        for scene in scenes:
            self.study(f"located-{scene}", [*rows, *more], commit)

    def growth(self, commit="abc"):
        for scene, end in (("a", 1e-3), ("b", 1e-3), ("example-3", 1.0)):
            place = self.folder / "runs" / f"growth-{scene}"
            place.mkdir(parents=True)
            growth = {"start": 1e-9, "at_contact": 1e-8, "end": end, "rate": 2.0}
            (place / "observables.json").write_text(json.dumps(
                {"growth": growth, "fixed": {"contacts": 7}, "origin": {"commit": commit}}))

    def run_script(self, name, *words):
        return subprocess.run([SCRIPTS / name, "--runs", self.folder / "runs", "--out", self.folder / "out", *words],
                              capture_output=True, text=True, check=False)

    def contacts(self, rows, *more):
        """The text of contact.md."""
        self.study("contact-a", rows)
        self.located(*more)
        self.growth()
        done = self.run_script("contact.py", "a")
        self.assertEqual(done.returncode, 0, done.stderr)
        return (self.folder / "out" / "contact.md").read_text()

    def test_the_factor_is_that_of_the_exact_steps(self):
        text = self.contacts(self.rows())
        # No row to compare at 1e-6; nearer by 10 at the one step there is.
        self.assertRegex(text, r"\| a \| leapfrog, resolved \| 100 \| yes \| speed 100, .* \| - \| 0.0001 \|\n")
        self.assertIn("| a | height | 5 | 1.0e-12 | 5 ± ", text)  # the limit of the paper's rule
        self.assertTrue((self.folder / "out" / "contact.png").is_file())

    def test_the_methods_have_a_line_each(self):
        text = self.contacts(self.rows(), self.row("blanes-moan-6", "resolved", 1e-6, 1e-5),
                             self.row("blanes-moan-6", "resolved", 1e-7, 2e-4))
        # The smallest step is not nearer by 10, so there is none from which on all are.
        self.assertRegex(text, r"\| a \| blanes-moan-6, resolved \| 1e\+03 \| yes \| .* \| 100 \| - \|\n")
        self.assertRegex(text, r"\| a \| blanes-moan-6, located \| 1e\+04 \| yes \| ")

    def test_the_growth_of_a_difference_tells_the_error_allowed(self):
        text = self.contacts(self.rows())
        # A tenth of the paper's 1e-3 over the growth from 1e-8 to 1e-3.
        self.assertIn("| a | 7 | 1.0e-09 | 1.0e-08 | 1.0e-03 | 1.0e+05 | 2.0 | 1.0e-09 |", text)
        self.assertIn("| example-3 | 7 | 1.0e-09 | 1.0e-08 | 1.0e+00 | 1.0e+08 | 2.0 | - |", text)

    def test_a_factor_that_is_too_small_is_told(self):
        rows = [*self.rows(), self.row("leapfrog", "resolved", 1e-6, 1e-7)]
        rows[4] = self.row("leapfrog", "resolved", 1e-4, 2e-4)
        self.assertRegex(self.contacts(rows), r"\| a \| leapfrog, resolved \| 5 \| NO \| .* \| 1e\+04 \| 1e-06 \|\n")

    def test_no_number_is_no_factor(self):
        rows = self.rows()
        rows[4] = self.row("leapfrog", "resolved", 1e-4, math.nan)
        self.assertRegex(self.contacts(rows), r"\| a \| leapfrog, resolved \| nan \| NO \| .* \| - \| - \|\n")

    def test_what_is_not_there_is_named(self):
        self.study("contact-a", self.rows(resolved_step=1.01e-4))
        self.study("contact-b", self.rows(), commit="abc-dirty")
        self.located(scenes="ab")
        self.growth()
        for scene, text in (("a", "at exactly 0.0001 s"), ("b", "a clean commit"), ("c", "cannot be read")):
            done = self.run_script("contact.py", scene)
            self.assertEqual((done.returncode, done.stdout), (2, ""))
            self.assertIn(text, done.stderr)
            self.assertEqual(list((self.folder / "out").iterdir()), [])

    def test_precisions_are_in_table_and_picture(self):
        from pictures import accuracy

        self.study("accuracy-a", self.rows())
        done = self.run_script("accuracy.py", "a")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("| leapfrog, listing, single, 0.0001 |", (self.folder / "out" / "accuracy.md").read_text())
        study = accuracy.read_study(self.folder / "runs" / "accuracy-a")
        self.assertIn(("leapfrog", "resolved", "compensated"), study.lines())
        labels = [text.get_text() for text in accuracy.figure_of(study, "a").axes[-2].get_legend().get_texts()]
        self.assertIn("leapfrog, resolved, compensated", labels)
        self.assertIn("listing, listing", labels)
        self.assertIn("gsl-bsimp, located (not finished)", labels)

    def test_a_scene_comes_to_those_that_are_there(self):
        self.study("accuracy-b", self.rows(), commit="first")
        self.assertEqual(self.run_script("accuracy.py", "b").returncode, 0)
        self.study("accuracy-a", self.rows(), commit="second")
        self.assertEqual(self.run_script("accuracy.py", "a").returncode, 0)
        lines = [line for line in (self.folder / "out" / "accuracy.md").read_text().splitlines()
                 if line.startswith(("| a |", "| b |"))]
        self.assertEqual([line.split(" | ")[-1] for line in lines], ["second |", "first |"])
        for name in ("a/accuracy.csv", "b/accuracy.csv", "a.png", "b.svg"):
            self.assertTrue((self.folder / "out" / "accuracy" / name).is_file(), name)

    def test_one_table_of_contacts_is_of_one_commit(self):
        self.study("contact-a", self.rows(), commit="first")
        self.study("contact-b", self.rows(), commit="second")
        self.located(scenes="ab", commit="first")
        self.growth()
        done = self.run_script("contact.py", "a", "b")
        self.assertEqual(done.returncode, 2)
        self.assertIn("first, second: allowed is one clean commit", done.stderr)
        done = self.run_script("contact.py", "a")  # the growth is of another
        self.assertEqual(done.returncode, 2)
        self.assertIn("commit abc: allowed is that of the studies, first", done.stderr)

    def test_scripts_refuse_unknown_options(self):
        for name in ("contact.sh", "accuracy.sh"):
            done = subprocess.run([SCRIPTS / name, "--no-such"], capture_output=True, text=True, check=False)
            self.assertEqual(done.returncode, 2)
            self.assertIn(f"{name}: unknown option --no-such", done.stderr)
            done = subprocess.run([SCRIPTS / name, "--help"], capture_output=True, text=True, check=False)
            self.assertEqual(done.returncode, 0)
            self.assertIn(f"scripts/{name} [--out DIR]", done.stdout)


if __name__ == "__main__":
    unittest.main()
