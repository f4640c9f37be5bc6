"""Is it the same physics? Positions of LAMMPS and bounce after the same steps of free flight.

Both step by velocity Verlet (bounce's method leapfrog) from the same bits. What may part them:

 1. The table. A cubic spline through exact values of the force, with exact slopes at its ends, is off by at
    most e = 5/384 h^4 max|F''''| between entries h apart (Hall and Meyer, J. Approx. Theory 16 (1976) 105).
    A force off by e puts the bond's distance at rest off by e/|F'(R0)|, a part d = e/(|F'(R0)| R0) of it.
    A ball whose distances at rest are all off by d is off by d times its radius where it comes to rest,
    and, let go, swings to twice that; twice again because the classes are not off alike: 4 d radius. d falls
    with the fourth power of the entries.
 2. Rounding. Ten times what two kernels of bounce (csr and ring, which sum in other orders) part by
    on the same flight; `bounce verify` allows as much.

Each table must be within 1 + 2, and from the coarsest to the third the differences must fall as
the entries' third power at least (the fourth is expected). The harmonic springs, another law, must not pass.
"""

import math

import numpy as np

from peers.flying_ball import PeerError, run_bounce
from peers.lammps import Bonds, read_state, run_lammps, spacing

COARSE = (250, 500, 1000)  # entries; far enough from rounding to show the order


class Disagreement(Exception):
    """LAMMPS and bounce do not compute the same flight."""


def compare_flights(bounce, lammps, ball, arguments, folder):
    """The record of the comparison for results/peers.json. Disagreement if it fails."""
    steps = arguments.check_steps
    if ball.flight_steps() < 1:
        raise PeerError(f"{arguments.scene}: starts at a wall; choose a scene that starts with a free flight")
    if not 1 <= steps <= ball.flight_steps():
        raise PeerError(f"--check-steps {steps}: allowed is 1 to {ball.flight_steps()}, the steps of "
                        f"{arguments.scene} before it can reach a wall")
    ring, csr = (fly(bounce, arguments, kernel, steps, folder) for kernel in ("ring", "csr"))
    rounding = 10.0 * apart(csr, ring)
    rows = []
    for entries in (*COARSE, arguments.entries):
        difference = apart(fly_lammps(lammps, ball, Bonds(entries), steps, folder), ring)
        rows.append({"entries": entries, "difference_cm": difference,
                     "bound_cm": table_bound(ball, entries) + rounding})
    harmonic = apart(fly_lammps(lammps, ball, Bonds(0), steps, folder), ring)
    record = {"steps": steps, "rounding_cm": rounding, "tables": rows, "harmonic_difference_cm": harmonic,
              "order": order(rows)}
    check(record)
    return record


def fly(bounce, arguments, kernel, steps, folder):
    """Positions by this kernel of bounce, never near a wall."""
    words = [*arguments.settings, "--set", "time.method=leapfrog", "--kernel", kernel, "--threads", "1"]
    run = run_bounce(bounce, arguments.scene, steps, folder / f"bounce-{kernel}", words, samples=100)
    if not (run.monitor["on_wall"] == 0).all():
        raise PeerError(f"{arguments.scene} meets a wall within {steps} steps; give fewer --check-steps")
    return run.frames[-1].x, run.frames[-1].y


def fly_lammps(lammps, ball, bonds, steps, folder):
    here = folder / f"lammps-{bonds.entries or 'harmonic'}"
    run_lammps(lammps, ball, bonds, steps, here, state="last.txt")
    return read_state(here / "last.txt", len(ball.x))


def apart(a, b):
    """The largest distance between two states' particles, cm; NaN if one is NaN."""
    return float(np.max(np.hypot(a[0] - b[0], a[1] - b[1])))


def table_bound(ball, entries):
    """4 d radius of the head, cm."""
    worst = 0.0
    for number, kind in enumerate(ball.classes):
        lengths = ball.lengths()[ball.bonds[:, 0] == number] / kind.rest
        # In flight the bonds ring about their rest by what they were off at the start; the cells
        # beside theirs count, too, as a spline's do.
        reach = np.linspace(min(lengths.min(), 0.95), max(lengths.max(), 1.05), 1001) * kind.rest
        error = 5.0 / 384.0 * spacing(kind, entries) ** 4 * float(np.abs(kind.fourth_derivative(reach)).max())
        worst = max(worst, error / (abs(kind.slope(kind.rest)) * kind.rest))
    return 4.0 * worst * ball.radius()


def order(rows):
    """The power of the entries with which the difference falls over the coarse tables."""
    first, last = rows[0], rows[len(COARSE) - 1]
    if not (first["difference_cm"] > 0.0 and last["difference_cm"] > 0.0):
        return math.nan
    return math.log(first["difference_cm"] / last["difference_cm"]) / math.log(last["entries"] / first["entries"])


def check(record):
    troubles = [f"with {row['entries']} entries they are {row['difference_cm']:.2g} cm apart; allowed is "
                f"{row['bound_cm']:.2g}" for row in record["tables"]
                if not row["difference_cm"] <= row["bound_cm"]]
    if not record["order"] >= 3.0:
        troubles.append(f"the difference falls as the entries' power {record['order']:.2g}; allowed is 3 or more")
    if not record["harmonic_difference_cm"] > 10.0 * record["tables"][-1]["bound_cm"]:
        troubles.append(f"harmonic springs are only {record['harmonic_difference_cm']:.2g} cm off: the check "
                        "cannot tell one law from another; give more --check-steps")
    if troubles:
        raise Disagreement(f"LAMMPS and bounce differ after {record['steps']} steps:\n  " + "\n  ".join(troubles))
