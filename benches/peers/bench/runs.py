"""One run of one program: a picture and its seconds."""

import json
import os
import subprocess
from dataclasses import dataclass
from pathlib import Path

import exr
from install import Renderer

# How exporters end where a scene can't be said in the renderer's words.
NOT_EXPRESSIBLE = 3


class Failed(Exception):
    """No picture, and why."""


@dataclass
class BenchScene:
    """A scene and its reference."""

    path: Path
    reference: Path
    # relMSE of the reference itself.
    error: float

    @property
    def name(self):
        return self.path.stem


def bench_scene(path: Path, folder: Path | None) -> BenchScene:
    reference = (folder or path.parent / "references") / f"{path.stem}.exr"
    if not reference.is_file():
        raise Failed(f"no reference {reference}: `vitrum bench --make-references --spp 4096 {path}` makes it")
    error = exr.attribute(reference, "vitrum:reference_error")
    if error is None:
        raise Failed(f"{reference} does not say vitrum:reference_error")
    return BenchScene(path, reference.resolve(), float(error))


class Programs:
    """vitrum, and how it and the others are run."""

    def __init__(self, vitrum: Path, threads: int, limit: float):
        self.vitrum, self.threads, self.limit = vitrum, threads, limit

    def own(self) -> Renderer:
        return Renderer("vitrum", [str(self.vitrum), "render"])

    def run(self, renderer: Renderer, scene: BenchScene, spp: int, seed: int, picture: Path) -> dict:
        """Renders; the answer is the program's report."""
        report = picture.with_suffix(".json")
        picture.unlink(missing_ok=True)
        report.unlink(missing_ok=True)
        command = [*renderer.command, str(scene.path), "--spp", str(spp), "--seed", str(seed)]
        command += ["--threads", str(self.threads), "-o", str(picture), "--report", str(report)]
        command += ["--quiet"] if renderer.name == "vitrum" else []
        try:
            done = subprocess.run(command, capture_output=True, text=True, timeout=self.limit)
        except subprocess.TimeoutExpired:
            raise Failed(f"no picture after {self.limit:.0f} s") from None
        said = done.stderr.strip().splitlines() or ["no word"]
        if done.returncode == NOT_EXPRESSIBLE:
            raise Failed(f"not expressible: {said[-1]}")
        if done.returncode or not report.is_file():
            raise Failed(f"ended with {done.returncode}: {said[-1]}")
        found = json.loads(report.read_text())
        report.unlink()
        return found

    def compare(self, picture: Path, reference: Path) -> dict:
        """The errors of a picture, as vitrum counts them for itself."""
        command = [self.vitrum, "compare", "--json", picture, reference]
        done = subprocess.run(command, capture_output=True, text=True)
        if done.returncode:
            raise Failed(f"the picture can't be compared: {done.stderr.strip()}")
        return json.loads(done.stdout)

    def machine(self) -> str:
        """As `vitrum bench` says it."""
        about = Path("/proc/cpuinfo")
        lines = about.read_text().splitlines() if about.is_file() else []
        models = [line.split(": ")[1] for line in lines if line.startswith("model name")]
        return f"{models[0] if models else os.uname().machine}, {self.threads} of {len(os.sched_getaffinity(0))} threads"
