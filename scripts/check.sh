#!/usr/bin/env bash
# The checks that take longer than scripts/test.sh, by name: check.sh PART... or check.sh all.
# Without a name it lists them. CONTRIBUTING.md says which to run before which change. Safe to run again.
set -euo pipefail
cd "$(dirname "$0")/.."
source scripts/steps.sh

parts=(asan tidy tsan package doxygen aarch64 parity fuzz searches cuda bench demo)
declare -A about=(
  [asan]="every test under AddressSanitizer and UndefinedBehaviorSanitizer"
  [tidy]="clang-format and clang-tidy on everything that ships; headers of the library and of the tests' support compile alone"
  [tsan]="a minute of streaming on many threads under ThreadSanitizer"
  [package]="the library alone, built, installed and used where nothing else is found; the tools alone configured"
  [doxygen]="the C API as pages, without a warning"
  [aarch64]="exact results on 64-bit Arm under qemu-user: tests, bakes and cuts to the byte"
  [parity]="the CPU stages with contraction off, against the float64 reference"
  [fuzz]="each target of tests/fuzz under libFuzzer for a minute, from the kept corpus"
  [searches]="what scripts/test.sh does in small: trees of a million nodes, whole paths, a bake in real cells"
  [cuda]="device code for every GPU that ships: Orin, Hopper, PTX; what kernels spill on an Orin"
  [bench]="the benchmarks build and run once, and so do the scripts of bench/"
  [demo]="scripts/demo.sh"
)

configure() { cmake --preset "$1" -DVOYAGER_WERROR=ON "${@:2}"; }

check_asan() {
  configure asan
  cmake --build --preset asan
  scripts/run_tests.sh asan
}

# Nothing is built but the shaders' headers. A folder of its own: the release's sources, CUDA's host code among
# them where nvcc is found, whatever the other folders were configured with.
check_tidy() {
  scripts/check_format.sh
  configure release -B build/tidy
  cmake --build build/tidy --target shader_headers
  scripts/check_headers.sh
  scripts/check_tidy.sh build/tidy
}

check_tsan() {
  configure tsan
  cmake --build --preset tsan --target property_tests
  VOYAGER_FLIGHT_SECONDS=60 scripts/run_tests.sh tsan -R property.StreamingFlight
}

check_package() { scripts/check_package.sh; }

# The pages are in build/doxygen/html.
check_doxygen() {
  mkdir -p build
  doxygen docs/Doxyfile
  # The rules at the head of a header are the file's, not its first macro's.
  local page
  for page in voyager_8h voyager__vulkan_8h; do
    sed -n '/>Detailed Description</,/>Macro Definition Documentation</p' "build/doxygen/html/$page.html" |
      grep THREAD-SAFETY >/dev/null || { echo "doxygen: $page.html: found no rules in the description of the file" >&2; return 1; }
  done
}

check_aarch64() {
  if [ "$(uname -m)" = aarch64 ]; then
    echo "this machine is one: scripts/test.sh is this check"
    return
  fi
  scripts/setup_aarch64.sh
  configure aarch64
  cmake --build --preset aarch64
  scripts/run_tests.sh aarch64
  configure release
  cmake --build --preset release --target voyager_tool
  scripts/check_aarch64.sh build/release build/aarch64
}

check_parity() {
  configure parity
  cmake --build --preset parity --target parity_tests numerics_tests
  scripts/run_tests.sh parity -L 'parity|numerics'
}

check_fuzz() {
  configure fuzz
  cmake --build --preset fuzz --target fuzzers
  echo "a minute each, two at a time; build/fuzz/run/NAME.log"
  scripts/run_fuzzers.sh build/fuzz/bin tests/fuzz 60 build/fuzz/run 2
}

check_searches() {
  configure release
  cmake --build --preset release --target property_tests command_line_tests
  VOYAGER_LARGE_TREES=1 VOYAGER_WHOLE_PATHS=1 scripts/run_tests.sh release \
    -R 'property.(Search|Streaming|Cut)|command_line.BakeInParts'
}

# A folder of its own: that of the release may have this machine's GPU only.
check_cuda() {
  scripts/check_cuda_module.sh --nvcc >/dev/null || { echo "no nvcc here, so no device code is built"; return; }
  configure release -B build/cuda
  cmake --build build/cuda --target voyager_cuda gpu_tests
  scripts/check_cuda_module.sh build/cuda
  scripts/check_spills.sh
}

check_bench() {
  scripts/setup.sh bench
  configure release -DVOYAGER_BUILD_BENCH=ON
  cmake --build --preset release --target bench_programs voyager_tool
  bench/run_once.sh build/release
}

check_demo() {
  scripts/demo.sh
  configure release  # which the demo leaves without its tests
}

if [ $# -eq 0 ] || [ "$1" = --help ]; then
  echo "usage: check.sh PART... | all"
  for part in "${parts[@]}"; do printf '  %-9s %s\n' "$part" "${about[$part]}"; done
  exit $(($# == 0))
fi
[ "$*" = all ] && set -- "${parts[@]}"
for part in "$@"; do
  [ -n "${about[$part]:-}" ] || { echo "check.sh: $part: found no such part, expected one of: ${parts[*]}, all" >&2; exit 1; }
done

step "check.sh: set-up"
scripts/setup.sh checks
export VOYAGER_REQUIRE_VULKAN=1 VOYAGER_REQUIRE_NGINX=1 VOYAGER_REQUIRE_BROWSER=1
for part in "$@"; do
  step "check.sh: $part"
  "check_$part"
done
step_times
