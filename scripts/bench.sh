#!/usr/bin/env bash
# The throughput benchmark on 2 cores: results/throughput.json (raw, with its origin) and
# results/throughput.md (the table), and what leaving out saves: results/left_out.json and .md. Both
# tables go into README, too. From a clean tree only, on an otherwise idle machine.
#   scripts/bench.sh [--out DIR] [--allow-dirty] [-- BENCHMARK_OPTIONS]
#   scripts/bench.sh --compare A B    two such results, or two commits: faster, slower, not told apart
set -euo pipefail
cd "$(dirname "$0")/.."

out=results
dirty=no
while [ $# -gt 0 ]; do
  case $1 in
    --out) out=${2:?--out needs a folder}; shift 2 ;;
    --allow-dirty) dirty=yes; shift ;;
    --compare)
      shift
      script=$PWD/scripts/bench_compare.py
      cd "$OLDPWD" # where the user's files are named from
      exec "$script" "$@"
      ;;
    --) shift; break ;;
    -h|--help) sed -n '2,6s/^# \?//p' "$0"; exit 0 ;;
    *) echo "bench.sh: unknown option $1 (--out DIR, --allow-dirty, --compare A B, -- BENCHMARK_OPTIONS)" >&2; exit 2 ;;
  esac
done
if [ "$dirty" = no ] && [ -n "$(git status --porcelain)" ]; then
  echo "bench.sh: the tree has uncommitted changes; results come from clean trees (--allow-dirty)" >&2
  exit 2
fi

scripts/install.sh
scripts/build.sh release bounce_bench
scripts/build.sh release bounce_left_out

mkdir -p "$out"
# measure NAME PROGRAM TABLE OPTION...: results NAME.json and NAME.md, whole or not at all.
measure() {
  local name=$1 program=$2 table=$3
  shift 3
  # Threads stay on their cores and spin between regions.
  OMP_PROC_BIND=close OMP_PLACES=cores OMP_WAIT_POLICY=active \
    "build/release/$program" --benchmark_out="$out/.$name.json" --benchmark_out_format=json \
    --benchmark_repetitions=15 --benchmark_enable_random_interleaving=true "$@"
  "scripts/$table" "$out/.$name.json" > "$out/.$name.md"
  mv "$out/.$name.json" "$out/$name.json"
  mv "$out/.$name.md" "$out/$name.md"
}
measure throughput bounce_bench bench_table.py "$@"
measure left_out bounce_left_out left_out_table.py "$@"
if [ "$out" = results ]; then scripts/update_readme.py; fi
echo "bench.sh: $out/throughput.{json,md}, $out/left_out.{json,md}"
