#!/usr/bin/python3
"""The contact rules as the step goes to 0: a table, CSV and picture from bounce accuracy's rows.

  scripts/studies/contact.py SCENE...    reads of each RUNS/contact-SCENE, located-SCENE and growth-SCENE, and
                                         RUNS/growth-example-3 (scripts/studies/contact.sh makes them)
  scripts/studies/contact.py             the page once more, from OUT/contact.csv, contact.md and OUT/reference

Writes OUT/contact.md, contact.csv, contact.png. From studies of one clean commit only, unless --allow-dirty.
"""

import csv
import json
import math
import re
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from pictures import accuracy, drawing
from pictures.drawing import plt
from studies import errors, study
from studies.study import InputError

NEW_STEP = 1e-4  # s; the paper's rule has PAPERS_STEP
PAPERS_STEP = 1e-6
FACTOR = 10.0
# What is compared with the paper's: the simplest method, and one whose own error at NEW_STEP is far below the
# contact's.
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
    """The largest step from which on all smaller ones are nearer by FACTOR, too; NaN if the smallest is not."""
    largest = math.nan
    for row in sorted(rows, key=lambda row: row["dt"]):
        if not times(row) >= FACTOR:
            break
        largest = row["dt"]
    return largest


def lines_of(scene, found):
    """A line an observable: value, limit of the paper's rule, the errors compared."""
    lines = found.lines()
    listing = lines.get(("listing", "listing"), [])
    papers = found.papers()
    compared = {", ".join(setting): lines.get(setting, []) for setting in SETTINGS}
    for setting, rows in compared.items():
        if not papers or not at_step(rows, NEW_STEP):
            raise InputError(f"{scene}: no row of the paper's program, or none of {setting} at exactly {NEW_STEP:g} s "
                           "(bounce accuracy --steps)")
    for name in errors.OBSERVABLES:
        limit, bar = extrapolated(listing, name)
        key, known = f"error_{name}", found.bar[f"error_{name}"]

        def times(row, key=key, known=known):
            error = known if row[key] < known else row[key]  # a NaN stays, and is nearer by no factor
            return math.inf if error == 0 else papers[key] / error

        line = {"scene": scene, "observable": name, "reference": found.bar[name], "known_to": known,
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


def nearer_text(rows):
    """Scene by scene: how many times nearer the height is, and which of the rest are."""
    head = ["scene", "method, contact", "height, at 1e-4 s: nearer by a factor", "the other observables, least first",
            "height, both at 1e-6 s", "height nearer by 10 from this step down, s"]
    lines = []
    for scene in dict.fromkeys(row["scene"] for row in rows):
        of_scene = {row["observable"]: row for row in rows if row["scene"] == scene}
        height = of_scene["height"]
        for setting in map(", ".join, SETTINGS):
            times = {name: row[f"{setting}: nearer"] for name, row in of_scene.items() if name != "height"}
            others = ", ".join(f"{name} {value:.3g}" for name, value in sorted(times.items(), key=lambda item: item[1]))
            lines.append([scene, setting, f"{height[f'{setting}: nearer']:.3g}", others,
                          told(height[f"{setting}: nearer at 1e-6"]), told(height[f"{setting}: 10 times nearer from"])])
    return study.table(head, lines)


def read_growth(path, commit):
    """How the disturbed third run of bounce reference parts, and the number of contacts. InputError if it is of another
    commit."""
    try:
        record = json.loads(path.read_text())
        growth = {name: float(record["growth"][name]) for name in ("start", "at_contact", "end", "rate")}
        growth["contacts"] = int(record["fixed"]["contacts"])
        found = record["origin"]["commit"]
    except (OSError, KeyError, TypeError, ValueError) as error:
        raise InputError(f"{path}: holds no growth of a disturbance: {error}") from error
    if commit not in (found, None):
        raise InputError(f"{path}: commit {found}: allowed is that of the studies, {commit}")
    return growth | {"commit": found}


def growth_text(growths, rows):
    """How a small difference grows: no rule with an error above that decides an end."""
    head = ["scene", "contacts", "apart at the start, cm", "at the first contact", "at the end", "times",
            "e-folds a second", "error allowed, cm"]
    lines = []
    for scene, g in growths.items():
        times = g["end"] / g["at_contact"] if g["at_contact"] > 0 else math.nan
        papers = [row["listing_error_at_1e-6"] for row in rows
                  if row["scene"] == scene and row["observable"] == "height"]
        lines.append([scene, f"{g['contacts']}", f"{g['start']:.1e}", f"{g['at_contact']:.1e}", f"{g['end']:.1e}",
                      f"{times:.1e}", f"{g['rate']:.1f}", f"{papers[0] / FACTOR / times:.1e}" if papers else "-"])
    return ("How a difference grows, by two solutions whose contacts are located to rounding and whose starts differ a "
            "little: what a first contact is off by is that much larger at the end. Last, the error of a place that "
            "all contacts together may have, so that no particle ends further off than a tenth of the error of the "
            "paper's rule in the height.\n\n" + study.table(head, lines) +
            "\nExample 3 collapses: its two solutions part, and no step and no rule converges to a particle's place. "
            f"The solutions are of commit {', '.join(sorted({g['commit'] for g in growths.values()}))}.\n")


def whole_text(rows):
    head = ["scene", "observable", "reference", "known to", "paper's rule, Δt → 0", "smallest Δt", "its error at 1e-6",
            *(word for setting in SETTINGS for word in (f"{', '.join(setting)}: error at 1e-4", "nearer"))]
    lines = [[r["scene"], r["observable"], f"{r['reference']:.9g}", f"{r['known_to']:.1e}",
              f"{r['listing_limit']:.9g} ± {r['listing_limit_bar']:.1e}", f"{r['smallest_dt']:.1e}",
              f"{r['listing_error_at_1e-6']:.1e}",
              *(word for setting in map(", ".join, SETTINGS)
                for word in (f"{r[f'{setting}: error at 1e-4']:.1e}", f"{r[f'{setting}: nearer']:.3g}"))] for r in rows]
    return study.table(head, lines)


def markdown(rows, made, growths):
    return "\n".join([
        "# The contact rules as the step goes to 0\n",
        "Resolved and located contact at Δt = 1e-4 s against the paper's (listing's scheme) at Δt = 1e-6 s: how many "
        "times nearer they are to the reference, which is the limit Δt → 0. At 1e-4 s, a quarter of the stable step "
        "at E = 16000, leapfrog's own error counts as well as the contact's, that of blanes-moan-6 does not; last "
        "the same with both at 1e-6 s, and the step from which on all that were run are nearer by a factor 10. For "
        "alpha = 1, beta = -1 (example-6) the resolved rule is the paper's, and what differs is the method.\n",
        nearer_text(rows), growth_text(growths, rows),
        "In full: the paper's rule extrapolated from its smallest steps, ± what leaving out the smallest changes; the "
        "errors. Known to: what the two references differ by; nothing below counts.\n",
        whole_text(rows),
        "![errors of the height](contact.png)\n",
        f"Made by `scripts/studies/contact.sh` {made}.", ""])


def draw(found, path):
    columns = min(3, len(found) + 1)
    rows = math.ceil((len(found) + 1) / columns)
    figure, panels = plt.subplots(rows, columns, figsize=(3.2 * columns, 2.9 * rows), squeeze=False,
                                  layout="constrained")
    *panels, legend = panels.flat[:len(found) + 1]
    for axes in figure.axes[len(found):]:
        axes.axis("off")
    for axes, (scene, each) in zip(panels, found.items()):
        for (method, contact), rows in each.lines().items():
            # What is off by more than the ball's size was unstable.
            rows = sorted((r for r in rows if 0 < r["error_height"] < 10.0), key=lambda r: r["dt"])
            axes.loglog([r["dt"] for r in rows], [r["error_height"] for r in rows], linewidth=1.0,
                        color=accuracy.colour_of(method), label=accuracy.label_of(method, contact),
                        **accuracy.style_of(contact))
        axes.set_title(scene, fontsize=9)
        axes.set_xlabel("time step, s")
    for axes in panels[::columns]:
        axes.set_ylabel("error of the centre's height, cm")
    legend.legend(*panels[0].get_legend_handles_labels(), loc="center", frameon=False, fontsize=8.5)
    drawing.save(figure, path)


def make(arguments, folder):
    found = errors.read_studies(arguments, "contact")
    others = errors.read_studies(arguments, "located")
    study.one_commit(each.origin["commit"] for each in (*found.values(), *others.values()))
    for scene, each in found.items():
        known = {(row["method"], row["contact"], row["dt"]) for row in each.rows}
        each.rows += [row for row in others[scene].rows
                      if (row["method"], row["contact"], row["dt"]) not in known]
    rows = [line for scene, each in found.items() for line in lines_of(scene, each)]
    origin = next(iter(found.values())).origin
    growths = {scene: read_growth(arguments.runs / f"growth-{scene}" / "observables.json", origin["commit"])
               for scene in (*found, COLLAPSING)}
    made = f"at commit {origin['commit']}, {origin['date']}, on {origin['cpu']}"
    study.write_whole(folder / "contact.md", markdown(rows, made, growths))
    with open(folder / "contact.csv", "w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, rows[0], lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)
    draw(found, folder / "contact.png")


def retell(out, folder):
    """The page from what was kept of its study; growth from the reference solutions, of another commit."""
    try:
        with open(out / "contact.csv", newline="", encoding="utf-8") as file:
            rows = [{key: text if key in ("scene", "observable") else float(text) for key, text in row.items()}
                    for row in csv.DictReader(file)]
        made = re.search(r"^Made by `.*contact\.sh` (at commit .*)\.$", (out / "contact.md").read_text(),
                         re.MULTILINE)[1]
        scenes = dict.fromkeys([*(row["scene"] for row in rows), COLLAPSING])
        growths = {scene: read_growth(out / "reference" / scene / "observables.json", None) for scene in scenes}
        text = markdown(rows, made, growths)
    except (OSError, KeyError, TypeError, ValueError) as error:
        raise InputError(f"{out}: contact.csv and contact.md cannot be used: {type(error).__name__}: {error}"
                         ) from error
    study.write_whole(folder / "contact.md", text)


def main():
    arguments = study.scene_parser(__doc__.splitlines()[0], "contact").parse_args()
    study.publish(arguments.out, lambda folder: make(arguments, folder) if arguments.scenes
                  else retell(arguments.out, folder))
    print(f"contact.py: {arguments.out}/contact.md")


if __name__ == "__main__":
    study.run(main)
