"""How a campaign and a tuning scale on Ray: two workers beside two threads of this process, in turn.

    python checks/python/scaling.py [--pairs 5] [--runs 10000] [--budget 60] [--draws 400]

Each pair flies the same on both, the order changing from pair to pair; told is the ratio of their times, threads over
workers: 1.0 is as fast. Ray is begun before anything is timed, and both must come to the same bytes.
"""

from __future__ import annotations

import argparse
import statistics
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import ray

import fspid

SCENARIOS = Path(__file__).resolve().parents[2] / "scenarios"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--pairs", type=int, default=5)
    parser.add_argument("--runs", type=int, default=10_000, help="runs of the campaign")
    parser.add_argument("--budget", type=int, default=60, help="candidates of the tuning")
    parser.add_argument("--draws", type=int, default=400, help="flights of a candidate")
    asked = parser.parse_args()
    ray.init(num_cpus=2, include_dashboard=False, log_to_driver=False, logging_level="error")
    campaign = fspid.Scenario.from_file(SCENARIOS / "campaign.toml")
    tuned = fspid.Scenario.from_file(SCENARIOS / "tuning" / "b747-robust.toml")
    tuned = tuned.with_({"tuning.runs": asked.draws})

    def fly(folder: Path, **who: object) -> bytes:
        return campaign.campaign(folder, runs=asked.runs, **who).file.read_bytes()

    def tune(folder: Path, **who: object) -> bytes:
        return tuned.tune("FSPID", budget=asked.budget, out=folder.with_suffix(".toml"), **who).toml.encode()

    # Whoever flies has begun, and has read what it flies.
    with tempfile.TemporaryDirectory() as folder:
        campaign.campaign(Path(folder) / "c", runs=400, shard_runs=20, engine="ray")
    compare(f"campaign of {asked.runs} runs", fly, asked.pairs)
    compare(f"tuning, {asked.budget} candidates of {asked.draws} flights", tune, asked.pairs)


def compare(what: str, work: Callable[..., bytes], pairs: int) -> None:
    """Both in turn, and the ratio of their times."""
    ratios = []
    for pair in range(pairs):
        seconds, answers = {}, {}
        who: dict[str, dict[str, object]] = {"threads": {"threads": 2}, "workers": {"engine": "ray"}}
        for name in sorted(who, reverse=pair % 2 == 1):
            with tempfile.TemporaryDirectory() as folder:
                begun = time.perf_counter()
                answers[name] = work(Path(folder) / "x", **who[name])
                seconds[name] = time.perf_counter() - begun
        assert answers["threads"] == answers["workers"], "not the same bytes"
        ratios.append(seconds["threads"] / seconds["workers"])
        print(f"{what}: threads {seconds['threads']:.2f} s, workers {seconds['workers']:.2f} s, {ratios[-1]:.2f}", flush=True)
    print(f"{what}: {statistics.median(ratios):.2f} in the median of {pairs} pairs, {min(ratios):.2f} to {max(ratios):.2f}")


if __name__ == "__main__":
    main()
