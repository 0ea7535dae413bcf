#!/usr/bin/env bash
# Installs those of the named packages that this machine lacks, from the distribution:
# install_packages.sh PACKAGE...  Says first how much that is. Removes nothing, and upgrades only
# what a missing package needs newer. Safe to run again; root or sudo.
set -euo pipefail
export DEBIAN_FRONTEND=noninteractive LC_ALL=C

fail() { printf 'install_packages.sh: %s\n' "$@" >&2; exit 4; }

command -v apt-get >/dev/null ||
  fail "apt-get: not found, expected Debian 12 or later" \
    "On another system install what corresponds to: $*"
missing=()
for package in "$@"; do
  dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep -q 'install ok installed' || missing+=("$package")
done
[ ${#missing[@]} -eq 0 ] && exit 0

install=(apt-get install -q --no-install-recommends --no-upgrade --no-remove)
as_root=()
if [ "$(id -u)" -ne 0 ]; then
  command -v sudo >/dev/null ||
    fail "not root, and no sudo. Have this run by root, then start again:" \
      "  apt-get update && ${install[*]} ${missing[*]}"
  as_root=(sudo "--preserve-env=DEBIAN_FRONTEND,LC_ALL,http_proxy,https_proxy,no_proxy")
fi

echo "Reading the package lists"
"${as_root[@]}" apt-get update -qq || echo "install_packages.sh: apt-get update failed; going on with the lists that are here" >&2

# What apt would do. Its simulation gives no sizes, so these are summed from the packages' records.
plan=$("${install[@]}" --simulate "${missing[@]}" 2>&1) ||
  fail "apt cannot install ${missing[*]}:" "$(grep '^E:\|^ ' <<<"$plan")" \
    "Expected Debian 12 or later with its usual sources, and a network. Behind a proxy set http_proxy and https_proxy."
read -r -d '' -a coming <<<"$(awk '$1 == "Inst" { print $2 }' <<<"$plan")" || true
apt-cache show --no-all-versions "${coming[@]}" | awk -v packages="${#coming[@]}" '
  $1 == "Size:" { bytes += $2 } $1 == "Installed-Size:" { kb += $2 }
  END { printf "%d packages: %.0f MB to fetch, %.0f MB unpacked\n", packages, bytes / 1e6, kb / 1e3 }'
awk '$1 == "Inst" && $3 ~ /^\[/ { print "  upgraded, because a package above needs it newer: " $2 }' <<<"$plan"

"${as_root[@]}" "${install[@]}" -y -qq -o Dpkg::Use-Pty=0 "${missing[@]}" >/dev/null ||
  fail "apt-get install failed: see the lines above." \
    "If packages could not be fetched, check the network and the proxy (http_proxy, https_proxy), then run this again: it goes on where it stopped." \
    "If another apt is running, wait for its end."
