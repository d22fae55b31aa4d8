"""Shards as tasks of Dask's scheduler, for sites that have one."""

from __future__ import annotations

import importlib
import itertools
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from ..errors import Error, InputError
from .job import Job
from .progress import Progress
from .store import Flight, FolderParts, Receipt, Store, StoreParts

if TYPE_CHECKING:
    from ..campaign import Campaign

#: How long an address may take to answer at all, s.
_ANSWERS_WITHIN_S = 5

#: Tasks that are given out for each thread of a worker: one flies, one waits.
_TASKS_A_THREAD = 2


def fly(
    campaign: Campaign,
    parts: FolderParts | StoreParts,
    *,
    client: Any = None,
    address: str | None = None,
    window: int | None = None,
    watch: Callable[[Progress], None] | None = None,
) -> None:
    """Fly what is missing of a campaign on Dask; merges nothing.

    Parameters
    ----------
    campaign : Campaign
        The campaign, planned in its folder.
    parts : FolderParts or StoreParts
        Where parts are, and go.
    client : distributed.Client, optional
        A client that is there already.
    address : str, optional
        ``tcp://host:port`` of a scheduler in place of ``client``.
    window : int, optional
        How many shards are given out at a time; by default two for each thread of a worker.
    watch : callable, optional
        Is told of the progress after each shard.
    """
    if client is not None:
        _fly(client, Flight(campaign, parts, window, watch))
        return
    if address is None:
        raise InputError("Dask needs a client or the address of a scheduler")
    try:
        own = _distributed().Client(address, timeout=_ANSWERS_WITHIN_S, set_as_default=False)
    except (OSError, ValueError) as reason:
        raise InputError(f"there is no Dask scheduler at {address}: {reason}") from reason
    with own:
        _fly(own, Flight(campaign, parts, window, watch))


def _distributed() -> Any:
    try:
        return importlib.import_module("distributed")
    except ImportError as missing:
        raise Error("this needs Dask: pip install 'fspid[dask]'") from missing


def _fly(client: Any, asked: Flight) -> None:
    campaign, parts, window, watch = asked
    distributed = _distributed()
    missing = parts.missing()
    progress = Progress(campaign.shards, campaign.shards - len(missing))
    [job] = client.scatter([Job.of(campaign)], broadcast=True)
    threads = sum(client.nthreads().values())
    at_once = window or max(2, _TASKS_A_THREAD * threads)
    queue = iter(missing)
    numbers: dict[Any, int] = {}

    def give(number: int) -> Any:
        future = client.submit(_shard, job, number, parts.store, pure=False, retries=0)
        numbers[future.key] = number
        return future

    first = [give(number) for number in itertools.islice(queue, at_once)]
    done = distributed.as_completed(first)
    try:
        for future in done:
            number = numbers.pop(future.key)
            try:
                answer = future.result()
            except distributed.scheduler.KilledWorker:
                # The scheduler gives up on a task whose workers went away a few times; a shard is never given up.
                progress.lost += 1
                done.add(give(number))
                continue
            parts.take(number, answer)
            progress.flown += 1
            if watch is not None:
                watch(progress)
            following = next(queue, None)
            if following is not None:
                done.add(give(following))
    finally:
        client.cancel(list(done.futures))


def _shard(job: Job, number: int, store: Store | None) -> bytes | Receipt:
    return job.do(number, store)
