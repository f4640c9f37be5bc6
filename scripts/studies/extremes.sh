#!/usr/bin/env bash
# Stiff and extreme scenes, each with what it should do: results/extremes.md (the table, which goes into README, too)
# and results/extremes.csv. About a minute on 2 cores. From a clean tree only.
#   scripts/extremes.sh [--out DIR] [--allow-dirty] [-- OPTIONS OF bounce extremes]
set -euo pipefail
cd "$(dirname "$0")/.."

out=results
dirty=no
while [ $# -gt 0 ]; do
  case $1 in
    --out) out=${2:?--out needs a folder}; shift 2 ;;
    --allow-dirty) dirty=yes; shift ;;
    --) shift; break ;;
    -h|--help) sed -n '2,4s/^# \?//p' "$0"; exit 0 ;;
    *) echo "extremes.sh: unknown option $1 (--out DIR, --allow-dirty, -- OPTIONS OF bounce extremes)" >&2; exit 2 ;;
  esac
done
if [ "$dirty" = no ] && [ -n "$(git status --porcelain)" ]; then
  echo "extremes.sh: the tree has uncommitted changes; results come from clean trees (--allow-dirty)" >&2
  exit 2
fi

scripts/install.sh
scripts/build.sh release bounce
# A table with a failed row is written, too; the script then ends as the program does.
code=0
build/release/bounce extremes --out "$out" "$@" || code=$?
if [ "$out" = results ] && [ -f results/extremes.md ]; then scripts/update_readme.py; fi
echo "extremes.sh: $out/extremes.md and $out/extremes.csv"
exit $code
