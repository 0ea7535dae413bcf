#!/usr/bin/env bash
# Sets up, builds the release with warnings as errors, and runs every test that states a property of the
# product. About 16 minutes on two cores, after the packages. Safe to run again. scripts/check.sh has the longer checks.
set -euo pipefail
cd "$(dirname "$0")/.."
source scripts/steps.sh

step "test.sh: set-up"
scripts/setup.sh tests
# The set-up has brought lavapipe, the validation layer, nginx and a browser: no test may skip for want of them.
export VOYAGER_REQUIRE_VULKAN=1 VOYAGER_REQUIRE_NGINX=1 VOYAGER_REQUIRE_BROWSER=1

step "test.sh: build"
# Device code for this machine's GPU only: `check.sh cuda` builds it for all, `check.sh bench` the benchmarks.
cmake --preset release -DVOYAGER_WERROR=ON \
  -DCMAKE_CUDA_ARCHITECTURES="$(scripts/cuda_architectures.sh)"
cmake --build --preset release
for module in http sog; do
  [ -e build/release/lib/libvoyager_$module.so ] || { echo "test.sh: libvoyager_$module.so: not built, expected because setup.sh brings what it needs" >&2; exit 1; }
done
scripts/check_cuda_module.sh build/release

step "test.sh: test"
scripts/run_tests.sh release
step_times
