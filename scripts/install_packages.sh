#!/usr/bin/env bash
# Installs those of the named packages that this machine lacks, from the
# distribution: install_packages.sh PACKAGE...  Safe to run again; root or sudo.
set -euo pipefail

missing=()
for package in "$@"; do
  dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep -q 'install ok installed' || missing+=("$package")
done
[ ${#missing[@]} -eq 0 ] && exit 0

as_root=()
if [ "$(id -u)" -ne 0 ]; then
  command -v sudo >/dev/null || { echo "install_packages.sh: needs root or sudo to install: ${missing[*]}" >&2; exit 4; }
  as_root=(sudo)
fi
echo "install_packages.sh: installing ${missing[*]}"
export DEBIAN_FRONTEND=noninteractive
"${as_root[@]}" apt-get update -q
"${as_root[@]}" apt-get install -y -q --no-install-recommends "${missing[@]}"
