"""The ball of a scene as another program must be told of it: start, bonds, constants, walls.

bounce prints what a scene resolves to (bounce show) and the start (a frame of a run of one step). Bonds
and constants it does not print: they are derived here as kernels/model/bonds.cpp and
problem.cpp have them, and proved right by the energy that bounce finds in its own bonds at the start.
"""

import math
import subprocess
import tomllib
from dataclasses import dataclass

import numpy as np

from pictures.run import read_run
from studies.study import InputError

LISTING_REST_SQUARED = [0.06854, 1.0205, 0.09865, 1.028925, 0.1343]  # cm^2, the listing's constants/16000


class PeerError(InputError):
    """What cannot be compared; the message says why, and what would do."""


@dataclass(frozen=True)
class BondClass:
    """Force -attraction/R^p + repulsion/R^q between two particles R apart; cgs, unit masses."""

    p: float
    q: float
    attraction: float
    repulsion: float
    rest: float  # cm, where the force is zero

    def force(self, r):
        return self.repulsion / r**self.q - self.attraction / r**self.p

    def potential(self, r):
        return self.repulsion * integral(r, self.q) - self.attraction * integral(r, self.p)

    def slope(self, r):
        """dF/dR."""
        return self.attraction * self.p / r ** (self.p + 1) - self.repulsion * self.q / r ** (self.q + 1)

    def fourth_derivative(self, r):
        def of_power(e):
            return e * (e + 1) * (e + 2) * (e + 3) / r ** (e + 4)

        return self.repulsion * of_power(self.q) - self.attraction * of_power(self.p)


def integral(r, e):
    """The potential whose force is 1/R^e."""
    return -np.log(r) if e == 1.0 else r ** (1.0 - e) / (e - 1.0)


@dataclass(frozen=True)
class Ball:
    scene: dict  # as bounce show prints it
    x: np.ndarray  # cm
    y: np.ndarray
    vx: np.ndarray  # cm/s
    vy: np.ndarray
    bonds: np.ndarray  # rows: class, particle, particle, from 0
    classes: list
    gravity: tuple  # cm/s^2, as stored
    step: float  # s, as stored
    walls: list  # (unit normal, offset in cm)

    def lengths(self):
        """The length of each bond at the start, cm."""
        _, i, j = self.bonds.T
        return np.hypot(self.x[i] - self.x[j], self.y[i] - self.y[j])

    def radius(self):
        return max(self.scene["ball"]["radii"])

    def flight_steps(self):
        """Steps until a rigid ball would have crossed all but 5 % of the way to the nearest wall."""
        times = [self.time_to(np.array(normal), offset) for normal, offset in self.walls]
        longest = min(times, default=math.inf)
        return int(min(longest / self.step, 1e12))

    def time_to(self, normal, offset):
        distance = 0.95 * float(np.min(normal[0] * self.x + normal[1] * self.y - offset))
        speed = -float(np.min(normal[0] * self.vx + normal[1] * self.vy))  # towards the wall
        pull = -float(normal @ self.gravity)
        if not distance > 0.0:
            return 0.0
        if pull == 0.0:
            return distance / speed if speed > 0.0 else math.inf
        root = speed * speed + 2.0 * pull * distance
        if root < 0.0:
            return math.inf
        time = 2.0 * distance / (speed + math.sqrt(root)) if speed + math.sqrt(root) > 0.0 else math.inf
        return time


def ask(command):
    """What the command prints; PeerError with what it complains of if it fails."""
    try:
        done = subprocess.run([str(word) for word in command], capture_output=True, text=True, check=False)
    except OSError as error:
        raise PeerError(f"{command[0]}: {error.strerror}") from error
    if done.returncode != 0:
        raise PeerError(f"{done.stderr.strip() or done.stdout.strip()}\n  (exit code {done.returncode} of "
                        f"{' '.join(str(word) for word in command)})")
    return done.stdout


def run_bounce(bounce, scene, steps, folder, options, samples=1):
    """A run of so many steps, its state kept at start and end, its monitor `samples` times."""
    end = steps * scene_of(bounce, scene, options)["time"]["step"]
    ask([bounce, "run", scene, *options, "--steps", steps, "--out", folder, "--force", "--quiet",
         "--set", f"output.frames_every={end!r}", "--set", f"output.monitor_every={end / samples!r}"])
    return read_run(folder)


def scene_of(bounce, scene, options):
    """The scene's values; of the options those that change it (--set KEY=VALUE) count."""
    settings = [word for at, word in enumerate(options) if at and options[at - 1] == "--set"]
    changes = [word for setting in settings for word in ("--set", setting)]
    return tomllib.loads(ask([bounce, "show", scene, *changes]))


def read_ball(bounce, scene, settings, folder):
    """The ball of the scene, checked against bounce. PeerError if LAMMPS cannot be given it."""
    values = scene_of(bounce, scene, settings)
    run = run_bounce(bounce, scene, 1, folder, settings)
    start = run.frames[0]
    if start.time != 0.0:
        raise PeerError(f"{folder}: its first frame is of t = {start.time:g} s, not of the start")
    velocities = values["ball"]["velocity"]
    single = values["constants"] == "single"
    ball = Ball(
        values, start.x, start.y,
        *(np.full(len(start.x), four_decimals(v) if values["ball"]["rounding"] == "listing" else v)
          for v in velocities),
        ring_bonds(len(values["ball"]["radii"]), values["ball"]["per_ring"]),
        bond_classes(values), tuple(stored(single, g) for g in values["gravity"]["acceleration"]),
        stored(single, values["time"]["step"]),
        [unit_wall(wall) for wall in values.get("wall", [])])
    check_bonds(ball, run)
    return ball


def stored(single, value):
    return float(np.float32(value)) if single else value


def four_decimals(value):
    return float(f"{value:.4f}") + 0.0


def unit_wall(wall):
    length = math.hypot(*wall["normal"])
    return tuple(n / length for n in wall["normal"]), wall["offset"]


def bond_classes(scene):
    law, single = scene["law"], scene["constants"] == "single"
    gap = law["q"] - law["p"]
    classes = []
    for squared in rest_squared(scene):
        power = squared if gap == 2.0 else squared ** (0.5 * gap)
        attraction = stored(single, law["elasticity"])
        repulsion = stored(single, law["elasticity"] * power)
        rest = (repulsion / attraction) ** (1.0 / gap)
        classes.append(BondClass(law["p"], law["q"], attraction, repulsion, rest))
    return classes


def rest_squared(scene):
    """Squared distances at rest, cm^2, class by class: ring 1, rings 1 and 2, ring 2, ..."""
    if scene["law"]["rest"] == "listing":
        return LISTING_REST_SQUARED
    radii, half = scene["ball"]["radii"], math.pi / scene["ball"]["per_ring"]
    squares = []
    for inner, outer in zip(radii, [*radii[1:], None]):
        squares.append((2.0 * inner * math.sin(half)) ** 2)
        if outer is not None:
            squares.append((outer - inner) ** 2 + 4.0 * inner * outer * math.sin(half / 2.0) ** 2)
    return squares


def ring_bonds(rings, per_ring):
    """Each bond once: next on the ring, and the two nearest on the next ring out."""
    bonds = []
    for ring in range(rings):
        # A staggered ring's particle lies between its column and the next of the rings beside it.
        other = 1 if ring % 2 == 1 else -1
        for column in range(per_ring):
            here = ring * per_ring + column
            bonds.append((2 * ring, here, ring * per_ring + (column + 1) % per_ring))
            if ring + 1 < rings:
                for beside in (column, (column + other) % per_ring):
                    bonds.append((2 * ring + 1, here, (ring + 1) * per_ring + beside))
    return np.array(bonds)


def check_bonds(ball, run):
    """PeerError unless these bonds hold the energy at the start that bounce finds in its own."""
    if run.record["bonds"] != len(ball.bonds):
        raise PeerError(f"bounce has {run.record['bonds']} bonds, derived were {len(ball.bonds)}")
    lengths = ball.lengths()
    energies = np.concatenate([kind.potential(lengths[ball.bonds[:, 0] == number])
                               for number, kind in enumerate(ball.classes)])
    theirs = run.record["energies_at_start"]["bond"]
    # 840 terms, each with a few roundings of 1.1e-16, summed in another order. A wrong bond or class
    # changes the sum by 1e-4 of it and more.
    allowed = 1e-12 * float(np.abs(energies).sum())
    off = abs(float(energies.sum()) - theirs)
    if not off <= allowed:
        raise PeerError(f"the bonds derived here hold {energies.sum():.15g} erg at the start, bounce's "
                        f"{theirs:.15g}: they are not the same bonds")
