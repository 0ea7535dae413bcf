#!/usr/bin/env python3
"""What two pictures an eye save, a sharp one of the middle and a coarse one of everything:
foveation.py time|error SCENE CAMERAS -o FOLDER [--voyager PROGRAM] [--eye 2064x2208] [--tan 1.1]
             [--inner 0.4] [--outer 0.5] [--frames N] [--options "..."]

CAMERAS is a walk; each camera becomes two eyes, 63 mm apart, that see --tan to each side.
--inner is the middle's share of the width and height, drawn with every pixel; --outer the share of
the pixels' rows and columns that the picture of everything has.
time: `voyager bench --stereo` of the whole picture, of the coarse one and of the middle.
error: left eyes of N cameras, spread over the walk, against the truth (`render --supersample 8`): PSNR
over the middle, over the rest and over all, of the whole picture and of the two together. Needs numpy."""
import argparse
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
    return {"whole": (whole, options.tan), "coarse": (coarse, options.tan),
            "middle": (middle, options.tan * middle[0] / whole[0])}


def write_cameras(options, cameras):
    files = {}
    for name, (size, tan) in pictures_of(options).items():
        files[name] = os.path.join(options.o, name + ".json")
        with open(files[name], "w", encoding="utf-8") as file:
            json.dump([eye for i, camera in enumerate(cameras) for eye in eyes_of(camera, i, size, tan)], file)
    return files


def run(options, *arguments):
    subprocess.run([options.voyager, *arguments, "--quiet", *options.options.split()], check=True)


def time(options, cameras):
    files, both = write_cameras(options, cameras), {}
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


def error(options, cameras):
    import numpy
    step = max(1, len(cameras) // options.frames)
    files = write_cameras(options, cameras[::step][:options.frames])
    for index in range(0, 2 * options.frames, 2):
        images = {}
        for name, path, more in [(n, p, []) for n, p in files.items()] + [
                ("truth", files["whole"], ["--supersample", "8", "--lod", "off"])]:
            out = os.path.join(options.o, f"{index:04}_{name}.pfm")
            run(options, "render", options.scene, "--cameras", path, "--camera", str(index), "--float", "-o", out, *more)
            images[name] = read_pfm(out)
        height, width = images["truth"].shape[:2]
        two = enlarged(images["coarse"], (width, height))
        rows, columns = images["middle"].shape[:2]
        top, left = (height - rows) // 2, (width - columns) // 2
        two[top:top + rows, left:left + columns] = images["middle"]
        middle = numpy.zeros((height, width), bool)
        middle[top:top + rows, left:left + columns] = True
        line = []
        for picture in (images["whole"], two):
            squares = ((picture - images["truth"]) ** 2).mean(axis=2)
            line += [decibels(squares[middle]), decibels(squares[~middle]), decibels(squares)]
        print("camera {:3}: whole {:.1f} middle, {:.1f} rest, {:.1f} all; two pictures {:.1f}, {:.1f}, {:.1f} dB".format(
            index // 2 * step, *line))


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
