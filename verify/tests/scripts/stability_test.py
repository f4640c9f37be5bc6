#!/usr/bin/python3
"""The script that draws the edge of stability, on a small sweep. BOUNCE_PROGRAM: path of bounce."""
import math
import os
import subprocess
import tempfile
import unittest
from pathlib import Path

from scripts_folder import STUDIES, has_numpy


@unittest.skipUnless(has_numpy(), "no numpy (apt-get install python3-numpy)")
class Stability(unittest.TestCase):
    def test_bad_input(self):
        with tempfile.TemporaryDirectory() as folder:
            done = subprocess.run([STUDIES / "stability.py", "--runs", folder, "--out", Path(folder) / "out"],
                                  capture_output=True, text=True, check=False)
            self.assertEqual((done.returncode, done.stdout), (2, ""))
            self.assertIn("example-1: no run there", done.stderr)
            self.assertEqual(list((Path(folder) / "out").iterdir()), [])
        done = subprocess.run([STUDIES / "stability.sh", "--no-such"], capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 2)

    def test_sweeps_are_read_and_drawn(self):
        from pictures import edge
        from studies import stability
        from studies.study import InputError

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
            with self.assertRaises(InputError):
                edge.read_sweep(Path(folder))


if __name__ == "__main__":
    unittest.main()
