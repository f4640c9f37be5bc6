#!/usr/bin/python3
"""The script that keeps the reference solutions. BOUNCE_PROGRAM: path of bounce."""
import json
import os
import subprocess
import tempfile
import unittest
from pathlib import Path

from scripts_folder import STUDIES


class Reference(unittest.TestCase):
    """reference.py, on a reference of bounce itself."""

    def test_what_is_not_known_is_not_told(self):
        from studies.reference import cell

        self.assertEqual(cell({"value": 1.5, "error": 1e-9}), "1.5 ± 1e-09")
        for value, error in ((None, None), (1.5, None)):
            self.assertEqual(cell({"value": value, "error": error}), "-")

    def run_script(self, folder, *words):
        return subprocess.run([STUDIES / "reference.py", "--runs", folder, "--out", Path(folder) / "out", *words],
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
            (Path(folder) / "out" / "reference.md").unlink()
            self.assertEqual(self.run_script(folder).returncode, 0)  # of what is kept
            self.assertEqual((Path(folder) / "out" / "reference.md").read_text(), text)


if __name__ == "__main__":
    unittest.main()
