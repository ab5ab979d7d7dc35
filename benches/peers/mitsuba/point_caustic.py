#!/usr/bin/env python3
"""The reference of scenes/bench/02_point_caustic.toml: the light of a point through a ball of glass, by Mitsuba's particle tracer.

    pip install -r benches/peers/mitsuba/requirements.txt
    python3 benches/peers/mitsuba/point_caustic.py --minutes 20 scenes/bench/references/02_point_caustic.exr

Paths from the camera never find a point behind glass; particles from the point do, and every one of them that the disk scatters is
seen by the camera, because no glass stands between these two. The picture is the mean of independent parts, whose differences tell
its own error. It is stored with the picture as relMSE: the mean of squared error over squared radiance plus 0.01.
"""

import argparse
import time
from pathlib import Path

import mitsuba as mi
import numpy as np

mi.set_variant("llvm_ad_rgb")

from common import glass, grey, sensor  # noqa: E402

SIZE = (128, 96)
# Particles of a part, per pixel.
PARTICLES = 20_000
DARK = 0.01


def scene():
    down = mi.ScalarTransform4f().look_at(origin=[0, 4, 0], target=[0, 0, 0], up=[1, 0, 0])
    upwards = mi.ScalarTransform4f().rotate([1, 0, 0], -90).scale(2.5)
    return {
        "type": "scene",
        "integrator": {"type": "ptracer", "max_depth": -1, "rr_depth": 64},
        "sensor": sensor([2.4, 1.6, 2.4], [0, 0, 0], 28, SIZE, "independent", PARTICLES),
        # All that stands in the scene lies within its beam, where it shines like a point; no particle is wasted on the rest.
        "light": {"type": "spot", "intensity": grey(40.0), "beam_width": 35, "cutoff_angle": 35.01, "to_world": down},
        "disk": {"type": "disk", "to_world": upwards, "bsdf": {"type": "diffuse", "reflectance": grey(0.7)}},
        "ball": {"type": "sphere", "center": [0, 2.2, 0], "radius": 0.6, "bsdf": glass(1.5, 1.0)},
    }


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("output", type=Path)
    parser.add_argument("--minutes", type=float, default=20)
    options = parser.parse_args()
    loaded = mi.load_dict(scene())
    parts, start = [], time.monotonic()
    while len(parts) < 8 or time.monotonic() - start < 60 * options.minutes:
        parts.append(np.array(mi.render(loaded, seed=len(parts), spp=PARTICLES), dtype=np.float64))
    stacked = np.stack(parts)
    mean = stacked.mean(0)
    error = (stacked.var(0, ddof=1) / len(parts) / (mean**2 + DARK)).mean()
    bitmap = mi.Bitmap(mean.astype(np.float32))
    bitmap.metadata()["vitrum:reference_error"] = f"{error:.4e}"
    how = f"Mitsuba {mi.__version__}, ptracer, {len(parts)} x {PARTICLES} particles per pixel"
    bitmap.metadata()["vitrum:reference_by"] = how
    bitmap.write(str(options.output))
    print(f"{how}: mean {mean.mean():.5f}, own relMSE {error:.2e}")


if __name__ == "__main__":
    main()
