"""Campaigns, tunings and contests on the engines that sites have: Ray and Dask here, Slurm and others for campaigns by
``fspid campaign run --engine``.

What is flown is flown by whoever gets it, wherever that is: run *i* of a campaign depends on its seed and on *i* alone,
a flight of a candidate on the candidate, its case and its run. The engine only says who is next. What is lost with a
machine is flown again, what is wrong is not; files and designs have the same bytes as those of one machine.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

from ..errors import InputError
from .progress import Progress, SearchProgress
from .store import FolderParts, StoreParts, parts

if TYPE_CHECKING:
    from .. import _core
    from ..campaign import Campaign
    from .flights import Flights
    from .window import Engine

__all__ = ["NAMES", "Progress", "SearchProgress", "crew", "fly", "reach"]

#: Names of the engines that Python starts.
NAMES = ("ray", "dask")


def reach(engine: str, *, address: str | None = None, client: Any = None) -> Engine:
    """An engine, to be used in a ``with`` block.

    Parameters
    ----------
    engine : {"ray", "dask"}
        Which engine.
    address : str, optional
        Where it is.
    client : distributed.Client, optional
        A client of Dask that is there already.
    """
    if engine == "ray":
        from .ray import Ray

        if client is not None:
            raise InputError("Ray takes an address and no client")
        return Ray(address)
    if engine == "dask":
        from .dask import Dask

        return Dask(address, client=client)
    raise InputError(f"there is no engine {engine!r}; known are local, {', '.join(NAMES)}")


def fly(
    campaign: Campaign,
    engine: str,
    *,
    watch: Callable[[Progress], None] | None = None,
    window: int | None = None,
    store: str | None = None,
    store_options: Mapping[str, Any] | None = None,
    **options: Any,
) -> None:
    """Fly what is missing of a campaign on an engine; merges nothing.

    Parameters
    ----------
    campaign : Campaign
        The campaign, planned in its folder.
    engine : {"ray", "dask"}
        Which engine.
    watch : callable, optional
        Is told of the progress after each shard.
    window : int, optional
        How many shards are given out at a time; by default two for each processor.
    store : str, optional
        Where workers put parts by themselves, such as ``s3://bucket/prefix`` or ``file:///shared/parts``. In the end they
        are brought into the campaign's folder; left out, they come through the driver.
    store_options : mapping, optional
        What fsspec takes for the store beside its path.
    **options
        What :func:`reach` takes: ``address``; ``client`` of Dask.
    """
    places = parts(campaign, store, store_options)
    with reach(engine, **options) as reached:
        drive(reached, campaign, places, window=window, watch=watch)
    places.gather()


def drive(
    engine: Engine,
    campaign: Campaign,
    places: FolderParts | StoreParts,
    *,
    window: int | None = None,
    watch: Callable[[Progress], None] | None = None,
) -> None:
    """Give out what is missing at places, and take in what comes."""
    from .job import ShardJob

    missing = places.missing()
    progress = Progress(campaign.shards, campaign.shards - len(missing))
    job = engine.share(ShardJob.of(campaign, places.store))
    for number, answer in engine.fly(job, missing, window):
        places.take(number, answer)
        progress.flown += 1
        progress.lost = engine.lost
        if watch is not None:
            watch(progress)


@contextmanager
def crew(
    scenario: _core.Scenario, engine: str, watch: Callable[[SearchProgress], None] | None, options: Mapping[str, Any]
) -> Iterator[tuple[Flights, Callable[..., None] | None]]:
    """What flies for tunings and contests of a scenario on an engine, and what is told of their progress."""
    with reach(engine, **options) as reached:
        from .flights import Flights

        fly = Flights(reached, scenario)

        def tell(*counts: int) -> None:
            if watch is not None:
                spent, budget = counts[-2:]
                watch(SearchProgress((spent, budget), (counts[0], counts[1]) if len(counts) == 4 else (1, 1), fly.lost))

        yield fly, None if watch is None else tell


def refuse(watch: object, options: Mapping[str, Any]) -> None:
    """Refuse what engines alone take."""
    given = [*options, *(["watch"] if watch is not None else [])]
    if given:
        raise InputError(f"{', '.join(given)}: this goes with an engine; known are {', '.join(NAMES)}")
