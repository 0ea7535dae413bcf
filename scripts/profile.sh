#!/usr/bin/env bash
# What each kernel of a frame takes on a CUDA device, by Nsight Compute: time, bytes of device
# memory and the time that these alone would take, bytes through the L2 cache, instructions, how
# many warps are resident, and how long multiprocessors idle while the last blocks end; and what
# a Jetson AGX Orin would take by its rates.
#   scripts/profile.sh SCENE.voy CAMERAS.json [options of `voyager bench`]
# Frames are drawn with --stages all --exp ex2 --repeat 1 unless the options say otherwise; a search
# alone (--stages search) is not profiled. --backend, --cameras and --json are set already.
# Each launch runs several times and much slower than alone: a path of a few frames is enough.
# VOYAGER names another command line than this build's. The program needs the right to read the
# GPU's counters: root, or the driver's option NVreg_RestrictProfilingToAdminUsers=0.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
voyager=${VOYAGER:-$here/../build/release/bin/voyager}
if (($# < 2)); then
  sed -n '2,12s/^# \?//p' "$0"
  [[ ${1:-} == --help ]] || exit 2
  exit 0
fi
command -v ncu >/dev/null || {
  echo "profile.sh: found no ncu, expected Nsight Compute of the CUDA toolkit on the PATH" >&2
  exit 1
}
command -v "$voyager" >/dev/null || {
  echo "profile.sh: $voyager: found no program, expected a build, or VOYAGER to name another" >&2
  exit 1
}
drawn=()
[[ " ${*:3} " == *' --stages'[\ =]* ]] || drawn+=(--stages all)
[[ " ${*:3} " == *' --exp'[\ =]* ]] || drawn+=(--exp ex2)
[[ " ${*:3} " == *' --repeat'[\ =]* ]] || drawn+=(--repeat 1)
rows=$(mktemp)
trap 'rm -f "$rows" "$rows.json"' EXIT
metrics=gpu__time_duration.sum,dram__bytes.sum,dram__bytes.sum.per_second,\
dram__bytes.sum.peak_sustained,dram__cycles_elapsed.avg.per_second,lts__t_bytes.sum,smsp__inst_executed.sum,\
sm__warps_active.avg.pct_of_peak_sustained_active,sm__cycles_active.avg,sm__cycles_elapsed.max
ncu --csv --page raw --print-units base --nvtx --metrics "$metrics" --nvtx-include 'voyager@search/' \
  --nvtx-include 'voyager@project/' --nvtx-include 'voyager@bin/' --nvtx-include 'voyager@sort/' \
  --nvtx-include 'voyager@rasterize/' --clock-control none --target-processes all \
  "$voyager" bench "$1" --cameras "$2" --backend cuda --json "$rows.json" \
  "${drawn[@]}" "${@:3}" >"$rows" || {
  status=$?
  grep -v '^"' "$rows" >&2 || true # what ncu says, without its rows
  exit $status
}
python3 "$here/profile_table.py" "$rows"
