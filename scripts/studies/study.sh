# Sourced by accuracy.sh, contact.sh and reference.sh, at the repository's root: `read_options "$0" HELP_LINES "$@"` sets out,
# dirty, scenes (if --scenes is given) and rest (what stands after --), or ends the script; the tree must be clean.
read_options() {
  local script=$1 help_lines=$2 name
  name=$(basename "$script")
  shift 2
  out=results
  dirty=()
  while [ $# -gt 0 ]; do
    case $1 in
      --out) out=${2:?--out needs a folder}; shift 2 ;;
      --allow-dirty) dirty=(--allow-dirty); shift ;;
      --scenes) scenes=${2:?--scenes needs names}; shift 2 ;;
      --) shift; break ;;
      -h|--help) sed -n "${help_lines}s/^# \?//p" "$script"; exit 0 ;;
      *) echo "$name: unknown option $1 (--out DIR, --allow-dirty, --scenes NAMES, -- OPTIONS)" >&2; exit 2 ;;
    esac
  done
  rest=("$@")
  if [ ${#dirty[@]} = 0 ] && [ -n "$(git status --porcelain)" ]; then
    echo "$name: the tree has uncommitted changes; results come from clean trees (--allow-dirty)" >&2
    exit 2
  fi
}

# What all of them begin with, once their options are good.
build_bounce() {
  scripts/install.sh
  scripts/build.sh release bounce
  mkdir -p runs
}

# study NAME SCENE OPTIONS OF bounce accuracy: runs/NAME-SCENE, and how long it took.
study() {
  local name=$1 scene=$2 start=$SECONDS
  shift 2
  build/release/bounce accuracy "$scene" --force --out "runs/$name-$scene" "$@" > /dev/null
  printf '%s.sh: %s took %d s\n' "$name" "$scene" $((SECONDS - start))
}
