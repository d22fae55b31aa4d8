"""Controllers by themselves, for loops that are written in Python."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from . import _core
from .errors import InputError
from .scenario import Scenario

if TYPE_CHECKING:
    from .fuzzy import Numbers

#: The loop that a controller is checked with, which it does not fly.
_BENCH = {
    "schema": 1,
    "name": "bench",
    "plant": {"preset": "b747-paper"},
    "setpoint": {"kind": "step", "amplitude_deg": 1.0},
}


class Controller:
    """A controller with its memory: it sees radians and answers radians, nose up positive.

    A sample cannot make ``step`` fail: one that is not finite or beyond the guard is answered by the last command, and latched
    as a fault.
    """

    def __init__(self, core: _core.Controller) -> None:
        self._native = core

    @property
    def sample_period_s(self) -> float:
        """Its sample period, s."""
        return self._native.period_s

    @property
    def gains(self) -> tuple[float, float, float]:
        """kp, ki and kd of the last step."""
        return self._native.gains

    @property
    def saturated(self) -> bool:
        """True where a limit cut the last command."""
        return self._native.saturated

    @property
    def faults(self) -> str:
        """Faults that are latched; ``none`` without any."""
        return self._native.faults

    @property
    def uses_rate(self) -> bool:
        """True where it uses the measured pitch rate, which each sample then has to have."""
        return self._native.uses_rate

    def step(self, setpoint: float, measurement: float, rate: float | None = None) -> float:
        """Answer a sample.

        Parameters
        ----------
        setpoint, measurement : float
            Commanded and measured pitch, rad.
        rate : float, optional
            Measured pitch rate, rad/s, nose up positive; needed where :attr:`uses_rate` is true.

        Returns
        -------
        float
            The command, rad; positive is nose up.

        Raises
        ------
        InputError
            No rate, of a controller that uses it.
        """
        return self._native.step(setpoint, measurement, rate)

    def step_many(self, setpoint: Numbers, measurement: Numbers, rate: Numbers | None = None) -> _core.Column:
        """Answer samples one after the other, as so many calls of :meth:`step`.

        Parameters
        ----------
        setpoint, measurement, rate : array or sequence of float
            Of one length and one dimension, rad and rad/s.

        Returns
        -------
        Column
            The commands, rad.

        Raises
        ------
        InputError
            Where another thread is in ``step_many`` of this controller: a controller has one memory, and its samples one
            order. Until that call ends, every other that would change the memory is refused too, ``step`` among them. And
            without rates where :attr:`uses_rate` is true.
        """
        return self._native.step_many((setpoint, measurement) if rate is None else (setpoint, measurement, rate))

    def track(self, setpoint: float, measurement: float, command: float, rate: float | None = None) -> float:
        """Take part in a sample that another has commanded, so that taking over bumps nothing."""
        return self._native.track(setpoint, measurement, command, rate)

    def hold(self) -> float:
        """Answer the last command once more, for a sample that is known to be bad."""
        return self._native.hold()

    def reset(self) -> None:
        """Begin anew."""
        self._native.reset()

    def __repr__(self) -> str:
        kp, ki, kd = self.gains
        return f"<{type(self).__name__} every {self.sample_period_s} s: kp {kp:.6g}, ki {ki:.6g}, kd {kd:.6g}>"


class _Written(Controller):
    """A controller with the settings of the scenario file."""

    _KIND = ""

    def __init__(self, sample_period_s: float, /, **settings: Any) -> None:
        if given := [key for key in ("name", "kind") if key in settings]:
            raise InputError(f"{' and '.join(given)} cannot be set: the class says the kind, and there is no name")
        loop = {"sample_period_s": sample_period_s, "duration_s": 10.0 * sample_period_s}
        controller = {"name": "it", "kind": self._KIND, **settings}
        bench = Scenario.from_dict({**_BENCH, "loop": loop, "controller": [controller]})
        super().__init__(_core.Controller(bench._core, "it"))


class Pid(_Written):
    """A PID with every option of the scenario file: limits, filters, weights, anti-windup, guards.

    Parameters
    ----------
    sample_period_s : float
        Its sample period, s.
    **settings
        What ``[[controller]]`` takes for ``kind = "pid"``.

    Raises
    ------
    ScenarioError
        With all that is wrong, each with what is allowed.

    Examples
    --------
    >>> pid = Pid(0.01, kp=2.0, ki=0.5, kd=0.0)
    >>> pid.step(0.1, 0.0)
    0.2005
    """

    _KIND = "pid"


class Fspid(_Written):
    """A fuzzy self-tuning PID with every option of the scenario file.

    Parameters
    ----------
    sample_period_s : float
        Its sample period, s.
    **settings
        What ``[[controller]]`` takes for ``kind = "fspid"``, such as ``nominal``, ``supervisor``, ``input_scale``.
    """

    _KIND = "fspid"
