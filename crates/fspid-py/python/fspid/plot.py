"""Axes of matplotlib, which is imported only where something is drawn."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

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


def over_limits(ax: Axes | None, requirements: Sequence[Mapping[str, Any]]) -> Axes:
    """Each requirement's value over each of its limits: green where it is met, and no bar where there is no value."""
    ax = axes(ax)
    sides = {"most": "at most", "least": "at least"}
    judged = [(each, side) for each in requirements for side in sides if each.get(side)]
    names = [
        f"{each['id']} {each['controller']}: {each['measure']} {sides[side]} {each[side]:g} {each['unit']}"
        for each, side in judged
    ]
    shares = [(each.get("value") or 0.0) / each[side] for each, side in judged]
    colours: dict[Any, str] = {True: "tab:green", False: "tab:red"}
    ax.barh(names, shares, color=[colours.get(each.get("met"), "tab:gray") for each, _ in judged])
    ax.axvline(1.0, color="black", linewidth=0.8)
    ax.invert_yaxis()
    ax.set_xlabel("value over its limit, the worst case")
    return ax


def failed(ax: Axes | None, controllers: Sequence[Mapping[str, Any]]) -> Axes:
    """The share of flights that fail, with its interval, in %; whoever was judged by no flight has none."""
    ax = axes(ax)
    controllers = [each for each in controllers if each["failed"]["estimate"] is not None]
    shares = [each["failed"] for each in controllers]
    at = [100.0 * it["estimate"] for it in shares]
    ends = [[100.0 * (it["estimate"] - it["lower"]) for it in shares], [100.0 * (it["upper"] - it["estimate"]) for it in shares]]
    ax.errorbar(at, [each["name"] for each in controllers], xerr=ends, fmt="o", capsize=4)
    ax.invert_yaxis()
    ax.set_xlabel("flights that fail (%)")
    return ax


def between_bounds(ax: Axes | None, parameters: Sequence[Mapping[str, Any]]) -> Axes:
    """Where free numbers began and ended between their bounds, in %."""
    ax = axes(ax)
    names = [each["path"] for each in parameters]
    for what, mark in (("start", "x"), ("value", "o")):
        share = [100.0 * (each[what] - each["bounds"][0]) / (each["bounds"][1] - each["bounds"][0]) for each in parameters]
        ax.plot(share, names, mark, label={"start": "start", "value": "found"}[what])
    ax.set_xlim(-2.0, 102.0)
    ax.invert_yaxis()
    ax.set_xlabel("from the lower to the upper bound (%)")
    ax.legend()
    return ax
