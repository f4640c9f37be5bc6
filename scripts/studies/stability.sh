#!/usr/bin/env bash
# The edge of stability: sweeps of Examples 1 and 2 over E, the seven examples and harder throws as runs, two pictures
# and the tables, in results/stability and results/stability.md. From a clean tree only. Some 10 minutes on 2 cores,
# and 3 more where runs/ lacks the examples. Stopped, it goes on where it was when it is started again.
#   scripts/studies/stability.sh [--out DIR] [--allow-dirty] [--count N]
set -euo pipefail
invoked=$(realpath "$0")
cd "$(dirname "$invoked")/../.."
source scripts/studies/study.sh

count=33 # four values of E a decade
read_options "$invoked" count "$@"

scripts/start.sh # builds; the seven examples in runs/

bounce=build/release/bounce
mkdir -p "$out"
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

scripts/studies/stability.py --runs runs --out "$out" "${dirty[@]}"
follow
