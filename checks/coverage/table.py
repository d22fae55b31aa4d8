#!/usr/bin/env python3
"""Lines and branches of each crate, from what `llvm-cov export --summary-only` wrote: table.py FILE [CRATE…]"""

import json
import re
import sys
from pathlib import Path

ROOT = Path(__file__).parents[2].resolve()


def main() -> None:
    crates: dict[str, dict[str, list[int]]] = {}
    for file in json.loads(Path(sys.argv[1]).read_text())["data"][0]["files"]:
        path = Path(file["filename"]).resolve()
        # Tests cover themselves: only what they test counts. Modules of tests inside a file count with it.
        found = re.match(r"crates/([^/]+)/src/(?!.*tests?(/|\.rs$))", str(path.relative_to(ROOT))) if path.is_relative_to(ROOT) else None
        if not found or sys.argv[2:] and found[1] not in sys.argv[2:]:
            continue
        counts = crates.setdefault(found[1], {"lines": [0, 0], "branches": [0, 0]})
        for kind, (covered, count) in counts.items():
            summary = file["summary"][kind]
            counts[kind] = [covered + summary["covered"], count + summary["count"]]
    if not crates:
        raise SystemExit("no file of a crate was found")
    print(f"{'crate':24} {'lines':>22} {'branches':>22}")
    for name, counts in sorted(crates.items()):
        row = [f"{covered:6} of {count:6} {covered / max(count, 1):6.1%}" for covered, count in counts.values()]
        print(f"{name:24} {row[0]:>22} {row[1]:>22}")


main()
