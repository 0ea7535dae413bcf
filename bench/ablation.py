#!/usr/bin/env python3
"""`voyager bench` over scenes, granularities, sizes and multiprocessors, as Markdown tables:
ablation.py FOLDER [--voyager PATH --scene SCENE=CAMERAS [...] [--tau PX ...] [--size WxH ...] [--sms N ...]]

Reports go to FOLDER, one JSON a run; a run whose report is there already is not repeated, so that
without --scene the tables of what FOLDER holds are printed."""
import argparse
import glob
import itertools
import json
import os
import subprocess
import sys

STAGES = ("search", "project", "sort", "bin", "rasterize")
STEPS = ("3dgs", "base", "+ streaming", "+ temporal", "+ alpha-filter", "+ lut", "ours")


def stem(path):
    return os.path.basename(path).split(".")[0]


def run(arguments, stages, scene, cameras, tau, size, multiprocessors):
    """Times one setting, unless its report is there."""
    name = f"{stages}_{os.path.basename(scene)}_{stem(cameras)}_{size}_tau{tau:g}_sms{multiprocessors}.json"
    report = os.path.join(arguments.folder, name)
    if os.path.exists(report):
        return
    command = [arguments.voyager, "bench", scene, "--cameras", cameras, "--stages", stages, "--tau", f"{tau:g}",
               "--size", size, "--backend", arguments.backend, "--json", report]
    if multiprocessors:
        command += ["--sms", str(multiprocessors)]
    if arguments.repeat:
        command += ["--repeat", str(arguments.repeat)]
    done = subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"{' '.join(command)}: exit status {done.returncode}: {done.stderr.strip().splitlines()[-1:]}")


def number(value, digits=3):
    return "–" if value is None else f"{value:,.{digits}f}"


def count(value):
    return "–" if value is None else f"{value / 1e6:,.2f}"


def setting(report):
    """The first cells of a row: what was drawn, and on how much of the device."""
    return [f"{os.path.basename(report['scene'])}, {stem(report['cameras'])}", report["size"] or "own", f"{report['tau']:g}",
            str(report["multiprocessors_asked"] or "all")]


SETTING = ["scene, cameras", "size", "τ", "multiprocessors"]


def print_table(title, heads, rows):
    if not rows:
        return
    print(f"\n### {title}\n\n| {' | '.join(heads)} |\n|{'---|' * len(heads)}")
    for cells in rows:
        print(f"| {' | '.join(cells)} |")


def row_named(report, name):
    return next((row for row in report["rows"] if row["name"] == name), None)


def time_of(row, part, which="median"):
    return row["ms"][part][which] if row else None


def ratio(slow, fast):
    return f"{slow / fast:.2f}" if slow and fast else "–"


def ablation_row(report):
    rows = {name: row_named(report, name) for name in STEPS}
    times = [f"{number(time_of(row, 'frame'))} / {number(time_of(row, 'frame', 'p99'))}" if row else "–"
             for row in rows.values()]
    ratios = [ratio(time_of(rows[slow], part), time_of(rows["ours"], part))
              for slow, part in (("base", "frame"), ("3dgs", "frame"), ("base", "splat"))]
    return setting(report) + times + ratios


def stage_row(report, row):
    counters, floor = row["counters"], row["floor"] or {}
    scores = floor.get("score", {})
    pixels = [count(counters["pixels_evaluated"]), count(counters["pixels_blended"])]
    return (setting(report) + [row["name"]] + [number(time_of(row, stage)) for stage in STAGES]
            + [count(counters[name]) for name in ("cut", "splats", "pairs_before", "pairs_after")] + pixels
            + [number(row["work_efficiency"], 2)]
            + [number(scores.get(part), 2) for part in ("project", "sort", "rasterize", "frame")]
            + [number(floor.get("ms", {}).get("frame")), number(row["orin"]["model_ms"]["frame"], 2)])


def orin_row(report, row):
    """Megabytes that each stage moves, and how long Orin would take for them."""
    times = row["orin"]["stage_ms"] or dict.fromkeys(STAGES)
    cells = [f"{row['bytes'][stage] / 1e6:,.1f} → {number(times[stage])}" for stage in STAGES]
    total = None if None in times.values() else sum(times.values())
    return setting(report) + [row["name"]] + cells + [number(total)]


def exponential_row(report, row):
    error = row["error"]
    psnr = "same" if error["psnr"] is None else number(error["psnr"], 1)
    return setting(report) + [row["name"], number(time_of(row, "rasterize")), number(time_of(row, "frame")),
                              number(time_of(row, "frame", "p99")), psnr, number(255 * error["largest"], 2)]


def camera_rows(report):
    """Stills are quoted one by one: medians of splatting, row by row."""
    stepped = [row for row in report["rows"] if "cameras" in row]
    return [setting(report) + [row["name"]] + [" · ".join(number(camera["ms"]["splat"]) for camera in row["cameras"])]
            for row in stepped if len(row["cameras"]) <= 8]


def read_reports(folder):
    reports = []
    for path in glob.glob(os.path.join(folder, "*.json")):
        with open(path, encoding="utf-8") as file:
            reports.append(json.load(file))
    return sorted(reports, key=lambda report: (report["multiprocessors_asked"], report["scene"], report["cameras"],
                                               str(report.get("size")), report["tau"]))


def print_left_out(reports):
    for report in reports:
        reasons = {}
        for row in report["left_out"]:
            reasons.setdefault(row["why"], []).append(row["name"])
        for why, names in reasons.items():
            print(f"\nLeft out ({', '.join(setting(report))}): {', '.join(names)}: {why}")


def print_tables(folder):
    reports = read_reports(folder)
    steps = [report for report in reports if report.get("stages") == "all"]
    splats = [report for report in reports if report.get("stages") == "splat"]
    every = [(report, row) for report in steps for row in report["rows"]]
    print(", ".join(sorted({f"{report['device']}, version {report['version']}" for report in steps + splats})))
    print_table("From 3DGS to ours (frame, median / p99, ms)",
                SETTING + list(STEPS) + ["base / ours", "3dgs / ours", "base / ours, project to rasterize"],
                [ablation_row(report) for report in steps])
    print_table("Stage by stage (medians, ms; counters in millions, means)",
                SETTING + ["", *STAGES, "Gp", "V", "pairs before", "K", "Pe", "Pu", "Pu/Pe", "score: project",
                           "sort + bin", "rasterize", "frame", "floor", "Orin floor"],
                [stage_row(*pair) for pair in every])
    print_table("Bytes a stage (MB → ms on Orin at least)", SETTING + ["", *STAGES, "sum"],
                [orin_row(*pair) for pair in every])
    print_table("Stills (project to rasterize, median of each, ms)", SETTING + ["", "camera by camera"],
                [row for report in steps for row in camera_rows(report)])
    print_table("Exponentials (medians, ms; images against exact's)",
                SETTING + ["", "rasterize", "frame", "p99", "PSNR, dB", "largest, /255"],
                [exponential_row(report, row) for report in splats for row in report["rows"] if "error" in row])
    print_left_out(steps + splats)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder")
    parser.add_argument("--voyager", default="build/release/bin/voyager")
    parser.add_argument("--scene", nargs="+", action="extend", default=[], metavar="SCENE=CAMERAS")
    parser.add_argument("--stages", nargs="+", default=["all", "splat"], choices=["all", "splat"])
    parser.add_argument("--tau", nargs="+", type=float, default=[0, 3, 15], metavar="PX")
    parser.add_argument("--size", nargs="+", default=["1920x1080"], metavar="WxH")
    parser.add_argument("--sms", nargs="+", type=int, default=[0], metavar="N", help="0: the whole device")
    parser.add_argument("--backend", default="cuda", choices=["auto", "cpu", "cuda"])
    parser.add_argument("--repeat", type=int, metavar="N")
    arguments = parser.parse_args()
    os.makedirs(arguments.folder, exist_ok=True)
    for pair in arguments.scene:
        scene, equals, cameras = pair.partition("=")
        if not equals:
            parser.error(f"--scene: found {pair}, expected SCENE=CAMERAS")
        for choice in itertools.product(arguments.stages, arguments.tau, arguments.size, arguments.sms):
            stages, tau, size, multiprocessors = choice
            run(arguments, stages, scene, cameras, tau, size, multiprocessors)
    print_tables(arguments.folder)


if __name__ == "__main__":
    main()
