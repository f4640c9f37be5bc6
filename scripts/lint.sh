#!/usr/bin/env bash
# clang-format and clang-tidy on all sources, or on those named; needs build/ci (scripts/test.sh).
# Both come from Debian 12 (clang-format, clang-tidy: version 14). Some 15 minutes for everything.
set -euo pipefail
cd "$(dirname "$0")/.."

files=("$@")
((${#files[@]})) || mapfile -t files < <(git ls-files '*.cpp')
git ls-files '*.cpp' '*.hpp' | xargs clang-format --dry-run --Werror
# clang does not know these two of GCC's.
mkdir -p build/ci/lint
sed 's/ -fschedule-insns//; s/ -fsched-pressure//' build/ci/compile_commands.json \
  > build/ci/lint/compile_commands.json
printf '%s\n' "${files[@]}" | xargs -P "$(nproc)" -n 1 clang-tidy -p build/ci/lint --quiet
