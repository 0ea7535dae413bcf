#!/usr/bin/env bash
# Makes the reports of docs/results anew, on the machine that it runs on and its first CUDA device:
#   bench/make_results.sh OUT [NAME SCENE.voy CAMERAS.json]...
# A synthetic city of VOYAGER_RESULTS_GAUSSIANS (6,000,000) is made and baked; other scenes come as
# NAME, a baked scene and its cameras. Each is measured on the whole device and on 16 of its
# multiprocessors, and has the curve of its tree. OUT/tables.md becomes docs/results/tables.md.
# VOYAGER names another command line than this build's. Safe to run again: what OUT holds is not made again.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
voyager=${VOYAGER:-$here/../build/release/bin/voyager}
if (($# < 1 || $# % 3 != 1)); then
  sed -n '2,7s/^# \?//p' "$0" >&2
  exit 2
fi
out=$1
shift
mkdir -p "$out/scenes"

gaussians=${VOYAGER_RESULTS_GAUSSIANS:-6000000} city=$out/scenes/city
[ -e "$city.voy" ] || {
  "$voyager" synth city --gaussians "$gaussians" --sh-degree 3 -o "$city.ply"
  "$voyager" bake "$city.ply" -o "$city.voy"
  rm "$city.ply"
}

reports=()
# Of one scene: reports on the whole device and on a part of it, and the curve.
measure() {
  local name=$1 scene=$2 cameras=$3 size=(--size 1920x1080)
  for part in all 16; do
    local sms=()
    [ $part = all ] || sms=(--sms "$part")
    reports+=("$out/${name}_$part")
    [ -e "$out/${name}_$part/steps.json" ] && continue
    "$voyager" report "$scene" --cameras "$cameras" --quick "${size[@]}" --backend cuda "${sms[@]}" \
      -o "$out/${name}_$part"
    "$voyager" bench "$scene" --cameras "$cameras" --stages all "${size[@]}" --repeat 1 --backend cuda \
      "${sms[@]}" --json "$out/${name}_$part/steps.json" >/dev/null
  done
  [ -e "$out/${name}_curve/curve.html" ] && return
  "$voyager" report "$scene" --cameras "$cameras" --curve --quick "${size[@]}" --backend cuda \
    -o "$out/${name}_curve"
}

measure city "$city.voy" "$city.cameras.json"
while (($# > 0)); do
  measure "$1" "$2" "$3"
  shift 3
done
python3 "$here/results.py" "${reports[@]}" >"$out/tables.md"
