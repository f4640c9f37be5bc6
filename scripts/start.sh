#!/usr/bin/env bash
# From a fresh clone to the paper's pictures: installs what is missing, builds, runs Example 2 and
# draws it, then the other six at full length, one on each core. A run that this commit has made of
# the same scene is kept.
#   scripts/start.sh           all examples: 111.5 million steps, a minute or two on 2 cores after the build
#   scripts/start.sh --quick   Example 2 alone
set -euo pipefail
cd "$(dirname "$0")/.."

fail() {
  printf 'start.sh: %s\n' "$*" >&2
  exit 1
}

quick=false
case "$*" in
  '') ;;
  --quick) quick=true ;;
  -h | --help)
    sed -n '2,6s/^# \{0,1\}//p' "$0"
    exit 0
    ;;
  *)
    printf 'start.sh: %s: allowed is --quick or nothing\n' "$*" >&2
    exit 2
    ;;
esac

bounce=build/release/bounce

# is_current SCENE: runs/SCENE is complete, of this commit, and the scene as it is built in. Of a
# changed tree nobody knows what made a run: it is made again.
is_current() {
  local run=runs/$1
  [[ $commit != *-dirty && $commit != unknown && -e $run/run.json ]] &&
    grep -qx '  "status": "complete",' "$run/run.json" &&
    grep -qx '  "initial": null,' "$run/run.json" &&
    grep -qx "    \"commit\": \"$commit\"," "$run/run.json" &&
    cmp -s "$run/scene.toml" <("$bounce" show "$1")
}

# keep_own SCENE: a run with other settings is the user's own; it gets a new name.
keep_own() {
  local run=runs/$1 number=1
  [[ -e $run/scene.toml ]] || return 0
  if cmp -s "$run/scene.toml" <("$bounce" show "$1") &&
    grep -qx '  "initial": null,' "$run/run.json"; then
    return 0
  fi
  while [[ -e $run.own-$number ]]; do number=$((number + 1)); done
  mv "$run" "$run.own-$number"
  printf '  %s: has other settings, kept as %s\n' "$run" "$run.own-$number"
}

# run_scene SCENE OPTION...: the run, its report only if it fails.
run_scene() {
  local scene=$1 report status=0 start=$SECONDS
  report=$("$bounce" run "$scene" --out "runs/$scene" --threads 1 --force 2>&1) || status=$?
  if ((status)); then
    printf '  %s: FAILED, exit code %d\n%s\n' "$scene" "$status" "$report" >&2
    return "$status"
  fi
  printf '  %s: done in %d s, %s\n' "$scene" $((SECONDS - start)) \
    "$(grep '^state hash' <<<"$report")"
}

run_all() {
  local failed=0 running=0 scene
  for scene in "$@"; do
    if ((running >= $(nproc))); then
      wait -n || failed=1
      running=$((running - 1))
    fi
    run_scene "$scene" &
    running=$((running + 1))
  done
  while ((running)); do
    wait -n || failed=1
    running=$((running - 1))
  done
  return "$failed"
}

scripts/install.sh
printf 'Building the program: 2 to 8 minutes the first time, by the machine\n'
scripts/build.sh release bounce
commit=$("$bounce" --version | sed -n '1s/.*(commit \(.*\))$/\1/p')
[[ -n $commit ]] || fail "$bounce --version names no commit"

# draw FIGURE...: into runs/, which git ignores: results/ holds what was made from a clean tree and
# committed. No FIGURE: all.
draw() {
  local only=()
  (($# == 0)) || only=(--only "$@")
  scripts/figures.py --runs runs --out runs/figures --allow-dirty "${only[@]}"
}

# run_missing SCENE...: those that are not there already.
run_missing() {
  local to_run=() scene
  for scene in "$@"; do
    if is_current "$scene"; then
      printf '  runs/%s: there already, by this commit; not run again\n' "$scene"
    else
      keep_own "$scene"
      to_run+=("$scene")
    fi
  done
  ((${#to_run[@]} == 0)) || run_all "${to_run[@]}" || fail "not every run is complete; no pictures drawn"
}

printf 'Running Example 2, 15 million steps: some seconds\n'
run_missing example-2
draw 1 2 3 4 7
printf 'Look at runs/figures/figure-07.png: Example 2 falls and bounces.\n'
if [[ $quick == false ]]; then
  printf 'Running the other six, 96.5 million steps: a minute or two\n'
  # The longest first, so that the cores finish together.
  run_missing example-7 example-4 example-5 example-6 example-1 example-3
  draw
  printf 'Look at the pictures in runs/figures.\n'
fi
printf 'Next: %s list; %s run --help\n' "$bounce" "$bounce"
