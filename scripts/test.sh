#!/usr/bin/env bash
# Sets up, builds and runs every test: format, the release build, static
# analysis, the sanitizer builds, and aarch64 under qemu-user. What CI runs. Safe
# to run again.
set -euo pipefail
cd "$(dirname "$0")/.."
scripts/setup.sh

# setup.sh has brought lavapipe, the validation layer, nginx and a browser: no test may skip for want of them.
export VOYAGER_REQUIRE_VULKAN=1 VOYAGER_REQUIRE_NGINX=1 VOYAGER_REQUIRE_BROWSER=1

step() { printf '\n== %s (%d s)\n' "$1" "$SECONDS"; }

step "format"
scripts/check_format.sh

step "release: build and test"
cmake --preset release -DVOYAGER_WERROR=ON
cmake --build --preset release
[ -e build/release/lib/libvoyager_http.so ] || { echo "test.sh: libvoyager_http.so: not built, expected because setup.sh brings libcurl" >&2; exit 1; }
ctest --preset release -j "$(nproc)"

step "asan: build under AddressSanitizer and UndefinedBehaviorSanitizer"
cmake --preset asan -DVOYAGER_WERROR=ON
cmake --build --preset asan

step "static analysis"
scripts/check_tidy.sh build/asan

step "asan: test"
ctest --preset asan -j "$(nproc)"

step "tsan: a minute of streaming on many threads under ThreadSanitizer"
cmake --preset tsan -DVOYAGER_WERROR=ON
cmake --build --preset tsan --target property_streaming_flight_test
VOYAGER_FLIGHT_SECONDS=60 ctest --preset tsan -R StreamingFlight

if [ "$(uname -m)" = aarch64 ]; then
  step "aarch64: this machine is one, and the steps above were it"
else
  step "aarch64: cross-compile, test under qemu-user, compare cuts and bakes"
  scripts/setup_aarch64.sh
  cmake --preset aarch64 -DVOYAGER_WERROR=ON
  cmake --build --preset aarch64
  ctest --preset aarch64 -j "$(nproc)"
  scripts/check_aarch64.sh build/release build/aarch64
fi
step "done"
