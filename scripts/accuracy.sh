#!/usr/bin/env bash
# Error against run time of the seven examples: results/accuracy.md (the table, which goes into README, too) and
# results/accuracy/ (all rows, pictures). From a clean tree only. Some minutes a scene on 2 cores.
#   scripts/accuracy.sh [--out DIR] [--allow-dirty] [--scenes "example-1 ..."] [-- OPTIONS OF bounce accuracy]
set -euo pipefail
cd "$(dirname "$0")/.."

out=results
dirty=()
scenes="example-1 example-2 example-3 example-4 example-5 example-6 example-7"
while [ $# -gt 0 ]; do
  case $1 in
    --out) out=${2:?--out needs a folder}; shift 2 ;;
    --allow-dirty) dirty=(--allow-dirty); shift ;;
    --scenes) scenes=${2:?--scenes needs names}; shift 2 ;;
    --) shift; break ;;
    -h|--help) sed -n '2,4s/^# \?//p' "$0"; exit 0 ;;
    *) echo "accuracy.sh: unknown option $1 (--out DIR, --allow-dirty, --scenes NAMES, -- OPTIONS)" >&2; exit 2 ;;
  esac
done
if [ ${#dirty[@]} = 0 ] && [ -n "$(git status --porcelain)" ]; then
  echo "accuracy.sh: the tree has uncommitted changes; results come from clean trees (--allow-dirty)" >&2
  exit 2
fi

scripts/install.sh
scripts/build.sh release bounce
mkdir -p runs
for scene in $scenes; do
  start=$SECONDS
  build/release/bounce accuracy "$scene" --force --out "runs/accuracy-$scene" "$@" > /dev/null
  printf 'accuracy.sh: %s took %d s\n' "$scene" $((SECONDS - start))
done
# shellcheck disable=SC2086 # names
scripts/accuracy.py --runs runs --out "$out" "${dirty[@]}" $scenes
if [ "$out" = results ]; then scripts/update_readme.py; fi
