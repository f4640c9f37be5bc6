#!/usr/bin/python3
"""The comparison with LAMMPS. BOUNCE_PROGRAM: path of bounce."""
import math
import os
import subprocess
import tempfile
import unittest
from pathlib import Path

from scripts_folder import SCRIPTS, has_numpy


@unittest.skipUnless(has_numpy(), "no numpy (apt-get install python3-numpy)")
class Peers(unittest.TestCase):
    BOUNCE = os.environ.get("BOUNCE_PROGRAM")

    def test_without_lammps(self):
        done = subprocess.run([SCRIPTS / "peers" / "compare.py", "--lammps", "no-such-lammps"],
                              capture_output=True, text=True, check=False)
        self.assertEqual((done.returncode, done.stdout), (2, ""))
        self.assertIn("apt-get install lammps", done.stderr)

    def test_the_page_is_made_again(self):
        results = SCRIPTS.parent / "results"
        with tempfile.TemporaryDirectory() as folder:
            words = [SCRIPTS / "peers" / "compare.py", "--page", "--out", folder]
            done = subprocess.run(words, capture_output=True, text=True, check=False)
            self.assertEqual((done.returncode, done.stdout), (2, ""))
            self.assertIn("peers.json: cannot be read", done.stderr)
            (Path(folder) / "peers.json").write_text((results / "peers.json").read_text())
            self.assertEqual(subprocess.run(words, capture_output=True, check=False).returncode, 0)
            self.assertEqual((Path(folder) / "peers.md").read_text(), (results / "peers.md").read_text())

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


if __name__ == "__main__":
    unittest.main()
