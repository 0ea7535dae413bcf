#!/usr/bin/env python3
"""What two pictures an eye save, a sharp one of the middle and a coarse one of everything:
foveation.py time|error SCENE CAMERAS -o FOLDER [--voyager PROGRAM] [--eye 2064x2208] [--tan 1.1]
             [--inner 0.4] [--outer 0.5] [--frames N] [--supersample 8] [--tiles T] [--options "..."]

CAMERAS is a walk; each camera becomes two eyes, 63 mm apart, that see --tan to each side.
--inner is the middle's share of the width and height, drawn with every pixel; --outer the share of
the pixels' rows and columns that the picture of everything has.
time: `voyager bench --stereo` of the whole picture, of the coarse one and of the middle.
error: left eyes of N cameras, spread over the walk, against the truth (`render --supersample`) in the pixels of
the whole picture: PSNR over the middle, over the rest and over all, of the whole picture, of the two together
(the coarse one enlarged), and of an even one, which has as many pixels as the two. "As drawn" is the PSNR of the
drawn picture, of the two the coarse one, against the truth in its own pixels. Needs numpy.
--tiles T draws the truth in T times T parts, each a picture with a frustum of its own. A picture's frustum bounds
the slopes of a Gaussian's covariance (docs/method.md §5): the narrower, the less large Gaussians near the camera,
beside the view, smear across it."""
import argparse
import itertools
import json
import math
import os
import subprocess
import sys

EYES_APART = 0.063  # metres


def size_of(text):
    width, height = text.split("x")
    return int(width), int(height)


def eyes_of(camera, index, size, tan):
    """The camera's two eyes, in pictures of a size, that see as far as tan to the left and right."""
    focal = size[0] / (2 * tan)
    right = [row[0] for row in camera["rotation"]]
    for side, name in ((-0.5, "L"), (0.5, "R")):
        position = [p + side * EYES_APART * r for p, r in zip(camera["position"], right)]
        yield {"id": 2 * index + (side > 0), "img_name": f"{index:04}_{name}", "width": size[0], "height": size[1],
               "position": position, "rotation": camera["rotation"], "fx": focal, "fy": focal}


def pictures_of(options):
    """Name, size and tangent of the pictures that an eye can have."""
    whole = size_of(options.eye)
    coarse = tuple(round(options.outer * n) for n in whole)
    middle = tuple(round(options.inner * n / 2) * 2 for n in whole)
    share = math.sqrt((math.prod(coarse) + math.prod(middle)) / math.prod(whole))
    return {"whole": (whole, options.tan), "coarse": (coarse, options.tan),
            "middle": (middle, options.tan * middle[0] / whole[0]),
            "even": (tuple(round(share * n) for n in whole), options.tan)}


def write_cameras(options, cameras, names):
    files = {}
    for name in names:
        size, tan = pictures_of(options)[name]
        files[name] = os.path.join(options.o, name + ".json")
        with open(files[name], "w", encoding="utf-8") as file:
            json.dump([eye for i, camera in enumerate(cameras) for eye in eyes_of(camera, i, size, tan)], file)
    return files


def run(options, *arguments):
    subprocess.run([options.voyager, *arguments, "--quiet", *options.options.split()], check=True)


def time(options, cameras):
    files, both = write_cameras(options, cameras, ["whole", "coarse", "middle"]), {}
    for name, path in files.items():
        result = os.path.join(options.o, name + ".bench.json")
        run(options, "bench", options.scene, "--cameras", path, "--stages", "all", "--stereo", "--json", result)
        with open(result, encoding="utf-8") as file:
            stereo = json.load(file)["stereo"]
        both[name] = stereo["frame"]["both"]
        pixels = math.prod(pictures_of(options)[name][0])
        print(f"{name:7} {pixels / 1e6:5.2f} M pixels an eye, both eyes {both[name]:.3f} ms, "
              f"{stereo['frame']['of_one_eye']:.2f} of one eye")
    together = both["coarse"] + both["middle"]
    print(f"coarse and middle {together:.3f} ms, {together / both['whole']:.2f} of the whole picture")


def read_pfm(path):
    import numpy
    with open(path, "rb") as file:
        file.readline()
        width, height = map(int, file.readline().split())
        file.readline()
        return numpy.flipud(numpy.frombuffer(file.read(), "<f4").reshape(height, width, 3)).clip(0, 1)


def enlarged(picture, size):
    """To size (width, height), bilinear, as a compositor does."""
    import numpy
    for axis, count in ((0, size[1]), (1, size[0])):
        at = ((numpy.arange(count) + 0.5) * picture.shape[axis] / count - 0.5).clip(0, picture.shape[axis] - 1)
        low = numpy.floor(at).astype(int)
        high = numpy.minimum(low + 1, picture.shape[axis] - 1)
        share = (at - low).astype("f4").reshape([-1 if a == axis else 1 for a in range(3)])
        picture = picture.take(low, axis) * (1 - share) + picture.take(high, axis) * share
    return picture


def decibels(squares):
    return -10 * math.log10(max(float(squares.mean()), 1e-12))


def draw(options, path, index, name):
    out = os.path.join(options.o, f"{index:04}_{name}.pfm")
    run(options, "render", options.scene, "--cameras", path, "--camera", str(index), "--float", "-o", out)
    return read_pfm(out)


def tiles_of(camera, count):
    """Where each tile begins and ends, and the camera that sees it alone."""
    edges = [[round(i * camera[side] / count) for i in range(count + 1)] for side in ("height", "width")]
    for (top, bottom), (left, right) in itertools.product(*(itertools.pairwise(e) for e in edges)):
        yield (slice(top, bottom), slice(left, right)), {
            **camera, "width": right - left, "height": bottom - top,
            "cx": camera["width"] / 2 - left, "cy": camera["height"] / 2 - top}


def draw_truth(options, path, index):
    import numpy
    with open(path, encoding="utf-8") as file:
        camera = json.load(file)[index]
    places, cameras = zip(*tiles_of(camera, options.tiles))
    cameras = [{**tile, "id": i, "img_name": f"{i:04}"} for i, tile in enumerate(cameras)]
    path, folder = (os.path.join(options.o, name) for name in ("tiles.json", "tiles"))
    with open(path, "w", encoding="utf-8") as file:
        json.dump(cameras, file)
    run(options, "render", options.scene, "--cameras", path, "--all", "--float", "-o", folder,
        "--supersample", str(options.supersample), "--lod", "off")
    truth = numpy.empty((camera["height"], camera["width"], 3), "f4")
    for i, place in enumerate(places):
        truth[place] = read_pfm(os.path.join(folder, f"{i:04}.pfm"))
    return truth


def errors_of(options, files, index):
    """Of one eye: for each kind of picture the PSNR of the middle, the rest, all, and as drawn."""
    import numpy
    drawn = {name: draw(options, path, index, name) for name, path in files.items()}
    truths = {name: draw_truth(options, files[name], index) for name in ("whole", "coarse", "even")}
    truth = truths["whole"]
    height, width = truth.shape[:2]
    rows, columns = drawn["middle"].shape[:2]
    top, left = (height - rows) // 2, (width - columns) // 2
    inside = numpy.zeros((height, width), bool)
    inside[top:top + rows, left:left + columns] = True
    two = enlarged(drawn["coarse"], (width, height))
    two[inside] = drawn["middle"].reshape(-1, 3)
    found = {}
    for name, picture, own in (("whole", drawn["whole"], "whole"), ("two pictures", two, "coarse"),
                               ("even", enlarged(drawn["even"], (width, height)), "even")):
        squares = ((picture - truth) ** 2).mean(axis=2)
        found[name] = [decibels(squares[inside]), decibels(squares[~inside]), decibels(squares),
                       decibels((drawn[own] - truths[own]) ** 2)]
    return found


def error(options, cameras):
    step = max(1, len(cameras) // options.frames)
    chosen = cameras[::step][:options.frames]
    files = write_cameras(options, chosen, list(pictures_of(options)))
    found = []
    for i in range(len(chosen)):
        found.append(errors_of(options, files, 2 * i))
        for name, row in found[-1].items():
            print(f"camera {i * step:3}, {name:12}: middle {row[0]:.1f}, rest {row[1]:.1f}, all {row[2]:.1f}, "
                  f"as drawn {row[3]:.1f} dB", flush=True)
    pixels = {name: math.prod(size) for name, (size, _) in pictures_of(options).items()}
    pixels["two pictures"] = pixels["coarse"] + pixels["middle"]
    print("\n| mean PSNR, dB | pixels | middle | rest | all | as drawn |\n|---|---|---|---|---|---|")
    for name in found[0]:
        means = [f"{sum(row[name][i] for row in found) / len(found):.1f}" for i in range(4)]
        print(f"| {name} | {pixels[name] / pixels['whole']:.2f} | {' | '.join(means)} |")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=["time", "error"])
    parser.add_argument("scene")
    parser.add_argument("cameras")
    parser.add_argument("-o", required=True, metavar="FOLDER")
    parser.add_argument("--voyager", default="voyager")
    parser.add_argument("--eye", default="2064x2208")
    parser.add_argument("--tan", type=float, default=1.1)
    parser.add_argument("--inner", type=float, default=0.4)
    parser.add_argument("--outer", type=float, default=0.5)
    parser.add_argument("--frames", type=int, default=3)
    parser.add_argument("--supersample", type=int, default=8)
    parser.add_argument("--tiles", type=int, default=1)
    parser.add_argument("--options", default="", help="for voyager, such as \"--tau 3\"")
    options = parser.parse_args()
    os.makedirs(options.o, exist_ok=True)
    with open(options.cameras, encoding="utf-8") as file:
        cameras = json.load(file)
    if not cameras:
        sys.exit(f"{options.cameras}: found no camera, expected a walk")
    {"time": time, "error": error}[options.what](options, cameras)


if __name__ == "__main__":
    main()
