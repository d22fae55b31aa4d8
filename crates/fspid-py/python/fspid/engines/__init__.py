"""Campaigns on the engines that sites have: Ray and Dask here, Slurm and others by ``fspid campaign run --engine``.

A shard is flown by whoever gets it, wherever that is: run *i* depends on the campaign's seed and on *i* alone. The
engine only says who is next. What is lost with a machine is flown again, what is wrong is not; the merged file has
the same bytes as that of a run on one machine.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

from ..errors import InputError
from .progress import Progress
from .store import parts

if TYPE_CHECKING:
    from ..campaign import Campaign

__all__ = ["NAMES", "Progress", "fly"]

#: Names of the engines that Python starts.
NAMES = ("ray", "dask")


def fly(
    campaign: Campaign,
    engine: str,
    *,
    watch: Callable[[Progress], None] | None = None,
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
    store : str, optional
        Where workers put parts by themselves, such as ``s3://bucket/prefix`` or ``file:///shared/parts``. In the end they
        are brought into the campaign's folder; left out, they come through the driver.
    store_options : mapping, optional
        What fsspec takes for the store beside its path.
    **options
        What the engine takes: ``address`` or ``window``; ``client`` of Dask.
    """
    if engine == "ray":
        from .ray import fly as on
    elif engine == "dask":
        from .dask import fly as on
    else:
        raise InputError(f"there is no engine {engine!r}; known are local, {', '.join(NAMES)}")
    places = parts(campaign, store, store_options)
    on(campaign, places, watch=watch, **options)
    places.gather()
