#!/usr/bin/env python3
"""Times of the hot loop and of whole renders as ratios: this tree, or another revision, over a revision before it, in one go.

    benches/ratio.py main                    # everything: kernels by criterion, scenes by `vitrum bench --against`
    benches/ratio.py v0.1.0 main             # of two revisions, on the scenes of this tree
    benches/ratio.py main --kernels query    # only kernels with this in their names
    benches/ratio.py main --scenes           # only scenes

Both are built first, revisions in worktrees under target/. Their runs alternate, because the speed of a machine drifts: kernels are
run in the order before, after, before, after, and the two runs of one program say how far equal programs are apart.
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
# Seconds of each kernel in each of the four runs.
MEASURED = ["--warm-up-time", "0.3", "--measurement-time", "1"]


def checked_out(side, revision):
    """The tree of a revision, in a folder of its own that is used again."""
    tree = ROOT / "target" / f"{side}-tree"
    if tree.exists():
        subprocess.run(["git", "worktree", "remove", "--force", tree], cwd=ROOT, check=True)
    # It may be known still although its folder is gone.
    subprocess.run(["git", "worktree", "prune"], cwd=ROOT, check=True)
    subprocess.run(["git", "worktree", "add", "--detach", tree, revision], cwd=ROOT, check=True)
    return tree


def build(side, revision):
    """Kernels and renderer of a revision, or of this tree. The sides have folders of their own for what is built."""
    tree = checked_out(side, revision) if revision else ROOT
    target = ["--target-dir", str(ROOT / "target" / side)]
    command = ["cargo", "bench", "--locked", "--bench", "hot_loop", "--no-run", "--message-format=json", *target]
    lines = subprocess.run(command, cwd=tree, check=True, stdout=subprocess.PIPE, text=True).stdout.splitlines()
    messages = [json.loads(line) for line in lines if line.startswith("{")]
    [kernels] = [m["executable"] for m in messages if m.get("target", {}).get("name") == "hot_loop" and m.get("executable")]
    subprocess.run(["cargo", "build", "--release", "--locked", *target], cwd=tree, check=True)
    return Path(kernels), Path(target[1]) / "release/vitrum"


def medians(results, baseline):
    """Nanoseconds of a pass of each kernel, by name."""
    found = {}
    for estimates in Path(results).glob(f"*/*/{baseline}/estimates.json"):
        name = json.loads((estimates.parent / "benchmark.json").read_text())["full_id"]
        found[name] = json.loads(estimates.read_text())["median"]["point_estimate"]
    return found


def kernels(programs, only):
    """Prints a table of ratios."""
    names = []
    # A folder of its own: what was measured before is not read again.
    with tempfile.TemporaryDirectory() as results:
        for turn in (1, 2):
            for side, program in programs.items():
                names.append(f"{side}-{turn}")
                command = [program, "--bench", "--noplot", "--save-baseline", names[-1], *MEASURED, *([only] if only else [])]
                run = subprocess.run(command, cwd=ROOT, env={**os.environ, "CRITERION_HOME": results}, capture_output=True, text=True)
                if run.returncode != 0:
                    sys.exit(f"{program}: ended with {run.returncode}\n{run.stderr}")
        found = {name: medians(results, name) for name in names}
    common = sorted(found["before-1"].keys() & found["after-1"].keys())
    if not common:
        sys.exit("the two revisions have no kernel in common" + (f" with {only} in its name" if only else ""))
    print("| kernel | after over before | two runs of one apart |\n|---|---:|---:|")
    logs = []
    for kernel in common:
        mean = lambda side: sum(math.log(found[f"{side}-{turn}"][kernel]) for turn in (1, 2)) / 2
        apart = max(abs(math.log(found[f"{side}-1"][kernel] / found[f"{side}-2"][kernel])) for side in programs)
        logs.append(mean("after") - mean("before"))
        print(f"| {kernel} | {math.exp(logs[-1]):.3f} | {100 * (math.exp(apart) - 1):.0f} % |")
    print(f"| geometric mean | {math.exp(sum(logs) / len(logs)):.3f} | |")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("before", help="what to compare with, such as a branch")
    parser.add_argument("after", nargs="?", help="what is compared, in the place of this tree")
    parser.add_argument("--kernels", nargs="?", const="", metavar="NAME", help="only kernels, of all or with this in their names")
    parser.add_argument("--scenes", action="store_true", help="only scenes")
    parser.add_argument("-o", "--output", default=str(ROOT / "target/against"), help="folder for the results of scenes, new")
    options = parser.parse_args()
    if options.kernels is None and Path(options.output, "results.jsonl").exists():
        sys.exit(f"{options.output}: holds results already; choose a new folder with -o")
    built = {side: build(side, revision) for side, revision in (("before", options.before), ("after", options.after))}
    if not options.scenes:
        kernels({side: program for side, (program, _) in built.items()}, options.kernels)
    if options.kernels is None:
        against = [str(built[side][1]) for side in ("before", "after")]
        command = [against[1], "bench", "--against", *against, "--time", "1s", "-o", options.output]
        sys.exit(subprocess.run(command, cwd=ROOT, check=False).returncode)


if __name__ == "__main__":
    main()
