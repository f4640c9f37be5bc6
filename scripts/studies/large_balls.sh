#!/usr/bin/env bash
# What a particle-step costs in balls of 360 to 10 million particles, beside a plain sweep through memory:
# results/large-balls.json (the figures, with their origin), .md (the table) and .png. From a clean tree only, on an
# otherwise idle machine; takes some ten minutes and 2 GB.
#   scripts/studies/large_balls.sh [--out DIR] [--allow-dirty] [-- BENCHMARK_OPTIONS]
set -euo pipefail
invoked=$(realpath "$0")
cd "$(dirname "$invoked")/../.."
source scripts/studies/study.sh

read_options "$invoked" rest "$@"

build bounce_bench_large
mkdir -p "$out"
partial=$(mktemp -d "$out/.large-balls-XXXXXX")
trap 'rm -rf "$partial"' EXIT
benchmark bounce_bench_large "$partial/large-balls.json" --benchmark_repetitions=3 "${rest[@]}"
scripts/studies/large_balls.py "$partial/large-balls.json" "$partial"
mv "$partial"/large-balls.* "$out"
follow
echo "large_balls.sh: $out/large-balls.json, .md and .png"
