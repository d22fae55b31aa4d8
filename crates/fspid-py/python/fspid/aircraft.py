"""Aircraft that fly: trimmed, linearised, their modes.

Numbers may be given with a unit, such as ``"100kt"``, ``"5000ft"`` or ``"3deg"``; bare ones are in m/s, m and deg.
"""

from __future__ import annotations

import importlib
from os import PathLike
from typing import Any

from . import _core
from .answers import Answer
from .errors import InputError

Quantity = float | str
# Velocity by its components, or by speed and angle of attack.
_STATES = ("components", "speed-and-angle")


class Linear(Answer):
    """The linear model of a flight."""

    _native: _core.Answer

    @property
    def plant(self) -> str:
        """Pitch over elevator as a plant file, which scenarios name."""
        return self._native.files[0][1]

    def to_control(self) -> Any:
        """The state space as ``control.StateSpace``; needs python-control."""
        return importlib.import_module("control").StateSpace(*self.matrices())

    def matrices(self) -> tuple[Any, Any, Any, Any]:
        """A, B, C and D as nested lists; the outputs are the states."""
        facts = self.to_dict()
        a, b = facts["a"], facts["b"]
        order, inputs = len(a), len(b[0])
        c = [[1.0 if row == column else 0.0 for column in range(order)] for row in range(order)]
        return a, b, c, [[0.0] * inputs for _ in range(order)]


def _text(value: Quantity | None) -> str | None:
    return None if value is None else value if isinstance(value, str) else repr(float(value))


def _asked(
    what: str, name: str | PathLike[str], speed: Quantity | None, altitude: Quantity | None, climb: Quantity | None
) -> _core.Answer:
    return _core.aircraft(what, str(name), _text(speed), _text(altitude), _text(climb))


def known() -> Answer:
    """The aircraft that fspid carries."""
    return Answer(_core.aircraft_list())


def show(name: str | PathLike[str]) -> Answer:
    """What is known of an aircraft, with its sources."""
    return Answer(_asked("show", name, None, None, None))


def check(name: str | PathLike[str]) -> Answer:
    """Check the file of an aircraft: its motions, and in ``warnings`` what in its numbers is hardly meant."""
    return Answer(_asked("check", name, None, None, None))


def trim(
    name: str | PathLike[str],
    *,
    speed: Quantity | None = None,
    altitude: Quantity | None = None,
    climb_angle: Quantity | None = None,
) -> Answer:
    """Trim an aircraft in straight flight.

    Parameters
    ----------
    name : str or path-like
        An aircraft that fspid carries, or a file.
    speed, altitude, climb_angle : float or str, optional
        True airspeed, altitude, angle of the flight path; those of the source and level flight if left out.
    """
    return Answer(_asked("trim", name, speed, altitude, climb_angle))


def linearise(
    name: str | PathLike[str],
    *,
    speed: Quantity | None = None,
    altitude: Quantity | None = None,
    climb_angle: Quantity | None = None,
    states: str = "components",
) -> Linear:
    """The linear model about a trim; ``states`` is ``components`` or ``speed-and-angle``."""
    if states not in _STATES:
        raise InputError(f"states={states!r}; allowed are {' and '.join(map(repr, _STATES))}")
    return Linear(_asked(states, name, speed, altitude, climb_angle))


def modes(
    name: str | PathLike[str],
    *,
    speed: Quantity | None = None,
    altitude: Quantity | None = None,
    climb_angle: Quantity | None = None,
) -> Answer:
    """Modes of an aircraft about a trim: short period, phugoid, and the others."""
    return Answer(_asked("modes", name, speed, altitude, climb_angle))
