#!/usr/bin/env python3
"""Cameras whose cut hangs on the last bit: edge_cameras.py SCENE.hier CAMERAS.json TAU OUT.json

For each of up to 60 positions of CAMERAS.json two cameras: one as if the whole image had 32 pixels
across, and one whose focal length makes τ* = (2τ + 1) / fx equal some node's size to the bit: a size
with fused multiply-adds falls below it, and the cut is another. All look at the sky: the cut does
not depend on the direction, and there is little to draw. SCENE.hier comes from `voyager export`."""
import json
import math
import struct
import sys

LARGEST_FX = 1e6  # a frustum of 16 pixels is then still wider than what is refused
UP = [[1, 0, 0], [0, 0, -1], [0, 1, 0]]  # forward is −y


def rounded(value):
    return struct.unpack("<f", struct.pack("<f", value))[0]


def read_boxes(path):
    """(min xyz, extent, max xyz, extent) of each node, as METHOD §2 lays the file out."""
    with open(path, "rb") as file:
        data = file.read()
    gaussians, = struct.unpack_from("<i", data, 0)
    nodes, = struct.unpack_from("<i", data, 4 + 236 * gaussians)
    if len(data) != 8 + 236 * gaussians + 60 * nodes:
        sys.exit(f"{path}: found {len(data)} bytes, expected {8 + 236 * gaussians + 60 * nodes}")
    return list(struct.iter_unpack("<8f", data[8 + 236 * gaussians + 28 * nodes:]))


def size(centre, box, product=rounded):
    """METHOD §3. A float64 operation on binary32 operands, rounded once more, is the binary32 one."""
    x, y, z = (rounded(centre[k] - min(max(centre[k], box[k]), box[4 + k])) for k in range(3))
    squared = rounded(rounded(rounded(x * x) + product(y * y)) + product(z * z))
    return rounded(box[3] / rounded(math.sqrt(squared))) if squared > 0 else math.inf


def edge_size(centre, boxes, start, least):
    """The size, at least so much, of a node that fused multiply-adds would make smaller, and so not refine."""
    for k in range(len(boxes)):
        box = boxes[(start + k * 104729) % len(boxes)]
        exact = size(centre, box)
        if least < exact < 1 and size(centre, box, product=lambda square: square) < exact:
            return exact
    sys.exit(f"no node's size at {centre} changes with fused multiply-adds")


def main(hier, cameras_file, tau, out):
    boxes = [box for box in read_boxes(hier) if box[3] > 0]
    with open(cameras_file, encoding="utf-8") as file:
        recorded = json.load(file)
    cameras = []
    for i, camera in enumerate(recorded[::max(1, len(recorded) // 60)]):
        centre = [rounded(x) for x in camera["position"]]
        edge = edge_size(centre, boxes, i * 7919, (2 * tau + 1) / LARGEST_FX)
        for fx in (camera["fx"] * 32 / camera["width"], (2 * tau + 1) / edge):
            cameras.append({"id": len(cameras), "img_name": f"edge_{len(cameras):04}", "width": 16, "height": 16,
                            "position": camera["position"], "rotation": UP, "fx": fx, "fy": fx})
    with open(out, "w", encoding="utf-8") as file:
        json.dump(cameras, file)


if __name__ == "__main__":
    if len(sys.argv) != 5:
        sys.exit(__doc__)
    main(sys.argv[1], sys.argv[2], float(sys.argv[3]), sys.argv[4])
