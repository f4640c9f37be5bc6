#!/usr/bin/env bash
# Stiff and extreme scenes, each with what it should do: results/extremes.md (the table) and results/extremes.csv.
# About a minute on 2 cores. From a clean tree only.
#   scripts/studies/extremes.sh [--out DIR] [--allow-dirty] [-- OPTIONS OF bounce extremes]
set -euo pipefail
invoked=$(realpath "$0")
cd "$(dirname "$invoked")/../.."
source scripts/studies/study.sh

read_options "$invoked" rest "$@"

build bounce
# A table with a failed row is written, too; the script then ends as the program does.
code=0
build/release/bounce extremes --out "$out" "${rest[@]}" || code=$?
follow
echo "extremes.sh: $out/extremes.md and $out/extremes.csv"
exit $code
