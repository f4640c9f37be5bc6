#!/usr/bin/python3
"""Draws the edge of stability and makes its tables, from what scripts/studies/stability.sh has put into runs/.

Writes OUT/stability.md and OUT/stability/: the sweeps' edge.csv, the pictures, origin.json. From runs of one clean
commit only, unless --allow-dirty.
"""

import json
import math
import shutil
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from pictures import drawing, edge
from pictures.run import read_run
from studies import study
from studies.study import InputError, table

SWEEPS = ("example-1", "example-2")
THROWS = ("0.767", "3", "10")  # cm/s


def examples_table(examples):
    """How far below its edge each example ran."""
    rows = []
    for number, run in sorted(examples.items()):
        stability, scene = run.record["stability"], run.scene
        worst = stability["greatest_part"]
        rows.append([f"{number}", f"{scene['law']['elasticity']:g}",
                     f"{stability['stable_step']:.3g}", f"{1 / stability['part']:.0f}",
                     f"{1 / worst['part']:.0f}", f"{worst['time']:.2f}", f"{worst['ratio']:.3f}"])
    return table(["Example", "E", "stable step at the start, s", "Δt = 1e-6 s is below it by a factor of",
                  "at the worst state of the run", "at t, s", "R/R0 of its stiffest bond"], rows)


def number(row, key="stable"):
    """A measured edge as text; one that was not found says so."""
    return f"{row[key]:.4g}" if row["outcome"] == "found" else row["outcome"]


def span(values, form=".3f"):
    low, high = format(min(values), form), format(max(values), form)
    return low if low == high else f"{low} to {high}"


def flight_table(sweeps):
    rows = []
    for scene, sweep in sweeps.items():
        for method in edge.methods(sweep):
            flights = sweep.where(method=method, passage="flight", sought="dt")
            # As the criterion passes over it, or is the same.
            strict = edge.longer_flights(sweep, method) or flights
            cells = {row["passage"]: number(row) for row in sweep.where(method=method, sought="E")}
            rows.append([scene, method, f"{len(flights)}",
                         f"{min(row['E'] for row in flights):g} to {max(row['E'] for row in flights):g}",
                         f"{edge.product_of(sweep, method, 'strict'):.4g}",
                         f"{span([row['stable'] / row['strict'] for row in strict])} ({strict[0]['periods']:g} periods)",
                         f"{edge.product_of(sweep, method):.4g}",
                         span([row["measured_over_predicted"] for row in flights]),
                         span([row["stable"] * math.sqrt(row["E"]) for row in flights], ".4g"),
                         cells.get("flight", "-"), cells.get("bounce", "-")])
    return table(["scene", "method", "cases", "E", "strict limit: Δt √E", "measured / strict limit",
                  "by the criterion: Δt √E", "measured / by the criterion", "measured: Δt √E",
                  "largest E at Δt = 1e-6 s, flight", "through a bounce"], rows)


def bounce_table(sweeps):
    """Bounces at the scene's E over speed and gravity; from the margin by the first method."""
    rows = []
    for scene, sweep in sweeps.items():
        names = edge.methods(sweep)
        own = [row for row in sweep.where(passage="bounce", growth=10 * sweep.rows[0]["growth"])]
        elasticity = own[0]["E"]
        for row in sweep.where(method=names[0], passage="bounce", sought="dt", E=elasticity):
            measured = []
            for name in names:
                same, *_ = sweep.where(method=name, passage="bounce", sought="dt", E=elasticity, g=row["g"],
                                       speed=row["speed"])
                measured.append(f"{same['stable'] / same['flight']:.3f}" if same["outcome"] == "found"
                                else same["outcome"])
            rows.append([scene, f"{row['E']:g}", f"{row['speed']:.3g}", f"{row['g']:g}",
                         f"{row['smallest_ratio']:.3f}", "yes" if row["left_wall"] else "stays down",
                         f"{row['predicted'] / row['flight']:.3f}" if row["predicted"] > 0 else "-", *measured])
    return table(["scene", "E", "impact, cm/s", "g", "R/R0 of the stiffest bond", "bounces",
                  "from the running margin", *(f"measured: {name}" for name in names)], rows)


def disturbed_table(sweep):
    rest = sweep.where(method=edge.methods(sweep)[0], passage="flight", sought="dt")[0]
    rows = {}
    for row in sweep.rows:
        if row["disturbed"] != rest["disturbed"]:
            at_rest = [r for r in sweep.where(method=row["method"], passage="flight", sought="dt")
                       if r["E"] == row["E"]][0]
            part = row["stable"] / at_rest["predicted"]
            rows.setdefault(row["disturbed"], {})[row["method"]] = f"{part:.3f}"
    names = edge.methods(sweep)
    return table(["disturbed by, shortest bonds", *names],
                 [[f"{size:g}", *(cells.get(name, "-") for name in names)] for size, cells in rows.items()])


def moves_with_criterion(sweep):
    """(row, by how much its edge is off that by the usual criterion) of all with another criterion."""
    usual = {key: sweep.rows[0][key] for key in ("growth", "periods", "disturbed")}
    for row in sweep.rows:
        factors = {row[key] / usual[key] for key in ("growth", "periods")}
        if row["disturbed"] != usual["disturbed"] or factors not in ({0.1, 1.0}, {1.0, 10.0}):
            continue
        same = [r for r in sweep.where(method=row["method"], passage=row["passage"], sought="dt")
                if (r["E"], r["g"], r["speed"]) == (row["E"], row["g"], row["speed"])]
        yield row, row["stable"] / same[0]["stable"] - 1.0


def criterion_text(sweeps):
    """By how much the edge moves with the criterion: the largest move, and where that is too much."""
    moves = [(scene, row, move) for scene, sweep in sweeps.items() for row, move in moves_with_criterion(sweep)]
    far = [(scene, row, move) for scene, row, move in moves if not abs(move) < 0.02]  # a NaN, too
    near = [abs(move) for _, _, move in moves if abs(move) < 0.02]
    text = (f"With a criterion ten times stricter or looser (growth, and in flight periods; {len(moves)} cases at "
            f"the scenes' E) the edge moves by {max(near, default=math.nan):.1%} at most")
    if not far:
        return text + ".\n"
    rows = [[scene, row["method"], row["passage"], f"{row['growth']:g}", f"{row['periods']:g}", f"{move:+.1%}",
             f"{row['measured_over_predicted']:.3f}"] for scene, row, move in far]
    return (text + f", but in {len(far)}:\n\n" +
            table(["scene", "method", "passage", "growth", "periods", "edge moves by",
                   "measured / predicted for that criterion"], rows))


def time_text(sweeps, origins):
    """What the map took: rows' seconds are shares of the time that went by."""
    rows = [row for sweep in sweeps.values() for row in sweep.rows]
    seconds = sum(row["seconds"] for row in rows)
    cores = {origin["cores"] for origin in origins.values()}
    return (f"The map: {len(rows)} edges, those of {len(sweeps)} scenes, "
            f"{len(edge.methods(next(iter(sweeps.values()))))} methods, "
            f"{len({row['E'] for row in next(iter(sweeps.values())).where(passage='flight', sought='dt')})} values of E, "
            f"and the rest; measured in {seconds / 60:.1f} minutes on {'/'.join(map(str, sorted(cores)))} cores.\n")


def markdown(examples, sweeps, origins):
    first = next(iter(sweeps.values()))
    some = next(iter(origins.values()))
    listing = first.where(passage="flight", sought="E")[0]
    return "\n".join([
        "# The edge of stability\n",
        f"**Δt = {listing['dt']:g} s really fails above E = {number(listing)}** ({listing['method']}, free "
        "flight). The examples ran far below their edges:\n",
        examples_table(examples),
        "| | |\n| --- | --- |\n| ![](stability/edge.png) | ![](stability/margin.png) |\n",
        f"Free flight over E, predicted and measured. Strict limit: the first vibration grows, however slowly. By "
        f"the criterion: the energy grows by more than {listing['growth']:g} within {listing['periods']:g} periods "
        "of the fastest vibration.\n",
        flight_table(sweeps),
        f"Through a bounce: its edge as a part of free flight's (by the criterion); from the running margin of "
        f"{edge.methods(first)[0]} at a quarter of the stable step or less, and measured:\n",
        bounce_table(sweeps),
        "In free flight, with vibrations that are not small: the lowest edge, as a part of that of a ball at "
        "rest (by the criterion).\n",
        disturbed_table(first),
        criterion_text(sweeps),
        time_text(sweeps, origins),
        f"Made by `scripts/studies/stability.sh` at commit {some['commit']}, {some['date']}, on {some['cpu']}; all "
        "rows: `results/stability/*/edge.csv`.",
        "",
    ])


def check_origins(runs, examples, throws, origins):
    """InputError unless all was made from one clean commit."""
    commits = {run.path: run.record["origin"]["commit"] for run in (examples | throws).values()}
    commits |= {runs / f"sweep-{scene}": origin["commit"] for scene, origin in origins.items()}
    for made_by, commit in commits.items():
        study.check_clean(made_by, commit)
    study.check_clean("scripts/", study.scripts_commit())
    study.one_commit(commits.values())


def make(arguments, folder):
    """Everything into the folder."""
    runs = arguments.runs
    examples = {n: read_run(runs / f"example-{n}") for n in range(1, 8)}
    throws = {f"impact at {speed} cm/s": read_run(runs / f"throw-{speed}") for speed in THROWS}
    sweeps = {scene: edge.read_sweep(runs / f"sweep-{scene}") for scene in SWEEPS}
    origins = {scene: json.loads((runs / f"sweep-{scene}" / "origin.json").read_text()) for scene in SWEEPS}
    if not arguments.allow_dirty:
        check_origins(runs, examples, throws, origins)
    place = folder / "stability"
    for scene in SWEEPS:
        (place / scene).mkdir(parents=True)
        for name in ("edge.csv", "origin.json", "scene.toml"):
            shutil.copy(runs / f"sweep-{scene}" / name, place / scene / name)
    places = {n: (run.scene["law"]["elasticity"], run.scene["time"]["step"]) for n, run in examples.items()}
    drawing.save(edge.plane(sweeps["example-2"], places), place / "edge.png")
    drawing.save(edge.margin(throws), place / "margin.png")
    record = {"command": "scripts/studies/stability.sh", "commit": origins[SWEEPS[0]]["commit"],
              "drawn_by_commit": study.scripts_commit(), "date": study.now(), "sweeps": origins,
              "runs": {run.path.name: {"command": run.record["command"],
                                       "state_hash": run.record["state_hash"],
                                       "commit": run.record["origin"]["commit"]}
                       for run in (examples | throws).values()}}
    study.write_whole(place / "origin.json", json.dumps(record, indent=2, ensure_ascii=False) + "\n")
    study.write_whole(folder / "stability.md", markdown(examples, sweeps, origins))


def main():
    parser = study.parser_of(__doc__.splitlines()[0], "example-N, sweep-example-N and throw-SPEED")
    arguments = parser.parse_args()
    study.publish(arguments.out, lambda folder: make(arguments, folder))
    print(f"stability.py: {arguments.out}/stability.md and {arguments.out}/stability")


if __name__ == "__main__":
    study.run(main)
