"""Shards as tasks of Ray: a bounded window of them, unlimited retries for lost workers, none for wrong answers."""

from __future__ import annotations

import importlib
import socket
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from ..errors import Error, InputError
from .job import Job
from .progress import Progress
from .store import Flight, FolderParts, Receipt, Store, StoreParts

if TYPE_CHECKING:
    from ..campaign import Campaign

#: How long an address may take to answer at all, s.
_ANSWERS_WITHIN_S = 5.0

#: How often the driver looks for tasks that are done, where many are waiting, s.
_LOOK_EVERY_S = 0.1

#: Tasks that are given out for each processor: one flies, one waits.
_TASKS_A_PROCESSOR = 2


def fly(
    campaign: Campaign,
    parts: FolderParts | StoreParts,
    *,
    address: str | None = None,
    window: int | None = None,
    watch: Callable[[Progress], None] | None = None,
) -> None:
    """Fly what is missing of a campaign on Ray; merges nothing.

    Parameters
    ----------
    campaign : Campaign
        The campaign, planned in its folder.
    parts : FolderParts or StoreParts
        Where parts are, and go.
    address : str, optional
        ``host:port`` of a cluster, ``ray://host:port`` of one that is reached from outside, or ``auto``; a Ray of this
        machine is started if left out and none runs.
    window : int, optional
        How many shards are given out at a time; by default two for each processor.
    watch : callable, optional
        Is told of the progress after each shard.
    """
    ray = _ray()
    began = not ray.is_initialized()
    if began:
        _begin(ray, address)
    try:
        _fly(ray, Flight(campaign, parts, window, watch))
    finally:
        if began:
            ray.shutdown()


def _ray() -> Any:
    try:
        ray = importlib.import_module("ray")
        # A folder of that name beside a script is no Ray.
        ray.init  # noqa: B018
    except (ImportError, AttributeError) as missing:
        raise Error("this needs Ray: pip install 'fspid[ray]'") from missing
    return ray


def _begin(ray: Any, address: str | None) -> None:
    if address is not None and address not in ("auto", "local"):
        _reach(address)
    try:
        ray.init(address=address, log_to_driver=False, logging_level="error", include_dashboard=False)
    except ValueError:
        # A cluster decides by itself whether it has a dashboard.
        ray.init(address=address, log_to_driver=False, logging_level="error")
    except (ConnectionError, OSError, RuntimeError) as reason:
        raise InputError(f"there is no Ray cluster at {address}: {reason}") from reason


def _reach(address: str) -> None:
    """Ray itself tries for minutes."""
    host, _, port = address.removeprefix("ray://").rpartition(":")
    if not host or not port.isdecimal():
        raise InputError(f"{address!r} is no address; allowed are HOST:PORT, ray://HOST:PORT and auto")
    try:
        socket.create_connection((host, int(port)), timeout=_ANSWERS_WITHIN_S).close()
    except (OSError, OverflowError) as reason:
        raise InputError(f"there is no Ray cluster at {address}: {reason}") from reason


def _fly(ray: Any, asked: Flight) -> None:
    campaign, parts, window, watch = asked
    missing = parts.missing()
    progress = Progress(campaign.shards, campaign.shards - len(missing))
    # Who flies a shard may go away as often as it likes; a shard that cannot be flown stops the campaign.
    task = ray.remote(num_cpus=1, max_retries=-1, retry_exceptions=False)(_shard)
    job = ray.put(Job.of(campaign))
    at_once = window or max(2, int(_TASKS_A_PROCESSOR * ray.cluster_resources().get("CPU", 1.0)))
    waiting: dict[Any, int] = {}
    queue = iter(missing)
    try:
        while True:
            while len(waiting) < at_once and (number := next(queue, None)) is not None:
                waiting[task.remote(job, number, parts.store)] = number
            if not waiting:
                return
            for done in _some(ray, list(waiting)):
                parts.take(waiting.pop(done), _answer(ray, done))
                progress.flown += 1
                if watch is not None:
                    watch(progress)
    finally:
        for task_ in waiting:
            ray.cancel(task_, force=True)


def _some(ray: Any, waiting: list[Any]) -> list[Any]:
    """What is done, one at least. Asking costs as much as there is waiting: so for an eighth of it, or what a tenth of a
    second brings."""
    done: list[Any] = []
    while not done:
        done = ray.wait(waiting, num_returns=max(1, len(waiting) // 8), timeout=_LOOK_EVERY_S)[0]
    return done


def _shard(job: Job, number: int, store: Store | None) -> bytes | Receipt:
    return job.do(number, store)


def _answer(ray: Any, done: Any) -> bytes | Receipt:
    """What a task answers; what went wrong in it goes on as it was raised there."""
    try:
        answer: bytes | Receipt = ray.get(done)
    except ray.exceptions.RayTaskError as error:
        cause = getattr(error, "cause", None)
        raise cause if isinstance(cause, Error) else Error(f"a worker could not fly its shard: {error}") from error
    return answer
