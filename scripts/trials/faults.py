#!/usr/bin/python3
"""Do the tests see a fault? Small faults are put in one at a time, drawn by chance from --seed, and the tests that could
see each are built and run, the quickest first, until one fails.

  scripts/trials/faults.py --faults 80 --seed 1      goes on where it was stopped (Ctrl-C)
  scripts/trials/faults.py --again                   those that nothing saw once more, with the tests of today

All in an overlay, a git worktree of this commit in --work with a build of its own; the tree stays as it is. A fault
that does not compile is drawn anew. Writes OUT/faults.csv after each fault, and OUT/faults.md; why a fault that nothing
sees is none (the program does the same) stands in faults_explained.toml. Slow: minutes a fault.
"""

import csv
import hashlib
import json
import os
import re
import resource
import signal
import subprocess
import sys
import tempfile
import time
import tomllib
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from studies import study
from studies.study import InputError
from trials import fault_kinds
from trials.fault_kinds import Fault

EXPLAINED = Path(__file__).with_name("faults_explained.toml")
COLUMNS = ("seed", "number", "file", "line", "kind", "before", "after", "seen_by", "seconds", "commit")
NOT_SEEN = "not seen"
# The floors of tests for a fault's floor: its own and those above, then those below that may know more. A label of ctest
# each; a floor's tests cannot see what they do not link.
FLOORS_OF_TESTS = {
    "kernels": ("model", "kernels", "oracle", "verify", "driver", "paper"),
    "verify": ("verify", "oracle", "kernels", "driver", "paper", "scripts"),
    "driver": ("driver", "scripts", "paper"),
    "scripts": ("scripts",),
}
SPARE_TIME = 60.0  # s beyond ten times what a test takes: then it hangs
MOST_MEMORY, LARGEST_FILE = 8 << 30, 1 << 30  # bytes that a test may take or write: a fault may ask for all there is


class Overlay:
    """A worktree of a commit, its build, and what its tests are."""

    def __init__(self, work, jobs):
        self.tree, self.build, self.jobs = work / "tree", work / "tree" / "build" / "release", jobs
        self.work = work
        self.environment = os.environ | {"CCACHE_BASEDIR": str(self.tree), "CCACHE_NOHASHDIR": "1",
                                         "GIT_OPTIONAL_LOCKS": "0", "PYTHONDONTWRITEBYTECODE": "1"}

    def run(self, *words, timeout=None, **more):
        """Exit code and output; None for one that did not end in time."""
        def limit():
            # As from a terminal, however this script was started.
            for each in (signal.SIGINT, signal.SIGHUP, signal.SIGTERM, signal.SIGQUIT):
                signal.signal(each, signal.SIG_DFL)
            if timeout is not None:
                resource.setrlimit(resource.RLIMIT_AS, (MOST_MEMORY, MOST_MEMORY))
                resource.setrlimit(resource.RLIMIT_FSIZE, (LARGEST_FILE, LARGEST_FILE))

        # A session of its own, so that what a test has started ends with it.
        process = subprocess.Popen([str(word) for word in words], cwd=self.build if self.build.is_dir() else self.tree,
                                   env=self.environment | more, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                   stderr=subprocess.STDOUT, text=True, errors="replace", start_new_session=True,
                                   preexec_fn=limit)
        try:
            output, _ = process.communicate(timeout=timeout)
            return process.returncode, output
        except BaseException as error:
            os.killpg(process.pid, 9)
            process.communicate()
            if isinstance(error, subprocess.TimeoutExpired):
                return None, ""
            raise

    def prepare(self, commit):
        """The worktree at that commit, without faults, and its build configured."""
        if not (self.tree / ".git").exists():
            self.demand(study.git("worktree", "prune") is not None and
                        study.git("worktree", "add", "--detach", self.tree, commit) is not None,
                        f"--work {self.work}: no worktree can be made there")
        for words in (("checkout", "--quiet", "--force", "--detach", commit), ("clean", "--quiet", "-fd")):
            code, output = self.run("git", "-C", self.tree, *words)
            self.demand(code == 0, output)
        # So that the commit in the program says -dirty with and without a fault.
        (self.tree / "has-faults").write_text("")
        launcher = [] if self.run("which", "ccache")[0] else ["-DCMAKE_CXX_COMPILER_LAUNCHER=ccache"]
        code, output = self.run("cmake", "--preset", "release", "-S", self.tree, "-B", self.build, "-G", "Ninja",
                                "-DBOUNCE_BENCH=OFF", *launcher)
        self.demand(code == 0, output)

    @staticmethod
    def demand(good, complaint):
        if not good:
            raise InputError(str(complaint).strip()[-2000:])

    def ninja(self, *targets):
        return self.run("ninja", f"-j{self.jobs}", *targets)

    def tests(self):
        """Name to command, label and environment; the tests of one program together."""
        code, output = self.run("ctest", "--show-only=json-v1")
        self.demand(code == 0, output)
        found = {}
        for test in json.loads(output)["tests"]:
            words = test.get("command", [])
            properties = {each["name"]: each["value"] for each in test.get("properties", [])}
            label = (properties.get("LABELS") or [""])[0]
            if not words or "cmake" in Path(words[0]).name:
                continue  # a stand-in
            script = "python" in Path(words[0]).name
            name = Path(words[1] if script else words[0]).name
            environment = dict(each.split("=", 1) for each in properties.get("ENVIRONMENT", []))
            if any(word.startswith("--gtest_filter") for word in words):
                words = [words[0], "--gtest_fail_fast", "--gtest_brief=1"]  # all its tests at once
            found[name] = {"command": words,
                           "label": label, "environment": environment, "target": None if script else name}
        bounce = self.build / "bounce"
        found["verify --quick"] = {"command": [str(bounce), "verify", "--quick"], "label": "oracle", "environment": {},
                                   "target": "bounce"}
        found["check_house.py"] = {"command": [str(self.tree / "scripts/check_house.py")], "label": "scripts",
                                   "environment": {}, "target": None}
        found["readme_numbers.py --check"] = {"command": [str(self.tree / "scripts/readme_numbers.py"), "--check"],
                                              "label": "scripts", "environment": {}, "target": None}
        return found

    def digest(self, target):
        path = next((p for p in (self.build / target, *self.build.glob(f"verify/tests/**/{target}")) if p.is_file()), None)
        return hashlib.sha256(path.read_bytes()).hexdigest() if path else None

    def baseline(self, commit):
        """How long each test takes, and what its program is, without a fault; measured once a commit. A test that fails
        without a fault is left out."""
        kept = self.work / "baseline.json"
        known = json.loads(kept.read_text()) if kept.is_file() else {"commit": None}
        if known["commit"] != commit:
            known = {"commit": commit, "tests": {}, "whole": False}
        if known["whole"]:
            return known["tests"]
        print("building without a fault ...", flush=True)
        code, output = self.ninja()
        self.demand(code == 0, output)
        for name, test in self.tests().items():
            if name in known["tests"]:
                continue
            begin = time.monotonic()
            code, output = self.run(*test["command"], timeout=3600.0, **test["environment"])
            test["seconds"] = time.monotonic() - begin
            test["digest"] = self.digest(test["target"]) if test["target"] else None
            test["fails"] = code != 0  # without a fault: it can judge none
            print(f"  {name}: " + (f"{test['seconds']:.1f} s" if code == 0 else
                                   f"LEFT OUT: it fails without a fault ({failure_of(output)})"), flush=True)
            known["tests"][name] = test
            study.write_whole(kept, json.dumps(known, indent=1))
        known["whole"] = True
        study.write_whole(kept, json.dumps(known, indent=1))
        return known["tests"]


def failure_of(output):
    """The test that failed first, as googletest or unittest name it."""
    found = re.search(r"\[  FAILED  \] ([\w./]+)|^(?:FAIL|ERROR): (\w+)", output, re.MULTILINE)
    return (found[1] or found[2]).removesuffix(".") if found else ""


class Trial:
    """One fault put in, and the tests that could see it."""

    def __init__(self, overlay, tests, fault):
        self.overlay, self.tests, self.fault = overlay, tests, fault
        self.place = overlay.tree / fault.file

    def run(self):
        """What saw it, or NOT_SEEN; None if it does not compile, or its line is no more."""
        sound = self.place.read_text(encoding="utf-8")
        faulty = fault_kinds.put_in(sound, self.fault)
        if faulty is None:
            return None
        self.place.write_text(faulty, encoding="utf-8")
        try:
            return self.judge()
        finally:
            self.place.write_text(sound, encoding="utf-8")

    def judge(self):
        floor = fault_kinds.floor_of(self.fault.file)
        if floor == "scripts":
            words = {"py": ("/usr/bin/python3", "-c", f"compile(open({str(self.place)!r}).read(), 'it', 'exec')"),
                     "sh": ("bash", "-n", self.place)}[self.place.suffix[1:]]
            if self.overlay.run(*words)[0] != 0:
                return None
        else:
            code, output = self.overlay.ninja("bounce")
            if code != 0:
                return None if ": error: " in output else "the build of bounce"
        program = self.overlay.digest("bounce")
        same_program = floor == "scripts" or program == self.tests["verify --quick"]["digest"]
        labels = FLOORS_OF_TESTS[floor]
        for label in labels:
            of_label = [(test["seconds"], name) for name, test in self.tests.items()
                        if test["label"] == label and not test["fails"]]
            for _, name in sorted(of_label):
                seen = self.seen_by(name, floor, same_program)
                if seen != "":
                    return seen
        return NOT_SEEN

    def seen_by(self, name, floor, same_program):
        """"" if that test sees nothing; None if it does not compile."""
        test = self.tests[name]
        if test["target"]:
            code, output = self.overlay.ninja(test["target"])
            if code != 0:
                return None if ": error: " in output else f"{name}: it does not even list its tests"
            runs_program = test["label"] in ("driver", "scripts") and not same_program
            if self.overlay.digest(test["target"]) == test["digest"] and not runs_program:
                return ""
        elif same_program and floor != "scripts":
            return ""
        for _ in range(2):  # a test that fails by chance has not seen it
            code, output = self.overlay.run(*test["command"], timeout=10.0 * test["seconds"] + SPARE_TIME,
                                            **test["environment"])
            if code == 0:
                return ""
            if code is None:
                return f"{name}: it hangs"
        return ": ".join(filter(None, (name, failure_of(output) or (f"signal {-code}" if code < 0 else ""))))


# ---- rows


def read_rows(path):
    try:
        with open(path, newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
    except FileNotFoundError:
        return []
    for row in rows:
        if set(row) != set(COLUMNS) or None in row.values():
            raise InputError(f"{path}: a row that is not one of {', '.join(COLUMNS)}")
    return rows


def write_rows(path, rows):
    with tempfile.TemporaryDirectory(dir=path.parent) as folder:
        temporary = Path(folder) / path.name
        with open(temporary, "w", newline="", encoding="utf-8") as file:
            writer = csv.DictWriter(file, COLUMNS, lineterminator="\n")
            writer.writeheader()
            writer.writerows(rows)
        os.replace(temporary, path)


def fault_of(row):
    return Fault(row["file"], int(row["line"]), row["kind"], row["before"], row["after"])


def read_explained(path=EXPLAINED):
    """(file, before, after) to why; lines without their indents."""
    try:
        entries = tomllib.loads(path.read_text(encoding="utf-8")).get("fault", [])
        return {(e["file"], e["before"].strip(), e["after"].strip()): e["why"] for e in entries}
    except (OSError, KeyError, AttributeError, tomllib.TOMLDecodeError) as error:
        raise InputError(f"{path}: cannot be used: {error!r}; allowed are tables [[fault]] with file, before, after, why"
                         ) from error


def why_of(row, explained):
    return explained.get((row["file"], row["before"].strip(), row["after"].strip()), "")


def code(text):
    return "`" + re.sub(r"\s+", " ", text.strip()).replace("|", "\\|") + "`"


def markdown(rows, explained):
    def counts(some):
        seen = sum(row["seen_by"] != NOT_SEEN for row in some)
        same = sum(row["seen_by"] == NOT_SEEN and why_of(row, explained) != "" for row in some)
        return [f"{len(some)}", f"{seen}", f"{same}", f"{len(some) - seen - same}",
                f"{100.0 * seen / len(some):.0f} %" if some else "-"]

    lines = [[floor, *counts([row for row in rows if fault_kinds.floor_of(row["file"]) == floor])]
             for floor in fault_kinds.FLOORS]
    lines.append(["all", *counts(rows)])
    unseen = [[f"{row['file']}:{row['line']}", row["kind"], code(row["before"]), code(row["after"]),
               why_of(row, explained) or "**no test sees it**"] for row in rows if row["seen_by"] == NOT_SEEN]
    seen = [[f"{row['file']}:{row['line']}", row["kind"], code(row["before"]), code(row["after"]), row["seen_by"]]
            for row in rows if row["seen_by"] != NOT_SEEN]
    seeds = ", ".join(sorted({row["seed"] for row in rows}))
    commits = ", ".join(sorted({row["commit"] for row in rows}))
    return "\n".join([
        "# Do the tests see a fault?\n",
        "Small faults, drawn by chance, put in one at a time; seen by the tests or `bounce verify --quick`. No fault: "
        "nothing sees it because the program does the same with it.\n",
        study.table(["floor", "put in", "seen", "no fault", "neither", "seen"], lines),
        "## Not seen\n",
        study.table(["where", "kind", "before", "after", "why"], unseen) if unseen else "None.\n",
        "## Seen\n",
        study.table(["where", "kind", "before", "after", "by"], seen),
        f"Made by `scripts/trials/faults.py` with seed {seeds} at commit {commits}.", ""])


# ---- the study


def sources_of(tree):
    """The files into which faults may be put, by name."""
    listed = subprocess.run(["git", "-C", tree, "ls-files", "-z"], capture_output=True, text=True, check=True).stdout
    return {name: (tree / name).read_text(encoding="utf-8")
            for name in listed.split("\0") if name and fault_kinds.is_source(name)}


def open_faults(arguments, rows, overlay):
    """(seed, number, fault) of those still to be tried, in the order of the draw."""
    if arguments.again:
        for row in [row for row in rows if row["seen_by"] == NOT_SEEN]:
            yield row["seed"], row["number"], fault_of(row)
        return
    done = {int(row["number"]) for row in rows}
    for number, fault in enumerate(fault_kinds.draw(sources_of(overlay.tree), arguments.seed), 1):
        if number not in done and len(rows) < arguments.faults:
            yield str(arguments.seed), str(number), fault
        if len(rows) >= arguments.faults:
            return


def save(arguments, rows):
    rows.sort(key=lambda row: int(row["number"]))
    arguments.out.mkdir(parents=True, exist_ok=True)
    write_rows(arguments.out / "faults.csv", rows)
    study.write_whole(arguments.out / "faults.md", markdown(rows, read_explained()))


def rows_to_go_on_with(arguments, commit):
    rows = read_rows(arguments.out / "faults.csv")
    if rows and not arguments.again and {(row["seed"], row["commit"]) for row in rows} != {(str(arguments.seed), commit)}:
        raise InputError(f"--out {arguments.out}: faults.csv is of another seed or commit; allowed is --again, another "
                         "--out, or none there")
    return rows


def main():
    parser = study.parser_of(__doc__.split("\n\n", maxsplit=1)[0], "nothing that is read here")
    add = parser.add_argument
    add("--faults", type=int, default=80, metavar="N", help="how many [80]")
    add("--seed", type=int, default=1, metavar="S", help="of the draw [1]")
    add("--again", action="store_true", help="those that nothing saw, with the tests of this commit")
    add("--table", action="store_true", help="only write faults.md once more, from faults.csv and the explanations")
    add("--work", type=Path, default=Path(tempfile.gettempdir()) / "bounce-faults", metavar="DIR",
        help="the overlay; kept, to go on [%(default)s]")
    add("--jobs", type=int, default=1, metavar="N", help="of the build [1]")
    arguments = parser.parse_args()
    if arguments.table:
        return save(arguments, read_rows(arguments.out / "faults.csv"))
    if arguments.faults < 1 or arguments.jobs < 1:
        raise InputError("--faults, --jobs: allowed is 1 or more")
    commit = study.scripts_commit()
    if not arguments.allow_dirty and (commit == "unknown" or study.git("status", "--porcelain") != ""):
        raise InputError("the tree has changes: allowed is a clean one, or --allow-dirty (the last commit is tried)")
    commit = study.git("rev-parse", "--short=12", "HEAD")
    rows = rows_to_go_on_with(arguments, commit)
    read_explained()
    os.nice(10)
    arguments.work.mkdir(parents=True, exist_ok=True)
    overlay = Overlay(arguments.work, arguments.jobs)
    overlay.prepare(commit)
    tests = overlay.baseline(commit)
    for seed, number, fault in open_faults(arguments, rows, overlay):
        begin = time.monotonic()
        seen_by = Trial(overlay, tests, fault).run()
        print(f"{number}: {fault.file}:{fault.line} {fault.kind}: {fault.before.strip()} -> {fault.after.strip()}: "
              f"{seen_by or 'does not compile'}", flush=True)
        if seen_by is None:
            continue
        rows[:] = [row for row in rows if row["number"] != number]
        rows.append({"seed": seed, "number": number, "file": fault.file, "line": str(fault.line), "kind": fault.kind,
                     "before": fault.before, "after": fault.after, "seen_by": seen_by,
                     "seconds": f"{time.monotonic() - begin:.0f}", "commit": commit})
        save(arguments, rows)
    save(arguments, rows)
    return 0


if __name__ == "__main__":
    try:
        study.run(main)
    except KeyboardInterrupt:
        print("faults.py: stopped; the same command goes on", file=sys.stderr)
        sys.exit(130)
