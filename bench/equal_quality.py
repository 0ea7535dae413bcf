#!/usr/bin/env python3
"""What a frame costs where trees of one scene look equally good, as a Markdown table:
equal_quality.py CURVE.json FOLDER --cameras F --trees A.voy [B.voy ...] [--voyager PATH --decibels DB ...
                 --size WxH --sms N ...]

CURVE.json is of `voyager report --curve` with the same trees and cameras, a path: the τ of each tree is
between those of its rows of `flight`, by straight lines over the decibels. `voyager bench` then times the
path at this τ, and once with every leaf of the first tree; its reports go to FOLDER and are not repeated."""
import argparse
import json
import os
import subprocess
import sys


def stem(path):
    return os.path.basename(path).rsplit(".", 1)[0]


def read(path):
    with open(path, encoding="utf-8") as file:
        return json.load(file)


def at_quality(rows, decibels):
    """τ and share of the leaves; None where the curve does not reach."""
    points = sorted((row["psnr_db"], row["tau"], row["cut_share"]) for row in rows)
    for (low, tau_low, share_low), (high, tau_high, share_high) in zip(points, points[1:]):
        if low <= decibels <= high and low < high:
            t = (decibels - low) / (high - low)
            return tau_low + t * (tau_high - tau_low), share_low + t * (share_high - share_low)
    return None


def timed(arguments, tree, multiprocessors, choice):
    """The bench's row of one configuration."""
    name = "_".join([stem(tree), stem(arguments.cameras), arguments.size or "own", arguments.backend, arguments.exp,
                     "".join(choice).strip("-"), f"sms{multiprocessors}.json"])
    report = os.path.join(arguments.folder, name)
    if not os.path.exists(report):
        command = [arguments.voyager, "bench", tree, "--cameras", arguments.cameras, "--stages", "all", "--exp", arguments.exp,
                   "--backend", arguments.backend, "--json", report, *choice]
        command += ["--size", arguments.size] if arguments.size else []
        command += ["--sms", str(multiprocessors)] if multiprocessors else []
        done = subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, check=False)
        if done.returncode != 0:
            sys.exit(f"{' '.join(command)}: exit status {done.returncode}: {done.stderr.strip()}")
    return read(report)["rows"][0]


def cells(row):
    ms = row["ms"]
    search = ms.get("search")
    return [f"{search['median']:.3f}" if search else "–", f"{ms['splat']['median']:.3f}",
            f"{ms['frame']['median']:.3f} / {ms['frame']['p99']:.3f}"]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("curve")
    parser.add_argument("folder")
    parser.add_argument("--cameras", required=True)
    parser.add_argument("--trees", nargs="+", required=True)
    parser.add_argument("--voyager", default="voyager")
    parser.add_argument("--backend", default="cuda")
    parser.add_argument("--exp", default="ex2")
    parser.add_argument("--decibels", nargs="+", type=float, default=[25, 30, 35, 40])
    parser.add_argument("--size")
    parser.add_argument("--sms", nargs="+", type=int, default=[0])
    arguments = parser.parse_args()
    os.makedirs(arguments.folder, exist_ok=True)
    rows = [row for row in read(arguments.curve)["rows"] if row["view"] == "flight"]
    print("| PSNR, dB | multiprocessors | tree | of the leaves | τ | search | splatting | frame, median / p99 |\n|---|---|---|---|---|---|---|---|")
    for multiprocessors in arguments.sms:
        own = str(multiprocessors or "all")
        for decibels in arguments.decibels:
            for tree in arguments.trees:
                found = at_quality([row for row in rows if row["tree"] == stem(tree)], decibels)
                if found is None:
                    print(f"| {decibels:g} | {own} | {stem(tree)} | not on the curve | | | | |")
                    continue
                row = timed(arguments, tree, multiprocessors, ["--tau", f"{found[0]:.4g}"])
                print(f"| {decibels:g} | {own} | {stem(tree)} | {found[1]:.1%} | {found[0]:.2f} | {' | '.join(cells(row))} |")
        row = timed(arguments, arguments.trees[0], multiprocessors, ["--lod", "off"])
        print(f"| ∞ | {own} | every leaf | 100 % | | {' | '.join(cells(row))} |")


main()
