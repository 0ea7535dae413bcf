#!/usr/bin/env bash
# nginx for the tests over HTTP, where this machine has none: the program alone, unpacked into
# build/nginx. Installing the package would enable and start a server. Safe to run again.
set -euo pipefail
cd "$(dirname "$0")/.."
nginx=build/nginx/usr/sbin/nginx
command -v nginx /usr/sbin/nginx >/dev/null && exit 0
[ -x "$nginx" ] && exit 0

mkdir -p build
work=$(mktemp -d "$PWD/build/nginx-package.XXXXXX")
trap 'rm -rf "$work"' EXIT
download() { (cd "$work" && apt-get download -qq -o APT::Sandbox::User= nginx); }
download || {
  echo "unpack_nginx.sh: apt-get download nginx failed. Run 'apt-get update' as root, check the network, and start again." >&2
  exit 4
}
dpkg-deb -x "$work"/nginx_*.deb "$work/root"
version=$("$work/root/usr/sbin/nginx" -v 2>&1) || {
  echo "unpack_nginx.sh: the unpacked nginx does not run: $version" >&2
  exit 4
}
rm -rf build/nginx
mv "$work/root" build/nginx
echo "unpack_nginx.sh: $nginx, $version, not installed"
