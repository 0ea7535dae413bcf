#!/usr/bin/env bash
# What a newcomer waits for: measure_newcomer.sh FOLDER [demo|test]...
# Makes a bare Debian 12 in FOLDER/root, clones the commit that is checked out into it, runs
# scripts/demo.sh and scripts/test.sh (or the one that is named) there, each in an empty clone, and
# prints minutes, packages and megabytes. The packages of test.sh are those beside demo.sh's where
# both run. Needs root, debootstrap, unshare, and apt sources with Debian 12.
set -euo pipefail

fail() { echo "measure_newcomer.sh: $1" >&2; exit "${2:-4}"; }
[ $# -ge 1 ] || fail "no folder given, expected FOLDER [demo|test]..." 2
[ "$(id -u)" -eq 0 ] || fail "not root, which debootstrap and chroot need"
for program in debootstrap unshare git; do
  command -v $program >/dev/null || fail "$program: not found; apt-get install debootstrap util-linux git"
done

# In a namespace of its own, so that mounts and processes end with this script, however it ends.
if [ -z "${MEASURE_NEWCOMER_INSIDE:-}" ]; then
  MEASURE_NEWCOMER_INSIDE=1 exec unshare --mount --pid --fork --kill-child "$0" "$@"
fi
mkdir -p "$1"
folder=$(cd "$1" && pwd)
root=$folder/root
shift
[ $# -gt 0 ] || set -- demo test
commands=("$@")
for command in "${commands[@]}"; do
  [[ $command =~ ^(demo|test)$ ]] || fail "$command: no such command, expected demo or test" 2
done
cd "$(dirname "$0")/.."

make_root() {
  [ ! -e "$root" ] || fail "$root: exists already, expected a folder to make; remove it, or name another"
  local mirror
  mirror=$(apt-get indextargets --format '$(SITE)' 'Created-By: Packages' 'Origin: Debian' 'Codename: bookworm' | sort -u | head -1)
  [ -n "$mirror" ] || fail "apt's sources: found none with Debian 12 (bookworm), expected one to take the mirror from"
  echo "A bare Debian 12 in $root, from $mirror"
  debootstrap --variant=minbase bookworm "$root" "$mirror" >"$folder/debootstrap.log" 2>&1 ||
    fail "debootstrap failed: see $folder/debootstrap.log"
}

mount_root() {
  mount -t proc proc "$root/proc"
  mount --rbind /dev "$root/dev"
  mount --rbind /sys "$root/sys"
}

# Nothing of this machine's environment goes in but a proxy.
inside() {
  chroot "$root" /usr/bin/env -i HOME=/root TERM=dumb PATH=/usr/sbin:/usr/bin:/sbin:/bin \
    ${http_proxy:+http_proxy="$http_proxy"} ${https_proxy:+https_proxy="$https_proxy"} \
    bash -c "cd /voyager && $1"
}

installed() { chroot "$root" dpkg-query -W -f '${Installed-Size}\n' | awk '{ kb += $1 } END { print NR, int(kb / 1024) }'; }
fetched() { du -cm --apparent-size "$root"/var/cache/apt/archives/*.deb 2>/dev/null | awk 'END { print $1 + 0 }'; }
# Units of systemd, and links of init scripts, which start in the runlevels of the folder.
enabled() { find "$root"/etc/systemd/system "$root"/etc/rc?.d \( -path '*.wants/*.service' -o -name 'S[0-9]*' \) 2>/dev/null | sort; }
# Processes whose root is the folder's.
running() { for process in /proc/[0-9]*; do [ "$(readlink "$process/root")" != "$root" ] || cat "$process/comm"; done; }

# time_of LOG COMMAND: runs COMMAND in the root; sets minutes and cpu_minutes.
time_of() {
  local times
  TIMEFORMAT='%R %U %S'
  { times=$({ time inside "$2" 2>&1 | tee "$1" >&3; } 2>&1); } 3>&1 || fail "$2 failed: see $1" 1
  read -r minutes cpu_minutes < <(tail -1 <<<"$times" | awk '{ printf "%.1f %.1f\n", $1 / 60, ($2 + $3) / 60 }')
}

measure() {
  local packages_before mb_before packages_after mb_after part=main
  [ "$1" = demo ] || part=tests
  rm -rf "$root/voyager" "$root"/var/cache/apt/archives/*.deb
  git clone --quiet --no-hardlinks . "$root/voyager"
  read -r packages_before mb_before < <(installed)
  time_of "$folder/$1.packages.log" "scripts/setup.sh $part"
  local minutes_packages=$minutes
  read -r packages_after mb_after < <(installed)
  time_of "$folder/$1.log" "scripts/$1.sh"
  rows+=("$(printf '%-8s %9d %11d %12d %21s %21s %12s' "$1.sh" $((packages_after - packages_before)) "$(fetched)" \
    $((mb_after - mb_before)) "$minutes_packages" "$minutes" "$cpu_minutes")")
}

make_root
mount --make-rprivate /
mount_root
enabled_before=$(enabled)
rows=()
for command in "${commands[@]}"; do measure "$command"; done

printf '\n%s, %d cores, load %s\n' "$(git describe --always --dirty)" "$(nproc)" "$(cut -d' ' -f1-3 /proc/loadavg)"
printf '%-8s %9s %11s %12s %21s %21s %12s\n' "" packages "MB fetched" "MB unpacked" "minutes for packages" "minutes for the rest" "CPU minutes"
printf '%s\n' "${rows[@]}"
echo "services enabled by the packages: $(comm -13 <(echo "$enabled_before") <(enabled) | xargs -r -n1 basename | paste -sd ' ' | grep . || echo none)"
echo "programs left running: $(running | paste -sd ' ' | grep . || echo none)"
