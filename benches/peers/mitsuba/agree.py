#!/usr/bin/env python3
"""Converged pictures of vitrum and Mitsuba 3, compared by tiles.

    pip install -r benches/peers/mitsuba/requirements.txt
    cargo build --release
    python3 benches/peers/mitsuba/agree.py [SAMPLES [SCENE...]]

Each scene is a file in scenes/ for vitrum and a dictionary here for Mitsuba: the same shapes, materials, lights and camera.
Prints the mean radiance of both pictures, how far the means of 36 tiles are apart (the largest and the root mean square),
and the seconds that each program took, loading included. Mitsuba runs in its variant scalar_rgb, with the integrator
`path`, no roulette before depth 64 and independent samples. VITRUM names another program than target/release/vitrum.
"""

import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import mitsuba as mi
import numpy as np

mi.set_variant("scalar_rgb")

from common import environment, floor, glass, grey, lamp, read, rectangle, sensor, tiles, write_environment  # noqa: E402

HERE = Path(__file__).parent
PROGRAM = os.environ.get("VITRUM", HERE.parents[2] / "target/release/vitrum")
SIZE = 96
TILES = 6


def ball(radius, bsdf):
    return {"type": "sphere", "center": [0, 0.7, 0], "radius": radius, "bsdf": bsdf}


def seen(samples, **objects):
    return {
        "type": "scene",
        "integrator": {"type": "path", "max_depth": 64, "rr_depth": 64},
        "sensor": sensor([0, 1.4, 4], [0, 0.7, 0], 40, (SIZE, SIZE), "independent", samples),
        **objects,
    }


def around(samples, **objects):
    """A checkered floor under a lamp and a sky, with these objects on it."""
    return seen(
        samples,
        sky={"type": "constant", "radiance": grey([0.3, 0.4, 0.6])},
        lamp=lamp([-2, 3, -2], [4, 0, 0], [0, 0, 4], 3.0),
        floor=floor(5),
        **objects,
    )


def scenes(samples, folder):
    rough = {"type": "roughdielectric", "distribution": "ggx", "alpha": 0.1, "int_ior": 1.5, "ext_ior": 1.0}
    gold = {
        "type": "roughconductor",
        "distribution": "ggx",
        "alpha": 0.2,
        "eta": grey([0.2, 0.9, 1.2]),
        "k": grey([3.2, 2.4, 1.9]),
    }
    pane = {"type": "thindielectric", "int_ior": 1.5, "ext_ior": 1.0}
    white = {"type": "diffuse", "reflectance": grey(0.8)}
    return {
        "sphere": around(samples, ball=ball(0.7, glass(1.5, 1.0))),
        "hollow": around(samples, ball=ball(0.7, glass(1.5, 1.0)), bubble=ball(0.5, glass(1.0, 1.5))),
        "rough": around(samples, ball=ball(0.7, rough)),
        "metal": around(samples, ball=ball(0.7, gold)),
        "pane": around(samples, pane=rectangle([-0.8, 0, 0], [1.6, 0, 0], [0, 1.4, 0], bsdf=pane)),
        "environment": seen(samples, environment=environment(folder, rotation=25.0), ball=ball(0.7, white)),
    }


def of_vitrum(name, samples, folder):
    text = (HERE / f"scenes/{name}.toml").read_text()
    if "[camera]" not in text:
        text = (HERE / "scenes/around.toml").read_text() + text
    scene, picture = folder / f"{name}.toml", folder / f"{name}.exr"
    scene.write_text(text)
    size, spp = ["--size", f"{SIZE}x{SIZE}"], ["--spp", str(samples)]
    subprocess.run([PROGRAM, "render", scene, "-o", picture, "--quiet", *size, *spp], check=True)
    return read(picture)


def main():
    samples = int(sys.argv[1]) if len(sys.argv) > 1 else 4096
    print("| scene | mean | Mitsuba | farthest tile | tiles, rms | seconds | Mitsuba |")
    print("|---|---:|---:|---:|---:|---:|---:|")
    with tempfile.TemporaryDirectory() as folder:
        write_environment(Path(folder))
        for name, scene in scenes(samples, Path(folder)).items():
            if sys.argv[2:] and name not in sys.argv[2:]:
                continue
            start = time.perf_counter()
            theirs = np.array(mi.render(mi.load_dict(scene)))
            middle = time.perf_counter()
            ours = of_vitrum(name, samples, Path(folder))
            end = time.perf_counter()
            apart = tiles(ours, TILES, TILES) / tiles(theirs, TILES, TILES) - 1
            print(
                f"| {name} | {ours.mean():.5f} | {theirs.mean():.5f} | {np.abs(apart).max():.2%} | "
                f"{np.sqrt((apart**2).mean()):.3%} | {end - middle:.1f} | {middle - start:.1f} |",
                flush=True,
            )


if __name__ == "__main__":
    main()
