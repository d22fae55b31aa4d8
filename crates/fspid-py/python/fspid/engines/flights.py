"""Flights of tunings and contests on an engine: candidates and blocks of their flights as tasks, generation by generation."""

from __future__ import annotations

from typing import TYPE_CHECKING

from .job import FlightsJob
from .window import Engine

if TYPE_CHECKING:
    from .. import _core

#: How long a task should last where there is so much to fly, s: above it a lost worker costs much, below it the engine.
_SHORTEST_S, _LONGEST_S = 2.0, 20.0

#: Tasks that each processor gets of a generation where they last long enough: who is slow gets fewer.
_TASKS_A_PROCESSOR = 4


class Flights:
    """Flies orders on an engine.

    Parameters
    ----------
    engine : Engine
        The engine, reached.
    scenario : Scenario
        The native scenario that orders are about.

    Attributes
    ----------
    tasks : int
        Tasks that were flown.
    """

    def __init__(self, engine: Engine, scenario: _core.Scenario) -> None:
        self._engine = engine
        self._job = engine.share(FlightsJob.of(scenario))
        self._flight_s: float | None = None
        self.tasks = 0

    @property
    def lost(self) -> int:
        """How often a task was given out again because who flew it went away, as far as the engine tells."""
        return self._engine.lost

    def __call__(self, order: str, flights: int, at_once: int) -> list[str]:
        """The answers to all parts of an order, in their order.

        Parameters
        ----------
        order : str
            The order.
        flights, at_once : int
            How many flights it asks for, and how many of them fly best together.
        """
        parts = blocks(flights, at_once, self._engine.processors, self._flight_s)
        answers: dict[int, str] = {}
        seconds = 0.0
        for (_, first, _), (took_s, answer) in self._engine.fly(self._job, ((order, *part) for part in parts)):
            answers[first] = answer
            seconds += took_s
            self.tasks += 1
        self._flight_s = seconds / max(1, flights)
        return [answers[first] for first, _ in parts]


def blocks(flights: int, at_once: int, processors: int, flight_s: float | None) -> list[tuple[int, int]]:
    """Blocks of flights as tasks: one for each processor, more where they would last long.

    Parameters
    ----------
    flights : int
        How many there are.
    at_once : int
        How many fly best together; blocks hold so many, or some times as many.
    processors : int
        How many tasks fly at a time.
    flight_s : float, optional
        How long a flight took in the last generation, s.

    Returns
    -------
    list of (int, int)
        The first of each block, and that behind its last.

    Examples
    --------
    >>> blocks(20, 8, 2, None)
    [(0, 8), (8, 20)]
    >>> len(blocks(10_000, 8, 10, 0.01))
    40
    """
    processor_s = flights * (flight_s or 0.0) / processors
    rounds = min(_TASKS_A_PROCESSOR, int(processor_s / _SHORTEST_S))
    rounds = max(1, rounds, -int(-processor_s // _LONGEST_S))
    groups = -(-flights // at_once)
    tasks = min(groups, processors * rounds)
    ends = [at_once * (groups * (task + 1) // tasks) for task in range(tasks)]
    ends[-1] = flights
    return list(zip([0, *ends[:-1]], ends))
