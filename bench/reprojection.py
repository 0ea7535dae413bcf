#!/usr/bin/env python3
"""What a frame between two is worth that is made from the one before (VoyVulkanReprojection):
reprojection.py SCENE CAMERAS -o FOLDER [--voyager PROGRAM] [--frames N] [--hz 72] [--speed 1.4]
                [--turn 0 30 100] [--options "..."]

N cameras of CAMERAS, spread over it. From each, the eye moves ahead by --speed metres a second and turns
to the right by each of --turn degrees a second, for one frame of --hz. PSNR against the truth
(`render --supersample 8`, every leaf) where the eye is then: of the frame drawn there, of the frame
before as it is, and of that reprojected, as vulkan_interop/shaders/reprojection.glsl does it. Needs numpy."""
import argparse
import json
import math
import os
import subprocess
import sys

try:
    import numpy
except ImportError:
    numpy = None  # --help works without

TURNS = 6  # as the shader


def moved(camera, metres, degrees):
    """INRIA's axes: columns of the rotation are right, down and forward in the world."""
    axes = numpy.array(camera["rotation"], float)
    a = math.radians(degrees)
    turn = numpy.array([[math.cos(a), 0, math.sin(a)], [0, 1, 0], [-math.sin(a), 0, math.cos(a)]])
    position = numpy.array(camera["position"], float) + metres * axes[:, 2]
    return dict(camera, position=position.tolist(), rotation=(axes @ turn).tolist())


def read_pfm(path):
    with open(path, "rb") as file:
        channels = 3 if file.readline().strip() == b"PF" else 1
        width, height = map(int, file.readline().split())
        file.readline()
        values = numpy.frombuffer(file.read(), "<f4").reshape(height, width, channels)
    return numpy.flipud(values)


def draw(options, cameras, index, name, *more):
    """Colour, and depth in metres."""
    paths = [os.path.join(options.o, f"{name}{end}.pfm") for end in ("", ".depth")]
    depth = [] if "--supersample" in more else ["--depth", paths[1]]
    subprocess.run([options.voyager, "render", options.scene, "--cameras", cameras, "--camera", str(index), "--float",
                    "-o", paths[0], "--quiet", *depth, *more, *options.options.split()], check=True)
    return read_pfm(paths[0]).clip(0, 1), read_pfm(paths[1])[..., 0] if depth else None


def reprojected(color, depth, drawn, now):
    height, width = depth.shape
    focal = numpy.array([drawn["fx"], drawn["fy"]])
    middle = numpy.array([width, height]) / 2
    axes, axes_now = (numpy.array(c["rotation"], float) for c in (drawn, now))
    turn = axes.T @ axes_now
    apart = axes.T @ (numpy.array(now["position"]) - numpy.array(drawn["position"]))
    y, x = numpy.mgrid[0:height, 0:width] + 0.5
    seen = numpy.stack([(x - middle[0]) / focal[0], (y - middle[1]) / focal[1], numpy.ones_like(x)], -1)
    inverse = numpy.zeros((height, width))
    for _ in range(TURNS):
        p = seen @ turn.T + apart * inverse[..., None]
        at = p[..., :2] / p[..., 2:] * focal + middle
        pixel = numpy.clip(numpy.floor(at), 0, [width - 1, height - 1]).astype(int)
        found = 1 / depth[pixel[..., 1], pixel[..., 0]]
        there = numpy.concatenate([(pixel + 0.5 - middle) / focal, numpy.ones((height, width, 1))], -1)
        share = (there - apart * found[..., None]) @ turn[:, 2]
        inverse = numpy.where(share > 0, found / share, 0)
    low = numpy.floor(at - 0.5)
    part = at - 0.5 - low
    out = numpy.zeros_like(color, float)
    for dy in (0, 1):
        for dx in (0, 1):
            weight = (part[..., 0] if dx else 1 - part[..., 0]) * (part[..., 1] if dy else 1 - part[..., 1])
            tap = numpy.clip(low + [dx, dy], 0, [width - 1, height - 1]).astype(int)
            out += weight[..., None] * color[tap[..., 1], tap[..., 0]]
    return out


def decibels(a, b):
    return -10 * math.log10(max(float(((a - b) ** 2).mean()), 1e-12))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scene")
    parser.add_argument("cameras")
    parser.add_argument("-o", required=True, metavar="FOLDER")
    parser.add_argument("--voyager", default="voyager")
    parser.add_argument("--frames", type=int, default=4)
    parser.add_argument("--hz", type=float, default=72)
    parser.add_argument("--speed", type=float, default=1.4)
    parser.add_argument("--turn", type=float, nargs="+", default=[0, 30, 100])
    parser.add_argument("--options", default="", help="for voyager, such as \"--tau 3 --size 960x540\"")
    options = parser.parse_args()
    if numpy is None:
        sys.exit("reprojection.py: found no numpy, expected it (python3-numpy)")
    os.makedirs(options.o, exist_ok=True)
    with open(options.cameras, encoding="utf-8") as file:
        walk = json.load(file)
    chosen = walk[::max(1, len(walk) // options.frames)][:options.frames]
    for turn in options.turn:
        pairs = [c for camera in chosen for c in (camera, moved(camera, options.speed / options.hz, turn / options.hz))]
        path = os.path.join(options.o, "pairs.json")
        with open(path, "w", encoding="utf-8") as file:
            json.dump(pairs, file)
        sums = numpy.zeros(3)
        for i in range(0, len(pairs), 2):
            before, depth = draw(options, path, i, "before")
            drawn, _ = draw(options, path, i + 1, "drawn")
            truth, _ = draw(options, path, i + 1, "truth", "--supersample", "8", "--lod", "off")
            scale = depth.shape[1] / pairs[i]["width"]
            sized = [dict(c, fx=c["fx"] * scale, fy=c["fy"] * scale) for c in pairs[i:i + 2]]
            line = [decibels(p, truth) for p in (drawn, before, reprojected(before, depth, *sized))]
            print("  camera {}: drawn {:.1f}, before {:.1f}, reprojected {:.1f} dB".format(i // 2, *line))
            sums += line
        print("{:g} degrees a second: drawn {:.1f}, before {:.1f}, reprojected {:.1f} dB".format(turn, *sums / len(chosen)))


if __name__ == "__main__":
    main()
