"""What the driver of a cluster costs: the driver itself, with workers that answer at once or by the clock.

    python checks/python/driver.py [--shards 100000] [--cores 1000] [--shard-s 5] [--ray]

Every shard is one run of a short scenario, flown beforehand: what is measured is the cost of a shard. A second campaign of few
shards of 8192 runs gives the cost of a row. With `--ray`, tasks of a real Ray on this machine that do nothing. The results stand
in docs/scale.md.
"""

from __future__ import annotations

import argparse
import heapq
import multiprocessing
import os
import shutil
import sys
import tempfile
import time
from pathlib import Path
from types import SimpleNamespace

import fspid
import fspid.engines.window
from fspid import engines
from fspid.engines.job import ShardJob
from fspid.engines.ray import Ray
from fspid.engines.store import FolderParts, Receipt, StoreParts, parts

SCENARIO = {
    "schema": 1,
    "name": "short",
    "plant": {"preset": "b747-paper"},
    "loop": {"sample_period_s": 0.05, "duration_s": 1.0},
    "setpoint": {"kind": "step", "amplitude_deg": 1.0},
    "controller": [{"name": "PID", "kind": "pid", "kp": 2.0, "ki": 0.5, "kd": 1.0}],
    "dispersion": [
        {"path": "controller[0].kp", "distribution": "uniform", "lower": 0.5, "upper": 1.5, "relative": True},
    ],
}


class Workers:
    """What the driver takes for Ray: so many processors that need so long for a shard, or no time at all."""

    exceptions = SimpleNamespace(RayTaskError=RuntimeError)

    def __init__(self, cores, shard_s, answer):
        self._shard_s, self._answer = shard_s, answer
        self._cores = cores
        self._free = [0.0] * cores
        self._ready = {}

    def is_initialized(self):
        return True

    def remote(self, **_):
        return lambda _: SimpleNamespace(remote=self._give)

    def put(self, what):
        return what

    def cluster_resources(self):
        return {"CPU": float(self._cores)}

    def _give(self, job, number):
        begins = max(time.monotonic(), heapq.heappop(self._free))
        heapq.heappush(self._free, begins + self._shard_s)
        self._ready[number] = begins + self._shard_s
        return number

    def wait(self, tasks, num_returns, timeout):
        if self._shard_s > 0.0:
            due = sorted(self._ready[task] for task in tasks)[num_returns - 1]
            time.sleep(max(0.0, min(due - time.monotonic(), timeout)))
        now = time.monotonic()
        done = [task for task in tasks if self._ready[task] <= now][:num_returns]
        return done, []

    def get(self, task):
        del self._ready[task]
        return self._answer(task)

    def cancel(self, task, force):
        pass


def drive(ray, campaign, places, window=None):
    """The package's own driver, on what stands for Ray."""
    reached = Ray.__new__(Ray)
    engines.window.Engine.__init__(reached)
    reached._ray, reached._address = ray, None
    with reached:
        engines.drive(reached, campaign, places, window=window)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--shards", type=int, default=100_000)
    parser.add_argument("--cores", type=int, default=1000)
    parser.add_argument("--shard-s", type=float, default=5.0)
    parser.add_argument("--clock-s", type=float, default=20.0, help="how long workers by the clock fly")
    parser.add_argument("--large", type=int, default=8, help="shards of 8192 runs")
    parser.add_argument("--ray", action="store_true", help="measure tasks of a real Ray too")
    asked = parser.parse_args()
    work = Path(tempfile.mkdtemp(prefix="fspid-driver-"))
    try:
        print(f"{asked.shards} shards of one run, {asked.cores} cores of {asked.shard_s} s a shard")
        measure_shards(work, asked)
        if asked.large:
            measure_rows(work, asked.large)
        if asked.ray:
            measure_ray(work, min(asked.shards, 5000))
    finally:
        shutil.rmtree(work)


def measure_shards(work, asked):
    scenario = fspid.Scenario.from_dict(SCENARIO)
    made = made_parts(scenario, work, asked.shards, 1)
    campaign, _ = told("plan", lambda: scenario.plan_campaign(work / "c", runs=asked.shards, shard_runs=1))
    told("look for what is missing, nothing there", campaign.missing)
    names = [Path(campaign._core.part(number)).name for number in range(asked.shards)]

    def receipt(number):
        return Receipt(names[number], 9000, "0" * 64)

    def part(number):
        return (made / names[number]).read_bytes()

    def flown(what, places, answer, shard_s=0.0):
        workers = Workers(asked.cores, shard_s, answer)
        _, used = told(what, lambda: drive(workers, campaign, places))
        return used

    class Counted(StoreParts):
        def missing(self):
            return super().missing()[: int(asked.clock_s / asked.shard_s * asked.cores)]

    store = f"file://{work}/store"
    used = flown("drive all, parts in a store", parts(campaign, store, None), receipt)
    share(used, asked)
    clocked = Counted(campaign, parts(campaign, store, None)._of)
    begun = time.monotonic()
    used = flown("drive by the clock, parts in a store", clocked, receipt, asked.shard_s)
    print(f"    {100 * used / (time.monotonic() - begun):.1f} % of one core")
    used = flown("drive all, parts through the driver", FolderParts(campaign), part)
    share(used, asked)
    told("look for what is missing, all there", campaign.missing)
    told("summary of the parts", campaign.summary)
    told("merge", campaign.merge)


def measure_rows(work, shards):
    scenario = fspid.Scenario.from_dict(SCENARIO)
    runs = 8192
    made = made_parts(scenario, work, shards * runs, runs)
    campaign = scenario.plan_campaign(work / "large", runs=shards * runs, shard_runs=runs)
    each = [(made / Path(campaign._core.part(number)).name) for number in range(shards)]
    print(f"{shards} shards of {runs} rows, {each[0].stat().st_size / runs:.0f} bytes a row")
    told("take in", lambda: [campaign.put(number, path.read_bytes()) for number, path in enumerate(each)], shards)
    told("look for what is missing", campaign.missing, shards)
    told("summary of the parts, exact", campaign.summary, shards)
    told("merge", campaign.merge, shards)


def measure_ray(work, tasks):
    import ray

    campaign = fspid.Scenario.from_dict(SCENARIO).plan_campaign(work / "ray", runs=tasks, shard_runs=1)
    names = [Path(campaign._core.part(number)).name for number in range(tasks)]
    engines.ray._flown = lambda job, number: Receipt(names[number], 9000, "0" * 64)
    places = parts(campaign, f"file://{work}/ray-store", None)
    ray.init(num_cpus=2, include_dashboard=False, log_to_driver=False, logging_level="error")
    for window in (4, 2000):
        told(f"{tasks} tasks of Ray, {window} at a time", lambda: drive(ray, campaign, places, window), tasks)
    ray.shutdown()


def told(what, do, each=None):
    """Does something and tells seconds by the clock and of processors."""
    begun, cpu = time.perf_counter(), time.process_time()
    answer = do()
    clock_s, cpu_s = time.perf_counter() - begun, time.process_time() - cpu
    one = f", {1e3 * cpu_s / each:.2f} ms each" if each else ""
    print(f"  {what}: {clock_s:.2f} s, processors {cpu_s:.2f} s{one}", flush=True)
    return answer, cpu_s


def share(used_s, asked):
    one = used_s / asked.shards
    rate = asked.cores / asked.shard_s
    print(f"    {1e3 * one:.3f} ms a shard: {100 * one * rate:.1f} % of one core at {rate:.0f} shards a second")


def made_parts(scenario, work, runs, shard_runs):
    """Parts as workers fly them, in a folder."""
    made = work / f"made-{shard_runs}"
    made.mkdir()
    campaign = scenario.plan_campaign(work / f"plan-{shard_runs}", runs=runs, shard_runs=shard_runs)
    job, count = ShardJob.of(campaign), os.cpu_count() or 1
    begun = time.perf_counter()
    fliers = [
        multiprocessing.Process(target=fly, args=(job, range(first, campaign.shards, count), campaign.file.parent, made)) for first in range(count)
    ]
    for flier in fliers:
        flier.start()
    for flier in fliers:
        flier.join()
        if flier.exitcode:
            sys.exit("a worker could not fly")
    print(f"  flown beforehand: {time.perf_counter() - begun:.1f} s")
    return made


def fly(job, numbers, folder, made):
    core = fspid.Campaign.from_folder(folder)._core
    for number in numbers:
        (made / Path(core.part(number)).name).write_bytes(job.fly(number))


if __name__ == "__main__":
    main()
