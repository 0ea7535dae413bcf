#!/usr/bin/env bash
# The tests of a preset that is built, then what was skipped and why: run_tests.sh PRESET [CTEST_OPTION...]
set -euo pipefail
cd "$(dirname "$0")/.."
preset=$1
shift
rm -rf "build/$preset/test_results"
mkdir -p "build/$preset/test_results"
failed=0
ctest --preset "$preset" -j "$(nproc)" --output-junit "test_results/ctest.junit" "$@" || failed=1
echo
scripts/summarise_tests.py "build/$preset" || failed=1
exit "$failed"
