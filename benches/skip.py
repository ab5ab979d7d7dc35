#!/usr/bin/env python3
"""What it is worth to skip what a scene does not need, in instructions: a table in Markdown.

    benches/skip.py                # what doing all the same costs, row by row and scene by scene: some minutes
    benches/skip.py --builds       # and what carrying a feature costs scenes without it: four builds more

First: instructions of a small render of each bench scene with `--no-skip=ROW` over those without, for every row that the plan of the
scene skips. Then what single rays skip: renders of scenes that differ in one number, which is zero or nearly. Last, the same of the
program that users get over one that was built without the feature; a plan costs at least the question. Counted by valgrind, like the
gate.
"""

import argparse
import os
import subprocess
import sys
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import gate

ROWS = ["lights", "absorption", "nested-media", "thin-sheets", "object-tree", "solids", "outlines"]
# What carrying a feature may cost a scene without it.
LIMIT = 0.005
# Features that a build can be made without.
BUILDS = ["absorption", "nested media", "images", "lights", "thin sheets"]

# A ball of a material before a sky, and pairs of materials: what has nothing to follow, and what has nearly nothing.
BALL = """[render]
integrator = "{integrator}"
size = [128, 96]

[camera]
type = "pinhole"
position = [0, 0, 5]
target = [0, 0, 0]
fov = {fov}

[background]
type = "constant"
color = 0.5

[[object]]
shape = "sphere"
center = [0, 0, 0]
radius = 1
material = {{ {material} }}
"""
PAIRS = {
    "a coefficient of zero": ("whitted", 'type = "transparent", ior = 1.5, kr = {}, kt = 1', "0", "1e-9"),
    "indices that match": ("path", 'type = "dielectric", ior = {}, sigma_a = 1', "1", "1.0001"),
}


def costs(program, scenes, pool, *options):
    return dict(zip(scenes, pool.map(lambda scene: gate.count_render(program, scene, *options), scenes)))


def table(heading, rows, scenes, cell):
    print(f"| {heading} | " + " | ".join(s.stem[:2] for s in scenes) + " |\n|---|" + "---:|" * len(scenes))
    for row in rows:
        print(f"| {row} | " + " | ".join(cell(row, scene) for scene in scenes) + " |")


def pairs(program):
    """What following nearly nothing costs, for each pair."""
    with tempfile.TemporaryDirectory() as folder:
        for name, (integrator, material, nothing, nearly) in PAIRS.items():
            counts = []
            for number in (nothing, nearly):
                scene = Path(folder) / "scene.toml"
                scene.write_text(BALL.format(integrator=integrator, fov=24, material=material.format(number)))
                counts.append(gate.count_render(program, scene, "--cutoff", "0", "--max-depth", "8"))
            print(f"{name}: {nearly} in the place of {nothing} costs {100 * (counts[1] / counts[0] - 1):+.0f} %", flush=True)


def outlines(program):
    """What searching pixels costs that no object reaches, in a picture that is mostly sky."""
    with tempfile.TemporaryDirectory() as folder:
        scene = Path(folder) / "scene.toml"
        scene.write_text(BALL.format(integrator="path", fov=60, material='type = "dielectric", ior = 1.5'))
        skipping, doing = (gate.count_render(program, scene, *more, crop="0,0,128,96") for more in ([], ["--no-skip=outlines"]))
        print(f"outlines: searching the sky around a ball costs {100 * (doing / skipping - 1):+.0f} %", flush=True)


def build_without(feature):
    """The program without a feature, and how long building it took."""
    target = gate.ROOT / "target/without" / feature.replace(" ", "-")
    # Encoded, because a name has a space.
    variables = {"CARGO_ENCODED_RUSTFLAGS": f'--cfg\x1fvitrum_without="{feature}"'}
    start = time.monotonic()
    command = ["cargo", "build", "--release", "--locked", "--target-dir", str(target)]
    subprocess.run(command, cwd=gate.ROOT, check=True, env={**os.environ, **variables})
    return target / "release/vitrum", time.monotonic() - start


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--builds", action="store_true", help="also count builds without a feature")
    options = parser.parse_args()
    _, vitrum = gate.build()
    print(f"the program has {vitrum.stat().st_size / 1e6:.1f} MB")
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        plain = costs(vitrum, gate.SCENES, pool)
        doing = {row: costs(vitrum, gate.SCENES, pool, f"--no-skip={row}") for row in ROWS}
        doing["all of these"] = costs(vitrum, gate.SCENES, pool, "--no-skip")
        # Where nothing changed, the scene does it anyway, or has no occasion to.
        change = lambda of, scene: f"{100 * (of[scene] / plain[scene] - 1):+.1f} %" if of[scene] != plain[scene] else "-"
        table("done all the same", doing, gate.SCENES, lambda row, scene: change(doing[row], scene))
        print()
        pairs(vitrum)
        outlines(vitrum)
        if not options.builds:
            return
        print()
        without = {}
        for feature in BUILDS:
            program, seconds = build_without(feature)
            print(f"without {feature}: built in {seconds:.0f} s", flush=True)
            # A program without what a scene needs refuses it.
            counts = {}
            for scene in gate.SCENES:
                try:
                    counts[scene] = gate.count_render(program, scene)
                except SystemExit as refusal:
                    if "made without what the scene needs" not in str(refusal):
                        raise
                    counts[scene] = None
            without[feature] = counts
        share = lambda count, scene: "needed" if count is None else f"{100 * (plain[scene] / count - 1):+.2f} %"
        table("carried all the same", BUILDS, gate.SCENES, lambda row, scene: share(without[row][scene], scene))
        for feature, counts in without.items():
            for scene, count in counts.items():
                if count is not None and plain[scene] / count - 1 > LIMIT:
                    sys.exit(f"{scene.stem} pays more than {100 * LIMIT} % for {feature}, which it does not need")


if __name__ == "__main__":
    main()
