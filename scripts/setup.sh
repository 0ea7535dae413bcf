#!/usr/bin/env bash
# Installs what the build, the tests and the samples need and this machine
# lacks, from the distribution's packages. Safe to run again; root or sudo.
set -euo pipefail

packages=(
  g++ cmake ninja-build binutils git                     # the build
  libtbb-dev zlib1g-dev libzstd-dev libxxhash-dev        # runtime
  libeigen3-dev
  libpng-dev libfmt-dev nlohmann-json3-dev libcli11-dev  # tools and samples
  libgtest-dev libbenchmark-dev                          # tests and benchmarks
  clang-format clang-tidy                                # checks
  python3
)

missing=()
for package in "${packages[@]}"; do
  dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep -q 'install ok installed' || missing+=("$package")
done
[ ${#missing[@]} -eq 0 ] && exit 0

as_root=()
if [ "$(id -u)" -ne 0 ]; then
  command -v sudo >/dev/null || { echo "setup.sh: needs root or sudo to install: ${missing[*]}" >&2; exit 4; }
  as_root=(sudo)
fi
echo "setup.sh: installing ${missing[*]}"
export DEBIAN_FRONTEND=noninteractive
"${as_root[@]}" apt-get update -q
"${as_root[@]}" apt-get install -y -q --no-install-recommends "${missing[@]}"
