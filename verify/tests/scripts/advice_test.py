#!/usr/bin/python3
"""The script that checks bounce advise, with a program that says and takes what the test wants."""
import json
import math
import subprocess
import tempfile
import unittest
from pathlib import Path

from scripts_folder import STUDIES


class Advice(unittest.TestCase):
    """advice.py with a program that says and takes what the test wants; its answer is 5 cm and `off`."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    PROGRAM = """#!/usr/bin/python3
import json, sys
from pathlib import Path
if "1e-9" in sys.argv:
    print("nothing reaches it; the smallest error that something is known to reach is 1e-07 cm", file=sys.stderr)
    sys.exit(2)
out = Path(sys.argv[sys.argv.index("--out") + 1])
out.mkdir(exist_ok=True)
(out / "scene.toml").write_text("")
(out / "monitor.csv").write_text("t,cy\\n0,9\\n1,HEIGHT\\n")
(out / "run.json").write_text(json.dumps({"origin": {"commit": "c0ffee", "cpu": "a cpu", "compiler": "c",
    "flags": "-O3"}, "wall_seconds": float("SECONDS"), "advice":
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
        done = subprocess.run([STUDIES / "advice.py", "--bounce", self.program(off, seconds), "--results", results,
                               "--out", results, "--errors", asked, "a"], capture_output=True, text=True, check=False)
        self.assertEqual(done.stderr, "")
        self.assertIn("at commit c0ffee, ", (results / "advice.md").read_text())
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
