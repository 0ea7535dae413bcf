#!/usr/bin/env bash
# Hosts in C99, C++ and C++ without exceptions and RTTI are built out of tree against an installed
# prefix, by find_package and by pkg-config, and draw: where it was installed, where it was moved to,
# and without the modules.
. "$(dirname "$0")/common.sh"

expect_all() {  # expect_all PREFIX NAME
  build_with_cmake "$1" "$2_cmake"
  build_with_pkg_config "$1" "$2_pkg_config"
  for name in "$2_cmake" "$2_pkg_config"; do
    run_consumers "$name"
    expect_modules "$name"
    found=$(ldd "$WORK/$name/frame" | sed -nE 's/.*libvoyager\.so[^ ]* => ([^ ]*).*/\1/p')
    expect_equal "$name/frame's library" "$found" "$1/$LIB/libvoyager.so.$series"
  done
}
install_to "$WORK/here"
expect_all "$WORK/here" here

# Moved as a whole; the first place is no more.
mv "$WORK/here" "$WORK/moved"
expect_all "$WORK/moved" moved
if [ "$TOOLS" = ON ]; then quietly "$WORK/moved/bin/voyager" info "$scene"; fi

# A version that the library does not serve is not found.
cat >"$WORK/version.cmake" <<EOF
foreach(version 0.2 1.999 2.0)
  find_package(voyager \${version} CONFIG QUIET PATHS "$WORK/moved/$LIB/cmake/voyager" NO_DEFAULT_PATH)
  if(voyager_FOUND OR NOT voyager_CONSIDERED_VERSIONS STREQUAL "$VERSION")
    message(FATAL_ERROR "version \${version} was found, or $VERSION was not looked at: \${voyager_CONSIDERED_VERSIONS}")
  endif()
endforeach()
EOF
quietly cmake -P "$WORK/version.cmake"

# Without the modules everything draws on the CPU, and who asks for a module is told its name.
for module in cuda http sog; do rm -f "$WORK/moved/$LIB/libvoyager_$module.so"; done
run_consumers moved_cmake
expect_said moved_cmake '^cuda: .*libvoyager_cuda.so: (not found in|cannot be loaded: .*cannot open shared object file)'
expect_said moved_cmake '^http: .*libvoyager_http.so: (not found in|cannot be loaded: .*cannot open shared object file)'
expect_said moved_cmake '^sog: .*libvoyager_sog.so: (not found in|cannot be loaded: .*cannot open shared object file)'

# A module that is damaged, or lacks a library of its own, is refused with that reason.
echo "no library" >"$WORK/moved/$LIB/libvoyager_cuda.so"
run_consumers moved_cmake
expect_said moved_cmake '^cuda: .*libvoyager_cuda.so: cannot be loaded: .*file too short'
