"""Run time against error: runs of all programs in turns, one line of JSON each, as `vitrum bench` writes them."""

import json
from pathlib import Path

from runs import BenchScene, Failed, Programs

# A reference tells an error to a twentieth of it.
TELLING = 20.0
MOST_SAMPLES = 1 << 16


class Results:
    def __init__(self, programs: Programs, folder: Path):
        self.programs, self.folder = programs, folder
        self.file = open(folder / "results.jsonl", "x")

    def run(self, renderer, scene: BenchScene, spp: int, seed: int) -> dict:
        """Renders, compares, and writes down: at once, so that what is stopped has lost nothing."""
        kept = Path("pictures") / f"{scene.name}-{renderer.name.replace(' ', '_')}-{spp}.exr" if seed == 1 else None
        picture = self.folder / (kept or "scratch.exr")
        report = self.programs.run(renderer, scene, spp, seed, picture)
        counts = [value for key, value in report.items() if key.endswith("_rays")]
        record = {
            "scene": scene.name,
            "program": renderer.name,
            "version": report["version"],
            "machine": self.programs.machine(),
            "spp": spp,
            "seed": seed,
            "loading": report["loading"],
            "rendering": report["rendering"],
            "processors": report.get("processors"),
            "rays": sum(counts) if counts else None,
            **self.programs.compare(picture, scene.reference),
            "reference_error": scene.error,
            "reference": str(scene.reference),
            "picture": kept and str(kept),
        }
        self.file.write(json.dumps(record) + "\n")
        self.file.flush()
        return record


def measure(results: Results, renderers, scene: BenchScene, seeds: int, seconds: float, factor: int):
    """All runs of a scene: samples rise, until a program's run takes so long or the reference is not good enough for it."""
    going = list(renderers)
    for renderer in renderers:
        # Files come into memory, and compiled kernels into caches.
        try:
            results.programs.run(renderer, scene, 1, 0, results.folder / "scratch.exr")
        except Failed as reason:
            print(f"{scene.name}, {renderer.name}: {reason}", flush=True)
            going.remove(renderer)
    spp = 1
    while going and spp <= MOST_SAMPLES:
        longest = {renderer.name: 0.0 for renderer in going}
        least = {renderer.name: float("inf") for renderer in going}
        for seed in range(1, seeds + 1):
            for renderer in list(going):
                try:
                    record = results.run(renderer, scene, spp, seed)
                except Failed as reason:
                    print(f"{scene.name}, {renderer.name}, {spp} samples: {reason}", flush=True)
                    going.remove(renderer)
                    continue
                name, time = renderer.name, record["loading"] + record["rendering"]
                longest[name], least[name] = max(longest[name], time), min(least[name], record["rel_mse"])
        for renderer in going:
            name = renderer.name
            print(f"{scene.name}, {name}: {spp} samples, {longest[name]:.2f} s, relMSE {least[name]:.2e}", flush=True)
        going = [r for r in going if longest[r.name] < seconds and least[r.name] >= TELLING * scene.error]
        spp *= factor
