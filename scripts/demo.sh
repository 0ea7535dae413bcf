#!/usr/bin/env bash
# From an empty clone to pictures: builds what it runs, makes a city, bakes it, draws one picture,
# then a walk and a flight. The CUDA module is built too where nvcc is found. Safe to run again.
set -euo pipefail
cd "$(dirname "$0")/.."
source scripts/steps.sh
bin=build/release/bin
out=demo
mkdir -p "$out"

step "set-up: packages that are missing"
scripts/setup.sh

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

cat <<END

Open       $PWD/$out/walk/0000.png, and on to 0119.png: the walk and the flight
Then try   $bin/voyager render $out/city.voy -o $out/above.png
With yours $bin/voyager render YOUR.ply -o yours.png
END
