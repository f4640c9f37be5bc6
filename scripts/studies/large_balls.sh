#!/usr/bin/env bash
# What a particle-step costs in balls of 360 to 10 million particles, beside a plain sweep through memory:
# results/large-balls.json (raw, with its origin), .md (the table, which goes into README, too), .png and .svg.
# From a clean tree only, on an otherwise idle machine; takes some ten minutes and 2 GB.
#   scripts/large_balls.sh [--out DIR] [--allow-dirty] [-- BENCHMARK_OPTIONS]
set -euo pipefail
cd "$(dirname "$0")/.."

out=results
dirty=no
while [ $# -gt 0 ]; do
  case $1 in
    --out) out=${2:?--out needs a folder}; shift 2 ;;
    --allow-dirty) dirty=yes; shift ;;
    --) shift; break ;;
    -h|--help) sed -n '2,5s/^# \?//p' "$0"; exit 0 ;;
    *) echo "large_balls.sh: unknown option $1 (--out DIR, --allow-dirty, -- BENCHMARK_OPTIONS)" >&2; exit 2 ;;
  esac
done
if [ "$dirty" = no ] && [ -n "$(git status --porcelain)" ]; then
  echo "large_balls.sh: the tree has uncommitted changes; results come from clean trees (--allow-dirty)" >&2
  exit 2
fi

scripts/install.sh
scripts/build.sh release bounce_bench_large

mkdir -p "$out"
partial=$(mktemp -d "$out/.large-balls-XXXXXX")
trap 'rm -rf "$partial"' EXIT
OMP_PROC_BIND=close OMP_PLACES=cores OMP_WAIT_POLICY=active \
  build/release/bounce_bench_large --benchmark_out="$partial/large-balls.json" \
  --benchmark_out_format=json --benchmark_repetitions=3 "$@"
scripts/large_balls.py "$partial/large-balls.json" "$partial"
mv "$partial"/large-balls.* "$out"
if [ "$out" = results ]; then scripts/update_readme.py; fi
echo "large_balls.sh: $out/large-balls.json, .md, .png and .svg"
