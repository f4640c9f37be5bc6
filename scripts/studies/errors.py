"""accuracy.csv of bounce accuracy: errors and run times of a scene, a row a setting."""

import csv
import json
import math
from dataclasses import dataclass

from studies.study import InputError, check_clean

OBSERVABLES = ("height", "speed", "rebound", "contact_time", "energy_lost", "flattening")
ERRORS = ("position", *OBSERVABLES, "energy")
TEXTS = ("method", "contact", "kernel", "note")


@dataclass
class Study:
    """The reference's error bar and a dictionary a row; origin.json; how many rows are of other precisions than double.

    Programs before 2026-11-28 had other precisions and a column for them. Their rows are left out."""

    bar: dict
    rows: list
    origin: dict
    left_out: int = 0

    def lines(self):
        """(method, contact) to its rows."""
        found = {}
        for row in self.rows:
            found.setdefault((row["method"], row["contact"]), []).append(row)
        return found

    def methods(self):
        return list(dict.fromkeys(row["method"] for row in self.rows))

    def papers(self):
        """The paper's program: listing, its contact, 1e-6 s; None without it."""
        return next((row for row in self.rows if row["method"] == row["contact"] == "listing"
                     and abs(row["dt"] / 1e-6 - 1.0) < 1e-9), None)

    def papers_seconds(self):
        """What it takes on the oracle."""
        return self.origin.get("oracle_seconds") or self.papers()["seconds"]

    def frontier(self, methods, name):
        """(run time, error) of these methods' rows, each better than all that are as cheap, down to the first that is
        as good as the reference is known."""
        key, known = f"error_{name}", self.bar[f"error_{name}"]
        rows = sorted((row["seconds"], row[key]) for row in self.rows
                      if row["method"] in methods and math.isfinite(row[key]) and math.isfinite(row["seconds"]))
        best, found = math.inf, []
        for seconds, error in rows:
            error = max(error, known)
            if error < best:
                found.append((seconds, error))
                best = error
        return found


def read_study(folder):
    """InputError if the folder holds no study, or one with a number that is none."""
    path = folder / "accuracy.csv"
    try:
        with open(path, newline="") as file:
            rows = [read_row(row) for row in csv.DictReader(file, restval=None)]
        origin = json.loads((folder / "origin.json").read_text())
    except (OSError, TypeError, ValueError) as error:
        raise InputError(f"{path}: cannot be read: {error}") from error
    wanted = ("dt", "seconds", "evaluations", *(f"error_{name}" for name in ERRORS))
    if len(rows) < 2 or rows[0].get("method") != "reference" or any(key not in rows[0] for key in wanted):
        raise InputError(f"{path}: no rows of bounce accuracy")
    in_double = [row for row in rows[1:] if row.pop("precision", "double") == "double"]
    return Study(rows[0], in_double, origin, len(rows) - 1 - len(in_double))


def read_row(row):
    for key, text in row.items():
        if text is None:
            raise ValueError(f"a row without {key}")
        if key not in TEXTS and key != "precision":
            row[key] = float(text) if text else math.nan
    return row


def read_studies(arguments, name):
    """Scene to study of RUNS/NAME-SCENE. InputError if one is not of a clean commit, unless --allow-dirty."""
    found = {}
    for scene in arguments.scenes:
        folder = arguments.runs / f"{name}-{scene}"
        found[scene] = read_study(folder)
        if not arguments.allow_dirty:
            check_clean(folder, found[scene].origin["commit"])
    return found
