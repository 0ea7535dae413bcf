#!/usr/bin/env bash
# What the preset aarch64 needs: the cross compiler and qemu-user from the
# distribution's packages, and the libraries' arm64 packages unpacked into
# build/aarch64-sysroot. They are not installed, so this machine gets no foreign
# architecture and no upgrades. Safe to run again; root or sudo.
set -euo pipefail
cd "$(dirname "$0")/.."
scripts/install_packages.sh g++-aarch64-linux-gnu qemu-user

packages=(
  libc6-dev libstdc++6                                   # the compiler brings libstdc++'s headers
  libtbb-dev zlib1g-dev libzstd-dev libxxhash-dev        # runtime
  libeigen3-dev nlohmann-json3-dev
  libpng-dev libfmt-dev libcli11-dev                     # tools
  libvulkan-dev                                          # Vulkan's headers
  libgtest-dev                                           # tests
)
sysroot=build/aarch64-sysroot
made_by=$(sha256sum scripts/setup_aarch64.sh)
[ "$(cat "$sysroot/made_by" 2>/dev/null)" = "$made_by" ] && exit 0
echo "setup_aarch64.sh: unpacking into $sysroot: ${packages[*]}"

# An apt of our own: this machine's sources, arm64 only, nothing installed.
mkdir -p build
work=$(mktemp -d "$PWD/build/aarch64-packages.XXXXXX")
trap 'rm -rf "$work"' EXIT
mkdir -p "$work"/{state/lists/partial,cache/archives/partial,root/usr/lib}
: >"$work/status"
arm64_apt() {
  apt-get -q -y -o APT::Architecture=arm64 -o APT::Architectures=arm64 -o APT::Sandbox::User= \
    -o Dir::State="$work/state" -o Dir::State::status="$work/status" -o Dir::Cache="$work/cache" "$@"
}
arm64_apt update
arm64_apt install --download-only --no-install-recommends "${packages[@]}"

ln -s usr/lib "$work/root/lib"
for package in "$work"/cache/archives/*.deb; do
  dpkg-deb --fsys-tarfile "$package" | tar -x --keep-directory-symlink --no-same-owner -C "$work/root"
done
# Links from the root of a file system: from the sysroot's.
find "$work/root" -type l -lname '/*' -print0 | while IFS= read -r -d '' link; do
  ln -sfnr "$work/root$(readlink "$link")" "$link"
done
echo "$made_by" >"$work/root/made_by"
rm -rf "$sysroot"
mv "$work/root" "$sysroot"
