#!/usr/bin/env python3
"""How far scenes in other formats are from a .ply: rows of a Markdown table.

  format_table.py VOYAGER REFERENCE.ply CAMERAS.json CAMERA FILE...

Each FILE holds the Gaussians of REFERENCE, in any order. For each: the largest difference of each
parameter, and the PSNR of its picture (960 x 540, CPU, 3DGS's filter) against that of REFERENCE with
as many SH bands. FILE may be `.ENDING` or `.ENDING:OPTIONS`: what `voyager convert` makes of
REFERENCE, as in `.glb:--spz`. A value of REFERENCE outside of the format's range counts as the
nearer end of it, and "outside" says of how many Gaussians there is one.
The same Gaussian is looked for within 5 cm in x, by position, scale, opacity and colour."""
import array
import bisect
import math
import os
import subprocess
import sys
import tempfile

REACH = 0.05  # metres
COLOUR = 0.5 / 0.28209479177387814  # f_dc of a colour of 1
SPZ = {"scale": (-10, 5.9375), "colour": (-10 / 3, 10 / 3), "rest": (-1, 127 / 128)}
RANGES = [(".spz", SPZ), (".glb with --spz", SPZ), (".compressed.ply", {"rest": (-4, 4)}),
          (".splat", {"colour": (-COLOUR, COLOUR)}), (".ksplat", {"colour": (-COLOUR, COLOUR)})]


def run(*command):
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    if done.returncode != 0:
        sys.exit(f"{' '.join(command)}\n{done.stdout}")


def read_ply(path):
    """Of a .ply of binary32: the names of its columns, and its rows."""
    with open(path, "rb") as file:
        names, count = [], 0
        for line in file:
            words = line.split()
            if words[0] == b"end_header":
                break
            if words[0] == b"element":
                count = int(words[2])
            elif words[0] == b"property":
                if words[1] != b"float":
                    sys.exit(f"{path}: found {line!r}, expected columns of binary32")
                names.append(words[2].decode())
        values = array.array("f", file.read())
    rows = [values[i * len(names):(i + 1) * len(names)] for i in range(count)]
    return names, rows


def write_ply(path, names, rows):
    header = f"ply\nformat binary_little_endian 1.0\nelement vertex {len(rows)}\n"
    header += "".join(f"property float {name}\n" for name in names) + "end_header\n"
    with open(path, "wb") as file:
        file.write(header.encode())
        for row in rows:
            row.tofile(file)


def rest_of(names):
    return sum(name.startswith("f_rest_") for name in names)


def of_degree(names, rows, rest):
    """The first bands alone: f_rest_* are all red, then all green, then all blue."""
    has = rest_of(names) // 3
    first = names.index("f_rest_0") if has else 0
    left_out = {first + channel * has + i for channel in range(3) for i in range(rest // 3, has)}
    kept = [i for i in range(len(names)) if i not in left_out]
    renamed = [names[i] for i in kept]
    at = 0
    for i, name in enumerate(renamed):
        if name.startswith("f_rest_"):
            renamed[i], at = f"f_rest_{at}", at + 1
    return renamed, [array.array("f", (row[i] for i in kept)) for row in rows]


class Columns:
    def __init__(self, names):
        at = {name: i for i, name in enumerate(names)}
        self.position = [at[c] for c in "xyz"]
        self.scale = [at[f"scale_{i}"] for i in range(3)]
        self.rotation = [at[f"rot_{i}"] for i in range(4)]
        self.colour = [at[f"f_dc_{i}"] for i in range(3)]
        self.rest = [at[f"f_rest_{i}"] for i in range(rest_of(names))]
        self.opacity = at["opacity"]


def clamped(names, rows, ranges):
    """The rows within ranges, and how many were not."""
    columns = Columns(names)
    limits = [(i, low, high) for name, (low, high) in ranges.items() for i in getattr(columns, name)]
    outside, inside = 0, []
    for row in rows:
        new = row[:]
        for i, low, high in limits:
            new[i] = min(max(row[i], low), high)
        outside += new != row
        inside.append(new)
    return (names, inside), outside


def sigmoid(x):
    return 1 / (1 + math.exp(-x)) if x > -700 else 0.0


def largest(a, b, at_a, at_b):
    return max((abs(a[i] - b[j]) for i, j in zip(at_a, at_b)), default=0.0)


def partners(a, rows_a, b, rows_b):
    """Of each row of b the row of a that is the most like it."""
    by_x = sorted(rows_a, key=lambda row: row[a.position[0]])
    xs = [row[a.position[0]] for row in by_x]

    def unlike(p, q):
        return (largest(p, q, a.position, b.position) / REACH + largest(p, q, a.scale, b.scale) +
                largest(p, q, a.colour, b.colour) +
                abs(sigmoid(p[a.opacity]) - sigmoid(q[b.opacity])))

    for q in rows_b:
        x = q[b.position[0]]
        near = by_x[bisect.bisect_left(xs, x - REACH):bisect.bisect_right(xs, x + REACH)]
        yield min(near or by_x, key=lambda p: unlike(p, q)), q


def angle(p, q):
    """Degrees between two rotations; of equal ones exactly 0, which an arc cosine would not be."""
    p, q = ([x / (math.hypot(*r) or 1) for x in r] for r in (p, q))
    chord = min(math.dist(p, q), math.dist(p, [-x for x in q]))
    return math.degrees(4 * math.asin(chord / 2))


def differences(reference, other):
    (names_a, rows_a), (names_b, rows_b) = reference, other
    a, b = Columns(names_a), Columns(names_b)
    most = [0.0] * 6
    for p, q in partners(a, rows_a, b, rows_b):
        found = (largest(p, q, a.position, b.position), largest(p, q, a.scale, b.scale),
                 angle([p[i] for i in a.rotation], [q[i] for i in b.rotation]),
                 abs(sigmoid(p[a.opacity]) - sigmoid(q[b.opacity])),
                 largest(p, q, a.colour, b.colour), largest(p, q, a.rest, b.rest))
        most = [max(x, y) for x, y in zip(most, found)]
    return most


class Table:
    def __init__(self, voyager, reference, cameras, camera, folder):
        self.voyager, self.reference, self.folder = voyager, reference, folder
        self.view = ["--cameras", cameras, "--camera", camera, "--size", "960x540", "--backend", "cpu",
                     "--antialias", "off", "--float"]
        self.pictures = {}
        self.truth = self.read(reference)

    def file(self, name):
        return os.path.join(self.folder, name)

    def read(self, path):
        run(self.voyager, "convert", path, "-o", self.file("read.ply"))
        return read_ply(self.file("read.ply"))

    def picture(self, scene, name):
        run(self.voyager, "render", scene, *self.view, "-o", self.file(name))
        return self.file(name)

    def picture_of_truth(self, rest):
        if rest not in self.pictures:
            write_ply(self.file("bands.ply"), *of_degree(*self.truth, rest))
            self.pictures[rest] = self.picture(self.file("bands.ply"), f"truth_{rest}.pfm")
        return self.pictures[rest]

    def psnr(self, a, b):
        script = os.path.join(os.path.dirname(os.path.abspath(__file__)), "psnr.py")
        return subprocess.run([sys.executable, script, a, b], stdout=subprocess.PIPE, text=True,
                              check=True).stdout.split(" dB")[0]

    def made(self, what):
        ending, _, options = what.partition(":")
        path = self.file("made" + ending)
        run(self.voyager, "convert", self.reference, "-o", path, *options.split())
        return path

    def row(self, what):
        is_made = what.startswith(".") and "/" not in what
        path = self.made(what) if is_made else what
        names, rows = self.read(path)
        rest = rest_of(names)
        truth = of_degree(*self.truth, rest)
        if len(rows) != len(truth[1]):
            sys.exit(f"{path}: found {len(rows)} Gaussians, expected {len(truth[1])}")
        name = what.replace(":", " with ") if is_made else os.path.basename(what)
        ranges = next((ranges for ending, ranges in RANGES
                       if name.endswith(ending) or name.startswith(ending)), {})
        truth, outside = clamped(*truth, ranges)
        found = [f"{x:.2g}" for x in differences(truth, (names, rows))]
        if rest == 0:
            found[5] = ""
        decibels = self.psnr(self.picture_of_truth(rest), self.picture(path, "other.pfm"))
        if decibels == "inf":
            decibels = "identical"
        return [f"`{name}`", f"{os.path.getsize(path):,}", *found, f"{outside:,}" if outside else "", decibels]


def main(voyager, reference, cameras, camera, *files):
    print("| file | bytes | position, m | log scale | rotation, ° | opacity | f_dc | SH bands | outside | PSNR, dB |")
    print("|---|---|---|---|---|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as folder:
        table = Table(voyager, reference, cameras, camera, folder)
        for file in files:
            print("| " + " | ".join(table.row(file)) + " |", flush=True)


if __name__ == "__main__":
    if len(sys.argv) < 6:
        sys.exit(__doc__)
    main(*sys.argv[1:])
