#!/usr/bin/env python3
"""How time and memory grow: with pixels, samples, triangles, objects, lights, depth and threads.

    benches/cost.py -o FOLDER           # runs, and writes FOLDER/cost.jsonl and FOLDER/cost.md: a quarter of an hour
    benches/cost.py -o FOLDER --quick   # a tenth of that, to see that it works

Each row of the table renders one scene that differs in one number, several times in alternation, and fits a line to the logarithms of
number and median of the seconds: its slope is the exponent of the growth. Scenes and meshes are written by this program. Seconds
are those of `vitrum render --report`; memory is the most that the process had.
"""

import argparse
import json
import math
import os
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
TURNS = 3

HEAD = """[render]
integrator = "path"
size = [{size}]

[camera]
type = "pinhole"
position = [0, 1.5, 4.5]
target = [0, 0.8, 0]
fov = 36

[background]
type = "gradient"
bottom = [0.3, 0.3, 0.3]
top = [0.5, 0.6, 0.8]

[[object]]
name = "floor"
shape = "rectangle"
corner = [-10, 0, 10]
edge_u = [20, 0, 0]
edge_v = [0, 0, -20]
material = {{ type = "matte", color = 0.5 }}
"""
GLASS = 'material = { type = "dielectric", ior = 1.5 }\n'


def ball(x, y, z, radius):
    return f'\n[[object]]\nshape = "sphere"\ncenter = [{x:.5f}, {y:.5f}, {z:.5f}]\nradius = {radius:.5f}\n{GLASS}'


def lamp(place, x, z, edge):
    return (
        f'\n[[object]]\nname = "lamp {place}"\nshape = "rectangle"\ncorner = [{x:.5f}, 4, {z:.5f}]\nedge_u = [{edge:.5f}, 0, 0]\n'
        f'edge_v = [0, 0, {edge:.5f}]\nmaterial = {{ type = "emissive", radiance = {4.0 / edge**2 / 100:.5f} }}\n'
    )


def write_bumpy(path, triangles):
    """A ball with bumps of several sizes: two triangles for every pair of a ring and a segment."""
    rings = max(3, round(math.sqrt(triangles / 4)))
    segments = max(3, round(triangles / (2 * (rings - 1))))
    with open(path, "w") as out:
        out.write("v 0 2 0\nv 0 0 0\n")
        for ring in range(1, rings):
            theta = math.pi * ring / rings
            for segment in range(segments):
                phi = 2 * math.pi * segment / segments
                bumps = 0.1 * math.sin(5 * theta) * math.cos(4 * phi) + 0.02 * math.sin(37 * theta) * math.cos(30 * phi)
                r = 0.85 * (1 + bumps * math.sin(theta))
                x, y, z = r * math.sin(theta) * math.cos(phi), 1 + r * math.cos(theta), r * math.sin(theta) * math.sin(phi)
                out.write(f"v {x:.7f} {y:.7f} {z:.7f}\n")
        at = lambda ring, segment: 3 + (ring - 1) * segments + segment % segments
        for s in range(segments):
            out.write(f"f 1 {at(1, s + 1)} {at(1, s)}\nf 2 {at(rings - 1, s)} {at(rings - 1, s + 1)}\n")
            for ring in range(1, rings - 1):
                a, b, c, d = at(ring, s), at(ring, s + 1), at(ring + 1, s), at(ring + 1, s + 1)
                out.write(f"f {a} {b} {d}\nf {a} {d} {c}\n")
    return 2 * (rings - 1) * segments


class Cost:
    def __init__(self, options, folder):
        self.program, self.quick, self.folder = options.program, options.quick, folder
        self.output = Path(options.output)
        self.output.mkdir(parents=True, exist_ok=True)
        self.lines = open(self.output / "cost.jsonl", "w")
        self.table = []

    def scene(self, name, text, size=(160, 120)):
        path = self.folder / f"{name}.toml"
        path.write_text(HEAD.format(size=", ".join(map(str, size))) + text)
        return path

    def render(self, scene, *more):
        """The report of a render, with the most memory that it had (MiB)."""
        report = self.folder / "report.json"
        command = [self.program, "render", scene, "-o", self.folder / "picture.exr", "--report", report, "--quiet", *more]
        process = subprocess.Popen(list(map(str, command)))
        _, status, used = os.wait4(process.pid, 0)
        if status != 0:
            sys.exit(f"{' '.join(map(str, command))}: ended with {status}")
        return {**json.loads(report.read_text()), "memory": used.ru_maxrss / 1024}

    def grow(self, what, unit, variants, key="rendering"):
        """Renders each of (number, scene, options), turn by turn, and fits."""
        found = {number: [] for number, _, _ in variants}
        for _ in range(1 if self.quick else TURNS):
            for number, scene, more in variants:
                report = self.render(scene, *more)
                found[number].append(report)
                self.lines.write(json.dumps({"cost": what, "number": number, **report}) + "\n")
                self.lines.flush()
        points = [(number, statistics.median(r[key] for r in reports)) for number, reports in found.items()]
        exponent = slope(points)
        cells = ", ".join(f"{number}: {seconds:.3g}" for number, seconds in points)
        self.table.append(f"| {what} | {unit} | {exponent:.2f} | {cells} |")
        print(self.table[-1], flush=True)
        return found

    def finish(self, notes):
        head = "| seconds with | number of | exponent | number: seconds |\n|---|---|---:|---|"
        text = "\n".join([head, *self.table, "", *notes]) + "\n"
        (self.output / "cost.md").write_text(text)


def slope(points):
    logs = [(math.log(a), math.log(b)) for a, b in points]
    x, y = (statistics.fmean(p[i] for p in logs) for i in (0, 1))
    return sum((a - x) * (b - y) for a, b in logs) / sum((a - x) ** 2 for a, _ in logs)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("-o", "--output", required=True, help="folder for the results")
    parser.add_argument("--program", default=str(ROOT / "target/release/vitrum"))
    parser.add_argument("--quick", action="store_true")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        cost = Cost(options, Path(folder))
        few = options.quick
        one = ball(0, 1, 0, 1)
        one_thread = ["--threads", "1"]
        scene = cost.scene("one", one)

        sizes = [(80, 60), (160, 120), (320, 240), (640, 480)][: 2 if few else 4]
        cost.grow("pixels", "pixels", [(w * h, scene, ["--size", f"{w}x{h}", "--spp", "16", *one_thread]) for w, h in sizes])
        counts = [16, 64, 256, 1024][: 2 if few else 4]
        cost.grow("samples", "samples per pixel", [(n, scene, ["--spp", str(n), *one_thread]) for n in counts])

        meshes = []
        for wanted in [1_000, 10_000, 100_000, 1_000_000, 4_000_000][: 3 if few else 5]:
            name = f"bumpy{wanted}"
            triangles = write_bumpy(cost.folder / f"{name}.obj", wanted)
            text = f'\n[[object]]\nshape = "mesh"\nfile = "{name}.obj"\nnormals = "flat"\n{GLASS}'
            meshes.append((triangles, cost.scene(name, text), ["--spp", "16", "--branching", "one", *one_thread]))
        by_triangles = cost.grow("triangles", "triangles", meshes)

        def balls(number):
            edge = math.ceil(number ** (1 / 3))
            cell = 2 / edge
            place = lambda i: (i % edge, i // edge % edge, i // edge // edge)
            centres = [[(c + 0.5) * cell for c in place(i)] for i in range(number)]
            return "".join(ball(x - 1, y + 0.05, z - 1, 0.4 * cell) for x, y, z in centres)

        numbers = [10, 100, 1000, 10_000, 100_000][: 3 if few else 5]
        objects = [(n, cost.scene(f"balls{n}", balls(n)), ["--spp", "8", "--branching", "one", *one_thread]) for n in numbers]
        cost.grow("objects", "balls of glass", objects)

        def lamps(number):
            edge = math.ceil(math.sqrt(number))
            cell = 6 / edge
            return "".join(lamp(i, i % edge * cell - 3, i // edge * cell - 3, 0.5 * cell) for i in range(number))

        numbers = [1, 10, 100, 1000, 10_000][: 3 if few else 5]
        lights = [(n, cost.scene(f"lamps{n}", one + lamps(n)), ["--spp", "16", *one_thread]) for n in numbers]
        cost.grow("lights", "rectangles that shine", lights)

        depths = [2, 4, 8, 16, 32, 64][: 3 if few else 6]
        shells = "".join(ball(0, 1, 0, 1 - 0.03 * i) for i in range(10))
        deep = cost.scene("shells", shells)
        cost.grow("depth", "largest depth", [(d, deep, ["--spp", "32", "--max-depth", str(d), *one_thread]) for d in depths])

        threads = [2**i for i in range(8) if 2**i <= (os.cpu_count() or 1)]
        by_threads = cost.grow("threads", "threads", [(n, scene, ["--spp", "512", "--threads", str(n)]) for n in threads])

        median = lambda reports, key: statistics.median(r[key] for r in reports)
        notes = ["| triangles | loading s | rendering s | rays | ns per ray | memory MiB |", "|---:|---:|---:|---:|---:|---:|"]
        rows = {}
        for triangles, reports in by_triangles.items():
            rays = sum(reports[0][k] for k in ("camera_rays", "reflected_rays", "transmitted_rays", "shadow_rays", "pilot_rays"))
            seconds, memory = median(reports, "rendering"), median(reports, "memory")
            rows[triangles] = (1e9 * seconds / rays, memory)
            loading = median(reports, "loading")
            notes.append(f"| {triangles} | {loading:.3f} | {seconds:.3f} | {rays} | {rows[triangles][0]:.0f} | {memory:.0f} |")
        large = [n for n in rows if n >= 10_000]
        if len(large) > 1:
            per_decade = (rows[large[-1]][0] - rows[large[0]][0]) / math.log10(large[-1] / large[0])
            bytes_each = 2**20 * (rows[large[-1]][1] - rows[large[0]][1]) / (large[-1] - large[0])
            notes.append(f"\nFrom {large[0]} to {large[-1]} triangles a ray takes {per_decade:.0f} ns more for each factor of ten, and a triangle {bytes_each:.0f} bytes at the peak, reading included.")
        busy = {n: median(reports, "processors") for n, reports in by_threads.items()}
        wall = {n: median(reports, "rendering") for n, reports in by_threads.items()}
        for n in list(busy)[1:]:
            idle = 1 - busy[n] / (n * wall[n])
            notes.append(f"\n{n} threads: {busy[n] / busy[1]:.3f} of the processor time of one, {wall[1] / wall[n]:.2f} times as fast, {100 * idle:.1f} % idle.")
        cost.finish(notes)
        print("\n".join(notes))


if __name__ == "__main__":
    main()
