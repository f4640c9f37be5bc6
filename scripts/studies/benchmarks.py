"""Google Benchmark's JSON as scripts/bench.sh and large_balls.sh keep it: context, and a row a repetition."""

import json
import math
from pathlib import Path

from studies.study import InputError, write_whole

# Threads stay on their cores and spin between regions.
PINNED = {"OMP_PROC_BIND": "close", "OMP_PLACES": "cores", "OMP_WAIT_POLICY": "active"}
CONTEXT = ("date", "num_cpus", "commit", "compiler", "cpu", "flags", "turns")
ROW = ("run_name", "run_type", "family_index", "repetitions", "label", "error_occurred", "error_message")
FIGURES = ("ns_per_step", "particles_per_s", "bonds_per_s", "part_of_port_limit", "hand_shake_ns", "x_oracle_O3",
           "x_oracle_Ofast", "difference_cm", "gain", "ns_per_particle_step", "x_papers_ball",
           "sweep_ns_per_particle_step", "sweep_x_papers_ball", "memory_bytes_per_s", "memory_ns_per_particle_step",
           "build_s")


def read(path):
    """The whole of it. InputError if it is none."""
    try:
        data = json.loads(Path(path).read_text(encoding="utf-8"))
        data["context"]["commit"]
        for run in data["benchmarks"]:
            for key in ("run_name", "run_type", "family_index"):
                run[key]
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise InputError(f"{path}: not a result of scripts/bench.sh or scripts/studies/large_balls.sh "
                         f"({type(error).__name__}: {error})") from error
    return data


def rows(data):
    """A row's name to its repetitions, in the order in which the rows were registered, not in which they ran."""
    found = {}
    for run in sorted(data["benchmarks"], key=lambda run: run["family_index"]):
        if run["run_type"] == "iteration":
            found.setdefault(run["run_name"], []).append(run)
    return found


def origin_text(context):
    return f"at commit {context['commit']}, {context['date']}, on {context['cpu']} ({context['num_cpus']} cores), " \
           f"{context['compiler']}, {context['flags']}"


def left_out_text(data):
    """What slim.py has taken out, as a paragraph."""
    gone = data["context"].get("left_out")
    if not gone:
        return ""
    return f"At this commit there were more rows, of what the program no longer has: {'; '.join(gone)}.\n\n"


def cell(value, form):
    """A number as text; a missing or non-finite one is a dash, never a plausible figure."""
    if not isinstance(value, (int, float)) or not math.isfinite(value):
        return "-"
    return format(value, form)


def write(data, path):
    """A line a repetition."""
    lines = ",\n".join("  " + json.dumps(run, ensure_ascii=False) for run in data["benchmarks"])
    context = json.dumps(data["context"], ensure_ascii=False)
    write_whole(Path(path), f'{{"context": {context},\n "benchmarks": [\n{lines}\n]}}\n')
