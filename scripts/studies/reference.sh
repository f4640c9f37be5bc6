#!/usr/bin/env bash
# The reference solutions of the seven examples as data: results/reference/ (of each the course's observables with
# error bars and origin, the ball just before the impact and at the end) and results/reference.md (the table). From a
# clean tree only. Some ten minutes on 2 cores.
#   scripts/studies/reference.sh [--out DIR] [--allow-dirty] [--scenes "example-1 ..."] [-- OPTIONS OF bounce reference]
set -euo pipefail
invoked=$(realpath "$0")
cd "$(dirname "$invoked")/../.."
source scripts/studies/study.sh

scenes="example-1 example-2 example-3 example-4 example-5 example-6 example-7"
read_options "$invoked" 'scenes rest' "$@"

build bounce
for scene in $scenes; do
  build/release/bounce reference "$scene" --force --out "runs/reference-$scene" "${rest[@]}" > /dev/null
done
# shellcheck disable=SC2086 # names
scripts/studies/reference.py --out "$out" "${dirty[@]}" $scenes
follow
