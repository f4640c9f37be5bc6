#!/usr/bin/env bash
# The two contact rules as the step goes to 0, below 1e-7 s: results/contact.md (and README), .csv, .png.
# From a clean tree only. Some ten minutes a scene on 2 cores.
#   scripts/contact.sh [--out DIR] [--allow-dirty] [--scenes "example-1 ..."] [-- OPTIONS OF bounce accuracy]
set -euo pipefail
cd "$(dirname "$0")/.."

out=results
dirty=()
scenes="example-1 example-2 example-4 example-5 example-6"
while [ $# -gt 0 ]; do
  case $1 in
    --out) out=${2:?--out needs a folder}; shift 2 ;;
    --allow-dirty) dirty=(--allow-dirty); shift ;;
    --scenes) scenes=${2:?--scenes needs names}; shift 2 ;;
    --) shift; break ;;
    -h|--help) sed -n '2,4s/^# \?//p' "$0"; exit 0 ;;
    *) echo "contact.sh: unknown option $1 (--out DIR, --allow-dirty, --scenes NAMES, -- OPTIONS)" >&2; exit 2 ;;
  esac
done
if [ ${#dirty[@]} = 0 ] && [ -n "$(git status --porcelain)" ]; then
  echo "contact.sh: the tree has uncommitted changes; results come from clean trees (--allow-dirty)" >&2
  exit 2
fi

scripts/build.sh release bounce
mkdir -p runs
for scene in $scenes; do
  # From 0.9 of the stable step: 1.4e-3 s at E = 1000, 3.4e-4 s at 16000.
  decades=4
  if [ "$scene" = example-1 ]; then decades=4.5; fi
  build/release/bounce accuracy "$scene" --methods listing,leapfrog --decades $decades --per-decade 2 --force \
    --out "runs/contact-$scene" "$@" > /dev/null
done
build/release/bounce reference example-3 --force --out runs/contact-growth > /dev/null
# shellcheck disable=SC2086 # names
scripts/contact.py --out "$out" "${dirty[@]}" $scenes
if [ "$out" = results ]; then scripts/update_readme.py; fi
