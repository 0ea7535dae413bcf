#!/usr/bin/env bash
# Each component holds what it should and no more; none of it knows where it was built; the headers
# are all there, and each compiles alone.
. "$(dirname "$0")/common.sh"

expect_files() {  # expect_files COMPONENT FILE...
  local component=$1 prefix=$WORK/component_$1
  shift
  install_to "$prefix" "$component"
  expect_equal "component $component" "$(cd "$prefix" && find . -not -type d | sed 's:^\./::' | LC_ALL=C sort)" \
    "$(printf '%s\n' "$@" | LC_ALL=C sort)"
}
expect_files runtime "$LIB/libvoyager.so.$VERSION" "$LIB/libvoyager.so.$series" "share/doc/libvoyager$series/LICENSE"
expect_files development "$LIB/libvoyager.so" "$LIB/pkgconfig/voyager.pc" "$LIB"/cmake/voyager/voyagerConfig{,Version,-release}.cmake \
  $(cd "$source/plugin" && find include -name '*.h' -o -name '*.hpp')
if [ "$TOOLS" = ON ]; then expect_files tools bin/voyager; fi
if [ "$HTTP" = ON ]; then expect_files http "$LIB/libvoyager_http.so"; fi
if [ "$SOG" = ON ]; then expect_files sog "$LIB/libvoyager_sog.so"; fi
if [ "$CUDA" = ON ]; then expect_files cuda "$LIB/libvoyager_cuda.so"; fi

# Whole, as a user installs it.
prefix=$WORK/prefix
install_to "$prefix"
expect_equal "the whole, and its components" "$(cd "$prefix" && find . -not -type d | sort)" \
  "$(for part in "$WORK"/component_*; do (cd "$part" && find . -not -type d); done | sort)"

# Neither the source nor the build nor the place of installation.
for folder in "$source" "$BUILD" "$WORK"; do
  # As the start of a path: a clone may be called /voyager, and headers stand in include/voyager/.
  pattern="(^|[^}A-Za-z0-9_.*/-])$(sed 's/[][\.*^$+?(){}|]/\\&/g' <<<"$folder")(/|[^A-Za-z0-9_.-]|\$)"
  found=$(grep -rlaE "$pattern" "$prefix" || true)
  [ -z "$found" ] || fail "$folder: found in $found, expected in no installed file"
done
found=$(grep -nE '(^|[^}A-Za-z0-9_.*])/[A-Za-z]' "$prefix/$LIB/pkgconfig/voyager.pc" "$prefix/$LIB"/cmake/voyager/*.cmake || true)
[ -z "$found" ] || fail "an absolute path: found $found, expected none in what is installed"
found=$(grep -hE 'INTERFACE_LINK_LIBRARIES|LINK_DEPENDENT|find_dependency' "$prefix/$LIB"/cmake/voyager/*.cmake || true)
[ -z "$found" ] || fail "voyager::voyager: found $found, expected a target that needs no other"
for binary in $(find "$prefix/$LIB" "$prefix/bin" -type f -name 'libvoyager*.so*' -o -type f -name voyager 2>/dev/null); do
  found=$(grep -aoE '/(home|root|usr|opt|tmp|mnt|srv|var)/[A-Za-z0-9_.]+' "$binary" | sort -u || true)
  [ -z "$found" ] || fail "$binary: found $found, expected no absolute path"
  found=$(readelf -d "$binary" | sed -nE 's/.*\((RPATH|RUNPATH)\).*\[(.*)\]/\2/p')
  case $found in
    '$ORIGIN' | '$ORIGIN/../'*) ;;
    *) fail "$binary: found the run path \"$found\", expected one that starts at \$ORIGIN" ;;
  esac
done

for header in "$prefix"/include/voyager/*; do
  for language in "$CC -x c -std=c99" "$CXX -x c++ -std=c++17" "$CXX -x c++ -std=c++17 -fno-exceptions -fno-rtti"; do
    case $header:$language in *.hpp:*' c '* | *.hpp:*-fno-exceptions*) continue ;; esac
    quietly $language -Wall -Wextra -pedantic -Werror -fsyntax-only -I "$prefix/include" -include "$header" /dev/null
  done
done
