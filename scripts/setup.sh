#!/usr/bin/env bash
# Installs what the build, the tests and the samples need and this machine
# lacks, from the distribution's packages. Safe to run again; root or sudo.
set -euo pipefail
cd "$(dirname "$0")/.."

packages=(
  g++ cmake ninja-build binutils git                     # the build
  libtbb-dev zlib1g-dev libzstd-dev libxxhash-dev        # runtime
  libeigen3-dev
  libcurl4-openssl-dev                                   # http:// and https://
  libpng-dev libfmt-dev nlohmann-json3-dev libcli11-dev  # tools and samples
  libcairo2-dev pkg-config fonts-dejavu-core             # voyager report: plots
  libvulkan-dev glslang-tools                            # Vulkan: headers, loader, shaders
  libtinygltf-dev libglm-dev libglfw3-dev libimgui-dev   # the Vulkan sample
  libopenxr-dev libopenxr-loader1                        # OpenXR: headers, loader
  openxr-layer-corevalidation                            # tests with OpenXR: its rules watched by another eye
  mesa-vulkan-drivers vulkan-validationlayers xvfb       # tests with Vulkan: a CPU that has it, validation, a window's display
  nginx-light openssl                                    # tests with HTTP: a real server, certificates
  chromium-headless-shell                                # tests of pages that are written: a browser without a window
  libgtest-dev libbenchmark-dev                          # tests and benchmarks
  clang-format clang-tidy                                # checks
  python3 python3-matplotlib                             # bench/: scripts, plots
)
exec scripts/install_packages.sh "${packages[@]}"
