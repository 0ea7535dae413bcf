#!/usr/bin/env bash
# Makes the pictures of docs/viewer.md anew, on an X server without a screen: docs/pictures/viewer*.png.
# Needs a build with `voyager view`, Xvfb (scripts/setup.sh tests) and pngquant.
set -euo pipefail
cd "$(dirname "$0")/.."
voyager=$PWD/build/release/bin/voyager
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
export XDG_CACHE_HOME=$work
pictures=$PWD/docs/pictures
cd "$work"

"$voyager" synth city --gaussians 200000 -o city.ply
"$voyager" bake city.ply -o city.voy
"$voyager" synth city --gaussians 1500000 -o large.ply

view() {  # view SCENE [OPTION...], with a script on standard input
  cat >script.txt
  xvfb-run -a -s "-screen 0 1400x900x24" "$voyager" view "$@" --script script.txt
}

view city.voy <<END
loaded
still
window viewer.png
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
for picture in viewer*.png; do
  pngquant --force --speed 1 --output "$pictures/$picture" 128 "$picture"
done
ls -l "$pictures"/viewer*.png
