#!/usr/bin/env python3
"""How time and memory grow: with pixels, samples, triangles, objects, lights, depth and threads.

    benches/cost.py -o FOLDER           # runs, and writes FOLDER/cost.jsonl and FOLDER/index.html: some minutes
    benches/cost.py -o FOLDER --quick   # some seconds, to see that it works

Each kind has scenes that differ in one number, rendered several times in turn on one thread, but for the last. What else changes: balls
of glass fill the same space, so the more there are the smaller they are, and the more rays it takes; lamps share a ceiling. Triangles
and balls are rendered with one path a sample (`--branching one`), so that the time of a ray can be told. Scenes and meshes are written by this
program. Seconds and memory are those of `vitrum render --report`; `vitrum page --costs` makes tables, plots and exponents of them.
"""

import argparse
import json
import math
import os
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


class Costs:
    def __init__(self, options, folder):
        self.program, self.turns, self.folder = options.program, 1 if options.quick else TURNS, folder
        self.output = Path(options.output)
        self.output.mkdir(parents=True, exist_ok=True)
        self.path = self.output / "cost.jsonl"
        if self.path.exists():
            sys.exit(f"{self.path} has results; choose a new folder, they are not written over")

    def scene(self, name, text, size=(160, 120)):
        path = self.folder / f"{name}.toml"
        path.write_text(HEAD.format(size=", ".join(map(str, size))) + text)
        return path

    def render(self, scene, *more):
        """The report of a render."""
        report = self.folder / "report.json"
        command = [self.program, "render", scene, "-o", self.folder / "picture.exr", "--report", report, "--quiet", *more]
        if subprocess.run(list(map(str, command))).returncode != 0:
            sys.exit(f"{' '.join(map(str, command))}: failed")
        return json.loads(report.read_text())

    def grow(self, growing, tell, variants, threads=lambda number: 1):
        """Renders each of (number, scene, options), turn by turn; `tell` is what follows a law."""
        for _ in range(self.turns):
            for number, scene, more in variants:
                used = threads(number)
                report = self.render(scene, "--threads", used, *more)
                line = {"growing": growing, "tell": tell, "number": number, "threads": used, **report}
                with open(self.path, "a") as lines:
                    lines.write(json.dumps(line) + "\n")
        print(f"{growing}: done", flush=True)

    def finish(self):
        page = [self.program, "page", "--costs", self.path]
        subprocess.run(list(map(str, [*page, "-o", self.output / "index.html"])), check=True)
        subprocess.run(list(map(str, [*page, "--markdown"])), check=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("-o", "--output", required=True, help="folder for the results")
    parser.add_argument("--program", help="vitrum [default: it is built]")
    parser.add_argument("--quick", action="store_true")
    options = parser.parse_args()
    if options.program is None:
        subprocess.run(["cargo", "build", "--release", "--locked"], cwd=ROOT, check=True)
        options.program = str(ROOT / "target/release/vitrum")
    with tempfile.TemporaryDirectory() as folder:
        costs = Costs(options, Path(folder))
        few = options.quick
        one = ball(0, 1, 0, 1)
        scene = costs.scene("one", one)

        sizes = [(80, 60), (160, 120), (320, 240), (640, 480), (1280, 960)][: 2 if few else 5]
        costs.grow("pixels", ["rendering", "memory"], [(w * h, scene, ["--size", f"{w}x{h}", "--spp", 16]) for w, h in sizes])
        counts = [16, 64, 256, 1024][: 2 if few else 4]
        costs.grow("samples per pixel", ["rendering"], [(n, scene, ["--spp", n]) for n in counts])

        meshes = []
        for wanted in [1_000, 10_000, 100_000, 1_000_000, 4_000_000][: 3 if few else 5]:
            name = f"bumpy{wanted}"
            triangles = write_bumpy(costs.folder / f"{name}.obj", wanted)
            text = f'\n[[object]]\nshape = "mesh"\nfile = "{name}.obj"\nnormals = "flat"\n{GLASS}'
            meshes.append((triangles, costs.scene(name, text), ["--spp", 16, "--branching", "one"]))
        costs.grow("triangles", ["ray", "memory"], meshes)

        def balls(number):
            edge = math.ceil(number ** (1 / 3))
            cell = 2 / edge
            place = lambda i: (i % edge, i // edge % edge, i // edge // edge)
            centres = [[(c + 0.5) * cell for c in place(i)] for i in range(number)]
            return "".join(ball(x - 1, y + 0.05, z - 1, 0.4 * cell) for x, y, z in centres)

        numbers = [10, 100, 1000, 10_000, 100_000][: 3 if few else 5]
        objects = [(n, costs.scene(f"balls{n}", balls(n)), ["--spp", 8, "--branching", "one"]) for n in numbers]
        costs.grow("balls of glass", ["ray", "memory"], objects)

        def lamps(number):
            edge = math.ceil(math.sqrt(number))
            cell = 6 / edge
            return "".join(lamp(i, i % edge * cell - 3, i // edge * cell - 3, 0.5 * cell) for i in range(number))

        numbers = [1, 10, 100, 1000, 10_000][: 3 if few else 5]
        costs.grow("lamps", ["ray"], [(n, costs.scene(f"lamps{n}", one + lamps(n)), ["--spp", 16]) for n in numbers])

        depths = [2, 4, 8, 16, 32, 64][: 3 if few else 6]
        shells = "".join(ball(0, 1, 0, 1 - 0.03 * i) for i in range(10))
        deep = costs.scene("shells", shells)
        costs.grow("largest depth", [], [(d, deep, ["--spp", 32, "--max-depth", d]) for d in depths])

        threads = [2**i for i in range(8) if 2**i <= len(os.sched_getaffinity(0))]
        costs.grow("threads", [], [(n, scene, ["--spp", 512]) for n in threads], threads=lambda number: number)
        costs.finish()


if __name__ == "__main__":
    main()
