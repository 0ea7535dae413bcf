#!/usr/bin/env python3
"""A share of a tree as a flat file, against other files of the same size: PSNR at three distances.

  keep_share.py VOYAGER SCENE.ply X,Y,Z FILE...

SCENE is the truth. Four views each look from 22, 60 and 150 m, 30 degrees above the horizon, at
X,Y,Z: 480 x 270 pixels, f = 350, 6 x 6 samples a pixel, CPU. Prints the mean dB of each FILE."""
import json
import math
import os
import subprocess
import sys
import tempfile

DISTANCES = (22, 60, 150)  # metres
VIEWS = 4


def look(centre, distance, azimuth, elevation=math.radians(30)):
    """INRIA's camera, whose y is down: the axes right, down, forward are columns."""
    flat = math.cos(elevation)
    forward = (-flat * math.cos(azimuth), math.sin(elevation), -flat * math.sin(azimuth))
    right = (-math.sin(azimuth), 0, math.cos(azimuth))
    down = (forward[1] * right[2] - forward[2] * right[1], forward[2] * right[0] - forward[0] * right[2],
            forward[0] * right[1] - forward[1] * right[0])
    return {"position": [c - distance * f for c, f in zip(centre, forward)],
            "rotation": [list(row) for row in zip(right, down, forward)]}


def cameras(centre):
    return [{"id": i, "img_name": str(i), "width": 480, "height": 270, "fx": 350, "fy": 350,
             **look(centre, DISTANCES[i // VIEWS], 2 * math.pi * (i % VIEWS) / VIEWS)}
            for i in range(VIEWS * len(DISTANCES))]


def draw(voyager, scene, views, folder):
    done = subprocess.run([voyager, "render", scene, "--cameras", views, "--all", "--backend", "cpu",
                           "--supersample", "6", "--float", "-o", folder],
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    if done.returncode != 0:
        sys.exit(f"{scene}: {done.stdout}")
    return [os.path.join(folder, f"{i:04}.pfm") for i in range(VIEWS * len(DISTANCES))]


def psnr(a, b):
    script = os.path.join(os.path.dirname(os.path.abspath(__file__)), "psnr.py")
    return float(subprocess.run([sys.executable, script, a, b], stdout=subprocess.PIPE, text=True,
                                check=True).stdout.split()[0])


def main(voyager, scene, centre, *files):
    with tempfile.TemporaryDirectory() as folder:
        views = os.path.join(folder, "cameras.json")
        with open(views, "w") as file:
            json.dump(cameras([float(x) for x in centre.split(",")]), file)
        truth = draw(voyager, scene, views, os.path.join(folder, "truth"))
        print("| file | " + " | ".join(f"{d} m" for d in DISTANCES) + " |\n" + "|---" * 4 + "|")
        for number, name in enumerate(files):
            found = [psnr(a, b) for a, b in
                     zip(truth, draw(voyager, name, views, os.path.join(folder, str(number))))]
            means = [sum(found[i:i + VIEWS]) / VIEWS for i in range(0, len(found), VIEWS)]
            print(f"| {os.path.basename(name)} | " + " | ".join(f"{m:.1f}" for m in means) + " |",
                  flush=True)


if __name__ == "__main__":
    if len(sys.argv) < 5:
        sys.exit(__doc__)
    main(*sys.argv[1:])
