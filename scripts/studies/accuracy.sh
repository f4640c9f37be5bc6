#!/usr/bin/env bash
# Error against run time of the seven examples: results/accuracy.md (the table, which goes into README, too) and
# results/accuracy/ (all rows, pictures). From a clean tree only. A quarter of an hour a scene on 2 cores; those
# that --scenes leaves out stay in the table as they are.
#   scripts/accuracy.sh [--out DIR] [--allow-dirty] [--scenes "example-1 ..."] [-- OPTIONS OF bounce accuracy]
set -euo pipefail
invoked=$(realpath "$0")
cd "$(dirname "$0")/.."
source scripts/studies.sh

scenes="example-1 example-2 example-3 example-4 example-5 example-6 example-7"
read_options "$invoked" 2,5 "$@"

build_bounce
for scene in $scenes; do study accuracy "$scene" "${rest[@]}"; done
# shellcheck disable=SC2086 # names
scripts/accuracy.py --runs runs --out "$out" "${dirty[@]}" $scenes
if [ "$out" = results ]; then scripts/update_readme.py; fi
