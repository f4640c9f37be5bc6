#!/usr/bin/python3
"""scripts/draw.py, on runs as bounce makes them. BOUNCE_PROGRAM: path of bounce."""
import os
import subprocess
import tempfile
import unittest
from pathlib import Path

from scripts_folder import SCRIPTS, has_numpy, run_here


@unittest.skipUnless(has_numpy(), "no numpy (apt-get install python3-numpy)")
class Draw(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def run_scene(self, *words):
        subprocess.run([os.environ["BOUNCE_PROGRAM"], "run", *words, "--quiet", "--out", self.folder / "run"],
                       check=True)

    def draw(self, *words):
        return run_here(SCRIPTS / "draw.py", *words)

    def picture_of(self, *words):
        self.run_scene(*words)
        done = self.draw(self.folder / "run")
        self.assertEqual(done.returncode, 0, done.stderr)
        picture = self.folder / "run" / "picture.png"
        self.assertEqual(done.stdout, f"{picture}\n")
        self.assertEqual(picture.read_bytes()[:4], b"\x89PNG")

    def test_two_walls_and_many_frames(self):
        self.picture_of("example-7", "--steps", "2000", "--set", "output.frames_every=1e-4",
                        "--set", "output.monitor_every=1e-4")

    def small_disc(self):
        scene = self.folder / "disc.toml"
        scene.write_text('[ball]\nkind = "disc"\nradii = [2.0]\nspacing = 0.5\nrounding = "none"\n[law]\nrest = "geometry"\n'
                         '[time]\nend = 0.001\n[output]\nmonitor_every = 0.001\n')
        return scene

    def test_a_disc_without_walls(self):
        self.picture_of(self.small_disc(), "--set", "output.frames_every=0.001")

    def test_frames_at_most(self):
        import sys

        sys.path.insert(0, str(SCRIPTS))
        import draw

        self.assertEqual(draw.some_of(list(range(3))), [0, 1, 2])
        some = draw.some_of(list(range(1000)))
        self.assertEqual((len(some), some[0], some[-1]), (draw.MOST_BALLS, 0, 999))

    def test_a_run_that_kept_no_balls(self):
        self.run_scene(self.small_disc())
        done = self.draw(self.folder / "run")
        self.assertEqual(done.returncode, 2)
        self.assertIn("frames_every", done.stderr)

    def test_bad_input(self):
        done = self.draw(self.folder / "nothing")
        self.assertEqual((done.returncode, done.stdout), (2, ""))
        self.assertIn("no run there", done.stderr)
        self.assertEqual(self.draw().returncode, 2)
        self.assertEqual(self.draw("--fast").returncode, 2)


if __name__ == "__main__":
    unittest.main()
