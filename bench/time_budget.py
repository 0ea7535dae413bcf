#!/usr/bin/env python3
"""`voyager bench --time-budget` over scenes, rates and multiprocessors, as a Markdown table and plots:
time_budget.py FOLDER [--voyager PATH --scene SCENE=CAMERAS [...] [--hz F ...] [--ms MS ...] [--size WxH ...]
               [--sms N ...] [--stereo]]

The budget is 1000 / F milliseconds less --reserve, what a host's own work takes of a frame, or MS.
Reports go to FOLDER, one JSON a run, each with a plot beside it: milliseconds and τ over the frames.
A run whose report is there is not repeated, so that without --scene the table and plots are made of
what FOLDER holds."""
import argparse
import glob
import itertools
import json
import os
import subprocess
import sys

import matplotlib

matplotlib.use("Agg")
from matplotlib import pyplot  # noqa: E402  (after the backend is chosen)


def stem(path):
    return os.path.basename(path).removesuffix(".json").removesuffix(".cameras")


def run(arguments, scene, cameras, budget, size, multiprocessors):
    """Times one setting, unless its report is there."""
    name = f"{os.path.basename(scene)}_{stem(cameras)}_{size}_{budget:.3f}ms_sms{multiprocessors}{'_stereo' * arguments.stereo}.json"
    report = os.path.join(arguments.folder, name)
    if os.path.exists(report):
        return
    command = [arguments.voyager, "bench", scene, "--cameras", cameras, "--stages", "all", "--time-budget", f"{budget:.6g}",
               "--backend", arguments.backend, "--repeat", str(arguments.repeat), "--json", report]
    if arguments.stereo:
        command.append("--stereo")
    if size != "own":
        command += ["--size", size]
    if multiprocessors:
        command += ["--sms", str(multiprocessors)]
    done = subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"{' '.join(command)}: exit status {done.returncode}: {done.stderr.strip().splitlines()[-1:]}")


def plot(report, path):
    budget = report["rows"][0]["time_budget"]
    figure, (times, taus) = pyplot.subplots(2, 1, sharex=True, figsize=(10, 5), layout="constrained")
    frames = range(len(budget["path"]["ms"]))
    times.plot(frames, budget["path"]["ms"], linewidth=0.8)
    times.axhline(budget["milliseconds"], color="tab:red", linewidth=0.8, label="budget")
    times.axhline(0.9 * budget["milliseconds"], color="tab:grey", linewidth=0.8, linestyle="--", label="aim")
    times.set_ylim(0, max(1.5 * budget["milliseconds"], 1.1 * sorted(budget["path"]["ms"])[int(0.99 * len(frames))]))
    times.set_ylabel("milliseconds")
    times.legend(loc="upper right")
    times.set_title(f"{os.path.basename(report['scene'])}, {stem(report['cameras'])}, {report['size'] or 'own size'}: "
                    f"{100 * budget['on_time']:.1f} % of the frames within {budget['milliseconds']:.3f} ms")
    taus.plot(frames, budget["path"]["tau"], color="tab:green", linewidth=0.8)
    taus.set_yscale("log")
    taus.set_ylabel("τ, pixels")
    taus.set_xlabel("frame")
    figure.savefig(path, dpi=120)
    pyplot.close(figure)


def decibels(values):
    """Mean and least; None is the same image."""
    known = [value for value in values if value is not None]
    return "same" if not known else f"{sum(known) / len(known):.1f} / {min(known):.1f}"


def cells(report):
    budget = report["rows"][0]["time_budget"]
    tau, ms = budget["tau"], budget["ms"]
    return [f"{os.path.basename(report['scene'])}, {stem(report['cameras'])}", str(report["eyes"]), report["size"] or "own",
            str(report["multiprocessors_asked"] or "all"), f"{budget['milliseconds']:.3f}", f"{100 * budget['on_time']:.1f}",
            f"{100 * budget['unreachable']:.1f}", f"{ms['median']:.3f} / {ms['p99']:.3f}",
            f"{tau['median']:.2f} / {tau['p99']:.2f}", f"{100 * budget['moved']:.1f}",
            decibels([row["budget"] for row in budget["psnr"]]), decibels([row["fixed"] for row in budget["psnr"]])]


HEADS = ["scene, cameras", "eyes", "size", "multiprocessors", "budget, ms", "on time, %", "late at the greatest τ, %",
         "ms: median / p99", "τ: median / p99", "frames that moved τ, %", "PSNR against all leaves, dB: mean / least",
         "the same at τ = 3"]


def print_table(folder):
    print(f"| {' | '.join(HEADS)} |\n|{'---|' * len(HEADS)}")
    for path in sorted(glob.glob(os.path.join(folder, "*.json"))):
        with open(path, encoding="utf-8") as file:
            report = json.load(file)
        if "time_budget" not in report.get("rows", [{}])[0]:
            continue
        plot(report, path.removesuffix(".json") + ".png")
        print(f"| {' | '.join(cells(report))} |")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder")
    parser.add_argument("--voyager", default="build/release/bin/voyager")
    parser.add_argument("--scene", nargs="+", action="extend", default=[], metavar="SCENE=CAMERAS")
    parser.add_argument("--hz", nargs="+", type=float, default=[], metavar="F")
    parser.add_argument("--reserve", type=float, default=0.0, metavar="MS")
    parser.add_argument("--ms", nargs="+", type=float, default=[], metavar="MS")
    parser.add_argument("--size", nargs="+", default=["own"], metavar="WxH", help="own: each camera's")
    parser.add_argument("--sms", nargs="+", type=int, default=[0], metavar="N", help="0: the whole device")
    parser.add_argument("--backend", default="cuda", choices=["auto", "cpu", "cuda"])
    parser.add_argument("--repeat", type=int, default=1, metavar="N")
    parser.add_argument("--stereo", action="store_true", help="cameras two by two; PSNR is the left eyes'")
    arguments = parser.parse_args()
    os.makedirs(arguments.folder, exist_ok=True)
    budgets = arguments.ms + [1000 / rate - arguments.reserve for rate in arguments.hz]
    for pair in arguments.scene:
        scene, equals, cameras = pair.partition("=")
        if not equals:
            parser.error(f"--scene: found {pair}, expected SCENE=CAMERAS")
        for choice in itertools.product(budgets, arguments.size, arguments.sms):
            budget, size, multiprocessors = choice
            run(arguments, scene, cameras, budget, size, multiprocessors)
    print_table(arguments.folder)


if __name__ == "__main__":
    main()
