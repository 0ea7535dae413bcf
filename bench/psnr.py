#!/usr/bin/env python3
"""PSNR (dB) and largest difference of two .pfm images: psnr.py A.pfm B.pfm

Values are clamped to [0, 1] first, as a screen shows them; peak 1."""
import array
import math
import sys


def read_pfm(path):
    with open(path, "rb") as file:
        magic, size, scale = file.readline().strip(), file.readline().split(), float(file.readline())
        if magic not in (b"PF", b"Pf") or scale > 0:
            sys.exit(f"{path}: found {magic!r} with scale {scale}, expected a little-endian .pfm")
        values = array.array("f", file.read())
    expected = int(size[0]) * int(size[1]) * (3 if magic == b"PF" else 1)
    if len(values) != expected:
        sys.exit(f"{path}: found {len(values)} values, expected {expected}")
    return values


def main(first, second):
    a, b = read_pfm(first), read_pfm(second)
    if len(a) != len(b):
        sys.exit(f"{first} has {len(a)} values, {second} {len(b)}")
    total = largest = 0.0
    for x, y in zip(a, b):
        if x != y:
            d = abs(min(max(x, 0.0), 1.0) - min(max(y, 0.0), 1.0))
            total += d * d
            largest = max(largest, d)
    decibels = math.inf if total == 0 else 10 * math.log10(len(a) / total)
    print(f"{decibels:.2f} dB, largest difference {largest * 255:.3f}/255")


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(sys.argv[1], sys.argv[2])
