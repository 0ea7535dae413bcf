#!/usr/bin/env bash
# Prints what a build for this machine alone passes as CMAKE_CUDA_ARCHITECTURES: the GPUs that are
# here, or where there is none PTX, which is the quickest to build and serves any later GPU.
set -euo pipefail
found=$({ nvidia-smi --query-gpu=compute_cap --format=csv,noheader 2>/dev/null || true; } |
  awk '/^[0-9]+\.[0-9]+$/ && $1 >= 8 { sub(/\./, ""); print $0 "-real" }' | sort -u | paste -sd ';')
echo "${found:-80-virtual}"
