# What the tests of this folder share. ctest sets BUILD, WORK (a folder of the test's own), VERSION,
# LIB (the libraries' folder in a prefix), CUDA, HTTP, SOG and TOOLS (ON or OFF), CC and CXX.
set -euo pipefail
source=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
series=${VERSION%%.*}  # of hosts that are served
scene=$source/tests/fuzz/corpus/ply/degree0.ply
unset CMAKE_C_COMPILER_LAUNCHER CMAKE_CXX_COMPILER_LAUNCHER LD_LIBRARY_PATH
rm -rf "$WORK"
mkdir -p "$WORK"

fail() { echo "$(basename "$0"): $*" >&2; exit 1; }

expect_equal() {  # expect_equal WHAT FOUND EXPECTED
  [ "$2" = "$3" ] || fail "$1: found
$2
expected
$3"
}

quietly() { "$@" >"$WORK/said" 2>&1 || { cat "$WORK/said" >&2; fail "failed: $*"; }; }

install_to() {  # install_to PREFIX [COMPONENT]
  quietly cmake --install "$BUILD" --strip --prefix "$1" ${2:+--component "$2"}
}

# The consumers, built against PREFIX by find_package into WORK/NAME.
build_with_cmake() {  # build_with_cmake PREFIX NAME
  quietly cmake -G Ninja -S "$source/tests/package/consumer" -B "$WORK/$2" -DCMAKE_PREFIX_PATH="$1" \
    -DCMAKE_BUILD_TYPE=Release -DSERIES="$series"
  quietly cmake --build "$WORK/$2"
}

# The same by pkg-config. The run path is the host's own business.
build_with_pkg_config() {  # build_with_pkg_config PREFIX NAME
  local consumer=$source/tests/package/consumer flags
  mkdir -p "$WORK/$2"
  flags="-Wall -Wextra -pedantic -Werror $(PKG_CONFIG_PATH=$1/$LIB/pkgconfig pkg-config --cflags --libs voyager) -Wl,-rpath,$1/$LIB"
  # shellcheck disable=SC2086  # words
  {
    "$CC" -std=c99 "$consumer/frame.c" -o "$WORK/$2/frame" $flags
    "$CXX" -std=c++17 "$consumer/scene.cpp" -o "$WORK/$2/scene" $flags
    "$CXX" -std=c++17 -fno-exceptions -fno-rtti "$consumer/backends.cpp" -o "$WORK/$2/backends" $flags
  }
}

# Runs what was built into WORK/NAME; what it says of the modules is in WORK/NAME.said.
run_consumers() {  # run_consumers NAME
  quietly "$WORK/$1/frame" "$scene"
  quietly "$WORK/$1/scene" "$scene"
  printf 'PK\3\4' >"$WORK/damaged.sog"
  "$WORK/$1/backends" "$WORK/damaged.sog" >"$WORK/$1.said" || fail "failed: $1/backends"
}

expect_said() {  # expect_said NAME PATTERN
  grep -qE "$2" "$WORK/$1.said" || fail "$1/backends: found
$(cat "$WORK/$1.said")
expected $2"
}

# What the consumers say where the modules are beside the library. With no GPU that is the
# driver's reason, not that of a file that was not found.
expect_modules() {  # expect_modules NAME
  if [ "$HTTP" = ON ]; then expect_said "$1" '^http: .*bad/illegal format'; fi
  if [ "$SOG" = ON ]; then expect_said "$1" '^sog: .*zip of the .sog'; fi
  if [ "$CUDA" = ON ]; then
    expect_said "$1" '^cuda: '
    ! grep -q '^cuda: .*libvoyager_cuda.so' "$WORK/$1.said" || fail "$1/backends: found
$(cat "$WORK/$1.said")
expected that libvoyager_cuda.so is loaded"
  fi
}
