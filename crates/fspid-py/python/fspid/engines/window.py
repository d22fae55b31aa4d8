"""What engines have in common: a bounded window of tasks, whose answers come as they are ready."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING, Any, TypeVar

if TYPE_CHECKING:
    from .job import Job

Unit = TypeVar("Unit")

#: Tasks that are given out for each processor: one flies, one waits.
_TASKS_A_PROCESSOR = 2


class Lost(Exception):
    """Who flew a task went away with it."""


class Engine(ABC):
    """An engine that is reached; use it in a ``with`` block.

    Attributes
    ----------
    lost : int
        How often a task was given out again because who flew it went away.
    """

    def __init__(self) -> None:
        self.lost = 0

    @abstractmethod
    def __enter__(self) -> Engine: ...

    @abstractmethod
    def __exit__(self, *_: object) -> None: ...

    @property
    @abstractmethod
    def processors(self) -> int:
        """How many tasks fly at a time, just now."""

    @abstractmethod
    def share(self, job: Job) -> Any:
        """The job where workers find it, for :meth:`fly`."""

    @abstractmethod
    def _give(self, job: Any, unit: Any) -> Any:
        """Give out a task."""

    @abstractmethod
    def _ready(self, waiting: list[Any]) -> list[Any]:
        """Tasks that are done; may be none after a moment."""

    @abstractmethod
    def _answer(self, task: Any) -> Any:
        """What a task answers; what went wrong in it goes on as it was raised there."""

    @abstractmethod
    def _cancel(self, waiting: list[Any]) -> None: ...

    def fly(self, job: Any, units: Iterable[Unit], window: int | None = None) -> Iterator[tuple[Unit, Any]]:
        """Answers of a job's units, in the order in which they are ready.

        Who flies a unit may go away as often as it likes; a unit that cannot be flown ends all.

        Parameters
        ----------
        job
            What :meth:`share` answered.
        units : iterable
            What is flown, each by a task.
        window : int, optional
            How many are given out at a time; by default two for each processor.
        """
        at_once = window or max(2, _TASKS_A_PROCESSOR * self.processors)
        queue = iter(units)
        waiting: dict[Any, Unit] = {}
        try:
            while True:
                while len(waiting) < at_once and (unit := next(queue, None)) is not None:
                    waiting[self._give(job, unit)] = unit
                if not waiting:
                    return
                for task in self._ready(list(waiting)):
                    if task not in waiting:
                        # Of units that nobody waits for any more.
                        continue
                    unit = waiting.pop(task)
                    try:
                        answer = self._answer(task)
                    except Lost:
                        self.lost += 1
                        waiting[self._give(job, unit)] = unit
                    else:
                        yield unit, answer
        finally:
            self._cancel(list(waiting))
