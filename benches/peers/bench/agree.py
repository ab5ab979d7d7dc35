"""Whether renderers converge to the same pictures: means of tiles of long renders against the references.

A renderer's own standard errors come from independent parts, those of a reference from its relMSE. Where seeds change nothing,
the error is what four times the samples have changed.
"""

from dataclasses import dataclass
from pathlib import Path

import exr
import numpy as np
from runs import BenchScene, Failed, Programs

TILES = (8, 6)
# Of vitrum's relMSE: added to the squared radiance.
DARK = 0.01
# Tiles are told from the reference's beyond both.
ERRORS, SHARE = 3.0, 0.005
# So many of them may be so by chance: errors that a few parts tell are uncertain themselves.
BY_CHANCE = 0.1
# What is so many errors apart is apart, however noisy.
FAR = 5.0
# How far tiles without noise may be apart: programs round and interpolate differently.
ROUNDING = 1e-4
# The seeds of parts are not those of runs.
FIRST_SEED = 1001


@dataclass
class Agreement:
    spp: int
    parts: int
    # Of the whole picture, relative to the reference's mean.
    mean: float
    mean_error: float
    # Of tiles, relative to the reference's.
    rms: float
    farthest: float
    # Standard errors of tiles, rms.
    noise: float
    # rms in standard errors.
    in_errors: float
    # The share of tiles.
    beyond: float

    @property
    def verdict(self):
        mean_is_off = abs(self.mean) > max(SHARE, ERRORS * self.mean_error)
        if self.beyond <= BY_CHANCE and self.in_errors <= FAR and not mean_is_off:
            return "yes"
        # Few samples with rare bright ones look like another picture.
        return "**no**" if self.noise < SHARE or self.in_errors > FAR else "noise"

    def cells(self):
        mean = f"{100 * self.mean:+.2f} ± {100 * self.mean_error:.2f} %"
        percents = [f"{100 * share:.2f} %" for share in (self.rms, self.farthest, self.noise)]
        errors = [f"{self.in_errors:.2f}", f"{100 * self.beyond:.0f} %"]
        return [f"{self.parts} x {self.spp}", mean, *percents, *errors, self.verdict]


HEADINGS = ["scene", "program", "parts x samples", "mean apart", "tiles apart, rms", "farthest", "errors, rms"]
HEADINGS += ["apart in errors", "tiles beyond", "agrees"]


def tiles(picture):
    height, width, _ = picture.shape
    across, down = TILES
    return picture.reshape(down, height // down, across, width // across, 3).mean((1, 3, 4))


def compared(parts, spp, own, reference, error) -> Agreement:
    """From the tiles of all parts; `own` are the squared errors of their mean."""
    reference = reference.astype(float)
    target, count = tiles(reference), len(parts)
    difference = parts.mean(0) - target
    # A tile that is nearly black counts as a tenth of the picture's mean.
    scale = np.maximum(target, 0.1 * target.mean())
    squares = tiles(error * (reference**2 + DARK)) / (reference.size / 3 / target.size)
    errors = np.sqrt(own + squares + (ROUNDING * scale) ** 2)
    share = difference / scale
    beyond = (np.abs(difference) > ERRORS * errors) & (np.abs(share) > SHARE)

    def rms(values):
        return float(np.sqrt((values**2).mean()))

    return Agreement(
        spp,
        count,
        difference.mean() / target.mean(),
        # Tiles are independent.
        rms(errors) / np.sqrt(target.size) / target.mean(),
        rms(share),
        float(np.abs(share).max()),
        rms(errors / scale),
        rms(difference / errors),
        float(beyond.mean()),
    )


def agree(programs: Programs, renderer, scene: BenchScene, seconds: float, parts: int, scratch: Path) -> Agreement:
    """Samples are doubled until all parts together take so many seconds."""

    def part(spp, seed):
        report = programs.run(renderer, scene, spp, seed, scratch)
        picture = exr.read(scratch).astype(float)
        if not np.isfinite(picture).all():
            raise Failed("pixels that are no numbers")
        return tiles(picture), report["rendering"]

    spp, parts = 4, parts if renderer.has_seeds else 1
    # What is compiled once is no part of how long samples take.
    part(spp, FIRST_SEED)
    while True:
        first, time = part(spp, FIRST_SEED)
        share = seconds / parts / max(time, 0.01)
        if share < 2:
            break
        # A short run says little of a long one.
        spp *= 1 << int(min(np.log2(share), 4))
    if renderer.has_seeds:
        found = np.stack([first] + [part(spp, FIRST_SEED + i)[0] for i in range(1, parts)])
        own = found.var(0, ddof=1) / parts
    else:
        found = first[None]
        own = (first - part(spp // 4, FIRST_SEED)[0]) ** 2
    return compared(found, spp, own, exr.read(scene.reference), scene.error)


def all_agreements(programs: Programs, renderers, chosen: list[BenchScene], seconds, parts, folder: Path):
    """The table, line by line; what fails is said in it. The answer says what each renderer can render."""
    able = {}
    text = folder / "agreement.md"
    with open(text, "w") as file:

        def line(cells):
            row = f"| {' | '.join(cells)} |"
            print(row, flush=True)
            file.write(row + "\n")
            file.flush()

        line(HEADINGS)
        line(["---", "---", *["---:"] * (len(HEADINGS) - 3), "---"])
        for scene in chosen:
            for renderer in renderers:
                start = [scene.name, renderer.name]
                try:
                    found = agree(programs, renderer, scene, seconds, parts, folder / "scratch.exr")
                    line([*start, *found.cells()])
                    able[scene.name, renderer.name] = found
                except Failed as reason:
                    line([*start, *["-"] * (len(HEADINGS) - 3), str(reason)])
    return able
