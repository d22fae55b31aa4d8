"""Campaigns on the engines that sites have: Ray and Dask here, Slurm and others by ``fspid campaign run --engine``.

A shard is flown by whoever gets it, wherever that is: run *i* depends on the campaign's seed and on *i* alone. The
engine only says who is next. What is lost with a machine is flown again, what is wrong is not; the merged file has
the same bytes as that of a run on one machine.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from ..errors import InputError
from .progress import Progress

if TYPE_CHECKING:
    from ..campaign import Campaign

__all__ = ["NAMES", "Progress", "fly"]

#: Names of the engines that Python starts.
NAMES = ("ray", "dask")


def fly(campaign: Campaign, engine: str, *, watch: Callable[[Progress], None] | None = None, **options: Any) -> None:
    """Fly what is missing of a campaign on an engine; merges nothing.

    Parameters
    ----------
    campaign : Campaign
        The campaign, planned in its folder.
    engine : {"ray", "dask"}
        Which engine.
    watch : callable, optional
        Is told of the progress after each shard.
    **options
        What the engine takes: ``address`` or ``window``; ``client`` of Dask.
    """
    if engine == "ray":
        from . import ray

        ray.fly(campaign, watch=watch, **options)
    elif engine == "dask":
        from . import dask

        dask.fly(campaign, watch=watch, **options)
    else:
        raise InputError(f"there is no engine {engine!r}; known are local, {', '.join(NAMES)}")
