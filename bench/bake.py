#!/usr/bin/env python3
"""Time and peak memory of `voyager bake`: bake.py BIN_FOLDER FOLDER N [N ...]

Makes a synthetic city of N Gaussians at SH 3 in FOLDER, bakes it in both
qualities, and prints wall seconds, peak memory and bytes a Gaussian."""
import os
import subprocess
import sys
import time


def run(command):
    """Wall seconds and peak resident bytes of one command."""
    start = time.monotonic()
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    _, status, usage = os.wait4(process.pid, 0)
    if status != 0:
        sys.exit(f"{' '.join(command)}: exit status {status}")
    return time.monotonic() - start, usage.ru_maxrss * 1024


def main(binaries, folder, counts):
    voyager = os.path.join(binaries, "voyager")
    ply, voy = os.path.join(folder, "bench_city.ply"), os.path.join(folder, "bench_city.voy")
    print("| Gaussians | quality | s | peak MB | bytes a Gaussian | file MB |\n|---|---|---|---|---|---|")
    for count in counts:
        run([voyager, "synth", "city", "--gaussians", str(count), "-o", ply])
        for quality in ("lossless", "compact"):
            seconds, peak = run([voyager, "bake", ply, "-o", voy, "--quality", quality])
            print(f"| {count:,} | {quality} | {seconds:.2f} | {peak / 1e6:.0f} | {peak / count:.0f} "
                  f"| {os.path.getsize(voy) / 1e6:.1f} |", flush=True)
    os.remove(ply)
    os.remove(voy)


if __name__ == "__main__":
    if len(sys.argv) < 4:
        sys.exit(__doc__)
    main(sys.argv[1], sys.argv[2], [int(count) for count in sys.argv[3:]])
