#!/usr/bin/env python3
"""Puts the table of a bench into README.md: benches/readme.py RESULTS (results.jsonl of `vitrum bench`).

The table is what `vitrum page RESULTS --markdown` prints, and stands between two markers; the line above it says what was measured
on. So no number there is typed by hand.
"""

import json
import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
BLOCK = re.compile(r"(<!-- bench -->\n).*?(<!-- end of bench -->)", re.S)


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__.strip())
    results = Path(sys.argv[1])
    first = json.loads(results.read_text().splitlines()[0])
    program = ROOT / "target/release/vitrum"
    table = subprocess.run([program, "page", results, "--markdown"], check=True, stdout=subprocess.PIPE, text=True).stdout
    readme = ROOT / "README.md"
    text, count = BLOCK.subn(lambda m: f"{m[1]}{first['machine']}:\n\n{table}\n{m[2]}", readme.read_text())
    if count != 1:
        sys.exit(f"{readme}: expected one block between the markers <!-- bench --> and <!-- end of bench -->, found {count}")
    readme.write_text(text)


if __name__ == "__main__":
    main()
