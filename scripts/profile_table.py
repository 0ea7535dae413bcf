#!/usr/bin/env python3
"""Prints the table of scripts/profile.sh from the rows that ncu wrote (--csv --page raw)."""
import collections
import csv
import re
import statistics
import sys

TIME = "gpu__time_duration.sum"
BYTES = "dram__bytes.sum"
PER_CYCLE = "dram__bytes.sum.peak_sustained"
CLOCK = "dram__cycles_elapsed.avg.per_second"
WARPS = "sm__warps_active.avg.pct_of_peak_sustained_active"
ACTIVE = "sm__cycles_active.avg"
ELAPSED = "sm__cycles_elapsed.max"
L2_BYTES = "lts__t_bytes.sum"
INSTRUCTIONS = "smsp__inst_executed.sum"  # of warps

# A Jetson AGX Orin: bytes a second of its memory; instructions of warps a second, 16
# multiprocessors of four schedulers at 1.3 GHz.
ORIN_BYTES = 204.8e9
ORIN_INSTRUCTIONS = 16 * 4 * 1.3e9


def number(row, name):
    """A metric's value; None where the device does not have it."""
    text = row.get(name, "").replace(",", "")
    try:
        return float(text)
    except ValueError:
        return None


def read_rows(path):
    with open(path, newline="") as file:
        lines = [line for line in file if line.startswith('"')]  # not what the programs print
    rows = list(csv.DictReader(lines))
    return [row for row in rows if number(row, TIME) is not None]


def short_name(name):
    """project_splats of void voyager::cuda::(anonymous)::project_splats<...>(SplatFrame, bool)."""
    name = re.sub(r"\(anonymous namespace\)|<unnamed>", "anonymous", name)
    name = re.sub(r"^void ", "", name)
    return re.split(r"[<(]", name)[0].split("::")[-1]


def median(rows, value):
    found = [v for v in map(value, rows) if v is not None]
    return statistics.median(found) if found else None


def millions(rows, name):
    found = median(rows, lambda row: number(row, name))
    return None if found is None else found / 1e6


def floor_us(row):
    """Microseconds that the bytes alone take at the memory's peak rate."""
    moved, per_cycle, clock = (number(row, name) for name in (BYTES, PER_CYCLE, CLOCK))
    if moved is None or not per_cycle or not clock:
        return None
    return 1e6 * moved / (per_cycle * clock)


def idle_share(row):
    active, elapsed = number(row, ACTIVE), number(row, ELAPSED)
    return None if active is None or not elapsed else 100 * (1 - active / elapsed)


def orin_us(row, of_bytes):
    """What bytes or instructions, whichever takes longer, would take on an Orin."""
    moved, instructions = number(row, of_bytes), number(row, INSTRUCTIONS)
    if moved is None or instructions is None:
        return None
    return 1e6 * max(moved / ORIN_BYTES, instructions / ORIN_INSTRUCTIONS)


def print_orin(rows):
    """The sum over kernels, each at least its bytes' or its instructions' time. Of the bytes, an
    Orin's smaller cache lets more through than this one's."""
    frames = sum(short_name(row["Kernel Name"]).startswith("rasterize_tiles") for row in rows)
    for name, holds in ((BYTES, "as much as this one's"), (L2_BYTES, "nothing")):
        times = [orin_us(row, name) for row in rows]
        if frames and None not in times:
            print("an AGX Orin takes at least %.2f ms a frame by its rates, if its cache holds %s (%d frames)" %
                  (sum(times) / frames / 1e3, holds, frames))


def text(value, form):
    return "-" if value is None else format(value, form)


def main():
    rows = read_rows(sys.argv[1])
    if not rows:
        sys.exit("profile_table.py: found no kernel in %s, expected rows that ncu wrote" % sys.argv[1])
    kernels = collections.OrderedDict()
    for row in rows:
        kernels.setdefault(short_name(row["Kernel Name"]), []).append(row)
    print("median of each kernel's launches; floor: its bytes at the memory's peak rate")
    print("%-20s %8s %9s %9s %9s %9s %9s %8s %8s" % (
        "kernel", "launches", "us", "MB", "floor us", "L2 MB", "Minstr", "warps %", "idle %"))
    for name, of in kernels.items():
        print("%-20s %8d %9s %9s %9s %9s %9s %8s %8s" % (
            name, len(of),
            text(median(of, lambda row: number(row, TIME) / 1e3), ".1f"),
            text(millions(of, BYTES), ".2f"),
            text(median(of, floor_us), ".1f"),
            text(millions(of, L2_BYTES), ".2f"),
            text(millions(of, INSTRUCTIONS), ".2f"),
            text(median(of, lambda row: number(row, WARPS)), ".0f"),
            text(median(of, idle_share), ".0f")))
    print_orin(rows)


main()
