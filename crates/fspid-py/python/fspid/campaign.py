"""Many flights of a dispersed scenario."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from . import _core, engines
from .answers import _Paged

if TYPE_CHECKING:
    from os import PathLike

    from matplotlib.axes import Axes

    from .engines import Progress


class CampaignSummary(_Paged):
    """How often flights failed, by how much requirements were missed, and what that depends on."""

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the share of flights that fail, with its interval, with matplotlib; ``figures`` has far more."""
        from .plot import failed

        return failed(ax, self.to_dict()["controllers"])


class Campaign:
    """A campaign in its folder: shards that are whole or not there, and one file of all rows.

    Every shard may be flown by any process on any machine that sees the folder: run *i* depends on the campaign's
    seed and on *i* alone, so that the merged file has the same bytes whoever flew it.
    """

    def __init__(self, core: _core.Campaign) -> None:
        self._core = core

    @classmethod
    def from_folder(cls, folder: str | PathLike[str]) -> Campaign:
        """The campaign that is planned in a folder."""
        return cls(_core.Campaign.planned(Path(folder)))

    @property
    def runs(self) -> int:
        """How many runs it has."""
        return self._core.runs

    @property
    def shards(self) -> int:
        """How many shards it has, numbered from 0."""
        return self._core.shards

    @property
    def id(self) -> str:
        """What tells it from every other campaign: scenario, seed, runs and program."""
        return self._core.id

    @property
    def file(self) -> Path:
        """The Parquet file of all rows, one for each run and controller, once it is merged."""
        return Path(self._core.file)

    @property
    def progress(self) -> tuple[int, int, int]:
        """Runs flown by this object, runs that were there already, and flights that failed among those flown."""
        return self._core.progress

    def run(
        self,
        *,
        threads: int = 0,
        engine: str = "local",
        watch: Callable[[Progress], None] | None = None,
        **options: Any,
    ) -> str:
        """Fly what is missing and merge it.

        Parameters
        ----------
        threads : int
            0 for as many as the machine has; for the engine ``local``.
        engine : {"local", "ray", "dask"}
            Who flies. The merged file has the same bytes.
        watch : callable, optional
            Is told of the progress on an engine after each shard.
        **options
            What the engine takes: ``address``, ``window``, ``client``; ``store`` such as ``s3://bucket/prefix``, where
            workers then put parts by themselves, with ``store_options`` for fsspec.

        Returns
        -------
        str
            SHA-256 of all rows.
        """
        if engine != "local":
            engines.fly(self, engine, watch=watch, **options)
            return self.merge()
        return self._core.run(threads)

    def fly_shard(self, number: int, *, threads: int = 0) -> bool:
        """Fly one shard unless it is there; True where it was flown now."""
        return self._core.shard(number, threads)

    def missing(self) -> list[int]:
        """Shards whose parts are not there, or not whole."""
        return self._core.missing()

    def put(self, number: int, part: bytes) -> None:
        """Take in the part of a shard that was flown elsewhere, if it is what it should be in every cell."""
        self._core.put(number, part)

    def merge(self) -> str:
        """Merge all shards; answers SHA-256 of all rows. Gaps and parts of other campaigns are refused."""
        return self._core.merge()

    def table(self) -> _core.Table:
        """All rows of the merged file, one for each run and controller.

        ``polars.DataFrame(campaign.table())``, ``pyarrow.table(…)`` and DuckDB take it as it lies, by Arrow.
        """
        return self._core.table()

    def summary(self, confidence: float = 0.95, *, incomplete: bool = False) -> CampaignSummary:
        """What the rows say, with confidence intervals: those of the merged file, or of the parts where there is none.

        Parameters
        ----------
        confidence : float
            How sure the intervals shall be, above 0 and below 1.
        incomplete : bool
            True to hear what there is so far, where shards are missing; every answer names how many.
        """
        return CampaignSummary(self._core.summary(confidence, incomplete))

    def __repr__(self) -> str:
        there = "merged" if self.file.exists() else "not merged yet"
        return f"<Campaign of {self.runs} runs in {self.file.parent}: {there}>"
