#!/usr/bin/env bash
# Fails where this machine has nvcc and the CUDA module was not built:
# check_cuda_module.sh BUILD_FOLDER
set -euo pipefail
cd "$(dirname "$0")/.."
module=$1/lib/libvoyager_cuda.so

for nvcc in "${CUDACXX:-}" nvcc "${CUDA_PATH:-/usr/local/cuda}/bin/nvcc" /usr/local/cuda/bin/nvcc; do
  [ -n "$nvcc" ] && found=$(command -v "$nvcc") || continue
  [ -e "$module" ] && exit 0
  echo "check_cuda_module.sh: $module: not found, expected because $found exists" >&2
  exit 1
done
echo "check_cuda_module.sh: no nvcc here, so no CUDA module is expected"
