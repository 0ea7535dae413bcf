#!/usr/bin/env bash
# Which kernels spill registers on an Orin (sm_87), and how many bytes:
#   scripts/check_spills.sh [MOST]
# Fails where one spills more than MOST bytes (default 96: a rasterize_tiles spills 92). Compiles
# every kernel, which takes minutes. Needs nvcc, no GPU.
set -euo pipefail
if [[ ${1:-} == --help ]]; then
  sed -n '2,5s/^# \?//p' "$0"
  exit 0
fi
most=${1:-96}
if (($# > 1)) || [[ ! $most =~ ^[0-9]+$ ]]; then
  echo "check_spills.sh: found '$*', expected a number of bytes, or nothing" >&2
  exit 2
fi
cd "$(dirname "$0")/.."
nvcc=$(scripts/check_cuda_module.sh --nvcc) || { echo "check_spills.sh: found no nvcc, expected one" >&2; exit 1; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# The flags are those of cuda/CMakeLists.txt.
compile() {
  "$1" -I. -O3 -DNDEBUG -std=c++20 --expt-relaxed-constexpr -Xcompiler=-fPIC,-ffp-contract=off \
    --generate-code=arch=compute_87,code='[sm_87]' -Xptxas -v -c "$3" -o "$2/$(basename "$3").o" 2>"$2/$(basename "$3").log" ||
    { cat "$2/$(basename "$3").log" >&2; exit 255; }
}
export -f compile
ls cuda/*/*.cu | xargs -P "$(nproc)" -I{} bash -c 'compile "$@"' _ "$nvcc" "$work" {}

# ptxas names a kernel, then its stack and spills, then its registers.
awk -v most="$most" '
  /Compiling entry function/ { split($0, name, "\047"); kernel = name[2] }
  /bytes spill stores/ { if ($5 + 0 > spills) spills = $5 + 0 }
  /Used [0-9]+ registers/ {
    for (i = 1; i < NF; ++i) if ($i == "Used") registers = $(i + 1)
    ++kernels
    if (spills > 0) printf "%4d bytes spilled, %3d registers: %s\n", spills, registers, kernel
    if (spills > most) bad = 1
    spills = 0
  }
  END {
    printf "%d kernels for sm_87\n", kernels
    if (kernels == 0) { print "check_spills.sh: found no kernel, expected some" > "/dev/stderr"; exit 1 }
    if (bad) { printf "check_spills.sh: found a kernel that spills more than %d bytes, expected none\n", most > "/dev/stderr"; exit 1 }
  }' "$work"/*.log
