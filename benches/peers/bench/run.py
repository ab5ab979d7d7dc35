#!/usr/bin/env python3
"""vitrum against other renderers, on the scenes of scenes/bench.

    cargo build --release
    python3 benches/peers/bench/run.py -o FOLDER

Installs what is missing under target/peers, tells whether the converged pictures agree (agreement.md), measures run time against
error in turns (results.jsonl), and draws both as one page (index.html). README.md says what is set in which renderer and why.
"""

import argparse
import os
import subprocess
import sys
from pathlib import Path

import install

install.in_own_environment()

import agree  # noqa: E402
import curves  # noqa: E402
import runs  # noqa: E402


def options():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("-o", "--output", type=Path, required=True, help="folder for the results, new or empty")
    parser.add_argument("--renderers", nargs="*", default=install.NAMES, choices=install.NAMES)
    parser.add_argument("--scenes", nargs="*", type=Path, help="all of scenes/bench, or these")
    parser.add_argument("--references", type=Path, help="their folder [default: references beside the scenes]")
    parser.add_argument("--vitrum", type=Path, default=install.ROOT / "target/release/vitrum")
    parser.add_argument("--threads", type=int, default=len(os.sched_getaffinity(0)), help="of every program [default: all]")
    parser.add_argument("--seeds", type=int, default=3, help="runs of each number of samples [default: 3]")
    parser.add_argument("--time", type=float, default=4.0, help="seconds of a program's longest runs [default: 4]")
    parser.add_argument("--factor", type=int, default=2, help="from one number of samples to the next [default: 2]")
    parser.add_argument("--agree", type=float, default=120.0, help="seconds of the long renders together [default: 120]")
    parser.add_argument("--parts", type=int, default=8, help="independent parts of the long renders [default: 8]")
    parser.add_argument("--limit", type=float, default=600.0, help="seconds after which a run has failed [default: 600]")
    parser.add_argument("--steps", nargs="*", default=["agree", "curves"], choices=["agree", "curves"])
    return parser.parse_args()


def renderers(chosen):
    """Those that can be had; the others are named."""
    for name in chosen:
        try:
            yield install.renderer(name)
        except install.Missing as reason:
            print(f"{name} is left out: {reason}", flush=True)


def page(vitrum: Path, folder: Path):
    """What `vitrum page` draws, with the agreement below."""
    drawn = folder / "index.html"
    if (folder / "results.jsonl").is_file():
        subprocess.run([vitrum, "page", folder / "results.jsonl", "-o", drawn], check=True)
    table = folder / "agreement.md"
    if drawn.is_file() and table.is_file():
        text = table.read_text().replace("&", "&amp;").replace("<", "&lt;").replace("**", "")
        rows = [row.strip("|\n").split("|") for row in text.splitlines() if not row.startswith("| ---")]
        cells = "".join(f"<tr>{''.join(f'<td>{cell.strip()}' for cell in row)}" for row in rows)
        added = f'<h2>Agreement</h2><p>Long renders against the references.</p><div class="scroll"><table>{cells}</table></div>\n'
        drawn.write_text(drawn.read_text().replace("</html>", added + "</html>"))


def main():
    chosen = options()
    if not chosen.vitrum.is_file():
        sys.exit(f"{chosen.vitrum}: found no program; `cargo build --release` makes it, or name it with --vitrum")
    if (chosen.output / "results.jsonl").exists():
        sys.exit(f"{chosen.output} has results; choose a new folder, they are not written over")
    (chosen.output / "pictures").mkdir(parents=True, exist_ok=True)
    programs = runs.Programs(chosen.vitrum.resolve(), chosen.threads, chosen.limit)
    all_renderers = [programs.own(), *renderers(chosen.renderers)]
    scenes = []
    for path in chosen.scenes or sorted((install.ROOT / "scenes/bench").glob("*.toml")):
        try:
            scenes.append(runs.bench_scene(path, chosen.references))
        except runs.Failed as reason:
            print(f"{path.stem} is left out: {reason}", flush=True)
    able = None
    if "agree" in chosen.steps:
        able = agree.all_agreements(programs, all_renderers, scenes, chosen.agree, chosen.parts, chosen.output)
    if "curves" in chosen.steps:
        results = curves.Results(programs, chosen.output)
        for scene in scenes:
            # What has no long render has no short one.
            taken = [r for r in all_renderers if able is None or (scene.name, r.name) in able]
            curves.measure(results, taken, scene, chosen.seeds, chosen.time, chosen.factor)
        results.file.close()
    (chosen.output / "scratch.exr").unlink(missing_ok=True)
    page(programs.vitrum, chosen.output)


if __name__ == "__main__":
    main()
