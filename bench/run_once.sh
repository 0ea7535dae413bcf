#!/usr/bin/env bash
# Runs each benchmark and each script of bench/ once, on a tiny made-up city, so that none rots: run_once.sh BUILD.
# Under a minute. The figures mean nothing. What this machine lacks is skipped, with the reason.
set -euo pipefail
cd "$(dirname "$0")/.."
bin=$1/bin
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
skipped=0

run() {
  echo "$*"
  "$@" >"$folder/output" 2>&1 || { cat "$folder/output" >&2; echo "run_once.sh: $*: failed" >&2; exit 1; }
}
skip() { echo "skipped: $1: $2"; skipped=$((skipped + 1)); }

scene=$folder/city.voy compact=$folder/compact.voy cameras=$folder/three.json
run "$bin/voyager" synth city --gaussians 10000 --sh-degree 1 -o "$folder/city.ply"
run "$bin/voyager" bake "$folder/city.ply" -o "$scene" --quality lossless
run "$bin/voyager" bake "$folder/city.ply" -o "$compact"
run python3 bench/walk60.py "$folder/city.cameras.json" -o "$folder/walk.json" --last 1
python3 -c 'import json, sys; json.dump(json.load(open(sys.argv[1]))[:3], open(sys.argv[2], "w"))' \
  "$folder/city.cameras.json" "$cameras"

export VOYAGER_BENCH_SCENE=$scene VOYAGER_BENCH_CAMERAS=$cameras VOYAGER_BENCH_SIZE=64x36 VOYAGER_BENCH_FILE=$folder/file
run "$bin/frame_bench" --benchmark_min_time=0.01
head -c 64000000 /dev/urandom >"$folder/file"
run "$bin/source_bench" --benchmark_min_time=0.01
run "$bin/read_bench" "$folder/city.ply" --benchmark_min_time=0.01
run "$bin/search_scale" --gaussians 5000 --cameras "$cameras" --backend cpu --json "$folder/scale.json"
run "$bin/stream_walk" "$scene" "$cameras" 4 60 64x36 3 1
run "$bin/stream_flight" "$scene" "$cameras" 4 50 64x36
run "$bin/stream_quality" "$scene" "$cameras" 4 0 64x36
run "$bin/useful_share" "$scene" "$cameras" 64x36 3 15
if [ -x "$bin/leaf_bytes" ]; then run "$bin/leaf_bytes" "$compact"; else skip "leaf_bytes" "built without CUDA"; fi
if [ -e /dev/nvidia0 ]; then
  run "$bin/handoff_bench" "$scene" "$cameras" 64x36
  run "$bin/turns_bench"
else
  skip "handoff_bench, turns_bench" "no NVIDIA GPU"
fi

mkdir "$folder/ablation" "$folder/equal" "$folder/budget"
run python3 bench/bake.py "$bin" "$folder" 10000
run python3 bench/ablation.py "$folder/ablation" --voyager "$bin/voyager" --scene "$scene=$cameras" --stages all --tau 3 \
  --size 64x36 --backend cpu --repeat 1
run "$bin/voyager" report "$scene" --curve --trees "$compact" --cameras "$cameras" --backend cpu --size 64x36 -o "$folder/curve"
run python3 bench/equal_quality.py "$folder/curve/curve.json" "$folder/equal" --cameras "$cameras" --trees "$scene" "$compact" \
  --voyager "$bin/voyager" --backend cpu --size 64x36 --decibels 20
run "$bin/voyager" report "$scene" --cameras "$cameras" --backend cpu --quick --size 64x36 -o "$folder/report"
run python3 bench/results.py "$folder/report"
for i in 0 1; do run "$bin/voyager" render "$scene" --cameras "$cameras" --camera "$i" --size 64x36 --float -o "$folder/$i.pfm"; done
run python3 bench/psnr.py "$folder/0.pfm" "$folder/1.pfm"
eyes=("$scene" "$cameras" -o "$folder/eyes" --voyager "$bin/voyager" --eye 40x44 --frames 1 --options "--backend cpu")
run python3 bench/foveation.py time "${eyes[@]}"
if python3 -c 'import numpy' 2>/dev/null; then
  run python3 bench/foveation.py error "${eyes[@]}" --tiles 2
  run python3 bench/reprojection.py "$scene" "$cameras" -o "$folder/between" --voyager "$bin/voyager" --frames 1 --turn 30 \
    --options "--size 64x36 --backend cpu"
else
  skip "bench/foveation.py error, bench/reprojection.py" "Python has no numpy"
fi
if python3 -c 'import matplotlib' 2>/dev/null; then
  run python3 bench/time_budget.py "$folder/budget" --voyager "$bin/voyager" --scene "$scene=$cameras" --ms 5 --size 64x36 --backend cpu
else
  skip "bench/time_budget.py" "Python has no matplotlib"
fi
echo "benchmarks and scripts ran once; $skipped skipped"
