#!/usr/bin/env bash
# The throughput benchmark on 2 cores: results/throughput.json (the figures, with their origin) and .md (the table),
# and what leaving out saves: results/left_out.json and .md. From a clean tree only, on an otherwise idle machine.
#   scripts/bench.sh [--out DIR] [--allow-dirty] [-- BENCHMARK_OPTIONS]
#   scripts/bench.sh --compare A B    two such results, or two commits: faster, slower, not told apart
set -euo pipefail
invoked=$(realpath "$0")
if [ "${1-}" = --compare ]; then # A and B are named from where the user stands
  shift
  exec "$(dirname "$invoked")/bench/bench_compare.py" "$@"
fi
cd "$(dirname "$invoked")/.."
source scripts/studies/study.sh

read_options "$invoked" rest "$@"

build bounce_bench bounce_left_out
mkdir -p "$out"
# measure NAME PROGRAM TABLE OPTION...: results NAME.json and NAME.md, whole or not at all.
measure() {
  local name=$1 program=$2 table=$3
  shift 3
  benchmark "$program" "$out/.$name.json" --benchmark_repetitions=15 --benchmark_enable_random_interleaving=true "$@"
  "scripts/bench/$table" "$out/.$name.json" > "$out/.$name.md"
  mv "$out/.$name.json" "$out/$name.json"
  mv "$out/.$name.md" "$out/$name.md"
}
measure throughput bounce_bench bench_table.py "${rest[@]}"
measure left_out bounce_left_out left_out_table.py "${rest[@]}"
follow
echo "bench.sh: $out/throughput.{json,md}, $out/left_out.{json,md}"
