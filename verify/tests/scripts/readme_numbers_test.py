#!/usr/bin/python3
"""scripts/readme_numbers.py on made-up results; README.md as it is committed: its numbers, size and links."""
import json
import math
import re
import subprocess
import tempfile
import unittest
from pathlib import Path

TOP = Path(__file__).resolve().parent.parent.parent.parent
SCRIPT = TOP / "scripts" / "readme_numbers.py"
EDGE = {"method": "listing", "passage": "flight", "growth": "100", "periods": "1000", "disturbed": "1e-06"}
# What README must show of the made-up results.
SHOWN = {
    "million_steps": "4.0", "auto_x_listing": "35", "ring_x_listing": "22", "ring_avx2_x_listing": "19",
    "ring_port_limit": "87", "half_x_lammps": "60", "ring_x_lammps": "40", "half_x_harmonic": "30",
    "ten_million_x_papers": "1.2", "sooner": "12,000", "sooner_least": "230", "sooner_most": "15,000",
    "papers_seconds": "120", "best_seconds": "0.010", "papers_error": "1.1 × 10⁻³", "best_error": "1.8 × 10⁻⁴",
    "known_to": "1.6 × 10⁻¹²", "edge_x_papers_step": "380", "edge_root": "0.048",
    "edge_elasticity": "2.3 × 10⁹", "equivalence_rows": "474", "extreme_rows": "2",
}


def table(path, rows):
    """A CSV whose columns are those of all rows; what a row has not is empty."""
    names = list(dict.fromkeys(name for row in rows for name in row))
    lines = [",".join(names), *(",".join(str(row.get(name, "")) for name in names) for row in rows)]
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")


def repetitions(row, threads, centre):
    """Three runs of a row, the middle one with these figures; and what Google Benchmark adds to them."""
    name = f"{row}/threads:{threads}/iterations:7/manual_time"
    runs = [{"run_name": name, "run_type": "iteration"} | {key: factor * value for key, value in centre.items()}
            for factor in (1.1, 1.0, 0.7)]
    return [*runs, {"run_name": name, "run_type": "aggregate", "aggregate_name": "mean"} | centre]


class ReadmeNumbers(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.top = Path(folder.name)
        self.results = self.top / "results"
        for name in ("accuracy", "stability/example-2"):
            (self.results / name).mkdir(parents=True)
        self.write_throughput()
        self.write_peers()
        self.write_accuracy()
        self.write_stability()
        (self.results / "equivalence.txt").write_text("scene kernel check\n\nequivalent: 474 of 474 rows hold\n")
        table(self.results / "extremes.csv", [{"row": "a", "as_expected": 1}, {"row": "b", "as_expected": 1}])
        self.write_readme(SHOWN)

    def write_throughput(self, **change):
        ring = {"x_oracle_O3": 22.24, "part_of_port_limit": 0.87} | change
        runs = [*repetitions("auto auto, example-1", 0, {"ns_per_step": 250.0, "x_oracle_O3": 35.2}),
                *repetitions("ring avx512", 1, ring), *repetitions("ring avx512", 2, {"x_oracle_O3": 1.0}),
                *repetitions("ring avx2", 1, {"x_oracle_O3": 18.8})]
        self.write_json("throughput.json", {"benchmarks": runs})
        large = repetitions("particles:10000200", 1, {"x_papers_ball": 1.21})
        self.write_json("large-balls.json", {"benchmarks": large})

    def write_peers(self):
        rows = [("LAMMPS, tabulated bonds", [1.0, 2.0, 1.0]), ("LAMMPS, harmonic bonds", [2.0, 4.0, 2.0]),
                ("bounce, leapfrog", [60.0, 120.0, 90.0]), ("bounce, leapfrog, ring", [40.0, 80.0, 40.0])]
        self.write_json("peers.json", {"rows": [{"program": name, "cores": 1, "steps_per_second": speeds}
                                                for name, speeds in rows]})

    def write_accuracy(self, **change):
        for number in range(1, 8):
            place = self.results / f"accuracy/example-{number}"
            place.mkdir(exist_ok=True)
            seconds = {1: 0.008, 2: 0.01, 7: 0.52}.get(number, 0.1)
            best = {"method": "leapfrog", "contact": "resolved", "dt": 7.0 / 30000.0, "seconds": seconds}
            self.write_json(place / "origin.json", {"oracle_seconds": 120.0, "best": best})
            table(place / "accuracy.csv", [
                {"method": "reference", "error_height": 1.6e-12},
                {"method": "listing", "contact": "listing", "precision": "double", "dt": 1e-6,
                 "error_height": 1.1e-3} | change,
                {"method": "leapfrog", "contact": "resolved", "precision": "double", "dt": 0.00023333333333333333,
                 "error_height": 1.8e-4},
                {"method": "leapfrog", "contact": "resolved", "precision": "single", "dt": 0.00023333333333333333,
                 "error_height": 9.9},
                {"method": "leapfrog", "contact": "resolved", "precision": "double", "dt": 0.0002,
                 "error_height": 1e-4}])

    def write_stability(self, stable=3.808e-4):
        table(self.results / "stability/example-2/edge.csv", [
            EDGE | {"sought": "dt", "E": "16000", "stable": stable},
            EDGE | {"sought": "dt", "E": "17780", "stable": 1.0},
            EDGE | {"sought": "dt", "E": "16000", "stable": 1.0, "periods": "10000"},
            EDGE | {"sought": "dt", "E": "16000", "stable": 1.0, "method": "leapfrog"},
            EDGE | {"sought": "E", "dt": "1e-06", "stable": 2.34e9}])

    def write_json(self, name, data):
        (self.results / name).write_text(json.dumps(data), encoding="utf-8")

    def write_readme(self, numbers, more=""):
        lines = [f"{name} is <!-- n:{name} -->{text}<!-- /n -->, no more." for name, text in numbers.items()]
        (self.top / "README.md").write_text("\n".join(["# A page", *lines, more, ""]), encoding="utf-8")

    def readme(self):
        return (self.top / "README.md").read_text(encoding="utf-8")

    def run_script(self, *words):
        done = subprocess.run([SCRIPT, "--top", self.top, *words], capture_output=True, text=True, check=False)
        self.assertEqual(done.stdout, "")
        return done.returncode, done.stderr

    def refused(self, complaint):
        """Both ways of calling it end with 1, say so, and leave README alone."""
        before = self.readme()
        for words in ((), ("--check",)):
            code, complaints = self.run_script(*words)
            self.assertEqual(code, 1, complaints)
            self.assertIn(complaint, complaints)
        self.assertEqual(self.readme(), before)

    def test_fills_in(self):
        self.write_readme(dict.fromkeys(SHOWN, "0"))
        code, complaints = self.run_script("--check")
        self.assertEqual(code, 1)
        for name, text in SHOWN.items():
            self.assertIn(f"{name}: README.md has 0, the results say {text} ", complaints)
        self.assertIn("sooner is <!-- n:sooner -->0<!-- /n -->, no more.", self.readme())
        self.assertEqual(self.run_script(), (0, ""))
        filled = self.readme()
        self.write_readme(SHOWN)
        self.assertEqual(filled, self.readme())
        self.assertEqual(self.run_script("--check"), (0, ""))
        self.assertEqual(sorted(path.name for path in self.top.iterdir()), ["README.md", "results"])

    def test_one_number_differs(self):
        self.write_readme(SHOWN | {"edge_root": "0.049"})
        code, complaints = self.run_script("--check")
        self.assertEqual((code, complaints.count("\n")), (1, 1))
        self.assertIn("edge_root: README.md has 0.049, the results say 0.048 ", complaints)

    def test_unknown_unused_and_torn(self):
        self.write_readme(SHOWN | {"sooner_or_later": "1"})
        self.refused("sooner_or_later: README.md asks for it")
        self.write_readme({name: text for name, text in SHOWN.items() if name != "sooner"})
        self.refused("sooner: README.md does not use it")
        self.write_readme(SHOWN, "and <!-- n:sooner -->12,000, that is all")
        self.refused("a marker is torn")
        self.write_readme(SHOWN, "  <!-- n:sooner -->12,000<!-- /n --> times")
        self.refused("a line begins with a marker")

    def test_what_is_no_number(self):
        for value in (math.nan, math.inf, 0.0):
            self.write_throughput(x_oracle_O3=value)
            self.refused("ring_x_listing: ")
        self.write_throughput()
        self.write_accuracy(error_height=math.nan)
        self.refused("papers_error: it is nan")
        self.write_accuracy(error_height="")
        self.refused("papers_error: ")
        self.write_accuracy()
        self.write_stability("nan")
        self.refused("edge_root: it is nan")

    def change_first(self, row, **change):
        """The first repetition of that row of throughput.json."""
        data = json.loads((self.results / "throughput.json").read_text())
        next(run for run in data["benchmarks"] if run["run_name"].startswith(row)).update(change)
        self.write_json("throughput.json", data)

    def test_one_repetition_is_no_number(self):
        """It must not pass for the median of the others."""
        self.change_first("ring avx512/threads:1", x_oracle_O3=math.nan)
        self.refused("ring_x_listing: a value is not finite")

    def test_failed_rows(self):
        self.change_first("ring avx2", error_occurred=True)
        self.refused("ring_avx2_x_listing: throughput.json: ring avx2, 1 thread(s): its state is wrong")
        self.write_throughput()
        (self.results / "equivalence.txt").write_text("equivalent: 473 of 474 rows hold\n")
        self.refused("equivalence_rows: equivalence.txt: not all rows hold")
        table(self.results / "extremes.csv", [{"row": "a", "as_expected": 0}])
        self.refused("extreme_rows: extremes.csv: not every row is as expected")

    def test_cheapest_in_another_precision(self):
        origin = json.loads((self.results / "accuracy/example-7/origin.json").read_text())
        origin["best"]["precision"] = "single"
        self.write_json("accuracy/example-7/origin.json", origin)
        self.refused("sooner_least: example-7: its cheapest setting is not in double precision")

    def test_missing_and_torn_results(self):
        (self.results / "peers.json").write_text('{"rows": [')
        self.refused("half_x_lammps: JSONDecodeError")
        (self.results / "peers.json").unlink()
        self.refused("peers.json: No such file or directory")

    def test_medians_alone(self):
        """A file that keeps no repetitions, but Google Benchmark's own medians."""
        data = json.loads((self.results / "throughput.json").read_text())
        kept = [run | {"aggregate_name": "median"} for run in data["benchmarks"] if run["run_type"] == "aggregate"]
        self.write_json("throughput.json", {"benchmarks": kept})
        self.assertEqual(self.run_script("--check"), (0, ""))

    def test_studies_without_other_precisions(self):
        for path in self.results.glob("accuracy/*/accuracy.csv"):
            lines = [line.split(",") for line in path.read_text().splitlines() if "single" not in line]
            column = lines[0].index("precision")
            path.write_text("\n".join(",".join(line[:column] + line[column + 1:]) for line in lines) + "\n")
        self.assertEqual(self.run_script("--check"), (0, ""))

    def test_bad_input(self):
        (self.top / "README.md").unlink()
        code, complaints = self.run_script()
        self.assertEqual(code, 2)
        self.assertIn("README.md: cannot be read", complaints)


def anchor_of(heading):
    """As GitHub makes it of a heading."""
    return re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-")


class CommittedPages(unittest.TestCase):
    def test_numbers(self):
        done = subprocess.run([SCRIPT, "--check"], capture_output=True, text=True, check=False)
        self.assertEqual((done.returncode, done.stderr), (0, ""))

    def test_size(self):
        text = (TOP / "README.md").read_bytes()
        self.assertLessEqual(len(text), 16000)
        self.assertLessEqual(text.count(b"\n"), 200)

    def test_links(self):
        """Of README.md and the folders' own: each names a file or folder that is there, and a heading of it."""
        pages = [TOP / "README.md", *TOP.glob("*/README.md")]
        self.assertGreater(len(pages), 5)
        for page in pages:
            for link in re.findall(r"\]\(([^)\s]+)\)", page.read_text(encoding="utf-8")):
                if link.startswith("http"):
                    continue
                name, _, anchor = link.partition("#")
                place = (page.parent / name).resolve() if name else page
                self.assertTrue(place.exists(), f"{page}: {link}")
                if anchor:
                    headings = re.findall(r"^#+ (.*)$", place.read_text(encoding="utf-8"), re.M)
                    self.assertIn(anchor, map(anchor_of, headings), f"{page}: {link}")


if __name__ == "__main__":
    unittest.main()
