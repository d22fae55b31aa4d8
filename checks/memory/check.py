#!/usr/bin/env python3
"""What commands take in memory, beside what they ask for before they fly: at most 1.2 times as much.

    check.py [fspid]

Each command is asked twice: with a `--max-memory` that is what the program takes without a flight, which it refuses with what it needs, and without one, when the system
tells its largest resident memory. On Linux. A minute or two.
"""

import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).parents[2]
FSPID = Path(sys.argv[1] if len(sys.argv) > 1 else ROOT / "target/release/fspid").resolve()
MOST = 1.2
# More than the program takes until it has read a scenario, less than it needs with a flight.
PROBE = "24MiB"
STEP, CAMPAIGN, NONLINEAR = "scenarios/747-pitch-step.toml", "scenarios/campaign.toml", "scenarios/gallery/navion-step.toml"
TUNE = "scenarios/gallery/tune-navion.toml"


def campaign(runs: int, shard: int, duration_s: float) -> list[str]:
    return [
        "campaign", "run", CAMPAIGN, "--runs", str(runs), "--shard-runs", str(shard), "--threads", "2", "--quiet",
        "--set", f"loop.duration_s={duration_s}",
    ]


ASKED = {
    "two traces of 100 000 samples": ["simulate", STEP, "--set", "loop.duration_s=1000"],
    "two traces of 500 000 samples": ["simulate", STEP, "--set", "loop.duration_s=5000"],
    "the same, as text and in a report": [
        "simulate", STEP, "--set", "loop.duration_s=5000", "--trace", "OUT/trace.csv", "--report", "OUT/report.html",
    ],
    "traces of a nonlinear aircraft": ["simulate", NONLINEAR, "--set", "loop.duration_s=2000"],
    "of an aircraft, as text and in a report": ["simulate", NONLINEAR, "--set", "loop.duration_s=2000", "--trace", "OUT/trace.csv", "--report", "OUT/report.html"],
    "16 runs of 500 000 samples": [*campaign(16, 16, 5000), "--out", "OUT/long"],
    "8000 runs in one shard": [*campaign(8000, 8000, 4), "--out", "OUT/many"],
    "4000 runs of eight controllers in one shard": [
        "campaign", "run", "OUT/eight.toml", "--runs", "4000", "--shard-runs", "4000", "--threads", "2", "--quiet", "--out", "OUT/eight",
    ],
    "a tuning": ["tune", TUNE, "--budget", "200", "--threads", "2", "--quiet", "--out", "OUT/design.toml"],
    "a tuning with a large population": [
        "tune", TUNE, "--budget", "4000", "--population", "2000", "--threads", "2", "--quiet", "--out", "OUT/large.toml",
    ],
}


def eight_controllers(folder: str) -> None:
    """The campaign with six controllers more, in flights that are short."""
    text = (ROOT / CAMPAIGN).read_text().replace("duration_s = 50.0", "duration_s = 4.0")
    more = [f'[[controller]]\nname = "P{n}"\nkind = "p"\nkp = 1.{n}\n' for n in range(6)]
    (Path(folder) / "eight.toml").write_text(text + "\n" + "\n".join(more))


def needed_mib(arguments: list[str]) -> float:
    refused = subprocess.run([FSPID, *arguments, "--max-memory", PROBE], cwd=ROOT, capture_output=True, text=True)
    told = re.search(r"would take some ([\d ]+) MiB of memory", refused.stderr)
    if not told:
        raise SystemExit(f"{' '.join(arguments)} tells no need:\n{refused.stderr}")
    return float(told.group(1).replace(" ", ""))


def taken_mib(arguments: list[str]) -> float:
    process = subprocess.Popen([FSPID, *arguments], cwd=ROOT, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
    told = process.stderr.read().decode()
    _, status, usage = os.wait4(process.pid, 0)
    # A requirement that is not met is an answer, too.
    if os.waitstatus_to_exitcode(status) not in (0, 1):
        raise SystemExit(f"{' '.join(arguments)}:\n{told}")
    return usage.ru_maxrss / 1024


def main() -> int:
    failed = 0
    for name, words in ASKED.items():
        with tempfile.TemporaryDirectory() as folder:
            eight_controllers(folder)
            arguments = [word.replace("OUT", folder) if word.startswith("OUT/") else word for word in words]
            needed = needed_mib(arguments)
            taken = taken_mib(arguments)
        verdict = "" if taken <= MOST * needed else "  TOO MUCH"
        failed += verdict != ""
        print(f"{name}: {taken:.0f} MiB of {needed:.0f} MiB, {taken / needed:.2f}{verdict}", flush=True)
    return 1 if failed else 0


sys.exit(main())
