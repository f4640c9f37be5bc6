#!/usr/bin/env bash
# Tests everything: installs what is missing, checks the rules of the house and README's numbers, builds
# with warnings as errors, compares the kernels with the oracle (bounce verify --quick), searches with each
# fuzz target for a minute, then runs all tests. At its end it says how many passed and which were skipped.
# Exit code 0 only if all of it holds.
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/install.sh
failed=()
scripts/check_house.py || failed+=('check_house.py (its lines are at the top)')
scripts/readme_numbers.py --check || failed+=('readme_numbers.py --check (its lines are at the top)')
scripts/build.sh ci
build/ci/bounce verify --quick || failed+=('bounce verify --quick (its table is above the tests)')
fuzzed=0
scripts/fuzz.sh 60 || fuzzed=$?
((fuzzed == 0 || fuzzed == 3)) || failed+=('fuzz.sh (its lines are above)')
rm -f build/ci/ctest.xml
ctest --preset ci -j2 --output-junit ctest.xml || failed+=(ctest)
# ctest counts skipped tests among those that passed.
scripts/test_summary.py build/ci/ctest.xml || failed+=('test_summary.py (its lines are the last)')
((fuzzed != 3)) || echo 'test.sh: skipped: the fuzz targets, as clang is not here'
if ((${#failed[@]})); then
  printf 'test.sh: failed: %s\n' "${failed[@]}" >&2
  exit 1
fi
