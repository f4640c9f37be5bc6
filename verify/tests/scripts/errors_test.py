#!/usr/bin/python3
"""The scripts that draw and judge rows of bounce accuracy, on made-up ones: accuracy.py and contact.py."""
import json
import math
import tempfile
import unittest
from pathlib import Path
from unittest import mock

from scripts_folder import STUDIES, has_numpy, run_here


@unittest.skipUnless(has_numpy(), "no numpy (apt-get install python3-numpy)")
class Contact(unittest.TestCase):
    """contact.py and accuracy.py, on made-up rows of bounce accuracy."""

    NAMES = ("height", "speed", "rebound", "contact_time", "energy_lost", "flattening")
    HEAD = ["method", "contact", "dt", "tolerance", "steps", "evaluations", "kernel", "seconds",
            "error_position", *(f"error_{name}" for name in NAMES), "error_energy", "error_energy_free", *NAMES, "note"]

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        # Pictures take most of the time; two tests have real ones.
        self.no_picture = mock.patch("pictures.drawing.save", self.save)
        self.no_picture.start()
        self.addCleanup(mock.patch.stopall)

    @staticmethod
    def save(figure, path, dpi=None):
        from pictures.drawing import plt

        plt.close(figure)
        path.write_bytes(b"a picture")

    def row(self, method, contact, step, error, seconds=1.0, note=""):
        return [method, contact, str(step), "", "1", "1", "ring", str(seconds), "1e-9", *[str(error)] * 6, "1e-9",
                "1e-9", *[str(5.0 + error)] * 6, note]

    def study(self, name, rows, commit="abc", head=HEAD, best=None):
        place = self.folder / "runs" / name
        place.mkdir(parents=True)
        reference = self.row("reference", "", "", 1e-12)
        if "precision" in head:
            reference.insert(2, "")
        (place / "accuracy.csv").write_text("".join(",".join(line) + "\n" for line in [head, reference, *rows]))
        (place / "scene.toml").write_text("")
        best = {"method": "leapfrog", "contact": "listing", "dt": 1e-4, "seconds": 1.0} | (best or {})
        (place / "origin.json").write_text(json.dumps({"commit": commit, "date": "today", "cpu": "some",
                                                       "oracle_seconds": 100.0, "best": best}))

    def read(self, name):
        from studies import errors

        return errors.read_study(self.folder / "runs" / name)

    def rows(self, resolved_step=1e-4):
        """The paper's rule is off by 1000 dt, the resolved by dt^2 x 1000."""
        return [*(self.row("listing", "listing", step, 1e3 * step) for step in (1e-4, 1e-5, 1e-6, 1e-7)),
                self.row("leapfrog", "resolved", resolved_step, 1e-5),
                self.row("leapfrog", "listing", 1e-4, 1e-3),
                self.row("gsl-bsimp", "located", "nan", math.inf, note='"too long, said ""it"""')]

    def old_rows(self):
        """As programs wrote them that had other precisions."""
        single = [*self.row("leapfrog", "listing", 1e-3, 1e-4, seconds=0.1), "single"]
        compensated = [*self.row("leapfrog", "resolved", 1e-4, 1e-9, seconds=0.1), "compensated"]
        rows = [*([*row, "double"] for row in self.rows()), single, compensated]
        return [[*row[:2], row[-1], *row[2:-1]] for row in rows], [*self.HEAD[:2], "precision", *self.HEAD[2:]]

    def located(self, *more, scenes="a", commit="abc", resolved_step=1e-4):
        """The other study that contact.py reads."""
        rows = [self.row("leapfrog", "resolved", resolved_step, 7.0),  # of the step in contact-a, which counts
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
        return run_here(STUDIES / name, "--runs", self.folder / "runs", "--out", self.folder / "out", *words)

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
        self.assertRegex(text, r"\| a \| leapfrog, resolved \| 100 \| speed 100, .* \| - \| 0.0001 \|\n")
        self.assertIn("| a | height | 5 | 1.0e-12 | 5 ± ", text)  # the limit of the paper's rule
        self.assertTrue((self.folder / "out" / "contact.png").is_file())

    def test_the_methods_have_a_line_each(self):
        text = self.contacts(self.rows(), self.row("blanes-moan-6", "resolved", 1e-6, 1e-5),
                             self.row("blanes-moan-6", "resolved", 1e-7, 2e-4))
        # The smallest step is not nearer by 10, so there is none from which on all are.
        self.assertRegex(text, r"\| a \| blanes-moan-6, resolved \| 1e\+03 \| .* \| 100 \| - \|\n")
        self.assertRegex(text, r"\| a \| blanes-moan-6, located \| 1e\+04 \| ")

    def test_the_growth_of_a_difference_tells_the_error_allowed(self):
        text = self.contacts(self.rows())
        # A tenth of the paper's 1e-3 over the growth from 1e-8 to 1e-3.
        self.assertIn("| a | 7 | 1.0e-09 | 1.0e-08 | 1.0e-03 | 1.0e+05 | 2.0 | 1.0e-09 |", text)
        self.assertIn("| example-3 | 7 | 1.0e-09 | 1.0e-08 | 1.0e+00 | 1.0e+08 | 2.0 | - |", text)

    def test_a_factor_that_is_too_small_is_told(self):
        rows = [*self.rows(), self.row("leapfrog", "resolved", 1e-6, 1e-7)]
        rows[4] = self.row("leapfrog", "resolved", 1e-4, 2e-4)
        self.assertRegex(self.contacts(rows), r"\| a \| leapfrog, resolved \| 5 \| .* \| 1e\+04 \| 1e-06 \|\n")

    def test_no_number_is_no_factor(self):
        rows = self.rows()
        rows[4] = self.row("leapfrog", "resolved", 1e-4, math.nan)
        self.assertRegex(self.contacts(rows), r"\| a \| leapfrog, resolved \| nan \| .* \| - \| - \|\n")

    def test_what_is_not_there_is_named(self):
        self.study("contact-a", self.rows(resolved_step=1.01e-4))
        self.study("contact-b", self.rows(), commit="abc-dirty")
        self.located(scenes="ab", resolved_step=1.01e-4)
        self.growth()
        for scene, text in (("a", "at exactly 0.0001 s"), ("b", "a clean commit"), ("c", "cannot be read")):
            done = self.run_script("contact.py", scene)
            self.assertEqual((done.returncode, done.stdout), (2, ""))
            self.assertIn(text, done.stderr)
            self.assertEqual(list((self.folder / "out").iterdir()), [])

    def test_the_page_is_made_again_of_what_was_kept(self):
        self.no_picture.stop()
        text = self.contacts(self.rows())
        kept = self.folder / "out" / "reference"
        for scene in ("a", "example-3"):
            (kept / scene).mkdir(parents=True)
            (self.folder / "runs" / f"growth-{scene}" / "observables.json").rename(kept / scene / "observables.json")
        picture = (self.folder / "out" / "contact.png").read_bytes()
        self.assertEqual(self.run_script("contact.py").returncode, 0)
        self.assertEqual((self.folder / "out" / "contact.md").read_text(), text)
        self.assertEqual((self.folder / "out" / "contact.png").read_bytes(), picture)

    def test_rows_of_other_precisions_are_left_out(self):
        rows, head = self.old_rows()
        self.study("accuracy-old", rows, head=head)
        self.study("accuracy-new", self.rows())
        old, new = self.read("accuracy-old"), self.read("accuracy-new")
        self.assertEqual((old.left_out, new.left_out), (2, 0))
        self.assertEqual([row["dt"] for row in old.rows[:-1]], [row["dt"] for row in new.rows[:-1]])
        self.assertNotIn(0.1, [row["seconds"] for row in old.rows])
        done = self.run_script("accuracy.py", "new")
        self.assertEqual(done.returncode, 0, done.stderr)
        page = self.folder / "out" / "accuracy.md"
        self.assertIn("| leapfrog, listing, 0.0001 |", page.read_text())
        self.assertNotIn("no longer has", page.read_text())
        self.assertEqual(self.run_script("accuracy.py", "old").returncode, 0)
        self.assertIn("their 2 rows are left out", page.read_text())

    def test_a_setting_that_is_no_more_is_not_told(self):
        rows, head = self.old_rows()
        self.study("accuracy-a", rows, head=head, best={"precision": "single", "dt": 1e-3})
        self.assertEqual(self.run_script("accuracy.py", "a").returncode, 0)
        self.assertIn("| a | - | - | - | - | - | ", (self.folder / "out" / "accuracy.md").read_text())

    def test_the_frontier_holds_only_what_is_cheapest(self):
        rows = [self.row("pefrl", "resolved", 1e-3, 1e-3, seconds=1.0),
                self.row("pefrl", "located", 5e-4, 1e-2, seconds=2.0),
                self.row("pefrl", "resolved", 2e-4, 1e-13, seconds=4.0),  # better than the reference is known
                self.row("pefrl", "located", 1e-4, 1e-14, seconds=8.0), self.row("leapfrog", "located", 1e-4, 1e-9),
                self.row("pefrl", "resolved", 1e-5, math.nan, seconds=0.1)]
        self.study("accuracy-a", rows)
        self.assertEqual(self.read("accuracy-a").frontier(("pefrl",), "height"), [(1.0, 1e-3), (4.0, 1e-12)])

    def test_the_picture_names_its_lines(self):
        from pictures import accuracy

        blown = self.row("pefrl", "resolved", 1e-3, 1e6)  # off by far more than the paper's program
        self.study("accuracy-a", [*self.rows(), blown])
        panels = accuracy.figure_of(self.read("accuracy-a"), "a").axes
        names = {text.get_text() for text in panels[1].texts}
        self.assertEqual(names, {"listing", "leapfrog"})

    def test_a_picture_for_readme(self):
        self.no_picture.stop()
        self.study("accuracy-example-2", self.rows())
        self.assertEqual(self.run_script("accuracy.py", "example-2").returncode, 0)
        headline = self.folder / "out" / "accuracy" / "headline.png"
        self.assertLess(headline.stat().st_size, 200_000)
        self.assertIn("](accuracy/headline.png)", (self.folder / "out" / "accuracy.md").read_text())

    def test_all_is_drawn_again_of_what_was_kept(self):
        self.assertEqual(self.run_script("accuracy.py").returncode, 2)  # nothing is
        self.study("accuracy-a", self.rows())
        self.assertEqual(self.run_script("accuracy.py", "a").returncode, 0)
        place = self.folder / "out" / "accuracy"
        (place / "a.png").unlink()
        (place / "a.svg").write_text("of an earlier commit")
        (place / "a" / "table.txt").write_text("the same")
        page = (self.folder / "out" / "accuracy.md").read_text()
        self.assertEqual(self.run_script("accuracy.py").returncode, 0)
        found = sorted(path.relative_to(place).as_posix() for path in place.rglob("*") if path.is_file())
        self.assertEqual(found, ["a.png", "a/accuracy.csv", "a/origin.json", "a/scene.toml"])
        self.assertEqual((self.folder / "out" / "accuracy.md").read_text(), page)

    def test_a_scene_comes_to_those_that_are_there(self):
        self.study("accuracy-b", self.rows(), commit="first")
        self.assertEqual(self.run_script("accuracy.py", "b").returncode, 0)
        self.study("accuracy-a", self.rows(), commit="second")
        self.assertEqual(self.run_script("accuracy.py", "a").returncode, 0)
        lines = [line for line in (self.folder / "out" / "accuracy.md").read_text().splitlines()
                 if line.startswith(("| a |", "| b |"))]
        self.assertEqual([line.split(" | ")[-1] for line in lines], ["second |", "first |"])
        for name in ("a/accuracy.csv", "b/accuracy.csv", "a.png", "b.png"):
            self.assertTrue((self.folder / "out" / "accuracy" / name).is_file(), name)

    def test_a_torn_row_is_named(self):
        self.study("accuracy-a", [*self.rows(), ["leapfrog", "resolved"]])
        done = self.run_script("accuracy.py", "a")
        self.assertEqual((done.returncode, done.stdout), (2, ""))
        self.assertIn("a row without dt", done.stderr)

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


if __name__ == "__main__":
    unittest.main()
