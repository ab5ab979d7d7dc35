#!/usr/bin/env python3
"""Appends what the gate counted, and what a bench measured, to a history that dashboards of benchmarks read.

    benches/history.py HISTORY REVISION COUNTS RESULTS

HISTORY is a JSON file, made where there is none, in the form that the page of github-action-benchmark draws: entries with a commit, a
date and benches (name, value, unit), of the kind customSmallerIsBetter. An entry of the same commit is replaced. Addresses are those of
the repository that GITHUB_SERVER_URL and GITHUB_REPOSITORY name, where they do. COUNTS is what `benches/gate.py --json` wrote, RESULTS results.jsonl
of `vitrum bench`, whose seconds depend on the machine.
"""

import json
import os
import statistics
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]


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


def repository():
    """Its address, where a server runs this."""
    names = [os.environ.get(name) for name in ("GITHUB_SERVER_URL", "GITHUB_REPOSITORY")]
    return "/".join(names) if all(names) else ""


def about(revision):
    """A commit, as dashboards want it; milliseconds."""
    form = "%H%n%ct%n%cI%n%s%n%cn"
    run = subprocess.run(["git", "show", "-s", f"--format={form}", revision], cwd=ROOT, capture_output=True, text=True)
    if run.returncode != 0:
        sys.exit(f"{revision}: {run.stderr.strip()}")
    found, seconds, timestamp, subject, name = run.stdout.split("\n")[:5]
    url = f"{repository()}/commit/{found}" if repository() else ""
    person = {"name": name, "username": name}
    commit = {"id": found, "timestamp": timestamp, "message": subject, "author": person, "committer": person, "url": url}
    return {"commit": commit, "date": 1000 * int(seconds)}


def main():
    if len(sys.argv) != 5:
        sys.exit(__doc__.strip())
    history, revision = Path(sys.argv[1]), sys.argv[2]
    benches = [*counted(sys.argv[3]), *measured(sys.argv[4])]
    commit = about(revision)
    data = json.loads(history.read_text()) if history.exists() else {"entries": {"vitrum": []}}
    if not isinstance(data, dict) or "vitrum" not in data.get("entries", {}):
        sys.exit(f"{history}: found no entries of vitrum; expected a file that this program wrote, or none")
    data["repoUrl"], data["lastUpdate"] = repository(), commit["date"]
    before = [entry for entry in data["entries"]["vitrum"] if entry["commit"]["id"] != commit["commit"]["id"]]
    data["entries"]["vitrum"] = before
    before.append(
        {
            "commit": commit["commit"],
            "date": commit["date"],
            "tool": "customSmallerIsBetter",
            "benches": [{"name": name, "value": value, "unit": unit} for name, unit, value in benches],
        }
    )
    history.write_text(json.dumps(data, indent=1) + "\n")


if __name__ == "__main__":
    main()
