#!/usr/bin/env bash
# Installs what this machine lacks, from the distribution's packages: setup.sh [PART...]
#   main    what builds and runs the library and the command line; the default, and with every part
#   view    beside it: `voyager view`, and a software Vulkan for machines without a GPU
#   samples beside view: the samples for Vulkan and OpenXR
#   tests   beside main: the samples, `voyager report`, a software Vulkan, a browser, a web server
#   checks  beside main and tests: git, clang with its sanitizers, clang-format, clang-tidy, libabigail, Doxygen
#   bench   beside main: the benchmarks and the plots of bench/
# scripts/setup_aarch64.sh is for the check of 64-bit Arm. No service is left running. Safe to run
# again; root or sudo.
set -euo pipefail
cd "$(dirname "$0")/.."

declare -A packages
packages[main]="
  g++ cmake ninja-build
  libtbb-dev zlib1g-dev libzstd-dev libxxhash-dev libeigen3-dev nlohmann-json3-dev
  libwebp-dev libzip-dev
  libcurl4-openssl-dev
  libpng-dev libfmt-dev libcli11-dev
  libvulkan-dev glslang-tools"
packages[view]="libglm-dev libglfw3-dev libimgui-dev libstb-dev mesa-vulkan-drivers"
packages[samples]="${packages[view]} libtinygltf-dev libopenxr-dev libopenxr-loader1"
packages[report]="libcairo2-dev pkg-config fonts-dejavu-core"
# GoogleTest and what inspects programs and .debs; software Vulkan and its validation, OpenXR's
# rules, a window's display; certificates; a browser.
packages[tests]="${packages[samples]} ${packages[report]}
  libgtest-dev binutils python3 dpkg-dev file
  vulkan-validationlayers openxr-layer-corevalidation xvfb
  openssl ca-certificates chromium-headless-shell"
packages[checks]="${packages[tests]} git clang libclang-rt-dev clang-format clang-tidy abigail-tools doxygen"
packages[bench]="libbenchmark-dev python3 python3-matplotlib"

wanted=${packages[main]}
for part in "$@"; do
  case $part in
    main | view | samples | tests | checks | bench) wanted+=" ${packages[$part]}" ;;
    *) echo "setup.sh: $part: no such part, expected main, view, samples, tests, checks or bench" >&2; exit 2 ;;
  esac
done
read -r -d '' -a wanted <<<"$wanted" || true
scripts/install_packages.sh "${wanted[@]}"

case " $* " in *" tests "* | *" checks "*) scripts/unpack_nginx.sh ;; esac
