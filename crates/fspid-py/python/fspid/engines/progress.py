"""How far a campaign, a tuning or a contest on an engine is."""

from __future__ import annotations

import time
from collections.abc import Callable


class Progress:
    """Shards that are there, those flown now, and how long the rest takes.

    Attributes
    ----------
    shards : int
        All shards of the campaign.
    found : int
        Those that were there before.
    flown : int
        Those flown now.
    lost : int
        How often a shard was given out again because who flew it went away.
    """

    def __init__(self, shards: int, found: int, clock: Callable[[], float] = time.monotonic) -> None:
        self.shards = shards
        self.found = found
        self.flown = 0
        self.lost = 0
        self._clock = clock
        self._begun = clock()

    @property
    def done(self) -> bool:
        """True once no shard is missing."""
        return self.found + self.flown >= self.shards

    @property
    def shards_s(self) -> float | None:
        """Shards flown a second; None before the first."""
        seconds = self._clock() - self._begun
        return self.flown / seconds if self.flown and seconds > 0.0 else None

    @property
    def left_s(self) -> float | None:
        """Seconds that the rest will take at this rate; None before the first shard."""
        rate = self.shards_s
        return None if rate is None else (self.shards - self.found - self.flown) / rate

    def __str__(self) -> str:
        words = [f"{self.found + self.flown} of {self.shards} shards"]
        if self.shards_s is not None and self.left_s is not None:
            words.append(f"{self.shards_s:.2g} a second")
            if not self.done:
                words.append(f"about {self.left_s:.0f} s left")
        if self.lost:
            words.append(f"{self.lost} given out again")
        return ", ".join(words)


class SearchProgress:
    """Candidates of a search that are flown; of a contest, also which of its searches.

    Attributes
    ----------
    candidates : tuple of int
        Candidates flown, the start not counted, and how many there will be.
    search : tuple of int
        Number of the search, from 1, and how many there are.
    lost : int
        How often a task was given out again because who flew it went away, as far as the engine tells.
    """

    def __init__(self, candidates: tuple[int, int], search: tuple[int, int] = (1, 1), lost: int = 0) -> None:
        self.candidates = candidates
        self.search = search
        self.lost = lost

    def __str__(self) -> str:
        words = [f"tuning {self.search[0]} of {self.search[1]}"] if self.search[1] > 1 else []
        words.append(f"{self.candidates[0]} of {self.candidates[1]} candidates")
        if self.lost:
            words.append(f"{self.lost} given out again")
        return ", ".join(words)
