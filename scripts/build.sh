#!/usr/bin/env bash
# build.sh PRESET [TARGET]: configures, the first time with Ninja if it is there, and builds TARGET,
# or everything, into build/PRESET.
set -euo pipefail
cd "$(dirname "$0")/.."

preset=${1:?usage: scripts/build.sh PRESET [TARGET], PRESET one of CMakePresets.json}
target=${2:-all}
generator=()
# A build folder keeps the generator it was made with.
if [[ ! -e build/$preset/CMakeCache.txt ]] && command -v ninja >/dev/null; then
  generator=(-G Ninja)
fi
printf 'Building build/%s\n' "$preset"
cmake --preset "$preset" "${generator[@]}" --log-level=WARNING
cmake --build --preset "$preset" --target "$target" -j "$(nproc)"
