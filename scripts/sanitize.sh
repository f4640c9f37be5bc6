#!/usr/bin/env bash
# The kernels under the sanitizers: builds the presets asan-ubsan (addresses and undefined behaviour)
# and tsan (data races), or those named, and runs the tests of the kernels, of the conservative method
# and of the baselines. Slow: under asan-ubsan the kernels are not optimised. Exit code 0 only if all pass.
#   scripts/sanitize.sh [-h] [asan-ubsan] [tsan]
set -euo pipefail
cd "$(dirname "$0")/.."

presets=("$@")
((${#presets[@]})) || presets=(asan-ubsan tsan)
for preset in "${presets[@]}"; do
  case $preset in
    asan-ubsan) ;;
    tsan)
      # GCC's own OpenMP is opaque to the sanitizer, which then sees races where there are none.
      [[ -e /usr/lib/llvm-14/lib/libarcher.so ]] || {
        echo 'sanitize.sh: tsan needs an OpenMP that it can see into: apt-get install libomp-14-dev' >&2
        exit 2
      } ;;
    -h | --help) sed -n '2,5s/^# \?//p' "$0"; exit 0 ;;
    *) echo "sanitize.sh: unknown preset $preset (asan-ubsan, tsan)" >&2; exit 2 ;;
  esac
done

scripts/install.sh
failed=()
for preset in "${presets[@]}"; do
  scripts/build.sh "$preset" sanitized_tests
  for which in '-L kernels' '-R ^(Conservative|GslJacobian)[.]|Baseline'; do
    # shellcheck disable=SC2086 # option and value
    ctest --preset "$preset" --no-tests=error $which || failed+=("$preset, ctest $which")
  done
done
((${#failed[@]} == 0)) || { printf 'sanitize.sh: failed: %s\n' "${failed[@]}" >&2; exit 1; }
