#!/usr/bin/python3
"""The two contact rules as the step goes to 0: a table, CSV and picture from bounce accuracy's rows.

Reads RUNS/contact-SCENE and RUNS/contact-growth (scripts/contact.sh makes them); writes OUT/contact.md, contact.csv,
contact.png. From studies of one clean commit only, unless --allow-dirty.
"""

import argparse
import csv
import json
import math
import os
import sys
import tempfile
from pathlib import Path

try:
    from pictures import accuracy
    from pictures.drawing import plt
    from pictures.run import RunError
except ImportError as missing:
    sys.exit(f"contact.py: {missing}; install it with: apt-get install python3-matplotlib")

OBSERVABLES = ("height", "speed", "rebound", "contact_time", "energy_lost", "flattening")


def read_arguments():
    root = Path(__file__).resolve().parent.parent
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    add = parser.add_argument
    add("--runs", type=Path, default=root / "runs", metavar="DIR", help="holds contact-SCENE [runs]")
    add("--out", type=Path, default=root / "results", metavar="DIR", help="[results]")
    add("--allow-dirty", action="store_true", help="take studies of changed trees, too")
    add("scenes", nargs="+", metavar="SCENE")
    return parser.parse_args()


def extrapolated(rows, name):
    """The value at step 0 through the two smallest steps, as a first order term has it, and an error bar: how far
    that moves when the next two are taken instead. NaN without three rows."""
    fine = sorted((row for row in rows if math.isfinite(row[name])), key=lambda row: row["dt"])[:3]
    if len(fine) < 3:
        return math.nan, math.nan

    def limit(a, b):
        return a[name] - (b[name] - a[name]) / (b["dt"] - a["dt"]) * a["dt"]

    value = limit(fine[0], fine[1])
    return value, abs(value - limit(fine[1], fine[2]))


def nearest(rows, step):
    """The row nearest a step, by ratio, among those that stayed finite."""
    finite = [row for row in rows if math.isfinite(row["error_height"])]
    return min(finite, key=lambda row: abs(math.log(row["dt"] / step)), default=None)


def lines_of(scene, study):
    """A line an observable: value, both limits, errors at the steps compared."""
    lines = study.lines()
    listing, resolved = lines.get(("listing", "listing"), []), lines.get(("leapfrog", "resolved"), [])
    papers, coarse = study.papers(), nearest(resolved, 1e-4)
    if not papers or not coarse:
        raise RunError(f"{scene}: no row of the paper's program, or none of leapfrog with resolved contact")
    for name in OBSERVABLES:
        limit, bar = extrapolated(listing, name)
        key, known = f"error_{name}", study.bar[f"error_{name}"]
        error = max(coarse[key], known)
        yield {"scene": scene, "observable": name, "reference": study.bar[name], "known_to": known,
               "listing_limit": limit, "listing_limit_bar": bar, "smallest_dt": min(r["dt"] for r in listing),
               "listing_error_at_1e-6": papers[key], "resolved_dt": coarse["dt"], "resolved_error": coarse[key],
               "nearer_times": papers[key] / error if error > 0 else math.inf}


def growth_text(folder):
    """What bounce reference says of Example 3, of which no rule of contact could decide the end."""
    path = folder / "observables.json"
    try:
        growth = json.loads(path.read_text())["growth"]
        return (f"Example 3 collapses: a start disturbed by {growth['start']:.1e} cm is {growth['at_contact']:.1e} cm "
                f"off at the first contact and {growth['end']:.1e} cm at the end, {growth['rate']:.1f} e-folds a second. No step "
                "and no rule converges there to a particle's place.\n")
    except (OSError, KeyError, TypeError, ValueError) as error:
        raise RunError(f"{path}: holds no growth of a disturbance: {error}") from error


def markdown(rows, some, growth):
    text = ["# The contact rules as the step goes to 0\n",
            "The paper's rule (listing's scheme) extrapolated from its smallest steps, ± what leaving out the smallest "
            "changes; its error at Δt = 1e-6 s, and that of the resolved rule (leapfrog) with a step about 1e-4 s. Known "
            "to: what the two references differ by; nothing below counts. Nearer: how many times.\n",
            "| scene | observable | reference | known to | paper's rule, Δt → 0 | smallest Δt | its error at 1e-6 "
            "| resolved, Δt | its error | nearer |", "| --- " * 10 + "|"]
    for r in rows:
        text.append(f"| {r['scene']} | {r['observable']} | {r['reference']:.9g} | {r['known_to']:.1e} "
                    f"| {r['listing_limit']:.9g} ± {r['listing_limit_bar']:.1e} | {r['smallest_dt']:.1e} "
                    f"| {r['listing_error_at_1e-6']:.1e} | {r['resolved_dt']:.1e} | {r['resolved_error']:.1e} "
                    f"| {r['nearer_times']:.3g} |")
    text += [f"\n{growth}", "![errors of the height](results/contact.png)\n",
             f"Made by `scripts/contact.sh` at commit {some['commit']}, {some['date']}, on {some['cpu']}.", ""]
    return "\n".join(text)


def draw(studies, path):
    figure, panels = plt.subplots(1, len(studies), figsize=(3.2 * len(studies), 3.2), squeeze=False,
                                  layout="constrained")
    for axes, (scene, study) in zip(panels[0], studies.items()):
        for (method, contact), rows in study.lines().items():
            rows = sorted((r for r in rows if math.isfinite(r["error_height"]) and r["error_height"] > 0),
                          key=lambda r: r["dt"])
            axes.loglog([r["dt"] for r in rows], [r["error_height"] for r in rows], linewidth=1.0,
                        label=f"{method}, {contact}", **accuracy.STYLES[contact])
        axes.set_title(scene, fontsize=9)
        axes.set_xlabel("time step, s")
    panels[0][0].set_ylabel("error of the centre's height, cm")
    panels[0][0].legend(frameon=False, fontsize=7)
    figure.savefig(path, dpi=150)
    plt.close(figure)


def make(arguments, folder):
    studies = {scene: accuracy.read_study(arguments.runs / f"contact-{scene}") for scene in arguments.scenes}
    commits = {study.origin["commit"] for study in studies.values()}
    commit = next(iter(commits))
    if not arguments.allow_dirty and (len(commits) > 1 or "dirty" in commit or commit == "unknown"):
        raise RunError(f"{arguments.runs}: commits {', '.join(sorted(commits))}: allowed is one clean commit for all")
    rows = [line for scene, study in studies.items() for line in lines_of(scene, study)]
    (folder / "contact.md").write_text(markdown(rows, next(iter(studies.values())).origin,
                                                growth_text(arguments.runs / "contact-growth")), encoding="utf-8")
    with open(folder / "contact.csv", "w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, rows[0], lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)
    draw(studies, folder / "contact.png")


def main():
    arguments = read_arguments()
    arguments.out.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(prefix=".partial-", dir=arguments.out) as partial:
        make(arguments, Path(partial))
        for name in ("contact.csv", "contact.png", "contact.md"):
            os.replace(Path(partial) / name, arguments.out / name)
    print(f"contact.py: {arguments.out}/contact.md")


if __name__ == "__main__":
    try:
        main()
    except RunError as error:
        print(f"contact.py: {error}", file=sys.stderr)
        sys.exit(2)
