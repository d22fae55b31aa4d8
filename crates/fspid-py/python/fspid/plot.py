"""Axes of matplotlib, which is imported only where something is drawn."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from .errors import Error, InputError

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def axes(ax: Axes | None) -> Axes:
    """These axes, or new ones."""
    return _pyplot().subplots()[1] if ax is None else ax


def _pyplot() -> Any:
    try:
        from matplotlib import pyplot
    except ImportError as missing:
        raise Error(
            "drawing needs matplotlib: pip install fspid[plot]; without it, .svg() and .figures draw"
        ) from missing
    return pyplot


def bode(ax: Sequence[Axes] | None, loops: Mapping[str, Mapping[str, Any]]) -> Sequence[Axes]:
    """Gain and phase over frequency, with 0 dB and -180 deg."""
    if ax is None:
        ax = _pyplot().subplots(2, 1, sharex=True)[1]
    if len(ax) != 2:
        raise InputError(f"{len(ax)} axes; this draws on two, the gain on the first and the phase on the second")
    for part, column, label, critical in (
        (ax[0], "gain_db", "gain of the open loop (dB)", 0.0),
        (ax[1], "phase_deg", "phase of the open loop [deg]", -180.0),
    ):
        for name, curve in loops.items():
            part.semilogx(list(curve["frequency_rad_s"]), list(curve[column]), label=name)
        part.axhline(critical, color="black", linewidth=0.8)
        part.set_ylabel(label)
        part.grid(True, which="both", alpha=0.3)
    ax[0].legend()
    ax[1].set_xlabel("frequency (rad/s)")
    return ax


def boxes(ax: Axes | None, controllers: Sequence[Mapping[str, Any]]) -> Axes:
    """Ranges of gains over their middles, in the colour of the verdict; a gain that does not move is a mark."""
    ax = axes(ax)
    colours = {"proved": "tab:green", "refuted": "tab:red", "not proved as it flies": "tab:red"}
    for each in controllers:
        colour = colours.get(each["verdict"], "tab:gray")
        for gain, (lower, upper) in (each.get("gains") or {}).items():
            middle = 0.5 * (lower + upper) or 1.0
            end = f" to {upper:.4g}" if upper > lower else ""
            name = f"{each['name']}, {each['verdict']}: {gain} {lower:.4g}{end}"
            ax.plot([lower / middle, upper / middle], [name, name], "-|", color=colour, linewidth=6, markersize=12)
    ax.invert_yaxis()
    ax.set_xlabel("gain over the middle of its range")
    return ax


def ranked(ax: Axes | None, contest: Mapping[str, Any], measure: str) -> Axes:
    """Median and quartiles of a measure in the order of the ranking, with the flights that failed."""
    found = {each["name"]: each for each in contest["controllers"]}
    order = [found.pop(name) for name in contest["ranking"]] + list(found.values())
    known = sorted({name for each in order for name in each.get("measures", {})})
    if measure not in known:
        raise InputError(f"no measure {measure!r}; there are {', '.join(known)}")
    ax = axes(ax)
    for place, each in enumerate(order):
        spread = each.get("measures", {}).get(measure) or {}
        if (at := spread.get("median")) is not None:
            ends = [[at - spread["lower_quartile"]], [spread["upper_quartile"] - at]]
            colour = "tab:red" if each["flights"]["failed"] else "tab:green"
            ax.errorbar([at], [place], xerr=ends, fmt="o", capsize=4, color=colour)
    failed = [f"{each['name']} ({each['flights']['failed']} of {each['flights']['of']} flights fail)" for each in order]
    ax.set_yticks(range(len(order)), failed)
    ax.set_ylim(len(order) - 0.5, -0.5)
    ax.set_xlabel(f"{measure}, median and quartiles of the searches")
    ax.set_title(contest["verdict"]["words"])
    return ax


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
