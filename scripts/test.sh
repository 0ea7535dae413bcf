#!/usr/bin/env bash
# Sets up, builds and runs every test: format, the release build, static
# analysis, and the sanitizer build. What CI runs. Safe to run again.
set -euo pipefail
cd "$(dirname "$0")/.."
scripts/setup.sh

step() { printf '\n== %s (%d s)\n' "$1" "$SECONDS"; }

step "format"
scripts/check_format.sh

step "release: build and test"
cmake --preset release -DVOYAGER_WERROR=ON
cmake --build --preset release
ctest --preset release -j "$(nproc)"

step "static analysis"
scripts/check_tidy.sh build/release

step "asan: build and test under AddressSanitizer and UndefinedBehaviorSanitizer"
cmake --preset asan -DVOYAGER_WERROR=ON
cmake --build --preset asan
ctest --preset asan -j "$(nproc)"
step "done"
