#!/usr/bin/env bash
# What tests/package does not see in one build: that the library alone and the tools alone are built
# with nothing of the other parts on the machine, that what is missing is said with its package, and
# that everything holds in a multiarch folder. Builds the library once more, under build/.
set -euo pipefail
cd "$(dirname "$0")/.."
work=build/check_package
mkdir -p "$work"

fail() { echo "check_package.sh: $*" >&2; exit 1; }

# configure NAME ARGUMENT...: nothing that the machine has beyond the part's own needs is to be found. What
# is installed where does not depend on optimising, which takes half of the time.
configure() {
  local name=$1 hidden=()
  shift
  rm -rf "$work/$name/CMakeCache.txt"
  for package in $hide; do hidden+=("-DCMAKE_DISABLE_FIND_PACKAGE_$package=ON"); done
  cmake --preset library -DVOYAGER_WERROR=ON -DCMAKE_CXX_FLAGS_RELEASE="-O0 -DNDEBUG" \
    -B "$work/$name" "${hidden[@]}" "$@" >"$work/$name.said" 2>&1
}

expect_said() {  # expect_said NAME TEXT
  grep -qF -- "$2" "$work/$1.said" || fail "$1: found
$(cat "$work/$1.said")
expected $2"
}

others="benchmark GTest glfw3 TinyGLTF glm OpenXR Vulkan"
tools="CLI11 fmt PNG PkgConfig"
hide="$others $tools CURL Python Python3"
multiarch=lib/$(uname -m)-linux-gnu
configure library -DCMAKE_INSTALL_LIBDIR="$multiarch" -DVOYAGER_CUDA=OFF || fail "$(cat "$work/library.said")"
expect_said library "HTTP module: left out (no libcurl 7.81 or newer, which libcurl4-openssl-dev brings"
expect_said library "CUDA module: left out (VOYAGER_CUDA is OFF)"
found=$(grep -oiE '^(imgui|stb|glfw|tinygltf|gtest|openxr|cli11|fmt|png|cairo|python)[a-z0-9_]*' "$work/library/CMakeCache.txt" || true)
[ -z "$found" ] || fail "library: looked for $found, expected nothing of the other parts"

hide="$others CURL PkgConfig"
configure tools -DVOYAGER_BUILD_TOOLS=ON -DVOYAGER_CUDA=OFF || fail "$(cat "$work/tools.said")"
expect_said tools "voyager report: left out (no cairo for this target, which libcairo2-dev and pkg-config bring)"
expect_said tools "voyager view: left out (not all of Vulkan's loader, GLFW,"

hide="TBB ZLIB PNG OpenXR GTest CURL"
if configure missing -DVOYAGER_BUILD_TOOLS=ON -DVOYAGER_BUILD_SAMPLES=ON -DVOYAGER_BUILD_TESTS=ON -DVOYAGER_CUDA=OFF; then
  fail "missing: configured without $hide, expected a refusal"
fi
for package in "libtbb-dev, for the library" "zlib1g-dev, for the library" "libpng-dev, for the tools" \
  "libpng-dev, for the samples" "libopenxr-dev, for the samples" "libgtest-dev, for the tests"; do
  expect_said missing "$package"
done

hide=CURL
for insisted in HTTP=ON HTTP=MAYBE CUDA=MAYBE BUILD_TESTS=ON; do
  if configure insisted "-DVOYAGER_$insisted"; then fail "VOYAGER_$insisted: configured, expected a refusal"; fi
  expect_said insisted "VOYAGER_${insisted%=*}"
done

cmake --build "$work/library"
export BUILD=$PWD/$work/library VERSION LIB=$multiarch CUDA=OFF HTTP=OFF SOG=OFF TOOLS=OFF CC=cc CXX=c++
if [ -e "$BUILD/lib/libvoyager_sog.so" ]; then SOG=ON; fi
VERSION=$(cat VERSION)
for test in install consumers deb; do
  WORK=$PWD/$work/$test "tests/package/${test}_test.sh"
done
echo "check_package.sh: done"
