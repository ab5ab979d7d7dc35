#!/usr/bin/env python3
"""Prints what criterion measured last as a Markdown table, in the order in which it ran.

    benches/table.py                 the last run
    benches/table.py first second    saved baselines, side by side

Medians, so that a moment in which the machine did something else does not count.
"""

import json
import sys
from pathlib import Path

baselines = sys.argv[1:] or ["new"]
results = Path(__file__).parent.parent / "target" / "criterion"
benches = [bench.parent.parent for bench in results.glob(f"*/*/{baselines[0]}/benchmark.json")]
if not benches:
    sys.exit(f"{results} holds no results named {baselines[0]}: run cargo bench first")
benches.sort(key=lambda bench: (bench / baselines[0] / "benchmark.json").stat().st_mtime)


def nanoseconds(bench, baseline):
    """Per element; None where the baseline lacks the bench."""
    folder = bench / baseline
    if not folder.is_dir():
        return None
    elements = json.loads((folder / "benchmark.json").read_text())["throughput"]["Elements"]
    return json.loads((folder / "estimates.json").read_text())["median"]["point_estimate"] / elements


print("| bench | " + " | ".join(f"ns ({name})" for name in baselines) + " | million per second |")
print("|---|" + "---:|" * (len(baselines) + 1))
for bench in benches:
    times = [nanoseconds(bench, baseline) for baseline in baselines]
    title = json.loads((bench / baselines[0] / "benchmark.json").read_text())["full_id"]
    fastest = min(time for time in times if time is not None)
    cells = ["" if time is None else f"{time:.3g}" for time in times]
    print(f"| {title} | " + " | ".join(cells) + f" | {1e3 / fastest:.3g} |")
