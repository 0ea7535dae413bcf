#!/usr/bin/env bash
# clang-tidy on everything that ships: check_tidy.sh BUILD_FOLDER, of a preset that compiles a
# library's sources together (asan): so they take their headers once. What two of them both define
# in an unnamed namespace would be an error there.
set -euo pipefail
cd "$(dirname "$0")/.."
grep -oE '"file": "[^"]*"' "$1/compile_commands.json" | cut -d'"' -f4 | sort -u |
  grep -E "^$PWD/(($1)/(runtime|plugin|http|tools)/.*/Unity/.*\.cxx|(runtime|plugin|http|tools)/.*\.cpp)$" |
  grep -v 'runtime/cpu/rasterize_avx' |
  xargs -P "$(nproc)" -n 1 clang-tidy -p "$1" --quiet --checks=-bugprone-suspicious-include
