#!/usr/bin/env bash
# Makes the pictures of the viewer and of the samples in docs/pictures anew, without a screen or a headset.
# Needs a release build of everything, a Vulkan device (scripts/setup.sh tests brings one in software) and pngquant.
set -euo pipefail
cd "$(dirname "$0")/.."
build=$PWD/build/release
voyager=$build/bin/voyager
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
export XDG_CACHE_HOME=$work
pictures=$PWD/docs/pictures
cd "$work"

"$voyager" synth city --gaussians 200000 -o city.ply
"$voyager" bake city.ply -o city.voy
"$voyager" synth city --gaussians 1500000 -o large.ply
"$voyager" synth city --gaussians 400000 -o samples.ply
"$voyager" bake samples.ply -o samples.voy
camera() {  # camera I FILE: the I-th of the city's
  python3 -c 'import json, sys; json.dump([json.load(open("samples.cameras.json"))[int(sys.argv[1])]], open(sys.argv[2], "w"))' "$@"
}

view() {  # view SCENE [OPTION...], with a script on standard input
  cat >script.txt
  env -u DISPLAY -u WAYLAND_DISPLAY "$voyager" view "$@" --script script.txt
}

view city.voy <<END
loaded
still
window viewer.png
END
view city.voy --size 1280x1000 <<END  # as high as the panel with all of its sections
loaded
bookmark
still
window viewer_panel.png
END
view city.voy --cameras city.cameras.json --camera 70 <<END
loaded
tau 12
line 0.6
right settings
right-tau 2
still
window viewer_split.png
right detail
still
window viewer_detail.png
measure
still
window viewer_error.png
END
view large.ply <<END
loaded
frames 10
window viewer_sample.png
END

camera 90 air.json
"$build/bin/vulkan_host" samples.voy --offscreen --frames 1 --tau 1 --camera-file air.json -o host
camera 30 street.json
echo '{"recommended": [400, 420]}' >script.json
XR_RUNTIME_JSON=$build/lib/voyager_test_runtime.json VOYAGER_TEST_RUNTIME_SCRIPT=$PWD/script.json \
  "$build/bin/openxr_headset" samples.voy --frames 1 --tau 1 --fixed-pose --camera-file street.json --readback eyes
cp host/0000.png vulkan_host.png
for eye in L_left R_right; do cp "eyes/0000_${eye%_*}.png" "headset_${eye#*_}.png"; done

for picture in *.png; do
  pngquant --force --speed 1 --output "$pictures/$picture" 128 "$picture"
done
ls -l "$pictures"
