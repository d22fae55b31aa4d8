"""Tasks of Dask's scheduler, for sites that have one."""

from __future__ import annotations

import importlib
from typing import Any

from ..errors import Error, InputError
from .job import Job
from .window import Engine, Lost

#: How long an address may take to answer at all, s.
_ANSWERS_WITHIN_S = 5


class Dask(Engine):
    """Dask's scheduler.

    Parameters
    ----------
    client : distributed.Client, optional
        A client that is there already.
    address : str, optional
        ``tcp://host:port`` of a scheduler in place of ``client``.
    """

    def __init__(self, address: str | None = None, *, client: Any = None) -> None:
        super().__init__()
        if client is None and address is None:
            raise InputError("Dask needs a client or the address of a scheduler")
        self._distributed = _distributed()
        self._client, self._address = client, address
        self._own: Any = None

    def __enter__(self) -> Dask:
        if self._client is None:
            try:
                self._own = self._distributed.Client(self._address, timeout=_ANSWERS_WITHIN_S, set_as_default=False)
            except (OSError, ValueError) as reason:
                raise InputError(f"there is no Dask scheduler at {self._address}: {reason}") from reason
            self._client = self._own
        self._done = self._distributed.as_completed()
        return self

    def __exit__(self, *_: object) -> None:
        if self._own is not None:
            self._own.close()

    @property
    def processors(self) -> int:
        threads: dict[str, int] = self._client.nthreads()
        return max(1, sum(threads.values()))

    def share(self, job: Job) -> Any:
        # A task's answer is made again where all who held it went away; what is scattered would be gone with them.
        return self._client.submit(_shared, job, pure=False)

    def _give(self, job: Any, unit: Any) -> Any:
        task = self._client.submit(_flown, job, unit, pure=False, retries=0)
        self._done.add(task)
        return task

    def _ready(self, waiting: list[Any]) -> list[Any]:
        # It looks at signals ten times a second.
        ready: list[Any] = self._done.next_batch()
        return ready

    def _answer(self, task: Any) -> Any:
        try:
            return task.result()
        except self._distributed.scheduler.KilledWorker as lost:
            # The scheduler gives up on a task whose workers went away a few times; a task is never given up here.
            raise Lost from lost
        except self._distributed.CancelledError as dropped:
            raise Error(
                f"Dask's scheduler dropped what it was given ({dropped}); begin again: what was flown before is kept"
            ) from dropped

    def _cancel(self, waiting: list[Any]) -> None:
        self._client.cancel(waiting)


def _shared(job: Job) -> Job:
    return job


def _flown(job: Job, unit: Any) -> Any:
    return job.fly(unit)


def _distributed() -> Any:
    try:
        return importlib.import_module("distributed")
    except ImportError as missing:
        raise Error("this needs Dask: pip install 'fspid[dask]'") from missing
