#!/usr/bin/env bash
# Compares what the headers promise with the recorded description of the last release: check_abi.sh
# With --record it then writes the description of this tree in its place, for a release; one that breaks the
# last is written only once that is deleted, with a new major version. Needs libabigail (scripts/setup.sh checks)
# and fails without it. Exports, sizes and offsets are pinned by tests/abi as well; this also sees the type of a
# parameter or of a field change.
# The kept headers of 1.0 are compared with their checksums: they are what hosts were built with.
set -euo pipefail
cd "$(dirname "$0")/.."
recorded=tests/abi/recorded/voyager.abi
(cd tests/abi/header_1.0 && sha256sum --quiet --check SHA256SUMS) || {
  echo "check_abi.sh: tests/abi/header_1.0: found other headers than 1.0's, expected them as they were released" >&2
  exit 1
}
command -v abidiff >/dev/null && command -v abidw >/dev/null ||
  { echo "check_abi.sh: found no abidiff or no abidw, expected both: scripts/setup.sh checks installs them (abigail-tools)" >&2; exit 1; }

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
# A library whose variables have the type of each function and structure: libabigail reads types from the
# debug information of what is exported, and structures in a `next` are behind no function.
{
  echo '#include <voyager/voyager_experiment.h>'
  echo '#include <voyager/voyager_vulkan.h>'
  sed 's/.*/PFN_& type_of_&;/' tests/abi/exports.txt
  sed -n 's/^\(Voy[A-Za-z]*\) .*/\1 a_\1;/p' tests/abi/layout.txt
} >"$folder/types.c"
gcc -std=c99 -g -O0 -shared -fPIC -fno-eliminate-unused-debug-types -ffile-prefix-map="$folder/=" -Iplugin/include "$folder/types.c" -o "$folder/libvoyager_types.so"

# The description has no places of declarations. With --headers-dir2 or --drop-private-types abidiff would take its
# types for private ones, and pass over a field whose type changed.
if [ -e "$recorded" ] &&
  ! abidiff --no-added-syms --suppressions tests/abi/recorded/outside_the_promise.ini \
    "$recorded" "$folder/libvoyager_types.so"; then
  echo "check_abi.sh: the headers break what $recorded promises until the major version changes" >&2
  exit 1
fi
if [ "${1:-}" = --record ]; then
  abidw --headers-dir plugin/include --drop-private-types --no-show-locs --no-corpus-path --no-comp-dir-path \
    --type-id-style hash --out-file "$recorded" "$folder/libvoyager_types.so"
  echo "check_abi.sh: recorded $(wc -c <"$recorded") bytes in $recorded"
  exit 0
fi
[ -e "$recorded" ] || { echo "check_abi.sh: $recorded: found no file, expected the last release's description" >&2; exit 1; }
echo "check_abi.sh: the headers keep what $recorded promises"
