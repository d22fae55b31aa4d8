"""Loops as transfer functions: exact margins, and the objects of python-control and SciPy."""

from __future__ import annotations

import importlib
from collections.abc import Sequence
from typing import Any

from . import _core
from .answers import _with_absent
from .errors import InputError


def margins(loop: Any, denominator: Sequence[float] | None = None, *, delay_s: float = 0.0) -> dict[str, Any]:
    """Margins of a loop that is closed with negative feedback: from polynomials, not from a grid of frequencies.

    Parameters
    ----------
    loop : TransferFunction or sequence of float
        A transfer function of python-control or SciPy (one input, one output, continuous), or the numerator by falling
        powers of s.
    denominator : sequence of float, optional
        The denominator, where ``loop`` is a numerator.
    delay_s : float
        Dead time in the loop, s.

    Returns
    -------
    dict
        ``stable``, ``gain_margin`` (a factor), ``phase_margin_deg``, ``delay_margin_s``, ``sensitivity_peak``,
        ``disk_margin``, and where they are; :class:`fspid.Absent` with its reason for what there is not.

    Examples
    --------
    >>> found = margins([11.7304, 22.578], [1.0, 4.9676, 12.941, 0.0])
    >>> found["stable"], round(found["phase_margin_deg"], 2)
    (True, 77.96)
    """
    numerator, bottom = polynomials(loop) if denominator is None else (list(loop), list(denominator))
    import json

    answer = json.loads(_core.margins(numerator, bottom, delay_s).json)
    reasons = answer.pop("reasons")
    answer.pop("schema", None)
    return {name: _with_absent({name: value}, reasons)[name] for name, value in answer.items()}


def polynomials(system: Any) -> tuple[list[float], list[float]]:
    """Numerator and denominator of a transfer function of python-control or SciPy, by falling powers of s.

    Parameters
    ----------
    system : TransferFunction or StateSpace
        Continuous, with one input and one output.
    """
    step_s = getattr(system, "dt", None)
    if step_s not in (None, 0, 0.0):
        raise InputError(f"the system is sampled every {step_s} s; allowed is a continuous one")
    if not hasattr(system, "num"):
        # A state space: both libraries know the way.
        if hasattr(system, "to_tf"):
            return polynomials(system.to_tf())
        if hasattr(system, "A") and hasattr(system, "B"):
            return polynomials(importlib.import_module("control").ss2tf(system))
        raise InputError(f"{type(system).__name__} is no transfer function; allowed are those of control and scipy.signal")
    return _only(system.num), _only(system.den)


def _only(polynomial: Any) -> list[float]:
    """The one polynomial of a list of lists, as python-control has it, or of an array, as SciPy has it."""
    listed = polynomial.tolist() if hasattr(polynomial, "tolist") else polynomial
    while isinstance(listed, (list, tuple)) and len(listed) == 1 and hasattr(listed[0], "__len__"):
        inner = listed[0]
        listed = inner.tolist() if hasattr(inner, "tolist") else inner
    try:
        return [float(each) for each in listed]
    except TypeError:
        raise InputError("the system has several inputs or outputs; allowed is one of each") from None


__all__ = ["margins", "polynomials"]
