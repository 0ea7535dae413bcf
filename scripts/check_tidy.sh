#!/usr/bin/env bash
# clang-tidy on everything that ships: check_tidy.sh BUILD_FOLDER. Takes the folder of a preset that
# compiles the sources of a library together, so that each header is parsed once for a whole library.
# Not on .cu: Debian's clang-tidy 14 knows CUDA up to 11.5, and its own wrappers of <new> and the headers of
# CUDA 12 and 13 exclude each other. There nvcc's warnings are errors instead (cuda/CMakeLists.txt), and what
# kernels share with the CPU, runtime/stages, is checked through the CPU's sources.
set -euo pipefail
cd "$(dirname "$0")/.."
folders='(runtime|plugin|http|sog|tools|vulkan_interop|host|samples|cuda)'
grep -oE '"file": "[^"]*"' "$1/compile_commands.json" | cut -d'"' -f4 | sort -u |
  grep -E "^$PWD/(($1)/$folders/.*/Unity/.*\.cxx|$folders/.*\.cpp)$" |
  grep -v 'runtime/cpu/rasterize_avx' |
  xargs -d '\n' -P "$(nproc)" -n 1 clang-tidy -p "$1" --quiet --checks=-bugprone-suspicious-include
