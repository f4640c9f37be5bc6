#!/usr/bin/python3
"""The contact rules as the step goes to 0: a table, CSV and picture from bounce accuracy's rows.

Reads of each SCENE RUNS/contact-SCENE, located-SCENE and growth-SCENE, and RUNS/growth-example-3 (scripts/contact.sh
makes them); writes OUT/contact.md, contact.csv, contact.png. From studies of one clean commit only, unless --allow-dirty.
"""

import csv
import json
import math
import sys

try:
    from pictures import accuracy, studies
    from pictures.drawing import plt
    from pictures.run import RunError
except ImportError as missing:
    sys.exit(f"contact.py: {missing}; install it with: apt-get install python3-matplotlib")

NEW_STEP = 1e-4  # s; the paper's rule has PAPERS_STEP
PAPERS_STEP = 1e-6
LEAST_FACTOR = 10.0
# What is compared with the paper's: the simplest method, and one whose own error at NEW_STEP is far below the contact's.
SETTINGS = (("leapfrog", "resolved"), ("leapfrog", "located"), ("blanes-moan-6", "resolved"),
            ("blanes-moan-6", "located"))
COLLAPSING = "example-3"


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


def nearer_from(rows, times):
    """The largest step from which on all smaller ones are nearer by LEAST_FACTOR, too; NaN if the smallest is not."""
    largest = math.nan
    for row in sorted(rows, key=lambda row: row["dt"]):
        if not times(row) >= LEAST_FACTOR:
            break
        largest = row["dt"]
    return largest


def lines_of(scene, study):
    """A line an observable: value, limit of the paper's rule, the errors compared."""
    lines = study.lines()
    listing = lines.get(("listing", "listing", "double"), [])
    papers = study.papers()
    compared = {", ".join(setting): lines.get((*setting, "double"), []) for setting in SETTINGS}
    for setting, rows in compared.items():
        if not papers or not at_step(rows, NEW_STEP):
            raise RunError(f"{scene}: no row of the paper's program, or none of {setting} at exactly {NEW_STEP:g} s "
                           "(bounce accuracy --steps)")
    for name in studies.OBSERVABLES:
        limit, bar = extrapolated(listing, name)
        key, known = f"error_{name}", study.bar[f"error_{name}"]

        def times(row, key=key, known=known):
            error = known if row[key] < known else row[key]  # a NaN stays, and is nearer by no factor
            return math.inf if error == 0 else papers[key] / error

        line = {"scene": scene, "observable": name, "reference": study.bar[name], "known_to": known,
                "listing_limit": limit, "listing_limit_bar": bar, "smallest_dt": min(r["dt"] for r in listing),
                "listing_error_at_1e-6": papers[key]}
        for setting, rows in compared.items():
            coarse, same_step = at_step(rows, NEW_STEP), at_step(rows, PAPERS_STEP)
            line |= {f"{setting}: error at 1e-4": coarse[key], f"{setting}: nearer": times(coarse),
                     f"{setting}: nearer at 1e-6": times(same_step) if same_step else math.nan,
                     f"{setting}: 10 times nearer from": nearer_from(rows, times)}
        yield line


def told(value):
    return "-" if math.isnan(value) else format(value, ".3g")


def claim_of(rows):
    """What issue 5 asks for, scene by scene: how many times nearer the height is, and which of the rest are."""
    text = ["| scene | method, contact | height, at 1e-4 s: nearer by a factor | of at least 10 | the other observables, "
            "least first | height, both at 1e-6 s | height nearer by 10 from this step down, s |", "| --- " * 7 + "|"]
    for scene in dict.fromkeys(row["scene"] for row in rows):
        of_scene = {row["observable"]: row for row in rows if row["scene"] == scene}
        height = of_scene["height"]
        for setting in map(", ".join, SETTINGS):
            times = {name: row[f"{setting}: nearer"] for name, row in of_scene.items() if name != "height"}
            others = ", ".join(f"{name} {value:.3g}" for name, value in sorted(times.items(), key=lambda item: item[1]))
            factor = height[f"{setting}: nearer"]
            text.append(f"| {scene} | {setting} | {factor:.3g} | {'yes' if factor >= LEAST_FACTOR else 'NO'} | {others} "
                        f"| {told(height[f'{setting}: nearer at 1e-6'])} "
                        f"| {told(height[f'{setting}: 10 times nearer from'])} |")
    return "\n".join(text) + "\n"


def read_growth(runs, scene, commit):
    """The disturbed third run of bounce reference, and the number of contacts. RunError if it is of another commit."""
    path = runs / f"growth-{scene}" / "observables.json"
    try:
        record = json.loads(path.read_text())
        growth = {name: float(record["growth"][name]) for name in ("start", "at_contact", "end", "rate")}
        growth["contacts"] = int(record["fixed"]["contacts"])
        found = record["origin"]["commit"]
    except (OSError, KeyError, TypeError, ValueError) as error:
        raise RunError(f"{path}: holds no growth of a disturbance: {error}") from error
    if found != commit:
        raise RunError(f"{path}: commit {found}: allowed is that of the studies, {commit}")
    return growth


def growth_text(growths, rows):
    """How a small difference grows: no rule with an error above that decides an end."""
    text = ["How a difference grows, by two solutions whose contacts are located to rounding and whose starts differ a "
            "little: what a first contact is off by is that much larger at the end. Last, the error of a place that "
            "all contacts together may have, so that no particle ends further off than a tenth of the error of the "
            "paper's rule in the height.\n",
            "| scene | contacts | apart at the start, cm | at the first contact | at the end | times | e-folds a second "
            "| error allowed, cm |", "| --- " * 8 + "|"]
    for scene, g in growths.items():
        times = g["end"] / g["at_contact"] if g["at_contact"] > 0 else math.nan
        papers = [row["listing_error_at_1e-6"] for row in rows
                  if row["scene"] == scene and row["observable"] == "height"]
        allowed = f"{papers[0] / LEAST_FACTOR / times:.1e}" if papers else "-"
        text.append(f"| {scene} | {g['contacts']} | {g['start']:.1e} | {g['at_contact']:.1e} | {g['end']:.1e} "
                    f"| {times:.1e} | {g['rate']:.1f} | {allowed} |")
    text.append("\nExample 3 collapses: its two solutions part, and no step and no rule converges to a particle's "
                "place.\n")
    return "\n".join(text)


def markdown(rows, some, growths):
    text = ["# The contact rules as the step goes to 0\n",
            "Resolved and located contact at Δt = 1e-4 s against the paper's (listing's scheme) at Δt = 1e-6 s: how many "
            "times nearer they are to the reference, which is the limit Δt → 0. At 1e-4 s, a quarter of the stable step "
            "at E = 16000, leapfrog's own error counts as well as the contact's, that of blanes-moan-6 does not; last "
            "the same with both at 1e-6 s, and the step from which on all that were run are nearer by a factor 10. For "
            "alpha = 1, beta = -1 (example-6) the resolved rule is the paper's, and what differs is the method.\n",
            claim_of(rows), growth_text(growths, rows),
            "In full: the paper's rule extrapolated from its smallest steps, ± what leaving out the smallest changes; the "
            "errors. Known to: what the two references differ by; nothing below counts.\n",
            "| scene | observable | reference | known to | paper's rule, Δt → 0 | smallest Δt | its error at 1e-6 "
            + "".join(f"| {', '.join(setting)}: error at 1e-4 | nearer " for setting in SETTINGS) + "|",
            "| --- " * (7 + 2 * len(SETTINGS)) + "|"]
    for r in rows:
        text.append(f"| {r['scene']} | {r['observable']} | {r['reference']:.9g} | {r['known_to']:.1e} "
                    f"| {r['listing_limit']:.9g} ± {r['listing_limit_bar']:.1e} | {r['smallest_dt']:.1e} "
                    f"| {r['listing_error_at_1e-6']:.1e} "
                    + "".join(f"| {r[f'{setting}: error at 1e-4']:.1e} | {r[f'{setting}: nearer']:.3g} "
                              for setting in map(", ".join, SETTINGS)) + "|")
    text += ["\n![errors of the height](results/contact.png)\n",
             f"Made by `scripts/contact.sh` at commit {some['commit']}, {some['date']}, on {some['cpu']}.", ""]
    return "\n".join(text)


def draw(found, path):
    # The last row is the legend's.
    figure, panels = plt.subplots(2, len(found), figsize=(3.2 * len(found), 3.8), squeeze=False, layout="constrained",
                                  gridspec_kw={"height_ratios": [3.2, 0.6]})
    for axes, (scene, study) in zip(panels[0], found.items()):
        for (method, contact, precision), rows in study.lines().items():
            # What is off by more than the ball's size was unstable.
            rows = sorted((r for r in rows if 0 < r["error_height"] < 10.0), key=lambda r: r["dt"])
            axes.loglog([r["dt"] for r in rows], [r["error_height"] for r in rows], linewidth=1.0,
                        label=accuracy.label_of(method, contact, precision), **accuracy.style_of(contact, precision))
        axes.set_title(scene, fontsize=9)
        axes.set_xlabel("time step, s")
    panels[0][0].set_ylabel("error of the centre's height, cm")
    for axes in panels[1]:
        axes.axis("off")
    legend = panels[1][0].legend(*panels[0][0].get_legend_handles_labels(), loc="upper left", ncols=4, frameon=False,
                                 fontsize=8)
    legend.set_in_layout(False)  # it is wider than its panel
    figure.savefig(path, dpi=150)
    plt.close(figure)


def make(arguments, folder):
    found = studies.read_studies(arguments, "contact")
    others = studies.read_studies(arguments, "located")
    studies.one_commit([*found.values(), *others.values()])
    for scene, study in found.items():
        known = {(row["method"], row["contact"], row["dt"]) for row in study.rows}
        study.rows += [row for row in others[scene].rows
                       if (row["method"], row["contact"], row["dt"]) not in known]
    rows = [line for scene, study in found.items() for line in lines_of(scene, study)]
    origin = next(iter(found.values())).origin
    growths = {scene: read_growth(arguments.runs, scene, origin["commit"]) for scene in (*found, COLLAPSING)}
    (folder / "contact.md").write_text(markdown(rows, origin, growths), encoding="utf-8")
    with open(folder / "contact.csv", "w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, rows[0], lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)
    draw(found, folder / "contact.png")


def main():
    arguments = studies.read_arguments(__doc__.splitlines()[0], "contact")
    studies.publish(arguments.out, ("contact.csv", "contact.png", "contact.md"),
                    lambda folder: make(arguments, folder))
    print(f"contact.py: {arguments.out}/contact.md")


if __name__ == "__main__":
    try:
        main()
    except RunError as error:
        print(f"contact.py: {error}", file=sys.stderr)
        sys.exit(2)
