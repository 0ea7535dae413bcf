#!/usr/bin/env bash
# From an empty clone to pictures: builds Voyager, makes a city, bakes it, and
# renders a walk and a flight through it. Safe to run again.
set -euo pipefail
cd "$(dirname "$0")/.."
scripts/setup.sh

cmake --preset release
cmake --build --preset release --target voyager_tool c_minimal
bin=build/release/bin
out=demo
mkdir -p "$out"

"$bin/voyager" synth city --gaussians 400000 -o "$out/city.ply"
"$bin/voyager" bake "$out/city.ply" -o "$out/city.voy"
"$bin/voyager" render "$out/city.voy" --cameras "$out/city.cameras.json" --all -o "$out/walk"
"$bin/c_minimal" "$out/city.voy" "$out/still.png"

echo
echo "The walk and the flight: $PWD/$out/walk/0000.png to 0119.png"
echo "One still from the C sample: $PWD/$out/still.png"
