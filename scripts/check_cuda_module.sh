#!/usr/bin/env bash
# Fails where this machine has nvcc and the CUDA module was not built: check_cuda_module.sh BUILD_FOLDER.
# check_cuda_module.sh --nvcc prints the nvcc that the build finds, and fails where there is none.
set -euo pipefail
cd "$(dirname "$0")/.."

find_nvcc() {
  local nvcc
  for nvcc in "${CUDACXX:-}" nvcc "${CUDA_PATH:-/usr/local/cuda}/bin/nvcc" /usr/local/cuda/bin/nvcc; do
    [ -n "$nvcc" ] && command -v "$nvcc" && return
  done
  return 1
}

if [ "$1" = --nvcc ]; then
  find_nvcc
  exit
fi
module=$1/lib/libvoyager_cuda.so
found=$(find_nvcc) || { echo "check_cuda_module.sh: no nvcc here, so no CUDA module is expected"; exit 0; }
[ -e "$module" ] || { echo "check_cuda_module.sh: $module: not found, expected because $found exists" >&2; exit 1; }
