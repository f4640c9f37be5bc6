#!/usr/bin/python3
"""The index of results/: that it is up to date, and that it notices what it must."""
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

from scripts_folder import SCRIPTS, STUDIES

RESULTS = SCRIPTS.parent / "results"


def index(*words):
    done = subprocess.run([STUDIES / "index.py", *words], capture_output=True, text=True, check=False)
    return done.returncode, done.stderr


class Index(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.results = Path(folder.name) / "results"

    def test_results_are_all_in_it(self):
        self.assertEqual(index("--check"), (0, ""))

    def test_what_is_wrong_is_named(self):
        changes = (
            (lambda at: (at / "new.md").write_text("# New\n"), "new.md: in no row"),
            (lambda at: (at / "accuracy" / "other.png").write_bytes(b""), "other.png: has no sentence"),
            (lambda at: (at / "peers.json").unlink(), "peers.json: is not there"),
            (lambda at: shutil.rmtree(at / "stability"), "stability/: is not there"),
            (lambda at: (at / "contact.png").write_bytes(bytes(200_001)), "contact.png: 200001 bytes; allowed is"),
            (lambda at: (at / "reference" / "much.csv").write_bytes(bytes(4_000_000)), "allowed is at most 4000000"),
            (lambda at: (at / "advice.md").write_text("Made at commit 0123456789ab.\n"), "README.md: is not what"),
            (lambda at: (at / "README.md").unlink(), "README.md: is not what"),
        )
        for change, complaint in changes:
            shutil.rmtree(self.results, ignore_errors=True)
            shutil.copytree(RESULTS, self.results)
            change(self.results)
            code, complaints = index("--check", "--results", self.results)
            self.assertEqual(code, 1, complaint)
            self.assertIn(complaint, complaints)

    def test_commits_come_from_the_pages(self):
        shutil.copytree(RESULTS, self.results)
        (self.results / "advice.md").write_text("0.000159051566 is no commit\n\nMade at commit 0123456789ab.\n")
        self.assertEqual(index("--results", self.results), (0, ""))
        line = [line for line in (self.results / "README.md").read_text().splitlines() if "](advice.md)" in line][0]
        self.assertTrue(line.endswith("| 0123456789ab |"), line)

    def test_pages_name_what_is_there(self):
        """Pictures and scripts that the pages name."""
        import re

        for page in RESULTS.glob("*.md"):
            text = page.read_text()
            for picture in re.findall(r"\]\(([^)]+)\)", text):
                self.assertTrue((RESULTS / picture).exists(), f"{page.name}: {picture}")
            for script in re.findall(r"`(scripts/[\w./]+)", text):
                self.assertTrue((SCRIPTS.parent / script).exists(), f"{page.name}: {script}")


if __name__ == "__main__":
    unittest.main()
