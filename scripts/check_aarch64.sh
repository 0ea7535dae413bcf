#!/usr/bin/env bash
# The same bytes on both machines: check_aarch64.sh NATIVE_BUILD AARCH64_BUILD
# A city and, where the real scenes are (tests/README.md), a block are baked, and
# the cuts of a walk dumped, by the native `voyager` and by the cross-compiled
# one under qemu-user. Baked files and cuts must be equal.
set -euo pipefail
cd "$(dirname "$0")/.."
native=("$1/bin/voyager")
aarch64=(qemu-aarch64 -L build/aarch64-sysroot "$2/bin/voyager")
scenes=${VOYAGER_SCENES:-../shared/scenes}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

quietly() { "$@" >"$work/said" 2>&1 || { cat "$work/said" >&2; return 1; }; }

same() {  # same WHAT A B
  diff -rq "$2" "$3" || { echo "check_aarch64.sh: $1: found different bytes on aarch64, expected equal" >&2; exit 1; }
}

check_scene() {  # check_scene NAME INPUT CAMERAS
  for quality in compact lossless; do
    quietly "${native[@]}" bake "$2" -o "$work/native.voy" --quality "$quality"
    quietly "${aarch64[@]}" bake "$2" -o "$work/aarch64.voy" --quality "$quality"
    same "$1, $quality bake" "$work/native.voy" "$work/aarch64.voy"
  done
  quietly "${native[@]}" export "$work/native.voy" -o "$work/native.hier"
  for tau in 0 3 15; do
    scripts/edge_cameras.py "$work/native.hier" "$3" "$tau" "$work/cameras.json"
    for machine in native aarch64; do
      rm -rf "$work/image" "$work/$machine.cut"
      local -n voyager=$machine
      quietly "${voyager[@]}" render "$work/native.voy" --cameras "$work/cameras.json" --all --tau "$tau" \
        --dump-cut "$work/$machine.cut" -o "$work/image"
    done
    same "$1, cuts at τ = $tau" "$work/native.cut" "$work/aarch64.cut"
    echo "$1, τ = $tau: $(ls "$work/native.cut" | wc -l) cuts, $(cat "$work"/native.cut/* | wc -l) nodes: equal"
  done
}

quietly "${native[@]}" synth city --gaussians 10000 -o "$work/city.ply"
check_scene city "$work/city.ply" "$work/city.cameras.json"
if [ -e "$scenes/README.md" ]; then
  check_scene block "$scenes/formats/block.ply" "$scenes/district.flight.cameras.json"
else
  echo "the block: left out (the real scenes are not here: set VOYAGER_SCENES to their folder)"
fi
