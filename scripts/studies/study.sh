# shellcheck shell=bash
# What the scripts that make results share; sourced at the repository's root.

# read_options SCRIPT "OWN..." "$@": sets out, dirty and rest, and ends the script if it is not to go on. OWN are the
# script's own options: a name for one with a value (--scenes NAMES sets scenes), and `rest` if it passes on what stands
# after --. The tree must be clean. SCRIPT's head is its help.
read_options() {
  local script=$1 own=" $2 " allowed='--out DIR, --allow-dirty' word
  shift 2
  for word in $own; do
    if [ "$word" = rest ]; then allowed+=', -- OPTIONS'; else allowed+=", --$word ${word^^}"; fi
  done
  out=results
  dirty=()
  rest=()
  while [ $# -gt 0 ]; do
    word=${1#--}
    case $1 in
      --allow-dirty) dirty=(--allow-dirty); shift ;;
      -h | --help) sed -n '2,/^[^#]/s/^# \?//p' "$script"; exit 0 ;;
      --) [[ $own == *' rest '* ]] || refuse "$script" "unknown option -- ($allowed)"
        shift
        rest=("$@")
        break ;;
      --*) [[ $word == out || $own == *" $word "* && $word != rest ]] ||
        refuse "$script" "unknown option $1 ($allowed)"
        [ -n "${2-}" ] || refuse "$script" "$1 needs a value ($allowed)"
        printf -v "$word" %s "$2"
        shift 2 ;;
      *) refuse "$script" "unknown option $1 ($allowed)" ;;
    esac
  done
  if [ ${#dirty[@]} = 0 ] && [ -n "$(git status --porcelain)" ]; then
    refuse "$script" 'the tree has uncommitted changes; results come from clean trees (--allow-dirty)'
  fi
}

refuse() {
  echo "$(basename "$1"): $2" >&2
  exit 2
}

# build TARGET...: what all of them begin with, once their options are good.
build() {
  local target
  scripts/install.sh
  for target in "$@"; do scripts/build.sh release "$target"; done
  mkdir -p runs
}

# study NAME SCENE OPTIONS OF bounce accuracy: runs/NAME-SCENE, and how long it took.
study() {
  local name=$1 scene=$2 start=$SECONDS
  shift 2
  build/release/bounce accuracy "$scene" --force --out "runs/$name-$scene" "$@" > /dev/null
  printf '%s.sh: %s took %d s\n' "$name" "$scene" $((SECONDS - start))
}

# benchmark PROGRAM FILE OPTION...: a Google Benchmark's JSON, cut down to what tables are made from. Threads stay on
# their cores and spin between regions.
benchmark() {
  local program=$1 file=$2
  shift 2
  OMP_PROC_BIND=close OMP_PLACES=cores OMP_WAIT_POLICY=active \
    "build/release/$program" --benchmark_out="$file" --benchmark_out_format=json "$@"
  scripts/studies/slim.py "$file"
}

# After new results in results/: README's numbers and the index follow them.
follow() {
  if [ "$out" != results ]; then return; fi
  scripts/readme_numbers.py
  scripts/studies/index.py
}
