#!/usr/bin/env bash
# Prints what a build for this machine alone passes as CMAKE_CUDA_ARCHITECTURES: the GPUs of
# this machine, or PTX if it has none: PTX is the quickest to build, and runs on any later GPU.
set -euo pipefail
found=$({ nvidia-smi --query-gpu=compute_cap --format=csv,noheader 2>/dev/null || true; } |
  awk '/^[0-9]+\.[0-9]+$/ && $1 >= 8 { sub(/\./, ""); print $0 "-real" }' | sort -u | paste -sd ';')
echo "${found:-80-virtual}"
