#!/usr/bin/env python3
"""Holds instructions and errors to what is recorded in baselines.json: neither slower nor noisier without anybody saying why.

    benches/gate.py                    # builds, counts, compares: exit status 1 where something moved
    benches/gate.py --update REASON    # records what moved, with the reason
    benches/gate.py --self-test        # whether it would see what it is for

Three things are held, each by itself: the instructions of every kernel of `hot_loop`, the instructions of a small render of every
bench scene, and the error of that scene at 16 samples (relMSE, mean of four seeds); and for each scene the product of the last two,
which is what a picture of given quality costs. Counts are valgrind's; the same tree gives the same numbers, whatever else the
machine does. Better counts as moved too: a gain that is not recorded would be room for a loss that nobody sees.

Needs valgrind. It knows AVX2 but not AVX-512, so both of that are counted on processors that have the former.
"""

import argparse
import json
import os
import re
import shutil
import statistics
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
BASELINES = ROOT / "benches/baselines.json"
SCENES = sorted((ROOT / "scenes/bench").glob("*.toml"))
SAMPLES, SEEDS = 16, 4
# A quarter of the picture, from its middle: counting takes fifty times as long as rendering.
CROP = "32,24,64,48"
# How far numbers may move. Other versions of the C library copy memory by other instructions; errors are of the same bytes everywhere,
# so they don't move at all.
TOLERANCES = {"instructions": 0.005, "error": 1e-9, "product": 0.005}
# Where a count begins and ends.
KERNEL = "hot_loop::measure::counted"
RENDER = "vitrum_tracer::render::render_here"


def build():
    """The two programs that are counted, as their users get them: kernels and renderer."""
    subprocess.run(["cargo", "build", "--release", "--locked"], cwd=ROOT, check=True)
    command = ["cargo", "bench", "--locked", "--bench", "hot_loop", "--no-run", "--message-format=json"]
    lines = subprocess.run(command, cwd=ROOT, check=True, stdout=subprocess.PIPE, text=True).stdout.splitlines()
    messages = [json.loads(line) for line in lines if line.startswith("{")]
    [kernels] = [m["executable"] for m in messages if m.get("target", {}).get("name") == "hot_loop" and m.get("executable")]
    metadata = ["cargo", "metadata", "--format-version=1", "--no-deps"]
    target = json.loads(subprocess.run(metadata, cwd=ROOT, check=True, stdout=subprocess.PIPE).stdout)["target_directory"]
    return Path(kernels), Path(target) / "release/vitrum"


def callgrind(folder, function, command, *options):
    """Runs a program under valgrind; its standard output. What the environment holds would move the stack."""
    valgrind = [shutil.which("valgrind") or "valgrind", "--tool=callgrind", f"--toggle-collect={function}", *options]
    out = f"--callgrind-out-file={folder}/counts"
    run = subprocess.run([*valgrind, out, *map(str, command)], cwd=ROOT, env={}, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    if run.returncode != 0:
        sys.exit(f"{' '.join(map(str, command))}: valgrind ended with {run.returncode}\n{run.stderr[-2000:]}")
    return run.stdout


def total(file):
    found = re.findall(r"^(?:totals|summary): (\d+)$", file.read_text(), re.M)
    if not found or int(found[0]) == 0:
        sys.exit(f"{file}: nothing was counted; is the function that counts begin and end with still called so?")
    return int(found[0])


def count_kernels(program):
    """Instructions of one pass of each kernel, by name. Every pass leaves a file of its own, in the order of the names."""
    with tempfile.TemporaryDirectory() as folder:
        options = [f"--zero-before={KERNEL}", f"--dump-after={KERNEL}"]
        names = [line.split("\t")[1] for line in callgrind(folder, KERNEL, [program, "--count"], *options).splitlines()]
        return {name: total(Path(f"{folder}/counts.{place}")) for place, name in enumerate(names, 1)}


def count_render(program, scene, *more, crop=CROP):
    """Instructions of a small render, from its first sample to its last: without reading the scene and writing the picture."""
    with tempfile.TemporaryDirectory() as folder:
        options = ["--spp", SAMPLES, "--crop", crop, "--threads", 1, "--seed", 1, "--quiet", *more]
        callgrind(folder, RENDER, [program, "render", scene, *options, "-o", f"{folder}/picture.exr"])
        return total(Path(f"{folder}/counts"))


def errors(program):
    """relMSE of every scene, mean of the seeds."""
    with tempfile.TemporaryDirectory() as folder:
        command = [program, "bench", "--spp", SAMPLES, "--seeds", SEEDS, "-o", f"{folder}/bench"]
        run = subprocess.run(list(map(str, command)), cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        if run.returncode != 0:
            sys.exit(f"{' '.join(map(str, command))}: ended with {run.returncode}\n{run.stderr}")
        records = [json.loads(line) for line in Path(f"{folder}/bench/results.jsonl").read_text().splitlines()]
        of = lambda scene: statistics.fmean(r["rel_mse"] for r in records if r["scene"] == scene.stem)
        return {scene.stem: of(scene) for scene in SCENES}


def measure():
    """All numbers, by kind and name."""
    kernels, vitrum = build()
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        counting = pool.submit(count_kernels, kernels)
        renders = dict(zip([s.stem for s in SCENES], pool.map(lambda s: count_render(vitrum, s), SCENES)))
        counted = counting.result()
    found = errors(vitrum)
    scenes = {name: {"instructions": count, "error": found[name]} for name, count in renders.items()}
    return {"kernels": counted, "scenes": scenes}


def flat(numbers):
    """(name, kind) and number, with the products."""
    for name, count in numbers["kernels"].items():
        yield (name, "instructions"), count
    for name, scene in numbers["scenes"].items():
        yield (name, "instructions"), scene["instructions"]
        yield (name, "error"), scene["error"]
        yield (name, "product"), scene["instructions"] * scene["error"]


def moved(recorded, found):
    """What is farther from what is recorded than it may be, by (name, kind), in words; what is new or gone counts too."""
    before, now = dict(flat(recorded)), dict(flat(found))
    lines = {}
    for key in sorted(before.keys() | now.keys()):
        name, kind = key
        if key not in now:
            lines[key] = f"{name}: {kind} recorded, and no longer measured"
        elif key not in before:
            lines[key] = f"{name}: {kind} measured, and not recorded"
        elif abs(now[key] / before[key] - 1) > TOLERANCES[kind]:
            change = 100 * (now[key] / before[key] - 1)
            lines[key] = f"{name}: {kind} {before[key]:.6g} -> {now[key]:.6g} ({change:+.2f} %)"
    return lines


def updated(recorded, found, lines, reason):
    """What is recorded, with what moved and nothing else: what is within its tolerance stays, so that it can't creep."""
    kernels = {n: found["kernels"][n] if (n, "instructions") in lines else recorded["kernels"][n] for n in found["kernels"]}
    scenes = {}
    for name, scene in found["scenes"].items():
        of = recorded["scenes"].get(name, {})
        scenes[name] = {kind: number if (name, kind) in lines else of[kind] for kind, number in scene.items()}
    change = {"reason": reason, "moved": list(lines.values())}
    return {"kernels": kernels, "scenes": scenes, "changes": [*recorded["changes"], change]}


def self_test():
    """Numbers that must be seen, and numbers that must not."""
    recorded = {"kernels": {"k": 1000}, "scenes": {"s": {"instructions": 1000, "error": 0.01}}, "changes": []}

    def seen(kernel, instructions, error):
        return set(moved(recorded, {"kernels": {"k": kernel}, "scenes": {"s": {"instructions": instructions, "error": error}}}))

    kinds = lambda *kinds: {("s", kind) for kind in kinds}
    assert seen(1000, 1000, 0.01) == set()
    assert seen(1004, 1004, 0.01) == set(), "within the tolerance"
    assert seen(1010, 1000, 0.01) == {("k", "instructions")}, "a slower kernel"
    assert seen(1000, 1010, 0.01) == kinds("instructions", "product"), "a slower render"
    assert seen(1000, 1000, 0.0101) == kinds("error", "product"), "a noisier sampler"
    assert seen(1000, 990, 0.0101010101) == kinds("instructions", "error"), "one against the other"
    assert seen(990, 1000, 0.01) == {("k", "instructions")}, "a gain that nobody recorded"
    gone = moved(recorded, {"kernels": {"new": 1}, "scenes": {}})
    assert set(gone) == {("k", "instructions"), ("new", "instructions"), *kinds("instructions", "error", "product")}
    found = {"kernels": {"k": 1004, "new": 1}, "scenes": {"s": {"instructions": 1004, "error": 0.02}}}
    after = updated(recorded, found, moved(recorded, found), "why")
    assert after["kernels"] == {"k": 1000, "new": 1}, "what is within its tolerance stays"
    assert after["scenes"]["s"] == {"instructions": 1000, "error": 0.02} and after["changes"][0]["reason"] == "why"
    print("the gate sees what it is for")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--update", metavar="REASON", help="record what moved, and why")
    parser.add_argument("--json", metavar="FILE", help="also write all numbers that were found")
    parser.add_argument("--self-test", action="store_true", help="measure nothing; try the comparison on known numbers")
    options = parser.parse_args()
    self_test()
    if options.self_test:
        return
    found = measure()
    recorded = json.loads(BASELINES.read_text()) if BASELINES.exists() else {"kernels": {}, "scenes": {}, "changes": []}
    lines = moved(recorded, found)
    for name, scene in found["scenes"].items():
        print(f"{name:<28} {scene['instructions']:>14} instructions  relMSE {scene['error']:.4e}")
    print(f"{len(found['kernels'])} kernels, {len(found['scenes'])} scenes; moved: {len(lines)}")
    print("\n".join(lines.values()))
    if options.json:
        Path(options.json).write_text(json.dumps(found, indent=1) + "\n")
    if options.update:
        BASELINES.write_text(json.dumps(updated(recorded, found, lines, options.update), indent=1) + "\n")
    elif lines:
        print("where this is meant, benches/gate.py --update REASON records it", file=sys.stderr)
        sys.exit(1)


if __name__ == "__main__":
    main()
