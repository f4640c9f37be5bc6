#!/usr/bin/env bash
# The edge of stability: sweeps of Examples 1 and 2 over E, the seven examples and harder throws as
# runs, two pictures and the tables for README, in results/stability and results/stability.md. From a
# clean tree only. Some 10 minutes on 2 cores, and 3 more where runs/ lacks the examples. Stopped, it
# goes on where it was when it is started again.
#   scripts/stability.sh [--out DIR] [--allow-dirty] [--count N]
set -euo pipefail
cd "$(dirname "$0")/.."

out=results
dirty=()
count=33 # four values of E a decade
while [ $# -gt 0 ]; do
  case $1 in
    --out) out=${2:?--out needs a folder}; shift 2 ;;
    --allow-dirty) dirty=(--allow-dirty); shift ;;
    --count) count=${2:?--count needs a number}; shift 2 ;;
    -h|--help) sed -n '2,6s/^# \?//p' "$0"; exit 0 ;;
    *) echo "stability.sh: unknown option $1 (--out DIR, --allow-dirty, --count N)" >&2; exit 2 ;;
  esac
done
if [ ${#dirty[@]} = 0 ] && [ -n "$(git status --porcelain)" ]; then
  echo "stability.sh: the tree has uncommitted changes; results come from clean trees (--allow-dirty)" >&2
  exit 2
fi

scripts/start.sh # builds; the seven examples in runs/

bounce=build/release/bounce
mkdir -p "$out/stability"
map_start=$SECONDS
for scene in example-1 example-2; do
  # In flight the two differ by E alone, which scales: great vibrations are looked at in one.
  more=()
  [ "$scene" = example-1 ] || more=(--no-disturbed)
  # Under runs/ until all is there.
  start=$SECONDS
  printf 'Sweeping %s\n' "$scene"
  [ -e "runs/sweep-$scene.part" ] || rm -rf "runs/sweep-$scene"
  "$bounce" stability "$scene" --count "$count" "${more[@]}" --out "runs/sweep-$scene"
  printf 'stability.sh: %s took %d s\n' "$scene" $((SECONDS - start))
done
printf 'stability.sh: the map took %d s\n' $((SECONDS - map_start))

# Example 1 from just above its wall, at the speed of its fall and thrown harder.
for speed in 0.767 3 10; do
  "$bounce" run example-1 --quiet --force --t-end 8 --out "runs/throw-$speed" \
    --set 'ball.centre=[0.0, 7.01]' --set "ball.velocity=[0.0, -$speed]" --set output.frames_every=8
done

scripts/stability.py --runs runs --out "$out" "${dirty[@]}"
if [ "$out" = results ]; then scripts/update_readme.py; fi
