"""Axes of matplotlib, which is imported only where something is drawn."""

from __future__ import annotations

from typing import TYPE_CHECKING

from .errors import Error

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def axes(ax: Axes | None) -> Axes:
    """These axes, or new ones."""
    if ax is not None:
        return ax
    try:
        from matplotlib import pyplot
    except ImportError as missing:
        raise Error("drawing needs matplotlib: pip install fspid[plot]; without it, .svg() draws") from missing
    return pyplot.subplots()[1]
