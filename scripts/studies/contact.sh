#!/usr/bin/env bash
# The contact rules as the step goes to 0, down to 1e-7 s: results/contact.md, .csv, .png. And how a small difference
# grows (bounce reference). From a clean tree only. Some ten minutes a scene on 2 cores.
#   scripts/studies/contact.sh [--out DIR] [--allow-dirty] [--scenes "example-1 ..."] [-- OPTIONS OF bounce accuracy]
set -euo pipefail
invoked=$(realpath "$0")
cd "$(dirname "$invoked")/../.."
source scripts/studies/study.sh

scenes="example-1 example-2 example-4 example-5 example-6"
read_options "$invoked" 'scenes rest' "$@"

build bounce
for scene in $scenes; do
  # From 0.9 of the stable step: 1.4e-3 s at E = 1000, 3.4e-4 s at 16000.
  decades=3
  if [ "$scene" = example-1 ]; then decades=3.5; fi
  # The steps that are compared, exactly, and the smallest.
  study contact "$scene" --methods listing,leapfrog --contacts listing,resolved \
    --steps 1e-4,1e-6,1e-7 --decades $decades --per-decade 2 "${rest[@]}"
  # And by a method whose own error at 1e-4 s is far below the contact's.
  study located "$scene" --methods leapfrog,blanes-moan-6 --contacts resolved,located \
    --steps 1e-4,1e-5 --decades 1.5 --per-decade 2 "${rest[@]}"
done
# example-3 has no study: it collapses.
for scene in $scenes example-3; do
  build/release/bounce reference "$scene" --force --out "runs/growth-$scene" > /dev/null
done
# shellcheck disable=SC2086 # names
scripts/studies/contact.py --out "$out" "${dirty[@]}" $scenes
follow
