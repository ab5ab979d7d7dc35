#!/usr/bin/env python3
"""Appends what the gate counted, and what a bench measured, to a history that dashboards of benchmarks read.

    benches/history.py HISTORY REVISION COUNTS RESULTS

HISTORY is a JSON file, made where there is none: a list of {"revision", "benches": [{"name", "unit", "value"}]}, each list of benches
in the form that github-action-benchmark calls customSmallerIsBetter. COUNTS is what `benches/gate.py --json` wrote, RESULTS results.jsonl
of `vitrum bench`, whose seconds depend on the machine.
"""

import json
import statistics
import sys
from pathlib import Path


def counted(counts):
    numbers = json.loads(Path(counts).read_text())
    for name, count in numbers["kernels"].items():
        yield name, "instructions", count
    for name, scene in numbers["scenes"].items():
        yield name, "instructions", scene["instructions"]
        yield f"{name}, error", "relMSE", scene["error"]
        yield f"{name}, product", "instructions x relMSE", scene["instructions"] * scene["error"]


def measured(results):
    """Seconds times error at the most samples of each scene: what a picture of given quality costs."""
    records = [json.loads(line) for line in Path(results).read_text().splitlines()]
    for scene in sorted({r["scene"] for r in records}):
        of = [r for r in records if r["scene"] == scene]
        most = max(r["spp"] for r in of)
        costs = [(r["loading"] + r["rendering"]) * r["rel_mse"] for r in of if r["spp"] == most]
        yield f"{scene}, measured", "s x relMSE", statistics.geometric_mean(costs)


def main():
    if len(sys.argv) != 5:
        sys.exit(__doc__.strip())
    history, revision = Path(sys.argv[1]), sys.argv[2]
    benches = [*counted(sys.argv[3]), *measured(sys.argv[4])]
    entries = json.loads(history.read_text()) if history.exists() else []
    entries.append({"revision": revision, "benches": [{"name": n, "unit": u, "value": v} for n, u, v in benches]})
    history.write_text(json.dumps(entries, indent=1) + "\n")


if __name__ == "__main__":
    main()
