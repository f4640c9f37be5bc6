#!/usr/bin/env bash
# Installs the Debian packages of packages.txt that are missing; does nothing if none is.
set -euo pipefail
cd "$(dirname "$0")"

fail() {
  printf 'install.sh: %s\n' "$*" >&2
  exit 1
}

missing=()
while read -r package; do
  status=$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null) || status=
  [[ $status == installed ]] || missing+=("$package")
done < <(sed -e 's/#.*//' -e '/^[[:space:]]*$/d' packages.txt)
((${#missing[@]})) || exit 0

by_hand="install them by hand:
  apt-get install ${missing[*]}"
printf 'Installing %d Debian packages: %s\n' "${#missing[@]}" "${missing[*]}"
command -v apt-get >/dev/null ||
  fail "no apt-get here; on Debian 12 the packages are ${missing[*]}.
With their like in place: cmake --preset release && cmake --build --preset release"
as_root=(env DEBIAN_FRONTEND=noninteractive)
if ((EUID != 0)); then
  command -v sudo >/dev/null || fail "neither root nor sudo; as root, $by_hand"
  as_root=(sudo "${as_root[@]}")
fi
"${as_root[@]}" apt-get update -qq || fail "apt-get update failed (its reason is above); $by_hand"
"${as_root[@]}" apt-get install -y -qq --no-install-recommends "${missing[@]}" ||
  fail "apt-get install failed (its reason is above); $by_hand"
