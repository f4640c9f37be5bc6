"""The same ball in LAMMPS: its files, its runs.

LAMMPS is given its best chance:
  - no pair interactions at all (pair_style none), so it builds no neighbour list; what is left of it,
    the look whether to deal the particles to the ranks anew, is asked for every 1000 steps only
    (neigh_modify), and in a fall from rest never leads to it;
  - no sorting of the particles in memory (atom_modify sort 0): 360 of them lie in the first cache;
  - each bond once (newton on); ghosts no wider than the longest bond needs (comm_modify cutoff);
  - two ranks cut the box, and with it the ball, in half (processors * 1 1), and are bound to their cores;
  - no output within a run (thermo 0, no dump, no energies asked for) and no clock read within a step
    (timer loop);
  - neither `fix enforce2d` nor periodic sides: nothing moves or pulls along z;
  - its own "Loop time" is taken: start, set-up and reading of the table do not count.
Debian's LAMMPS is built without its package OPENMP; where it is there, two of its threads are timed, too,
and bounce is measured by the faster of the two ways.
"""

import math
import os
import re
import shutil
import subprocess
from dataclasses import dataclass

import numpy as np

from peers.flying_ball import PeerError

# What the tables span, in distances at rest: room for a ball that bends at a wall.
SHORTEST, LONGEST = 0.75, 1.5
SKIN = 0.1  # cm, far more than a particle moves in 1000 steps of a paper's scene
INSTALL = "apt-get install lammps openmpi-bin"


class LammpsFailed(Exception):
    """LAMMPS stopped, or did not run what it was asked to."""


@dataclass(frozen=True)
class Bonds:
    """How LAMMPS is to compute the bonds: from a table of so many entries, or 0 as harmonic springs."""

    entries: int


@dataclass(frozen=True)
class Lammps:
    program: str
    version: str
    mpirun: list  # of two ranks; empty if there is no mpirun
    has_openmp: bool

    def launch(self, way):
        """The command that starts it: way is serial, mpi or omp (both on two cores)."""
        if way == "mpi":
            return [*self.mpirun, self.program]
        if way == "omp":
            return [self.program, "-sf", "omp", "-pk", "omp", "2"]
        return [self.program]

    def ways_to_two_cores(self):
        return (["mpi"] if self.mpirun else []) + (["omp"] if self.has_openmp else [])


def find_lammps(program):
    """LAMMPS as it is installed. PeerError with what to install if it is not."""
    found = shutil.which(program)
    if not found:
        raise PeerError(f"LAMMPS ({program}) is not here; on Debian: {INSTALL}")
    help_text = subprocess.run([found, "-h"], capture_output=True, text=True, check=False).stdout
    version = re.search(r"Massively Parallel Simulator - (.+)", help_text)
    packages = re.search(r"Installed packages:\s+(.*?)\n\n\S", help_text, re.S)
    if not version or not packages:
        raise PeerError(f"{found} -h does not read like LAMMPS's; on Debian: {INSTALL}")
    if "MOLECULE" not in packages[1].split():
        raise PeerError(f"{found} was built without its package MOLECULE (bonds); on Debian: {INSTALL}")
    mpirun = shutil.which("mpirun")
    ranks = [mpirun, "-np", "2", "--bind-to", "core"] if mpirun else []
    if mpirun and os.geteuid() == 0:
        ranks.append("--allow-run-as-root")
    return Lammps(found, version[1].strip(), ranks, "OPENMP" in packages[1].split())


def write_data(ball, path):
    """The data file: particles, velocities, bonds."""
    # Centred on the ball, so that half of it lies on either rank; room on all sides to fly.
    room = 4.0 * ball.radius()
    lines = ["the ball of bounce, cgs", "", f"{len(ball.x)} atoms", f"{len(ball.bonds)} bonds", "1 atom types",
             f"{len(ball.classes)} bond types"]
    for axis, at in (("x", ball.scene["ball"]["centre"][0]), ("y", ball.scene["ball"]["centre"][1])):
        lines.append(f"{at - room!r} {at + room!r} {axis}lo {axis}hi")
    lines += ["-0.5 0.5 zlo zhi", "", "Masses", "", "1 1.0", "", "Atoms # bond", ""]
    lines += [f"{i} 1 1 {x!r} {y!r} 0.0" for i, (x, y) in enumerate(zip(ball.x.tolist(), ball.y.tolist()), 1)]
    lines += ["", "Velocities", ""]
    lines += [f"{i} {x!r} {y!r} 0.0" for i, (x, y) in enumerate(zip(ball.vx.tolist(), ball.vy.tolist()), 1)]
    lines += ["", "Bonds", ""]
    lines += [f"{b} {kind + 1} {i + 1} {j + 1}" for b, (kind, i, j) in enumerate(ball.bonds.tolist(), 1)]
    path.write_text("\n".join(lines) + "\n")


def spacing(kind, entries):
    """Between the entries of a class's table, cm."""
    return (LONGEST - SHORTEST) * kind.rest / (entries - 1)


def distances(kind, entries):
    """Those of LAMMPS's own table of as many entries, so that it interpolates once, not twice. The
    distance at rest stands midway between two entries, where a spline is furthest off, however many
    there are: else finer tables would be better or worse by where it happens to stand."""
    h = spacing(kind, entries)
    below = round((1.0 - SHORTEST) * kind.rest / h) + 0.5
    return np.linspace(kind.rest - below * h, kind.rest + (entries - 1 - below) * h, entries)


def write_table(ball, entries, path):
    """One table a class."""
    with open(path, "w", encoding="ascii") as file:
        for number, kind in enumerate(ball.classes, 1):
            r = distances(kind, entries)
            ends = kind.slope(r[[0, -1]]).tolist()
            file.write(f"CLASS_{number}\nN {entries} FP {ends[0]!r} {ends[1]!r} EQ {kind.rest!r}\n\n")
            columns = zip(r.tolist(), kind.potential(r).tolist(), kind.force(r).tolist())
            file.writelines(f"{i} {at!r} {v!r} {f!r}\n" for i, (at, v, f) in enumerate(columns, 1))
            file.write("\n")


def bond_lines(ball, bonds):
    if bonds.entries:
        yield f"bond_style table spline {bonds.entries}"
        for number in range(1, len(ball.classes) + 1):
            yield f"bond_coeff {number} bonds.table CLASS_{number}"
        return
    yield "bond_style harmonic"
    for number, kind in enumerate(ball.classes, 1):
        # LAMMPS's K (R - R0)^2 has no half in it.
        yield f"bond_coeff {number} {-0.5 * kind.slope(kind.rest)!r} {kind.rest!r}"


def wall_line(walls):
    sides = []
    for (nx, ny), offset in walls:
        axis = {(1.0, 0.0): "xlo", (0.0, 1.0): "ylo", (-1.0, 0.0): "xhi", (0.0, -1.0): "yhi"}.get((nx, ny))
        if axis is None:
            raise PeerError(f"a wall with normal ({nx:g}, {ny:g}): fix wall/reflect takes walls along the axes; "
                            "choose a scene without an incline")
        sides.append(f"{axis} {offset if axis.endswith('lo') else -offset!r}")
    return [f"fix walls all wall/reflect {' '.join(sides)} units box"] if sides else []


def write_input(ball, bonds, steps, state, path):
    """The input script; the last state goes to the file `state` unless it is None."""
    cutoff = 1.1 * float(ball.lengths().max()) + SKIN
    g = math.hypot(*ball.gravity)
    way = f"{ball.gravity[0] / g!r} {ball.gravity[1] / g!r} 0.0" if g else ""
    gravity = [f"fix gravity all gravity {g!r} vector {way}"] if g else []
    lines = ["units lj", "dimension 2", "boundary f f p", "newton on", "atom_style bond", "atom_modify sort 0 0.0",
             f"neighbor {SKIN} bin", "neigh_modify every 1000 delay 1000 check yes",
             f"comm_modify cutoff {cutoff!r}", "processors * 1 1", "read_data ball.data",
             "pair_style none", "special_bonds lj 0.0 0.0 0.0", *bond_lines(ball, bonds),
             "fix move all nve", *gravity, *wall_line(ball.walls), f"timestep {ball.step!r}",
             "thermo_style custom step", "thermo_modify lost error", "thermo 0", "timer loop", f"run {steps}"]
    if state:
        lines.append(f"write_dump all custom {state} id x y vx vy modify sort id format float %.17g")
    path.write_text("\n".join(lines) + "\n")


def run_lammps(lammps, ball, bonds, steps, folder, way="serial", state=None):
    """Runs so many steps in this folder; the seconds of its loop."""
    folder.mkdir(parents=True, exist_ok=True)
    write_input(ball, bonds, steps, state, folder / "in.ball")
    if not (folder / "ball.data").exists():
        write_data(ball, folder / "ball.data")
        if bonds.entries:
            write_table(ball, bonds.entries, folder / "bonds.table")
    command = [*lammps.launch(way), "-in", "in.ball", "-log", "none"]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    loop = re.search(r"Loop time of (\S+) on (\d+) procs for (\d+) steps with (\d+) atoms", done.stdout)
    if done.returncode != 0 or not loop:
        complaints = [line for line in (done.stdout + done.stderr).splitlines() if "ERROR" in line]
        raise LammpsFailed(f"LAMMPS failed in {folder}: {'; '.join(complaints) or done.stdout[-400:]}")
    if int(loop[3]) != steps or int(loop[4]) != len(ball.x):
        raise LammpsFailed(f"LAMMPS in {folder} ran {loop[3]} steps with {loop[4]} particles; asked for were "
                        f"{steps} and {len(ball.x)}")
    return float(loop[1])


def read_state(path, particles):
    """x, y of write_dump's file, in order of the particles' numbers."""
    lines = path.read_text().splitlines()
    head = lines.index("ITEM: ATOMS id x y vx vy")
    table = np.array([line.split() for line in lines[head + 1:]], dtype=float)
    if table.shape != (particles, 5) or not (table[:, 0] == np.arange(1, particles + 1)).all():
        raise LammpsFailed(f"{path}: holds not the particles 1 to {particles}")
    return table[:, 1], table[:, 2]
