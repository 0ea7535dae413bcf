#!/usr/bin/env bash
# From an empty clone to pictures: builds what it runs, makes a city, bakes it, draws one picture,
# then a walk and a flight, and a window where there is a display. The CUDA module is built too where
# nvcc is found. Safe to run again.
set -euo pipefail
cd "$(dirname "$0")/.."
source scripts/steps.sh
bin=build/release/bin
out=demo
mkdir -p "$out"

# A display, and somebody before it who can close a window.
window=no
if [[ -n "${DISPLAY:-}${WAYLAND_DISPLAY:-}" && -z "${CI:-}" && -t 1 ]]; then window=yes; fi

step "set-up: packages that are missing"
if [[ $window = yes ]]; then scripts/setup.sh view; else scripts/setup.sh; fi

step "build: the library, the command line, a sample in C"
cmake --preset release -DVOYAGER_BUILD_SAMPLES=OFF -DVOYAGER_BUILD_TESTS=OFF \
  -DCMAKE_CUDA_ARCHITECTURES="$(scripts/cuda_architectures.sh)" >/dev/null
cmake --build --preset release --target voyager_tool c_minimal

step "a city of 400,000 Gaussians"
"$bin/voyager" synth city --gaussians 400000 -o "$out/city.ply"
"$bin/voyager" bake "$out/city.ply" -o "$out/city.voy"

step "the first picture"
"$bin/c_minimal" "$out/city.voy" "$out/still.png"
echo "Open $out/still.png"

# After the first picture, because device code takes longest to build.
targets=$(cmake --build --preset release --target help)
if grep -q '^voyager_cuda:' <<<"$targets"; then
  step "build: the CUDA module"
  cmake --build --preset release --target voyager_cuda
fi

step "what can draw here"
"$bin/voyager" devices

step "a walk and a flight through the city"
"$bin/voyager" render "$out/city.voy" --cameras "$out/city.cameras.json" --all -o "$out/walk"
step_times

look="Or look at it: $bin/voyager view YOUR.ply"
if [[ $window = no ]]; then look="In a window: scripts/setup.sh view, this script again, then $bin/voyager view YOUR.ply"; fi
cat <<END

Open       $PWD/$out/walk/0000.png, and on to 0119.png: the walk and the flight
Then try   $bin/voyager render $out/city.voy -o $out/above.png
With yours $bin/voyager render YOUR.ply -o yours.png
$look
END
if [[ $window = yes ]]; then "$bin/voyager" view "$out/city.voy" --cameras "$out/city.cameras.json"; fi
