#!/usr/bin/env python3
"""Instructions of a step, an inference, a flight, margins and a certificate's check, against stored ones.

    check.py            fails where one takes 3 % more than stored, and names the function that grew most
    check.py --quick    the same of the program that the tests have built, by their profile, with counts of its own
    check.py --record   stores what this machine counts, of both; with --quick of the latter

Counted by valgrind's callgrind in one thread: the same program gives the same count, whatever else the machine does. A compiler of
another version makes another program: then nothing is judged, and the script says so; of another valgrind, the same. Needs valgrind
(Debian's, installed where it is missing) and x86-64 with AVX2.
"""

import json
import os
import platform
import re
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).parents[2]
STORED = Path(__file__).with_name("counts.json")
WORK = ("step-fspid", "step-pid", "inference", "flight", "margins", "certificate")
TIMES = {"step-fspid": 2000, "step-pid": 2000, "inference": 2000}
MOST = 0.03
# What is told of each kind of work: those that take most, by themselves.
FUNCTIONS = 25


def said(*command: str) -> str:
    return subprocess.run(command, check=True, capture_output=True, text=True, cwd=ROOT).stdout


def valgrind() -> str:
    try:
        return said("valgrind", "--version").strip()
    except FileNotFoundError:
        root = [] if os.geteuid() == 0 else ["sudo"]
        subprocess.run([*root, "apt-get", "install", "--yes", "-qq", "--no-install-recommends", "valgrind"], check=True)
        return said("valgrind", "--version").strip()


def counted(program: Path, work: str) -> tuple[int, dict[str, int]]:
    """All instructions of a kind of work, and those of each function by itself."""
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "callgrind.out"
        toggle = "*::counted_" + work.replace("-", "_") + "*"
        subprocess.run(
            ["valgrind", "--quiet", "--tool=callgrind", f"--callgrind-out-file={out}", f"--toggle-collect={toggle}", str(program), work],
            check=True, stdout=subprocess.DEVNULL, cwd=ROOT,
        )
        listed = said("callgrind_annotate", "--threshold=100", "--auto=no", str(out))
    functions: dict[str, int] = {}
    total = 0
    for line in listed.splitlines():
        if found := re.match(r"\s*([\d,]+) \([^)]*\)\s+PROGRAM TOTALS", line):
            total = int(found.group(1).replace(",", ""))
        elif found := re.match(r"\s*([\d,]+) \([^)]*\)\s+(?:[^:]*:)?(\S.*?)(?: \[[^\]]*\])?$", line):
            # Names of one function in several instances or builds differ by their hash alone.
            name = re.sub(r"::h[0-9a-f]{16}|'\d+$", "", found.group(2))
            functions[name] = functions.get(name, 0) + int(found.group(1).replace(",", ""))
    if total == 0 or not functions:
        raise SystemExit(f"{work}: callgrind counted nothing")
    return total, functions


# What is asked, and where it lies: as it is handed out, and as the tests have it.
PROFILES = {"release": "release", "dev": "debug"}


def built(profile: str) -> Path:
    # With the features of the whole workspace the tests have built nearly all of it.
    packages = ["--workspace"] if profile == "dev" else ["-p", "fspid-certify"]
    subprocess.run(
        ["cargo", "build", "--profile", profile, "--locked", "--quiet", *packages, "--example", "instructions"],
        # Built in steps, a program has other functions in line: a fifth more instructions.
        check=True, cwd=ROOT, env={**os.environ, "CARGO_INCREMENTAL": "0"},
    )
    return Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target")) / PROFILES[profile] / "examples/instructions"


def all_counted(program: Path) -> dict[str, dict]:
    counts = {}
    for work in WORK:
        total, functions = counted(program, work)
        most = sorted(functions.items(), key=lambda it: (-it[1], it[0]))[:FUNCTIONS]
        counts[work] = {"instructions": total, "functions": dict(most)}
        times = TIMES.get(work, 1)
        each = f", {total / times:,.1f} each" if times > 1 else ""
        print(f"{work}: {total:,} instructions{each}; most in {most[0][0]} ({most[0][1] / total:.0%})", flush=True)
    return counts


def grown(work: str, now: dict, before: dict) -> str | None:
    """Why a kind of work takes too much now, if it does."""
    total, was = now["instructions"], before["instructions"]
    part = total / was - 1
    print(f"{work}: {part:+.2%} of the stored {was:,}")
    if part <= MOST:
        if part < -MOST:
            print("    better than stored: record it (check.py --record)")
        return None
    names = set(now["functions"]) | set(before["functions"])
    added = {name: now["functions"].get(name, 0) - before["functions"].get(name, 0) for name in names}
    name, more = max(added.items(), key=lambda it: it[1])
    return f"{work}: {part:+.2%} instructions, most of them in {name} (+{more:,})"


def main() -> int:
    if platform.machine() != "x86_64":
        print("not judged: counts are stored for x86-64")
        return 0
    compiler, tool = said("rustc", "--version").strip(), valgrind()
    stored = json.loads(STORED.read_text()) if STORED.exists() else {}
    record = "--record" in sys.argv[1:]
    # Which functions of the system's library run is decided by what the tool tells of the processor, the same on all that have AVX2.
    ours = (compiler, tool, "avx2" in Path("/proc/cpuinfo").read_text().split())
    theirs = (stored.get("compiler"), stored.get("valgrind"), True)
    if not record and ours != theirs:
        print(f"not judged: counts are stored for {theirs[0]}, {theirs[1]} and AVX2, and this is {compiler}, {tool}, AVX2 {ours[2]}")
        return 0
    quick = "--quick" in sys.argv[1:]
    if record and quick and ours != theirs:
        raise SystemExit("what is stored was counted with other tools: record both")
    asked = ["dev"] if quick else list(PROFILES) if record else ["release"]
    counts = {profile: all_counted(built(profile)) for profile in asked}
    if record:
        kept = {**stored.get("counts", {}), **counts}
        STORED.write_text(json.dumps({"compiler": compiler, "valgrind": tool, "counts": kept}, indent=1, ensure_ascii=False) + "\n")
        return 0
    [(profile, now)] = counts.items()
    failed = [why for work in WORK if (why := grown(work, now[work], stored["counts"][profile][work]))]
    for why in failed:
        print(f"TOO MANY: {why}")
    return 1 if failed else 0


sys.exit(main())
