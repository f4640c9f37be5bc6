"""The comparison as text: results/peers.md from what results/peers.json holds."""

import textwrap
from statistics import median

from peers.timing import HARMONIC, TABLE


def table(record):
    """The whole of peers.md."""
    origin = record["origin"]
    changes = f" with {', '.join(origin['settings'])}" if origin["settings"] else ""
    made = (f"Made by `{origin['command']}` at commit {origin['commit']}, {origin['date']}, on {origin['cpu']} "
            f"({origin['cores']} cores); bounce: {origin['compiler']}, {origin['flags']}; LAMMPS "
            f"{origin['lammps']}.")
    return "\n".join([f"# bounce beside LAMMPS, {origin['scene']}{changes}", "",
                      *agreement_lines(record["agreement"]), "", *timing_lines(record["rows"]), "", made, ""])


def paragraph(text):
    return textwrap.fill(text, 105, break_on_hyphens=False)


def agreement_lines(agreed):
    yield paragraph(
        f"The same physics: {agreed['steps']} steps of free flight by velocity Verlet from the same "
        "start. The finer LAMMPS's tables of the force, the nearer its particles are to bounce's, down to "
        f"rounding; the difference falls as the entries' power {agreed['order']:.1f} (a cubic spline's is "
        f"4). Harmonic bonds, another law, end {agreed['harmonic_difference_cm']:.1e} cm off.")
    yield ""
    yield "| entries of a table | furthest apart, cm | allowed, cm |"
    yield "| --- | --- | --- |"
    for row in agreed["tables"]:
        yield f"| {row['entries']} | {row['difference_cm']:.1e} | {row['bound_cm']:.1e} |"


def timing_lines(rows):
    references = [row for row in (reference(rows, program, cores) for program in (TABLE, HARMONIC)
                                  for cores in (1, 2)) if row]
    heads = [f"× {'tabulated' if row['program'] == TABLE else 'harmonic'}, {cores(row['cores'])}"
             for row in references]
    yield paragraph(
        f"Medians of {len(rows[0]['steps_per_second'])} rounds in which every row runs once, in an order "
        "of its own; × is the ratio to the row of LAMMPS named, made within a round (least to most in "
        "brackets). Start-up does not count; all of it is free flight.")
    yield ""
    yield f"| program | cores | how | steps/s | {' | '.join(heads)} |"
    yield "| --- " * (4 + len(heads)) + "|"
    for row in rows:
        ratios = [ratio_text(row, other) for other in references]
        yield (f"| {row['program']} | {row['cores']} | {row['how']} | {median(row['steps_per_second']):,.0f} | "
               f"{' | '.join(ratios)} |")


def cores(number):
    return f"{number} core{'s' if number > 1 else ''}"


def reference(rows, program, number):
    """LAMMPS's row for this many cores, the faster one if there are several ways; None if there is none."""
    ways = [row for row in rows if row["program"] == program and row["cores"] == number]
    return max(ways, key=lambda row: median(row["steps_per_second"]), default=None)


def ratio_text(row, other):
    if row is other:
        return "1"
    ratios = sorted(mine / theirs for mine, theirs in zip(row["steps_per_second"], other["steps_per_second"]))
    return f"{median(ratios):.3g} ({ratios[0]:.3g} to {ratios[-1]:.3g})"
