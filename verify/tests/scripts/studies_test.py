#!/usr/bin/python3
"""The scripts that judge and draw studies, on made-up ones. BOUNCE_PROGRAM: path of bounce."""
import json
import math
import os
import subprocess
import tempfile
import unittest
from pathlib import Path

from scripts_folder import SCRIPTS, has_numpy


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

    def test_a_ball_that_blew_up_is_not_drawn(self):
        from pictures import accuracy

        blown = self.row("pefrl", "resolved", 1e-3, 1e6)
        blown[self.HEAD.index("error_energy")] = "1e20"
        self.study("accuracy-a", [*self.rows(), blown])
        panel = accuracy.figure_of(accuracy.read_study(self.folder / "runs" / "accuracy-a"), "a").axes[0]
        drawn = {line.get_label(): len(line.get_xdata()) for line in panel.lines}
        self.assertEqual((drawn["pefrl, resolved"], drawn["leapfrog, resolved"]), (0, 1))

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

    def test_a_torn_row_is_named(self):
        self.study("accuracy-a", [*self.rows(), ["leapfrog", "resolved"]])
        done = self.run_script("accuracy.py", "a")
        self.assertEqual((done.returncode, done.stdout), (2, ""))
        self.assertIn("a row without precision", done.stderr)

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
        for name in ("contact.sh", "accuracy.sh", "reference.sh"):
            done = subprocess.run([SCRIPTS / name, "--no-such"], capture_output=True, text=True, check=False)
            self.assertEqual(done.returncode, 2)
            self.assertIn(f"{name}: unknown option --no-such", done.stderr)
            done = subprocess.run([SCRIPTS / name, "--help"], capture_output=True, text=True, check=False)
            self.assertEqual(done.returncode, 0)
            self.assertIn(f"scripts/{name} [--out DIR]", done.stdout)


class Reference(unittest.TestCase):
    """reference.py, on a reference of bounce itself."""

    def test_what_is_not_known_is_not_told(self):
        from reference import cell

        self.assertEqual(cell({"value": 1.5, "error": 1e-9}), "1.5 ± 1e-09")
        for value, error in ((None, None), (1.5, None)):
            self.assertEqual(cell({"value": value, "error": error}), "-")

    def run_script(self, folder, *words):
        return subprocess.run([SCRIPTS / "reference.py", "--runs", folder, "--out", Path(folder) / "out", *words],
                              capture_output=True, text=True, check=False)

    def test_scenes_are_kept_and_told(self):
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([os.environ["BOUNCE_PROGRAM"], "reference", "example-1", "--t-end", "0.02", "--out",
                            f"{folder}/reference-a"], capture_output=True, check=True)
            done = self.run_script(folder, "--allow-dirty", "a")
            self.assertEqual(done.returncode, 0, done.stderr)
            text = (Path(folder) / "out" / "reference.md").read_text()
            self.assertRegex(text, r"\n\| a \| 9\.99\d* ± \d")
            self.assertTrue((Path(folder) / "out" / "reference" / "a" / "final.csv").is_file())
            done = self.run_script(folder, "--allow-dirty", "b")
            self.assertEqual((done.returncode, done.stdout), (2, ""))
            self.assertIn("reference-b/observables.json: cannot be read", done.stderr)
            path = Path(folder) / "reference-a" / "observables.json"
            found = json.loads(path.read_text())
            found["origin"]["commit"] = "abc-dirty"
            path.write_text(json.dumps(found))
            done = self.run_script(folder, "a")
            self.assertEqual((done.returncode, done.stdout), (2, ""))
            self.assertIn("commit abc-dirty: allowed is a clean commit", done.stderr)
            self.assertEqual((Path(folder) / "out" / "reference.md").read_text(), text)  # as it was


class Advice(unittest.TestCase):
    """advice.py with a program that says and takes what the test wants; its answer is 5 cm and `off`."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    PROGRAM = """#!/usr/bin/python3
import json, sys
from pathlib import Path
if "--version" in sys.argv:
    sys.exit(print("bounce 0"))
if "1e-9" in sys.argv:
    print("nothing reaches it; the smallest error that something is known to reach is 1e-07 cm", file=sys.stderr)
    sys.exit(2)
out = Path(sys.argv[sys.argv.index("--out") + 1])
out.mkdir(exist_ok=True)
(out / "scene.toml").write_text("")
(out / "monitor.csv").write_text("t,cy\\n0,9\\n1,HEIGHT\\n")
(out / "run.json").write_text(json.dumps({"wall_seconds": float("SECONDS"), "advice":
    "method leapfrog, contact located, time step 0.001 s\\n"
    "forecast: error of height 1e-05 cm (asked 1e-4; known to 1e-9), run 0.5 s on one thread"}))
"""

    def program(self, off, seconds):
        path = self.folder / "bounce"
        path.write_text(self.PROGRAM.replace("HEIGHT", str(5.0 + off)).replace("SECONDS", str(seconds)))
        path.chmod(0o755)
        return path

    def line(self, asked="1e-4", off=2e-4, seconds=0.6, bar=1e-8):
        """Exit code and the table's line."""
        place = self.folder / "results" / "accuracy" / "a"
        place.mkdir(parents=True, exist_ok=True)
        (place / "accuracy.csv").write_text(f"height,error_height\n5.0,{bar}\n")
        (place / "scene.toml").write_text("end = 15.0\nframes_every = 1.0\n")
        results = self.folder / "results"
        done = subprocess.run([SCRIPTS / "advice.py", "--bounce", self.program(off, seconds), "--results", results,
                               "--out", results, "--errors", asked, "a"], capture_output=True, text=True, check=False)
        self.assertEqual(done.stderr, "")
        lines = [line for line in (results / "advice.md").read_text().splitlines() if line.startswith("| a |")]
        return done.returncode, lines[0]

    def test_what_came_out_is_judged(self):
        code, line = self.line()
        self.assertEqual((code, line), (0, "| a | 1e-4 | leapfrog, located, 0.001 | 1e-05 | 2.0e-04 | 1.0e-08 | 0.5 | "
                                           "1.20 | as asked |"))
        for off in (4e-4, -4e-4, math.nan):
            code, line = self.line(off=off)
            self.assertEqual((code, line.split(" | ")[-1]), (1, "MISSED |"))

    def test_time_and_what_is_not_known_are_told(self):
        for seconds in (0.2, 1.1, math.nan):
            self.assertIn("| as asked, not in time |", self.line(seconds=seconds)[1])
        self.assertIn("| not known well enough to tell |", self.line(bar=1e-3)[1])

    def test_a_refusal_has_its_floor(self):
        code, line = self.line(asked="1e-9")
        self.assertEqual(code, 0)
        self.assertIn("| refused |", line)
        self.assertIn("nothing known to reach below 1e-07 cm", line)



if __name__ == "__main__":
    unittest.main()
