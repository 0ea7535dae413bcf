#!/usr/bin/env python3
"""A walk at a steady speed from recorded cameras:
walk60.py IN.json -o OUT.json [--speed 1.4] [--fps 60] [--first I] [--last J] [--jitter-fov P]

Positions follow a smooth curve through those of IN (of a stereo file, names ending in _L and _R, the
left eyes), --speed / --fps metres a frame; orientations turn evenly from camera to camera.
--jitter-fov P changes fx and fy every frame, smoothly, by up to P per cent, as headsets do. The same
arguments give the same file."""
import argparse
import json
import math
import random
import sys

PIECES = 64  # straight ones, that stand for the curve between two cameras
MOST_FRAMES = 1_000_000


def mix(a, b, t):
    return [(1 - t) * x + t * y for x, y in zip(a, b)]


def read_cameras(path, first, last):
    """Cameras first to last, each at another position than the one before it."""
    try:
        with open(path, encoding="utf-8") as file:
            cameras = json.load(file)
    except (OSError, ValueError) as error:
        sys.exit(f"{path}: {error}")
    if not isinstance(cameras, list):
        sys.exit(f"{path}: found {type(cameras).__name__}, expected an array of cameras")
    last = len(cameras) - 1 if last is None else last
    if not 0 <= first < last < len(cameras):
        sys.exit(f"--first {first}, --last {last}: expected 0 <= first < last < {len(cameras)}, the cameras of {path}")
    path_cameras = []
    for index, camera in enumerate(cameras[first:last + 1], first):
        check_camera(camera, f"{path}: camera {index}")
        again = path_cameras and math.dist(camera["position"], path_cameras[-1]["position"]) < 1e-6
        if not again and not str(camera.get("img_name", "")).endswith("_R"):
            path_cameras.append(camera)
    if len(path_cameras) < 2:
        sys.exit(f"{path}: found {len(path_cameras)} positions, expected at least 2 different ones")
    return path_cameras


def check_camera(camera, place):
    try:
        rows = [camera["position"], *camera["rotation"], [camera[name] for name in ("fx", "fy", "width", "height")]]
        sound = [len(row) for row in rows] == [3, 3, 3, 3, 4] and all(math.isfinite(x) for row in rows for x in row)
    except (KeyError, TypeError):
        sound = False
    if not sound:
        sys.exit(f"{place}: found {json.dumps(camera)[:80]}, expected position, rotation, width, height, fx, fy")


def quaternion(m):
    """(w, x, y, z) of a rotation given as rows; by its largest component, so that nothing cancels."""
    squares = [1 + m[0][0] + m[1][1] + m[2][2], 1 + m[0][0] - m[1][1] - m[2][2],
               1 + m[1][1] - m[0][0] - m[2][2], 1 + m[2][2] - m[0][0] - m[1][1]]
    wx, wy, wz = m[2][1] - m[1][2], m[0][2] - m[2][0], m[1][0] - m[0][1]
    xy, xz, yz = m[0][1] + m[1][0], m[0][2] + m[2][0], m[1][2] + m[2][1]
    ww, xx, yy, zz = squares
    q = ([ww, wx, wy, wz], [wx, xx, xy, xz], [wy, xy, yy, yz], [wz, xz, yz, zz])[squares.index(max(squares))]
    return [c / math.hypot(*q) for c in q]


def rotation(q):
    w, x, y, z = q
    return [[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]]


def slerp(a, b, t):
    dot = sum(x * y for x, y in zip(a, b))
    if dot < 0:
        b, dot = [-x for x in b], -dot
    angle = math.acos(min(1.0, dot))
    if angle > 1e-6:
        s = math.sin(angle)
        q = [math.sin((1 - t) * angle) / s * x + math.sin(t * angle) / s * y for x, y in zip(a, b)]
    else:
        q = mix(a, b, t)
    return [c / math.hypot(*q) for c in q]


def curve(points, i, t):
    """The centripetal Catmull-Rom curve between points i and i + 1, 0 <= t <= 1 (Barry and Goldman 1988)."""
    b, c = points[i], points[i + 1]
    a = points[i - 1] if i > 0 else mix(b, c, -1)
    d = points[i + 2] if i + 2 < len(points) else mix(b, c, 2)
    ta = -math.sqrt(math.dist(a, b))
    tc = math.sqrt(math.dist(b, c))
    td = tc + math.sqrt(math.dist(c, d))
    u = t * tc
    ab, bc, cd = mix(a, b, (u - ta) / -ta), mix(b, c, t), mix(c, d, (u - tc) / (td - tc))
    return mix(mix(ab, bc, (u - ta) / (tc - ta)), mix(bc, cd, u / td), t)


def walk(points, step):
    """Every `step` metres along the curve: the position, i, and how far it is from point i to i + 1, as a share."""
    frames, start = 0, 0.0  # start: metres from the first point to the present piece
    for i in range(len(points) - 1):
        corners = [curve(points, i, k / PIECES) for k in range(PIECES + 1)]
        pieces = [math.dist(p, q) for p, q in zip(corners, corners[1:])]
        before, length = 0.0, sum(pieces)
        for corner, after, piece in zip(corners, corners[1:], pieces):
            while frames * step < start + piece:
                along = frames * step - start
                yield mix(corner, after, along / piece), i, (before + along) / length
                frames += 1
            start += piece
            before += piece


def smooth_noise(seed):
    """A function of the frame: smooth, within [-1, 1], never twice the same in a walk."""
    generator = random.Random(seed)
    waves = [(period, generator.random()) for period in (13.7, 31.3, 71.9)]
    return lambda frame: sum(math.sin(2 * math.pi * (frame / period + phase)) for period, phase in waves) / len(waves)


def make_walk(cameras, step, jitter):
    points = [camera["position"] for camera in cameras]
    turns = [quaternion(camera["rotation"]) for camera in cameras]
    noise = smooth_noise(1)
    frames = []
    for position, i, share in walk(points, step):
        if len(frames) == MOST_FRAMES:
            sys.exit(f"--speed, --fps: found {step:g} metres a frame, expected a walk of at most {MOST_FRAMES} frames")
        factor = 1 + jitter / 100 * noise(len(frames))
        frames.append({
            **{name: cameras[i][name] for name in ("width", "height", "cx", "cy") if name in cameras[i]},
            "id": len(frames), "img_name": f"walk_{len(frames):06}",
            "position": [round(x, 7) for x in position],
            "rotation": [[round(x, 9) for x in row] for row in rotation(slerp(turns[i], turns[i + 1], share))],
            "fx": round(factor * cameras[i]["fx"], 6), "fy": round(factor * cameras[i]["fy"], 6)})
    return frames


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("cameras")
    parser.add_argument("-o", dest="output", required=True)
    parser.add_argument("--speed", type=float, default=1.4, help="metres a second")
    parser.add_argument("--fps", type=float, default=60.0)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--last", type=int)
    parser.add_argument("--jitter-fov", type=float, default=0.0, metavar="P", help="per cent")
    arguments = parser.parse_args()
    step = arguments.speed / arguments.fps if arguments.fps > 0 else 0
    if not 0 < step < math.inf:
        parser.error(f"found {arguments.speed} m/s at {arguments.fps} FPS, expected both above 0")
    if not 0 <= arguments.jitter_fov < 100:
        parser.error(f"--jitter-fov: found {arguments.jitter_fov}, expected 0 to 100 per cent")
    frames = make_walk(read_cameras(arguments.cameras, arguments.first, arguments.last), step, arguments.jitter_fov)
    try:
        with open(arguments.output, "w", encoding="utf-8") as file:
            json.dump(frames, file)
    except OSError as error:
        sys.exit(str(error))
    print(f"{arguments.output}: {len(frames)} frames, {step:.4f} m a frame")


if __name__ == "__main__":
    main()
