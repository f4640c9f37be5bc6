#!/usr/bin/python3
"""Makes results/README.md, the index: each page and picture with a sentence, each page with its command and commit.

  scripts/studies/index.py            writes it
  scripts/studies/index.py --check    only says what is wrong: a file that no row of the index covers, a row without
                                      files, a picture without a sentence, an index that is not up to date, too much
                                      weight. Exit code 1 then
"""

import argparse
import fnmatch
import json
import re
import sys
from collections import namedtuple
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from studies import study
from studies.study import ROOT

MOST_BYTES = 4_000_000  # results/ as a whole
MOST_OF_A_PICTURE = 200_000

# page: what is read, and names its commits; files: the names it covers, a folder ends in /; kept: what is not in it.
Row = namedtuple("Row", "page shows command kept files")
ROWS = (
    Row("figures/origin.json", "The paper's Figures 1-13 and an overview of two bounces, drawn from the seven examples",
        "scripts/figures.py", "", ("figures/",)),
    Row("throughput.md", "How fast: every kernel's time for a step, beside the listing compiled by GCC",
        "scripts/bench.sh", "every repetition: [throughput.json](throughput.json)",
        ("throughput.md", "throughput.json")),
    Row("left_out.md", "What each thing saves that the program leaves out because a scene does not need it",
        "scripts/bench.sh", "every repetition: [left_out.json](left_out.json)", ("left_out.md", "left_out.json")),
    Row("peers.md", "The same ball in LAMMPS: that it is the same physics, then steps a second",
        "scripts/peers/compare.py", "every round: [peers.json](peers.json)", ("peers.md", "peers.json")),
    Row("large-balls.md", "What a particle-step costs in balls of 360 to 10 million particles",
        "scripts/studies/large_balls.sh", "every repetition: [large-balls.json](large-balls.json)",
        ("large-balls.md", "large-balls.json", "large-balls.png")),
    Row("crowded.md", "What it costs to ask for more threads than there are cores", "scripts/studies/crowded.py", "",
        ("crowded.md",)),
    Row("monitor_cost.md", "What watching a run costs", "scripts/studies/monitor_cost.py", "", ("monitor_cost.md",)),
    Row("equivalence.txt", "Is it right: kernels against the oracle on whole runs",
        "bounce verify --full --out results/equivalence.txt", "", ("equivalence.txt",)),
    Row("extremes.md", "Stiff and extreme scenes, each with what it should do and what it did",
        "scripts/studies/extremes.sh", "the rows as numbers: [extremes.csv](extremes.csv)",
        ("extremes.md", "extremes.csv")),
    Row("kills.md", "Runs killed at random moments and gone on with: what is lost", "scripts/studies/kills.py", "",
        ("kills.md",)),
    Row("stability.md", "How large a time step is stable: predicted, and measured over E, speed and gravity",
        "scripts/studies/stability.sh", "every case: `stability/SCENE/edge.csv`", ("stability.md", "stability/")),
    Row("reference.md", "The seven examples solved in continuous time, with error bars",
        "scripts/studies/reference.sh", "the solutions: `reference/SCENE/`", ("reference.md", "reference/")),
    Row("accuracy.md", "How wrong an answer is, and what it costs: error against run time",
        "scripts/studies/accuracy.sh", "every setting: `accuracy/SCENE/accuracy.csv`", ("accuracy.md", "accuracy/")),
    Row("contact.md", "The contact rules as the step goes to 0, and how a small difference grows",
        "scripts/studies/contact.sh", "the rows as numbers: [contact.csv](contact.csv)",
        ("contact.md", "contact.csv", "contact.png")),
    Row("advice.md", "What `bounce advise` forecasts, against what then comes out", "scripts/studies/advice.py", "",
        ("advice.md",)),
)
PICTURES = {
    "accuracy/headline.png": "Example 2: the error of an answer over its run time, by the paper's program, bounce and "
                             "GSL",
    "accuracy/example-*.png": "the same of each example: all methods, six errors",
    "stability/edge.png": "stable and unstable time steps over E, predicted and measured",
    "stability/margin.png": "an impact brings the edge nearer: the part of the stable step used, over time",
    "contact.png": "the error of the height over the time step, by contact rule",
    "large-balls.png": "the time of a particle-step over the number of particles",
}
FIGURES = {
    "figure-01": "Figure 1: the 360 particles",
    "figure-02": "Figure 2: small particles",
    "figure-03": "Figure 3: particles 2.5 times as large",
    "figure-04": "Figure 4: neighbours",
    "figure-05": "Figure 5: Example 1, a soft ball falls",
    "figure-06": "Figure 6: Example 1 at t = 9, the mechanism of the bounce",
    "figure-07": "Figure 7: Example 2, a stiff ball stays round",
    "figure-08": "Figure 8: Example 3, a soft ball collapses under strong gravity",
    "figure-09": "Figure 9: Example 4, a stiff ball bounces under strong gravity",
    "figure-10": "Figure 10: Example 5, thrown onto an axis with friction",
    "figure-11": "Figure 11: Example 6, thrown onto a frictionless axis",
    "figure-12": "Figure 12: Example 7, on an incline",
    "figure-13": "Figure 13: Example 7, down the incline and off the axis",
    "bounce-overview": "Height and energies of Examples 1 and 2 over time (no figure of the paper)",
}
HEAD = """# Results

What bounce was measured to do. Each page and picture is made by the command beside it, from a tree without changes; no
figure here is typed by hand. `scripts/studies/index.py` makes this index.

"""


def files_of(results):
    """Names from the folder down; what begins with a dot is still being written."""
    names = (path.relative_to(results).as_posix() for path in sorted(results.rglob("*")) if path.is_file())
    return [name for name in names if name != "README.md" and not any(part[0] == "." for part in name.split("/"))]


def covered(row, names):
    return [name for name in names if name in row.files or any(part.endswith("/") and name.startswith(part)
                                                                for part in row.files)]


def commits(path):
    """Those named in a page, or the commit of an origin.json."""
    text = path.read_text(encoding="utf-8")
    if path.suffix == ".json":
        return [json.loads(text)["commit"]]
    return list(dict.fromkeys(re.findall(r"(?<![.\w])[0-9a-f]{12}\b", text)))


def more_of(row, results):
    """What there is beside the page: its rows, the kernels of the equivalence table."""
    if row.page == "equivalence.txt":
        found = re.findall(r"^example-\d+ {2,}(\S+)", (results / row.page).read_text(encoding="utf-8"), re.MULTILINE)
        yield "kernels in it: " + ", ".join(dict.fromkeys(found))
    if row.kept:
        yield row.kept


def pages(results, names):
    lines = []
    for row in ROWS:
        if not covered(row, names) or not (results / row.page).is_file():
            continue
        name = row.page if row.page.endswith((".md", ".txt")) else row.page.split("/")[0]
        lines.append([f"[{name}]({name})", "; ".join([row.shows, *more_of(row, results)]), f"`{row.command}`",
                      ", ".join(commits(results / row.page)) or "not named"])
    return study.table(["page", "shows", "made by", "at commit"], lines)


def pictures(names):
    lines = []
    for pattern, shows in PICTURES.items():
        found = fnmatch.filter(names, pattern)
        if found:
            lines.append([", ".join(f"[{Path(name).stem}]({name})" for name in found), shows])
    return study.table(["picture", "shows"], lines)


def gallery(names):
    """Two a row."""
    cells = [f"![](figures/{name}.png) {shows}" for name, shows in FIGURES.items() if f"figures/{name}.png" in names]
    cells += [""] * (len(cells) % 2)
    return study.table(["", ""], list(zip(cells[::2], cells[1::2])))


def index_of(results):
    names = files_of(results)
    return HEAD + "\n".join([pages(results, names), "## Pictures\n", pictures(names), "## The paper's figures\n",
                             gallery(names)])


def troubles(results):
    names = files_of(results)
    known = {name for row in ROWS for name in covered(row, names)}
    with_sentence = (*PICTURES, *(f"figures/{name}.png" for name in FIGURES))
    for name in names:
        if name not in known:
            yield f"{name}: in no row of scripts/studies/index.py"
        if name.endswith(".png") and not any(fnmatch.fnmatch(name, pattern) for pattern in with_sentence):
            yield f"{name}: has no sentence in scripts/studies/index.py"
        size = (results / name).stat().st_size
        if name.endswith((".png", ".svg")) and size > MOST_OF_A_PICTURE:
            yield f"{name}: {size} bytes; allowed is at most {MOST_OF_A_PICTURE}"
    for row in ROWS:
        for part in row.files:
            if not any(name == part or part.endswith("/") and name.startswith(part) for name in names):
                yield f"{part}: is not there, but scripts/studies/index.py has it"
    weight = sum((results / name).stat().st_size for name in names)
    if weight > MOST_BYTES:
        yield f"all together: {weight} bytes; allowed is at most {MOST_BYTES}"
    readme = results / "README.md"
    if not readme.is_file() or readme.read_text(encoding="utf-8") != index_of(results):
        yield "README.md: is not what scripts/studies/index.py makes of the rest; run it"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--results", type=Path, default=ROOT / "results", metavar="DIR", help="[results]")
    parser.add_argument("--check", action="store_true", help="writes nothing")
    arguments = parser.parse_args()
    if not arguments.results.is_dir():
        raise study.InputError(f"{arguments.results}: no folder")
    if not arguments.check:
        study.write_whole(arguments.results / "README.md", index_of(arguments.results))
        return 0
    found = list(troubles(arguments.results))
    for trouble in found:
        print(f"index.py: {arguments.results}/{trouble}", file=sys.stderr)
    return 1 if found else 0


if __name__ == "__main__":
    study.run(main)
