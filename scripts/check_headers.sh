#!/usr/bin/env bash
# Every header compiles alone: check_headers.sh [FOLDER...], by default the library's and those that tests share.
# A header that needs another one before it says so with that file's name and the compiler's error.
set -euo pipefail
cd "$(dirname "$0")/.."
[ $# -gt 0 ] || set -- plugin/include runtime vulkan_interop http tools/openxr_runtime tests/support
eigen=$(pkg-config --cflags eigen3)
export eigen
compile() {
  c++ -std=c++20 -fsyntax-only -x c++ -I. -Iplugin/include $eigen -DVOYAGER_SOURCE_DIR='""' -DVOYAGER_BIN_DIR='""' \
    -include "$1" /dev/null || { echo "$1: does not compile alone" >&2; return 1; }
}
export -f compile
git ls-files --cached --others --exclude-standard -- "$@" | grep -E '\.(h|hpp)$' |
  xargs -P "$(nproc)" -n 1 bash -c 'compile "$1"' _
