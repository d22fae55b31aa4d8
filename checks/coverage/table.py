#!/usr/bin/env python3
"""Lines and branches of each crate that any of the programs ran, from what `llvm-cov export --format=lcov` wrote of each.

    table.py [--crate NAME…] FILE.lcov…   a row for each crate, or for each that is named
    table.py --missed FOLDER FILE.lcov…   what none of them ran, by file and line

Modules of tests are left out: `tests.rs`, `tests/`, and what stands behind `#[cfg(test)]` in a file. A branch is one side of a
condition; the sides of a condition in a generic function are those of all its instances together, as its lines are.
"""

import re
import sys
from collections import defaultdict
from functools import cache
from pathlib import Path

ROOT = Path(__file__).parents[2].resolve()
Counts = dict[tuple[str, int], int]


@cache
def place(name: str) -> tuple[str, str, int] | None:
    """Crate, file, and the line where its tests begin, of a file that counts."""
    path = Path(name)
    path = path if path.is_absolute() else ROOT / path
    if not path.is_relative_to(ROOT) or not path.is_file():
        return None
    inside = str(path.relative_to(ROOT))
    found = re.match(r"crates/([^/]+)/src/", inside)
    if not found or re.search(r"/tests?(/|\.rs$)|_tests?\.rs$", inside):
        return None
    lines = path.read_text(encoding="utf-8").splitlines()
    tests = next((at for at, line in enumerate(lines, 1) if line.strip() == "#[cfg(test)]"), len(lines) + 1)
    return found[1], inside, tests


def read(files: list[str]) -> tuple[dict, dict]:
    """How often each line, and each side of each condition, was run: by file and place, the most of all programs."""
    lines: dict = defaultdict(int)
    branches: dict = defaultdict(int)
    for file in files:
        here = None
        for row in Path(file).read_text(encoding="utf-8").splitlines():
            word, _, rest = row.partition(":")
            if word == "SF":
                here = place(rest)
            elif here and word in ("DA", "BRDA"):
                numbers = rest.split(",")
                if int(numbers[0]) >= here[2]:
                    continue
                count = 0 if numbers[-1] == "-" else int(numbers[-1])
                if word == "DA":
                    key = (here[1], int(numbers[0]))
                    lines[key] = max(lines[key], int(numbers[1]))
                else:
                    # Instances of a generic function number their conditions anew: side 0 or 1 of the line's is what is told apart.
                    key = (here[1], int(numbers[0]), int(numbers[2]) % 2)
                    branches[key] = max(branches[key], count)
    return lines, branches


def main() -> None:
    words = sys.argv[1:]
    missed = words[1] if words[:1] == ["--missed"] else None
    asked = set()
    while words[:1] == ["--crate"]:
        asked.add(words[1])
        words = words[2:]
    lines, branches = read(words[2:] if missed else words)
    if not lines:
        raise SystemExit("no file of a crate was found")
    if missed:
        for file, line in sorted(key for key, count in lines.items() if count == 0 and key[0].startswith(missed)):
            print(f"{file}:{line}: {(ROOT / file).read_text(encoding='utf-8').splitlines()[line - 1].strip()}")
        for file, line, side in sorted(key for key, count in branches.items() if count == 0 and key[0].startswith(missed)):
            print(f"{file}:{line}: never {('true', 'false')[side]}: {(ROOT / file).read_text(encoding='utf-8').splitlines()[line - 1].strip()}")
        return
    table: dict[str, list[int]] = defaultdict(lambda: [0, 0, 0, 0])
    for at, counts in ((0, lines), (2, branches)):
        for key, count in counts.items():
            row = table[key[0].split("/")[1]]
            row[at] += count > 0
            row[at + 1] += 1
    print(f"{'crate':24} {'lines':>22} {'branches':>22}")
    for name, (ran, all_lines, sides, all_sides) in sorted(table.items()):
        if asked and name not in asked:
            continue
        of = f"{ran:6} of {all_lines:6} {ran / all_lines:6.1%}", f"{sides:6} of {all_sides:6} {sides / max(all_sides, 1):6.1%}"
        print(f"{name:24} {of[0]:>22} {of[1]:>22}")


main()
