#!/usr/bin/env bash
# Looks for inputs that a reader of the program cannot bear: builds the fuzz targets (preset fuzz: clang,
# libFuzzer, address and undefined-behaviour sanitizers) and runs those named, or all, two at a time.
#   scripts/fuzz.sh [-h] [SECONDS] [TARGET...]      SECONDS: of each target [60]
# What it learns stays in build/fuzz/learnt/TARGET for the next time; an input that is a finding in
# build/fuzz/findings. A line a target. Exit code 0: nothing found; 1: a crash, a hang (10 s), a leak, a
# broken promise or too much memory (64 MB at once, 1 GB in all); 3: clang or its libraries are not here.
set -euo pipefail
cd "$(dirname "$0")/.."

case ${1-} in
  -h | --help) sed -n '2,9s/^# \?//p' "$0"; exit 0 ;;
esac
seconds=60
if [[ ${1-} =~ ^[0-9]+$ ]]; then
  seconds=$1
  shift
fi
sources=verify/tests/fuzz
mapfile -t all < <(cd "$sources/corpus" && printf '%s\n' *)
targets=("$@")
((${#targets[@]})) || targets=("${all[@]}")
for target in "${targets[@]}"; do
  [[ -d $sources/corpus/$target ]] || {
    echo "fuzz.sh: no target $target; allowed are ${all[*]}, after a number of seconds or without" >&2
    exit 2
  }
done

if ! printf '#include <omp.h>\nextern "C" int LLVMFuzzerTestOneInput(const char*, unsigned long) { return 0; }\n' |
  clang++ -fsanitize=fuzzer,address,undefined -fopenmp -x c++ - -o /dev/null 2>/dev/null; then
  echo 'fuzz.sh: skipped: clang++ or its libraries are not here: apt-get install clang libclang-rt-14-dev libomp-14-dev'
  exit 3
fi
scripts/build.sh fuzz fuzz_targets

# Runs one target; what it has to say goes into a line, and, if it failed, its last lines with it.
run() {
  local target=$1 log=build/fuzz/$1.log learnt=build/fuzz/learnt/$1 words=() code=0
  mkdir -p "$learnt" build/fuzz/findings
  [[ ! -e $sources/$target.dict ]] || words=("-dict=$sources/$target.dict")
  "build/fuzz/fuzz_$target" -max_total_time="$seconds" -timeout=10 -malloc_limit_mb=64 \
    -rss_limit_mb=1024 -max_len=4096 -print_final_stats=1 -verbosity=1 "${words[@]}" \
    -artifact_prefix="build/fuzz/findings/$target-" "$learnt" "$sources/corpus/$target" >"$log" 2>&1 || code=$?
  local runs
  runs=$(sed -n 's/^stat::number_of_executed_units: *//p' "$log")
  if ((code == 0)); then
    echo "fuzz.sh: $target: nothing found in ${runs:-?} inputs, $seconds s"
  else
    tail -n 40 "$log"
    echo "fuzz.sh: $target: FOUND something ($log; the input is in build/fuzz/findings)"
    return 1
  fi
}

# Of a script the shell lets processes in the background ignore Ctrl-C.
trap 'kill $(jobs -p) 2>/dev/null || true' EXIT
failed=0
for ((i = 0; i < ${#targets[@]}; i += 2)); do
  running=()
  for target in "${targets[@]:i:2}"; do
    run "$target" &
    running+=($!)
  done
  for process in "${running[@]}"; do wait "$process" || failed=1; done
done
exit "$failed"
