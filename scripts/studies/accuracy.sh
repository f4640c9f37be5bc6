#!/usr/bin/env bash
# Error against run time of the seven examples: results/accuracy.md (the table) and results/accuracy/ (all rows,
# pictures). From a clean tree only. A quarter of an hour a scene on 2 cores; those that --scenes leaves out stay in
# the table as they are.
#   scripts/studies/accuracy.sh [--out DIR] [--allow-dirty] [--scenes "example-1 ..."] [-- OPTIONS OF bounce accuracy]
set -euo pipefail
invoked=$(realpath "$0")
cd "$(dirname "$invoked")/../.."
source scripts/studies/study.sh

scenes="example-1 example-2 example-3 example-4 example-5 example-6 example-7"
read_options "$invoked" 'scenes rest' "$@"

build bounce
for scene in $scenes; do study accuracy "$scene" "${rest[@]}"; done
# shellcheck disable=SC2086 # names
scripts/studies/accuracy.py --runs runs --out "$out" "${dirty[@]}" $scenes
follow
