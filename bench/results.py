#!/usr/bin/env python3
"""Reports of `voyager report`, side by side, as docs/results/tables.md: results.py FOLDER ...

Each FOLDER holds a report.json, and may hold a steps.json of `voyager bench --stages all`."""
import json
import os
import sys


def decibels(value):
    return "∞" if value is None else f"{value:.1f}"


def change(row):
    """What a row has in the place of the default's."""
    if row["group"] in ("default", "tau"):
        return "every leaf" if row["lod"] == "off" else f"τ {row['tau']:g}"
    if row["group"] == "select":
        return f"{row['select']}, τ {row['tau']:g}"
    if row["group"] == "exp":
        return f"lut {row['lut_size']}" if row["exp"] == "lut" else row["exp"]
    if row["group"] == "search":  # slack is the temporal one's
        return row["search"] + (", slack off" if row["search"] == "temporal" and not row["slack"] else "")
    return {"sh": f"SH {row['sh_degree']}", "filter": "no α-filter", "splat": f"3dgs, lod {row['lod']}",
            "quality": row["quality"]}.get(row["group"], row["name"])


def order(row):
    if row["group"] in ("default", "tau"):
        return -1 if row["lod"] == "off" else row["tau"]
    return row["lut_size"] or 0


HEADS = ["", "Gaussians", "pairs", "ms, median / p95", "search", "PSNR, same cut", "PSNR, truth", "SSIM", "FLIP", "largest", "popping"]


def cells(row):
    same, all_leaves, ms = row["error"], row["total_error"], row["ms"]
    return [change(row) + (", the default" if row["group"] == "default" else ""), f"{row['cut']:,.0f}", f"{row['pairs']:,.0f}",
            f"{ms['frame']['median']:.3f} / {ms['frame']['p95']:.3f}", f"{ms['search']['median']:.3f}", decibels(same["psnr_db"]),
            decibels(all_leaves["psnr_db"]), "–" if all_leaves["ssim"] is None else f"{all_leaves['ssim']:.4f}", f"{all_leaves['flip']:.4f}",
            f"{255 * same['max_abs']:.2f}", "–" if all_leaves["popping"] is None else f"{all_leaves['popping']:.2f}"]


def read_report(folder):
    with open(os.path.join(folder, "report.json"), encoding="utf-8") as file:
        return json.load(file)


def name_of(folder):
    return os.path.basename(os.path.normpath(folder))


def only(rows, wanted):
    """The one row that is wanted; None where a report has none."""
    return next((row for row in rows if wanted(row)), None)


def frame_ms(row):
    return "–" if row is None else f"{row['ms']['frame']['median']:.3f} / {row['ms']['frame']['p99']:.3f}"


def truth_db(row):
    return "–" if row is None else decibels(row["total_error"]["psnr_db"])


def print_first_page(folders):
    """What a reader wants first: of each report a frame's time, its quality, and a leaf's bytes."""
    print("| | ms a frame, median / p99: default | every leaf | every leaf as 3DGS splats | PSNR to the truth: default | every leaf | bytes a leaf, file |")
    print("|---|---|---|---|---|---|---|")
    for folder in folders:
        report = read_report(folder)
        rows = report["rows"]
        default = only(rows, lambda row: row["group"] == "default")
        leaves = default if default["lod"] == "off" else only(rows, lambda row: row["group"] == "tau" and row["lod"] == "off")
        splat = only(rows, lambda row: row["group"] == "splat" and row["lod"] == "off")
        size = "–" if leaves is None else f"{report['provenance']['scene']['bytes'] / leaves['cut']:.0f}"
        print(f"| {name_of(folder)} | {frame_ms(default)} | {frame_ms(leaves)} | {frame_ms(splat)} | {truth_db(default)} | {truth_db(leaves)} | {size} |")


STEPS = ["3dgs", "base", "+ streaming", "+ temporal", "+ alpha-filter", "+ lut", "ours"]


def print_steps(folders):
    """The paper's steps, from 3DGS to ours: milliseconds a frame, median."""
    print(f"\n| | {' | '.join(STEPS)} | base / ours | 3dgs / ours |\n|{'---|' * (len(STEPS) + 3)}")
    for folder in folders:
        path = os.path.join(folder, "steps.json")
        if not os.path.exists(path):
            continue
        with open(path, encoding="utf-8") as file:
            rows = json.load(file)["rows"]
        ms = {row["name"]: row["ms"]["frame"]["median"] for row in rows}
        times = [ms.get(step) for step in STEPS]
        ratios = [ms[step] / ms["ours"] if step in ms and "ours" in ms else None for step in ("base", "3dgs")]
        texts = ["–" if t is None else f"{t:.3f}" for t in times] + ["–" if r is None else f"{r:.1f}" for r in ratios]
        print(f"| {name_of(folder)} | {' | '.join(texts)} |")


def print_report(folder):
    report = read_report(folder)
    rows = report["rows"]
    print(f"\n### {name_of(folder)}\n\n{report['method']} {report['recommendation']}\n")
    print(f"| {' | '.join(HEADS)} |\n|{'---|' * len(HEADS)}")
    groups = [("default", "tau")] + [(group,) for group in ("select", "exp", "filter", "splat", "sh", "quality", "search", "time budget")]
    for group in groups:
        for row in sorted((r for r in rows if r["group"] in group), key=order if len(group) == 2 or group[0] == "exp" else lambda _: 0):
            print(f"| {' | '.join(cells(row))} |")


print("""# Tables

Made by `bench/make_results.sh` from the reports in these folders ([what they say](README.md), [columns](../report.md#columns)). *All* is the whole GPU, *16* a part of it with 16 multiprocessors.
""")
print_first_page(sys.argv[1:])
print_steps(sys.argv[1:])
for each in sys.argv[1:]:
    print_report(each)
