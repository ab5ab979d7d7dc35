#!/usr/bin/env python3
"""Converged pictures of vitrum and Mitsuba 3, compared by tiles.

    pip install -r benches/peers/mitsuba/requirements.txt
    cargo build --release
    python3 benches/peers/mitsuba/agree.py [SAMPLES [SCENE...]]

Each scene is a file in scenes/ for vitrum and a dictionary here for Mitsuba: the same shapes, materials, lights and camera.
Prints the mean radiance of both pictures, how far the means of 36 tiles are apart (the largest and the root mean square),
and the seconds that each program took, loading included. Mitsuba runs in its variant scalar_rgb, with the integrator
`path`, no roulette before depth 64 and independent samples.
"""

import subprocess
import sys
import tempfile
import time
from pathlib import Path

import mitsuba as mi
import numpy as np

mi.set_variant("scalar_rgb")

HERE = Path(__file__).parent
PROGRAM = HERE.parents[2] / "target/release/vitrum"
SIZE = 96
TILES = 6


def grey(x):
    return {"type": "rgb", "value": x}


def rectangle(corner, u, v, **rest):
    corner, u, v = (np.array(x, float) for x in (corner, u, v))
    normal = np.cross(u, v)
    to_world = np.eye(4)
    to_world[:3, 0], to_world[:3, 1] = u / 2, v / 2
    to_world[:3, 2] = normal / np.linalg.norm(normal)
    to_world[:3, 3] = corner + (u + v) / 2
    return {"type": "rectangle", "to_world": mi.ScalarTransform4f(to_world), **rest}


def ball(radius, bsdf):
    return {"type": "sphere", "center": [0, 0.7, 0], "radius": radius, "bsdf": bsdf}


def around(samples, **objects):
    """A checkered floor under a lamp and a sky, with these objects on it."""
    checker = {
        "type": "checkerboard",
        "color0": grey(0.8),
        "color1": grey(0.2),
        "to_uv": mi.ScalarTransform4f().scale([10, 10, 1]),
    }
    to_world = mi.ScalarTransform4f().look_at(origin=[0, 1.4, 4], target=[0, 0.7, 0], up=[0, 1, 0])
    film = {"type": "hdrfilm", "width": SIZE, "height": SIZE, "rfilter": {"type": "box"}, "pixel_format": "rgb"}
    return {
        "type": "scene",
        "integrator": {"type": "path", "max_depth": 64, "rr_depth": 64},
        "sensor": {
            "type": "perspective",
            "fov": 40,
            "fov_axis": "y",
            "to_world": to_world,
            "film": film,
            "sampler": {"type": "independent", "sample_count": samples},
        },
        "sky": {"type": "constant", "radiance": grey([0.3, 0.4, 0.6])},
        "lamp": rectangle(
            [-2, 3, -2],
            [4, 0, 0],
            [0, 0, 4],
            bsdf={"type": "diffuse", "reflectance": grey(0.0)},
            emitter={"type": "area", "radiance": grey(3.0)},
        ),
        "floor": rectangle([-5, 0, 5], [10, 0, 0], [0, 0, -10], bsdf={"type": "diffuse", "reflectance": checker}),
        **objects,
    }


def glass(inside, outside, **rest):
    return {"type": "dielectric", "int_ior": inside, "ext_ior": outside, **rest}


def scenes(samples):
    rough = {"type": "roughdielectric", "distribution": "ggx", "alpha": 0.1, "int_ior": 1.5, "ext_ior": 1.0}
    gold = {
        "type": "roughconductor",
        "distribution": "ggx",
        "alpha": 0.2,
        "eta": grey([0.2, 0.9, 1.2]),
        "k": grey([3.2, 2.4, 1.9]),
    }
    pane = {"type": "thindielectric", "int_ior": 1.5, "ext_ior": 1.0}
    return {
        "sphere": around(samples, ball=ball(0.7, glass(1.5, 1.0))),
        "hollow": around(samples, ball=ball(0.7, glass(1.5, 1.0)), bubble=ball(0.5, glass(1.0, 1.5))),
        "rough": around(samples, ball=ball(0.7, rough)),
        "metal": around(samples, ball=ball(0.7, gold)),
        "pane": around(samples, pane=rectangle([-0.8, 0, 0], [1.6, 0, 0], [0, 1.4, 0], bsdf=pane)),
    }


def of_vitrum(name, samples, folder):
    text = (HERE / "scenes/around.toml").read_text() + (HERE / f"scenes/{name}.toml").read_text()
    scene, picture = folder / f"{name}.toml", folder / f"{name}.exr"
    scene.write_text(text)
    size, spp = ["--size", f"{SIZE}x{SIZE}"], ["--spp", str(samples)]
    subprocess.run([PROGRAM, "render", scene, "-o", picture, "--quiet", *size, *spp], check=True)
    return np.array(mi.Bitmap(str(picture)).convert(mi.Bitmap.PixelFormat.RGB, mi.Struct.Type.Float32))


def tiles(image):
    edge = SIZE // TILES
    return image.reshape(TILES, edge, TILES, edge, 3).mean((1, 3))


def main():
    samples = int(sys.argv[1]) if len(sys.argv) > 1 else 4096
    print("| scene | mean | Mitsuba | farthest tile | tiles, rms | seconds | Mitsuba |")
    print("|---|---:|---:|---:|---:|---:|---:|")
    with tempfile.TemporaryDirectory() as folder:
        for name, scene in scenes(samples).items():
            if sys.argv[2:] and name not in sys.argv[2:]:
                continue
            start = time.perf_counter()
            theirs = np.array(mi.render(mi.load_dict(scene)))
            middle = time.perf_counter()
            ours = of_vitrum(name, samples, Path(folder))
            end = time.perf_counter()
            apart = tiles(ours) / tiles(theirs) - 1
            print(
                f"| {name} | {ours.mean():.5f} | {theirs.mean():.5f} | {np.abs(apart).max():.2%} | "
                f"{np.sqrt((apart**2).mean()):.3%} | {end - middle:.1f} | {middle - start:.1f} |",
                flush=True,
            )


if __name__ == "__main__":
    main()
