#!/usr/bin/env bash
# The packages that cpack makes: their names, their dependencies, and consumers against what they
# install. They are unpacked into a folder; nothing is installed on this machine.
. "$(dirname "$0")/common.sh"
for program in dpkg-deb dpkg-shlibdeps; do
  command -v $program >/dev/null || { echo "deb_test.sh: left out: no $program, which dpkg and dpkg-dev bring"; exit 77; }
done

(cd "$BUILD" && quietly cpack -G "DEB;TGZ" -B "$WORK/packages")
found=""
names="libvoyager$series libvoyager-dev"
if [ "$TOOLS" = ON ]; then names+=" voyager-tools"; fi
if [ "$HTTP" = ON ]; then names+=" libvoyager-http"; fi
if [ "$SOG" = ON ]; then names+=" libvoyager-sog"; fi
if [ "$CUDA" = ON ]; then names+=" libvoyager-cuda"; fi
for package in "$WORK"/packages/*.deb; do
  dpkg-deb -x "$package" "$WORK/root"
  depends=$(dpkg-deb -f "$package" Depends)
  found+=" $(dpkg-deb -f "$package" Package)"
  case $(dpkg-deb -f "$package" Package) in
    "libvoyager$series") needs="libc6 libtbb12 libzstd1 zlib1g" never="libcurl|cuda|libvulkan|libpng|libwebp|libzip" ;;
    libvoyager-http) needs="libvoyager$series.(=.$VERSION) libcurl" never="libpng|cuda" ;;
    libvoyager-sog) needs="libvoyager$series.(=.$VERSION) libwebp libzip" never="libcurl|libpng|cuda" ;;
    libvoyager-cuda) needs="libvoyager$series.(=.$VERSION) libtbb12" never="cudart|libcuda|nvidia" ;;
    voyager-tools) needs="libvoyager$series.(=.$VERSION) libpng libfmt" never="libcurl|libcuda|libwebp|libzip" ;;
    libvoyager-dev) needs="libvoyager$series.(=.$VERSION)" never="lib(tbb|zstd|png)" ;;
  esac
  for need in $needs; do
    grep -q "$need" <<<"$depends" || fail "$(basename "$package"): found Depends: $depends, expected $need"
  done
  if grep -qE "$never" <<<"$depends"; then fail "$(basename "$package"): found Depends: $depends, expected none of $never"; fi
done
expect_equal "the packages" "$(tr ' ' '\n' <<<"$found" | sort)" "$(tr ' ' '\n' <<<" $names" | sort)"
# That this distribution has what they depend on; a simulation.
if command -v apt-get >/dev/null; then quietly apt-get install --simulate --no-install-recommends "$WORK"/packages/*.deb; fi

build_with_cmake "$WORK/root/usr" deb_cmake
build_with_pkg_config "$WORK/root/usr" deb_pkg_config
for name in deb_cmake deb_pkg_config; do
  run_consumers $name
  expect_modules $name
done

# The archive, unpacked anywhere, holds what the packages hold.
mkdir "$WORK/archive"
tar -xzf "$WORK"/packages/*.tar.gz -C "$WORK/archive" --strip-components 1
expect_equal "the archive" "$(cd "$WORK/archive" && find . -not -type d | sort)" \
  "$(cd "$WORK/root/usr" && find . -not -type d | sort)"
if [ "$TOOLS" = ON ]; then quietly "$WORK/archive/bin/voyager" info "$scene"; fi
