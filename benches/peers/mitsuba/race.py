#!/usr/bin/env python3
"""Seconds to a given error: vitrum against Mitsuba 3, on five scenes of glass.

    pip install -r benches/peers/mitsuba/requirements.txt
    cargo build --release
    python3 benches/peers/mitsuba/race.py --minutes 60 --references FOLDER

Four steps, each a table: whether the converged pictures agree; which of Mitsuba's roulettes suits each scene; seconds to a
relative mean square error of 1e-2 and of 1e-3; and what each part of vitrum contributes, by switching it off. README.md says
what is measured and how. `--help` lists the options.
"""

import argparse
import hashlib
import json
import os
import re
import resource
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass, field
from pathlib import Path

import mitsuba as mi
import numpy as np

mi.set_variant("scalar_rgb")

import race_scenes  # noqa: E402
from common import read, tiles  # noqa: E402

HERE = Path(__file__).parent
PIXELS = race_scenes.SIZE[0] * race_scenes.SIZE[1]
STEPS = ["agree", "tune", "race", "parts"]
# Shares of the time that the steps may take. The first includes the references, which a later run finds in its folder.
SHARES = {"agree": 0.35, "tune": 0.1, "race": 0.4, "parts": 0.15}
TARGETS = [1e-2, 1e-3]
# A reference is good enough where its own error is below a twentieth of the smallest target.
REFERENCE_ERROR = TARGETS[-1] / 20
LEAST_CHUNKS, MOST_CHUNKS = 8, 64
TILES = (8, 6)
# How far tiles without noise may be apart: the programs round and interpolate differently.
ROUNDING = 1e-4
# The seeds of different purposes differ.
RACE_SEED, PILOT_SEED, REFERENCE_SEED = 1, 900, 100_000
PARTS = {
    "as it is": [],
    "one ray at each glass": ["--branching", "one"],
    "both rays at the first glass only": ["--branching", "first"],
    "independent random numbers": ["--sequence", "independent"],
    "light found by asking only": ["--light-sampling", "lights"],
    "light found by meeting it only": ["--light-sampling", "bsdf"],
    "one ray, independent numbers": ["--branching", "one", "--sequence", "independent"],
}


@dataclass
class Run:
    """One render. Seconds of the clock, and of the processors (`cpu`: whole process)."""

    picture: np.ndarray
    samples: int
    render: float
    total: float | None = None
    load: float | None = None
    cpu: float | None = None
    # Processor seconds of rendering alone, where the program tells.
    busy: float | None = None


class Race:
    def __init__(self, options, folder):
        self.options, self.folder = options, folder
        race_scenes.write_scenes(folder)
        self.roulette = dict.fromkeys(race_scenes.NAMES, 5)
        self.log = open(options.log, "a") if options.log else None

    def vitrum(self, scene, samples, seed, *more):
        """A process of vitrum, from its start to its end."""
        picture = self.folder / "vitrum.exr"
        command = [self.options.vitrum, "render", self.folder / f"{scene}.toml", "-o", picture]
        command += ["--spp", str(samples), "--seed", str(seed), "--threads", str(self.options.threads)]
        command += ["--max-depth", str(self.options.depth), *more]
        before, start = children(), time.perf_counter()
        done = subprocess.run(command, capture_output=True, text=True)
        total, cpu = time.perf_counter() - start, children() - before
        if done.returncode:
            sys.exit(done.stderr)
        phases = re.search(r"([\d.]+) s loading, ([\d.]+) s rendering", done.stderr)
        load, render = float(phases[1]), float(phases[2])
        run = Run(read(picture), samples, render, total, load, cpu)
        self.note("vitrum", scene, seed, run, list(more))
        return run

    def mitsuba(self, scene, samples, seeds, roulette=None, cold=False):
        """A process of Mitsuba that renders once for each seed; only its first render has a total."""
        pictures = [str(self.folder / f"mitsuba{i}.exr") for i in range(len(seeds))]
        job = {
            "variant": self.options.variant,
            "threads": self.options.threads,
            "folder": str(self.folder),
            "scene": scene,
            "sampler": "multijitter",
            # Mitsuba counts the segments of a path, vitrum its vertices after the camera.
            "max_depth": self.options.depth + 1,
            "rr_depth": roulette or self.roulette[scene],
            "renders": [[samples, seed, picture] for seed, picture in zip(seeds, pictures)],
        }
        environment = dict(os.environ)
        with tempfile.TemporaryDirectory() as home:
            if cold:  # Compiled kernels are kept in the home folder.
                environment["HOME"] = home
            start = time.time()
            command = [sys.executable, HERE / "race_mitsuba.py", json.dumps(job)]
            done = subprocess.run(command, capture_output=True, text=True, env=environment)
        if done.returncode:
            sys.exit(f"{done.stderr[-2000:]}\nMitsuba failed; DRJIT_LIBLLVM_PATH names the LLVM that it compiles with")
        told = json.loads(done.stdout.splitlines()[-1])
        runs = [
            Run(read(picture), samples, seconds, busy=busy)
            for picture, (seconds, busy, samples) in zip(pictures, told["renders"])
        ]
        runs[0].total, runs[0].load, runs[0].cpu = told["written"] - start, told["load"], told["cpu"]
        for seed, run in zip(seeds, runs):
            self.note("mitsuba", scene, seed, run, [job["rr_depth"]])
        return runs

    def note(self, program, scene, seed, run, options):
        if self.log:
            of_run = {key: value for key, value in vars(run).items() if key != "picture"}
            line = {"program": program, "scene": scene, "seed": seed, "options": options, **of_run}
            print(json.dumps(line), file=self.log, flush=True)


def children():
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def say(*line):
    print(*line, file=sys.stderr, flush=True)


def table(title, head, rows):
    print(f"\n## {title}\n")
    print("| " + " | ".join(head) + " |")
    print("|" + "---|" + "---:|" * (len(head) - 1))
    for row in rows:
        print("| " + " | ".join(row) + " |")
    print(flush=True)


# References


@dataclass
class Sum:
    """Pictures of one program, added up with their samples as weights."""

    weights: list = field(default_factory=list)
    total: np.ndarray = 0.0
    squares: np.ndarray = 0.0
    of_tiles: list = field(default_factory=list)

    def add(self, run):
        picture = run.picture.astype(float)
        self.weights.append(run.samples)
        self.total = self.total + run.samples * picture
        self.squares = self.squares + run.samples * picture**2
        self.of_tiles.append(tiles(picture, *TILES))

    def samples(self):
        return int(sum(self.weights))

    def mean(self):
        return self.total / self.samples()

    def variance(self):
        """Of the mean, by pixel."""
        return np.maximum(self.squares / self.samples() - self.mean() ** 2, 0) / (len(self.weights) - 1)

    def tiles(self):
        """Means, and standard errors of the means."""
        of_tiles, weights = np.array(self.of_tiles), np.array(self.weights)
        mean = np.average(of_tiles, axis=0, weights=weights)
        variance = np.average((of_tiles - mean) ** 2, axis=0, weights=weights) / (len(weights) - 1)
        return mean, np.sqrt(variance)


@dataclass
class Reference:
    ours: Sum
    theirs: Sum

    def mean(self):
        return (self.ours.mean() + self.theirs.mean()) / 2

    def variance(self):
        return (self.ours.variance() + self.theirs.variance()) / 4

    def error(self):
        """The relative mean square error of the reference itself."""
        return float((self.variance() / (self.mean() ** 2 + 0.01)).mean())

    def errors(self, picture):
        """relMSE of a picture, of all pixels and without the worst 0.1 %, less what the reference's own noise adds."""
        r, scale = self.mean(), self.mean() ** 2 + 0.01
        by_pixel = (((picture - r) ** 2) / scale).mean(-1).ravel()
        own = (self.variance() / scale).mean(-1).ravel()
        kept = np.argsort(by_pixel)[: len(by_pixel) - len(by_pixel) // 1000]
        return float((by_pixel - own).mean()), float((by_pixel - own)[kept].mean())


def key(race, scene):
    """Changes with all that a converged picture depends on."""
    told = hashlib.sha256((race.folder / f"{scene}.toml").read_bytes())
    described = race_scenes.scene(scene, race.folder, "multijitter", race.options.depth, 0)
    told.update(repr(described).replace(str(race.folder), "").encode())
    for file in sorted([*race.folder.glob("*.obj"), *race.folder.glob("environment*.exr")]):
        told.update(file.read_bytes() if file.suffix == ".exr" or file.name in str(described) else b"")
    return told.hexdigest()


def load_reference(file, expected):
    if not file or not file.exists():
        return Reference(Sum(), Sum())
    stored = np.load(file)
    if str(stored["key"]) != expected:
        return Reference(Sum(), Sum())
    return Reference(*(
        Sum(list(stored[f"{who}_weights"]), *stored[f"{who}_sums"], list(stored[f"{who}_tiles"]))
        for who in ("ours", "theirs")
    ))


def save_reference(file, expected, reference):
    if not file:
        return
    arrays = {"key": expected}
    for who, part in (("ours", reference.ours), ("theirs", reference.theirs)):
        arrays[f"{who}_weights"] = part.weights
        arrays[f"{who}_sums"] = np.array([part.total, part.squares])
        arrays[f"{who}_tiles"] = np.array(part.of_tiles)
    np.savez(file, **arrays)


def make_reference(race, scene, deadline):
    """Long renders of both programs, in chunks of different seeds."""
    folder = race.options.references
    file = folder / f"{scene}-{race.options.depth}.npz" if folder else None
    expected = key(race, scene)
    reference = load_reference(file, expected)
    ours, theirs = reference.ours, reference.theirs
    while (count := len(ours.weights)) < MOST_CHUNKS:
        if count >= LEAST_CHUNKS and (time.time() > deadline or reference.error() < REFERENCE_ERROR):
            break
        seeds = [REFERENCE_SEED + count, REFERENCE_SEED + count + 1]
        for seed in seeds:
            ours.add(race.vitrum(scene, race.options.chunk, seed))
        for run in race.mitsuba(scene, race.options.chunk, seeds):
            theirs.add(run)
        save_reference(file, expected, reference)
        say(f"reference {scene}: {ours.samples()} samples, own error {reference.error():.1e}")
    return reference


def write_pictures(folder, scene, reference):
    """What both programs converge to, and ten times their difference on grey, to look at."""
    folder.mkdir(parents=True, exist_ok=True)
    ours, theirs = reference.ours.mean(), reference.theirs.mean()
    for name, picture in [("vitrum", ours), ("mitsuba", theirs), ("difference", 0.2 + 10 * (ours - theirs))]:
        bitmap = mi.Bitmap(np.maximum(picture, 0).astype(np.float32))
        bitmap.convert(mi.Bitmap.PixelFormat.RGB, mi.Struct.Type.UInt8, True).write(str(folder / f"{scene}_{name}.png"))


def agree(references):
    rows = []
    for scene, reference in references.items():
        (ours, our_error), (theirs, their_error) = reference.ours.tiles(), reference.theirs.tiles()
        apart = ours / theirs - 1
        noise = np.sqrt(our_error**2 + their_error**2 + (ROUNDING * theirs) ** 2)
        in_noise = (ours - theirs) / noise
        rows.append([
            scene,
            f"{reference.ours.mean().mean():.5f}",
            f"{reference.theirs.mean().mean():.5f}",
            f"{rms(apart):.3%}",
            f"{np.abs(apart).max():.2%}",
            f"{rms(our_error / ours):.3%}",
            f"{rms(their_error / theirs):.3%}",
            f"{rms(in_noise):.2f}",
            f"{np.abs(in_noise).max():.1f}",
            f"{reference.ours.samples()}",
            f"{reference.theirs.samples()}",
            f"{reference.error():.1e}",
        ])
    head = ["scene", "mean", "Mitsuba", "tiles apart, rms", "farthest", "own error", "Mitsuba", "apart in errors, rms"]
    head += ["farthest", "samples", "Mitsuba", "error of both"]
    table("Agreement", head, rows)


def rms(x):
    return float(np.sqrt((x**2).mean()))


# Mitsuba's setting


def tune(race, references, deadline):
    """Takes the roulette that gives Mitsuba less error in a processor second: its default, from depth 5, or none."""
    rows = []
    settings = {"from depth 5": 5, "none": race.options.depth + 1}
    for scene, reference in references.items():
        costs = {name: [] for name in settings}
        for i in range(race.options.seeds):
            for name, roulette in settings.items():
                first, second = race.mitsuba(scene, race.options.pilot, [PILOT_SEED + 2 * i, PILOT_SEED + 2 * i + 1], roulette)
                for run in first, second:
                    costs[name].append([*reference.errors(run.picture), second.busy])
            if i and time.time() > deadline:
                break
        means = {name: np.mean(cost, axis=0) for name, cost in costs.items()}
        score = {name: float(np.sqrt(max(full, 1e-12) * max(trimmed, 1e-12)) * busy) for name, (full, trimmed, busy) in means.items()}
        best = min(score, key=score.get)
        race.roulette[scene] = settings[best]
        told = [f"{full:.2e}, {trimmed:.2e}, {busy:.2f}" for full, trimmed, busy in means.values()]
        rows.append([scene, *told, f"{score['from depth 5'] / score['none']:.2f}", best])
    head = ["scene", "roulette from depth 5: relMSE, trimmed, s", "none", "efficiency of none over from depth 5", "taken"]
    table(f"Mitsuba's roulette, {race.options.pilot} samples, processor seconds", head, rows)


# The race


class Curve:
    """Errors and seconds of one program by samples."""

    def __init__(self):
        self.errors, self.seconds = {}, {}

    def add(self, reference, run, **seconds):
        self.errors.setdefault(run.samples, []).append(reference.errors(run.picture))
        for kind, value in seconds.items():
            if value is not None:
                self.seconds.setdefault(kind, {}).setdefault(run.samples, []).append(value)

    def counts(self):
        return sorted(self.errors)

    def error(self, trimmed, pick=None):
        """Means over the seeds, for each count of samples."""
        means = []
        for count in self.counts():
            values = np.array([pair[trimmed] for pair in self.errors[count]])
            means.append(values.mean() if pick is None else values[pick.integers(len(values), size=len(values))].mean())
        return np.array(means)

    def time(self, kind, pick=None):
        """Medians over the seeds, for each count of samples."""
        of_kind, medians = self.seconds[kind], []
        for count in self.counts():
            values = np.array(of_kind[count])
            medians.append(np.median(values if pick is None else values[pick.integers(len(values), size=len(values))]))
        return np.array(medians)

    def slope(self, trimmed):
        return np.polyfit(np.log(self.counts()), np.log(np.maximum(self.error(trimmed), 1e-12)), 1)[0]

    def samples_at(self, target, trimmed, pick=None):
        """Samples for an error, and whether they lie among those measured: interpolated in logarithms, or extrapolated with the
        slope of all."""
        counts, errors = np.log(self.counts()), np.log(np.maximum(self.error(trimmed, pick), 1e-12))
        goal = np.log(target)
        below = np.flatnonzero(errors <= goal)
        if len(below) and below[0] > 0:
            i = below[0]
            t = (goal - errors[i - 1]) / (errors[i] - errors[i - 1])
            return float(np.exp(counts[i - 1] + t * (counts[i] - counts[i - 1]))), True
        slope = min(np.polyfit(counts, errors, 1)[0], -0.5)
        nearest = 0 if len(below) else -1
        return float(np.exp(counts[nearest] + (goal - errors[nearest]) / slope)), False

    def seconds_at(self, target, trimmed, kind, pick=None):
        """Seconds for an error: interpolated in logarithms of samples; beyond those measured, each costs the same."""
        samples, _ = self.samples_at(target, trimmed, pick)
        counts, seconds = np.array(self.counts()), self.time(kind, pick)
        if counts[0] <= samples <= counts[-1]:
            return float(np.exp(np.interp(np.log(samples), np.log(counts), np.log(seconds))))
        each = (seconds[-1] - seconds[0]) / (counts[-1] - counts[0])
        nearest = 0 if samples < counts[0] else -1
        return max(float(seconds[nearest] + each * (samples - counts[nearest])), 1e-3)


def rungs(race, scene, reference, seconds):
    """Counts of samples for each program, in powers of two: from the larger error to below the smaller, as time permits."""
    chosen = []
    for runs in [race.vitrum(scene, race.options.pilot, PILOT_SEED)], race.mitsuba(scene, race.options.pilot, [PILOT_SEED, 901]):
        error = np.mean([reference.errors(run.picture)[0] for run in runs])
        trimmed = np.mean([reference.errors(run.picture)[1] for run in runs])
        samples, per_sample = runs[-1].samples, runs[-1].render / runs[-1].samples
        least = 2 ** int(np.floor(np.log2(samples * trimmed / TARGETS[0])))
        most = 2 ** int(np.ceil(np.log2(samples * error / TARGETS[-1] * 1.2)))
        least, most = min(least, race.options.most // 4), max(most, 16)
        counts = [2**k for k in range(1, race.options.most.bit_length()) if least <= 2**k <= most]
        while len(counts) > 3 and race.options.least_seeds * sum(counts) * per_sample * len(runs) > seconds / 2:
            counts.pop()
        chosen.append(counts)
    say(f"{scene}: vitrum {chosen[0]}, Mitsuba {chosen[1]} samples")
    return chosen


def run_race(race, references, deadline):
    seconds = (deadline - time.time()) / len(references)
    plans = {scene: rungs(race, scene, reference, seconds) for scene, reference in references.items()}
    curves = {scene: (Curve(), Curve()) for scene in references}
    rounds = 0
    while rounds < race.options.least_seeds or (rounds < race.options.seeds and time.time() < deadline):
        for scene, reference in references.items():
            ours, theirs = curves[scene]
            for i in range(max(len(plan) for plan in plans[scene])):
                seed = RACE_SEED + 2 * rounds
                for count in plans[scene][0][i : i + 1]:
                    run = race.vitrum(scene, count, seed)
                    ours.add(reference, run, total=run.total, load=run.load, render=run.render, warm=run.render, cpu=run.cpu)
                for count in plans[scene][1][i : i + 1]:
                    run, warm = race.mitsuba(scene, count, [seed, seed + 1])
                    theirs.add(reference, run, total=run.total, load=run.load, render=run.render, cpu=run.cpu)
                    theirs.add(reference, warm, warm=warm.render)
        rounds += 1
        say(f"round {rounds} of the race is done, load {os.getloadavg()[0]:.1f}")
    for trimmed, which in enumerate(["all pixels", "without the worst 0.1 % of pixels"]):
        seconds_table(curves, trimmed, which, rounds)
    slopes_table(curves, references)
    compile_table(race, references)


def seconds_table(curves, trimmed, which, rounds):
    rows = []
    for scene, (ours, theirs) in curves.items():
        for target in TARGETS:
            row = [scene, f"{target:.0e}"]
            for curve, kinds in (ours, ["total", "render", "cpu"]), (theirs, ["total", "render", "warm", "cpu"]):
                samples, inside = curve.samples_at(target, trimmed)
                row.append(f"{samples:.0f}{'' if inside else '*'}")
                row += [f"{curve.seconds_at(target, trimmed, kind):.2f}" for kind in kinds]
            row += [ratio(ours, theirs, kind, target, trimmed) for kind in ("total", "warm", "cpu")]
            rows.append(row)
    head = ["scene", "relMSE", "samples", "total", "render", "cpu", "Mitsuba: samples", "total", "render", "warm", "cpu"]
    head += ["ratio of total", "of warm renders", "of cpu"]
    table(f"Seconds to relMSE, {which}, {rounds} rounds; ratios above 1: vitrum is faster", head, rows)


def ratio(ours, theirs, kind, target, trimmed):
    """Mitsuba's seconds over vitrum's, with an interval of 95 % by resampling the seeds."""

    def value(pick=None):
        a, b = (curve.seconds_at(target, trimmed, kind, pick) for curve in (ours, theirs))
        return b / a

    pick = np.random.default_rng(0)
    low, high = np.percentile([value(pick) for _ in range(400)], [2.5, 97.5])
    return f"**{value():.2f}** ({low:.2f}–{high:.2f})"


def slopes_table(curves, references):
    rows = []
    for scene, pair in curves.items():
        reference = references[scene]
        for program, curve in zip(["vitrum", "Mitsuba"], pair):
            counts, warm, cpu = curve.counts(), curve.time("warm"), curve.time("cpu")
            per_cpu = (cpu[-1] - cpu[0]) / (counts[-1] - counts[0]) / PIXELS
            rows.append([
                scene,
                program,
                f"{counts[0]}–{counts[-1]}",
                f"{curve.slope(0):.2f}",
                f"{curve.slope(1):.2f}",
                f"{warm[-1] / counts[-1] / PIXELS * 1e6:.3f}",
                f"{per_cpu * 1e6:.3f}",
                f"{np.median(curve.time('load')):.2f}",
                f"{np.median(curve.time('total') - curve.time('render')):.2f}",
                f"{curve.error(0)[-1]:.1e}, {curve.error(1)[-1]:.1e}",
                f"{reference.error() / curve.error(0)[-1]:.1%}",
            ])
    head = ["scene", "program", "samples", "slope", "slope, trimmed", "µs a sample", "µs of cpu", "loading, s"]
    head += ["all but rendering, s", "least relMSE, trimmed", "reference's share"]
    table("Slopes d log relMSE / d log samples, and cost of a sample", head, rows)


def compile_table(race, references):
    rows = []
    for scene in references:
        first, warm = race.mitsuba(scene, race.options.pilot, [1, 2], cold=True)
        rows.append([scene, f"{first.render:.2f}", f"{warm.render:.2f}", f"{first.total:.2f}"])
    head = ["scene", "first render", "second", "total"]
    table(f"Mitsuba without kept kernels, {race.options.pilot} samples, seconds", head, rows)


# The parts of vitrum


def costs(measured, name, kind):
    """Error times seconds, seed by seed: a program that decides otherwise from seed to seed must not be judged by its mean of both."""
    return np.mean([run[kind] * run[2] for run in measured[name]])


def parts(race, references, deadline):
    rows, seconds = [], (deadline - time.time()) / len(references)
    for scene, reference in references.items():
        idle = race.vitrum(scene, 1, 1, "--crop", "0,0,1,1").cpu
        start = time.time()
        pilot = race.vitrum(scene, race.options.pilot, PILOT_SEED)
        # As many samples as give about the smallest error, or as time permits.
        wanted = pilot.samples * reference.errors(pilot.picture)[0] / TARGETS[-1]
        affordable = seconds / race.options.least_seeds / len(PARTS) / (pilot.render / pilot.samples)
        count = 2 ** int(np.clip(np.log2(max(min(wanted, affordable), 1)), 3, np.log2(race.options.most)))
        measured = {name: [] for name in PARTS}
        for i in range(race.options.seeds):
            for name, switches in PARTS.items():
                run = race.vitrum(scene, count, RACE_SEED + i, *switches)
                measured[name].append([*reference.errors(run.picture), run.cpu - idle])
            if i + 1 >= race.options.least_seeds and time.time() > start + seconds:
                break
        for name in PARTS:
            error, trimmed, busy = np.mean(measured[name], axis=0)
            rows.append([
                scene,
                name,
                f"{count}",
                f"{error:.2e}",
                f"{trimmed:.2e}",
                f"{busy:.2f}",
                f"{costs(measured, 'as it is', 0) / costs(measured, name, 0):.2f}",
                f"{costs(measured, 'as it is', 1) / costs(measured, name, 1):.2f}",
            ])
    head = ["scene", "vitrum", "samples", "relMSE", "trimmed", "cpu seconds", "efficiency", "trimmed"]
    table("Parts of vitrum: efficiency 1/(relMSE × cpu seconds) of each against vitrum as it is", head, rows)


def options():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--vitrum", type=Path, default=HERE.parents[2] / "target/release/vitrum", help="the program")
    parser.add_argument("--minutes", type=float, default=60, help="about how long all may take [60]")
    parser.add_argument("--scenes", nargs="+", default=race_scenes.NAMES, choices=race_scenes.NAMES)
    parser.add_argument("--steps", nargs="+", default=STEPS, choices=STEPS)
    parser.add_argument("--references", type=Path, help="folder that keeps the long renders for the next run")
    parser.add_argument("--seeds", type=int, default=10, help="most seeds of a measurement; time may permit fewer, 3 at least [10]")
    parser.add_argument("--roulette", nargs="+", default=[], metavar="SCENE=DEPTH", help="Mitsuba's, where `tune` does not run")
    parser.add_argument("--variant", default="llvm_ad_rgb", help="of Mitsuba [llvm_ad_rgb]; scalar_rgb is the other of use")
    parser.add_argument("--depth", type=int, default=32, help="limit, as vitrum counts: the camera ray has depth 0 [32]")
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--chunk", type=int, default=256, help="samples of a part of a reference [256]")
    parser.add_argument("--most", type=int, default=1024, help="most samples of a measured render [1024]")
    parser.add_argument("--quick", action="store_true", help="small references, few samples, two seeds: to see that all works")
    parser.add_argument("--pictures", type=Path, help="folder for pictures to look at")
    parser.add_argument("--log", type=Path, help="file for every measurement, as lines of JSON")
    chosen = parser.parse_args()
    chosen.pilot, chosen.least_seeds = 16, 3
    if chosen.quick:
        chosen.chunk, chosen.most, chosen.seeds, chosen.least_seeds = 64, 64, 2, 2
        chosen.minutes = min(chosen.minutes, 1)
    return chosen


def main():
    chosen = options()
    share = sum(SHARES[step] for step in chosen.steps)
    if chosen.references:
        chosen.references.mkdir(parents=True, exist_ok=True)

    def deadline(step, part=1.0):
        return time.time() + 60 * chosen.minutes * SHARES[step] / share * part

    with tempfile.TemporaryDirectory() as folder:
        race = Race(chosen, Path(folder))
        for setting in chosen.roulette:
            scene, depth = setting.split("=")
            race.roulette[scene] = int(depth)
        print(f"{chosen.threads} threads, {chosen.variant}, depth {chosen.depth}, load at the start {os.getloadavg()[0]:.1f}")
        references = {}
        for scene in chosen.scenes:
            # Without the first step a reference is taken as it is, if there is one.
            until = deadline("agree", 1 / len(chosen.scenes)) if "agree" in chosen.steps else 0
            references[scene] = make_reference(race, scene, until)
            if chosen.pictures:
                write_pictures(chosen.pictures, scene, references[scene])
        if "agree" in chosen.steps:
            agree(references)
        if "tune" in chosen.steps:
            tune(race, references, deadline("tune"))
        if "race" in chosen.steps:
            run_race(race, references, deadline("race"))
        if "parts" in chosen.steps:
            parts(race, references, deadline("parts"))
        print(f"Load at the end {os.getloadavg()[0]:.1f}")


if __name__ == "__main__":
    main()
