#!/usr/bin/python3
"""The two contact rules as the step goes to 0: a table, CSV and picture from bounce accuracy's rows.

Reads RUNS/contact-SCENE and RUNS/contact-growth (scripts/contact.sh makes them); writes OUT/contact.md, contact.csv,
contact.png. From studies of one clean commit only, unless --allow-dirty.
"""

import csv
import json
import math
import os
import sys
import tempfile
from pathlib import Path

try:
    from pictures import accuracy, studies
    from pictures.drawing import plt
    from pictures.run import RunError
except ImportError as missing:
    sys.exit(f"contact.py: {missing}; install it with: apt-get install python3-matplotlib")

RESOLVED_STEP = 1e-4  # s; the paper's rule has PAPERS_STEP
PAPERS_STEP = 1e-6
LEAST_FACTOR = 10.0


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


def at_step(rows, step):
    """The row of exactly that step; None if there is none."""
    return next((row for row in rows if abs(row["dt"] / step - 1.0) < 1e-9), None)


def lines_of(scene, study):
    """A line an observable: value, limit of the paper's rule, the errors compared."""
    lines = study.lines()
    listing = lines.get(("listing", "listing", "double"), [])
    papers = study.papers()
    leapfrog = lines.get(("leapfrog", "resolved", "double"), [])
    resolved, same_step = at_step(leapfrog, RESOLVED_STEP), at_step(leapfrog, PAPERS_STEP)
    if not papers or not resolved:
        raise RunError(f"{scene}: no row of the paper's program, or none of leapfrog with resolved contact at exactly "
                       f"{RESOLVED_STEP:g} s (bounce accuracy --steps)")
    for name in studies.OBSERVABLES:
        limit, bar = extrapolated(listing, name)
        key, known = f"error_{name}", study.bar[f"error_{name}"]

        def times(row, key=key, known=known):
            error = known if row[key] < known else row[key]  # a NaN stays, and is nearer by no factor
            return math.inf if error == 0 else papers[key] / error

        yield {"scene": scene, "observable": name, "reference": study.bar[name], "known_to": known,
               "listing_limit": limit, "listing_limit_bar": bar, "smallest_dt": min(r["dt"] for r in listing),
               "listing_error_at_1e-6": papers[key], "resolved_error_at_1e-4": resolved[key],
               "nearer_times": times(resolved), "nearer_times_at_1e-6": times(same_step) if same_step else math.nan}


def claim_of(rows):
    """What issue 5 asks for, scene by scene: how many times nearer the height is, and which of the rest are."""
    text = ["| scene | height: nearer by a factor | of at least 10 | the other observables, least first "
            "| height, both at 1e-6 s |", "| --- " * 5 + "|"]
    for scene in dict.fromkeys(row["scene"] for row in rows):
        times = {row["observable"]: row["nearer_times"] for row in rows if row["scene"] == scene}
        height = times.pop("height")
        same_step = next(row["nearer_times_at_1e-6"] for row in rows
                         if row["scene"] == scene and row["observable"] == "height")
        others = ", ".join(f"{name} {value:.3g}" for name, value in sorted(times.items(), key=lambda item: item[1]))
        text.append(f"| {scene} | {height:.3g} | {'yes' if height >= LEAST_FACTOR else 'NO'} | {others} "
                    f"| {'-' if math.isnan(same_step) else format(same_step, '.3g')} |")
    return "\n".join(text) + "\n"


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
            "The resolved rule (leapfrog) at Δt = 1e-4 s against the paper's (listing's scheme) at Δt = 1e-6 s: how many "
            "times nearer it is to the reference, which is the limit Δt → 0. At 1e-4 s, a quarter of the stable step at "
            "E = 16000, leapfrog's own error counts as well as the contact's; so last the same with both at 1e-6 s.\n",
            claim_of(rows),
            "In full: the paper's rule extrapolated from its smallest steps, ± what leaving out the smallest changes; the "
            "two errors. Known to: what the two references differ by; nothing below counts.\n",
            "| scene | observable | reference | known to | paper's rule, Δt → 0 | smallest Δt | its error at 1e-6 "
            "| resolved, error at 1e-4 | nearer |", "| --- " * 9 + "|"]
    for r in rows:
        text.append(f"| {r['scene']} | {r['observable']} | {r['reference']:.9g} | {r['known_to']:.1e} "
                    f"| {r['listing_limit']:.9g} ± {r['listing_limit_bar']:.1e} | {r['smallest_dt']:.1e} "
                    f"| {r['listing_error_at_1e-6']:.1e} | {r['resolved_error_at_1e-4']:.1e} "
                    f"| {r['nearer_times']:.3g} |")
    text += [f"\n{growth}", "![errors of the height](results/contact.png)\n",
             f"Made by `scripts/contact.sh` at commit {some['commit']}, {some['date']}, on {some['cpu']}.", ""]
    return "\n".join(text)


def draw(found, path):
    figure, panels = plt.subplots(1, len(found), figsize=(3.2 * len(found), 3.2), squeeze=False,
                                  layout="constrained")
    for axes, (scene, study) in zip(panels[0], found.items()):
        for (method, contact, precision), rows in study.lines().items():
            rows = sorted((r for r in rows if math.isfinite(r["error_height"]) and r["error_height"] > 0),
                          key=lambda r: r["dt"])
            axes.loglog([r["dt"] for r in rows], [r["error_height"] for r in rows], linewidth=1.0,
                        label=accuracy.label_of(method, contact, precision), **accuracy.style_of(contact, precision))
        axes.set_title(scene, fontsize=9)
        axes.set_xlabel("time step, s")
    panels[0][0].set_ylabel("error of the centre's height, cm")
    panels[0][0].legend(frameon=False, fontsize=7)
    figure.savefig(path, dpi=150)
    plt.close(figure)


def make(arguments, folder):
    found = studies.read_studies(arguments, "contact")
    studies.one_commit(found)
    rows = [line for scene, study in found.items() for line in lines_of(scene, study)]
    (folder / "contact.md").write_text(markdown(rows, next(iter(found.values())).origin,
                                                growth_text(arguments.runs / "contact-growth")), encoding="utf-8")
    with open(folder / "contact.csv", "w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, rows[0], lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)
    draw(found, folder / "contact.png")


def main():
    arguments = studies.read_arguments(__doc__.splitlines()[0], "contact")
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
