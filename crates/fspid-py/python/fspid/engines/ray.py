"""Tasks of Ray: unlimited retries for lost workers, none for wrong answers."""

from __future__ import annotations

import importlib
import socket
from typing import Any

from ..errors import Error, InputError
from .job import Job
from .window import Engine

#: How long an address may take to answer at all, s.
_ANSWERS_WITHIN_S = 5.0

#: How often a driver that waits looks whether Ctrl-C was pressed, s; Ray itself looks once a second.
_POLL_S = 0.1


class Ray(Engine):
    """Ray, which is left as it was found.

    Parameters
    ----------
    address : str, optional
        ``host:port`` of a cluster, ``ray://host:port`` of one that is reached from outside, or ``auto``; a Ray of this
        machine is started if left out and none runs.
    """

    def __init__(self, address: str | None = None) -> None:
        super().__init__()
        self._ray = _ray()
        self._address = address
        self._began = False

    def __enter__(self) -> Ray:
        if self._address is not None and self._address not in ("auto", "local"):
            _reach(self._address)
        self._began = not self._ray.is_initialized()
        if self._began:
            _begin(self._ray, self._address)
        # Who flies may go away as often as it likes; what cannot be flown ends all.
        self._task = self._ray.remote(num_cpus=1, max_retries=-1, retry_exceptions=False)(_flown)
        return self

    def __exit__(self, *_: object) -> None:
        if self._began:
            self._ray.shutdown()

    @property
    def processors(self) -> int:
        return max(1, int(self._ray.cluster_resources().get("CPU", 1.0)))

    def share(self, job: Job) -> Any:
        return self._ray.put(job)

    def _give(self, job: Any, unit: Any) -> Any:
        return self._task.remote(job, unit)

    def _ready(self, waiting: list[Any]) -> list[Any]:
        # Asking costs as much as there is waiting: so for an eighth of it, or what a tenth of a second brings.
        some = max(1, len(waiting) // 8)
        ready: list[Any] = self._ray.wait(waiting, num_returns=some, timeout=_POLL_S)[0]
        return ready

    def _answer(self, task: Any) -> Any:
        try:
            return self._ray.get(task)
        except self._ray.exceptions.RayTaskError as error:
            cause = getattr(error, "cause", None)
            raise cause if isinstance(cause, Error) else Error(f"a worker could not fly: {error}") from error

    def _cancel(self, waiting: list[Any]) -> None:
        for task in waiting:
            self._ray.cancel(task, force=True)


def _flown(job: Job, unit: Any) -> Any:
    return job.fly(unit)


def _ray() -> Any:
    try:
        ray = importlib.import_module("ray")
        # A folder of that name beside a script is no Ray.
        ray.init  # noqa: B018
    except (ImportError, AttributeError) as missing:
        raise Error("this needs Ray: pip install 'fspid[ray]'") from missing
    return ray


def _begin(ray: Any, address: str | None) -> None:
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
