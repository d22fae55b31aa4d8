"""Pitch loops as environments of Gymnasium: an agent in the controller's place, or one that tunes its gains.

Needs ``gymnasium`` (``pip install fspid[gym]``). Importing this module registers ``fspid/Pitch-v0``:

>>> import gymnasium, fspid.gym
>>> env = gymnasium.make("fspid/Pitch-v0", scenario="pitch-hold")
>>> observation, info = env.reset(seed=7)
>>> observation, reward, terminated, truncated, info = env.step(env.action_space.sample())

One step is one sample of the scenario: the delay, sensors, disturbances, gusts and the servo are those that
:meth:`fspid.Scenario.simulate` flies, with the same bits. An observation is five numbers of 64 bits:

===  =========================================================  ============
0    commanded pitch                                            deg
1    pitch as measured                                          deg
2    pitch rate as measured                                     deg/s
3    error as measured, the first less the second               deg
4    the last command, nose up positive; 0 at the beginning     deg
===  =========================================================  ============

With ``unit="rad"`` they are what controllers see, bit for bit; in degrees a number was multiplied once.
"""

from __future__ import annotations

import operator
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar

from . import _core
from .answers import Flight
from .errors import Error, InputError
from .scenario import Scenario

try:
    import gymnasium
    import numpy
    from gymnasium.spaces import Box
    from gymnasium.vector import AutoresetMode
    from gymnasium.vector.utils import batch_space
except ImportError as missing:
    raise Error("environments need gymnasium 1.1 or newer: pip install fspid[gym]") from missing

if TYPE_CHECKING:
    from os import PathLike

    from numpy.typing import NDArray

    Array = NDArray[numpy.float64]
    #: Of an observation, the action that answered it, the next observation, and whether the flight was lost.
    Reward = Callable[[Array, Array, Array, Any], Any]
    #: The lower and the upper end of each number of an action, or one interval.
    Ends = tuple[float, float] | Sequence[tuple[float, float]]

#: Numbers of an observation.
_OBSERVED = 5
#: Seeds that are drawn where none is given are below this, so that JSON holds them.
_SEEDS = 2**52


class _Loop:
    """What one environment and many have in common."""

    def _wanted(
        self,
        scenario: Scenario | str | PathLike[str],
        controller: str | None,
        action: str,
        unit: str,
        box: Ends | None,
    ) -> tuple[_core.Scenario, dict[str, Any]]:
        ends = None if box is None else _intervals(box)
        self.scenario = _scenario(scenario)
        return self.scenario._core, {"controller": controller, "action": action, "unit": unit, "ends": ends}


def _intervals(box: Any) -> list[tuple[float, float]]:
    """One interval alone, or a list of intervals."""
    try:
        return [(float(low), float(high)) for low, high in (box if hasattr(box[0], "__len__") else [box])]
    except (TypeError, ValueError, IndexError, KeyError):
        raise InputError(f"the box is {box!r}; allowed is (lower, upper), or a list of such") from None


def _scenario(given: Scenario | str | PathLike[str]) -> Scenario:
    """A scenario, the name of one that comes with fspid, or a file."""
    if isinstance(given, Scenario):
        return given
    if isinstance(given, str) and given in Scenario.presets():
        return Scenario.preset(given)
    if isinstance(given, str) and not Path(given).suffix:
        # Told with the names that there are.
        return Scenario.preset(given)
    return Scenario.from_file(given)


# Boxes say that they hold whole numbers or floats, and no environment that it has floats alone: spaces are `Any` here.
def _action_space(ends: Sequence[tuple[float, float]]) -> Any:
    low, high = (numpy.array(side, dtype=numpy.float64) for side in zip(*ends, strict=True))
    return Box(low, high, dtype=numpy.float64)


def _observation_space() -> Any:
    return Box(-numpy.inf, numpy.inf, (_OBSERVED,), dtype=numpy.float64)


def _numbers(given: Any, shape: tuple[int, ...]) -> Array:
    """An action, or one for each environment, as numbers of 64 bits side by side."""
    array = numpy.asarray(given)
    if array.dtype.kind not in "fiu":
        raise InputError(f"the action is an array of {array.dtype}; allowed are real numbers")
    if array.shape != shape:
        raise InputError(f"the action has the shape {array.shape}; allowed is {shape}")
    return numpy.ascontiguousarray(array, dtype=numpy.float64)


def _whole(name: str, given: Any) -> int:
    """A seed or the number of a run."""
    try:
        number = operator.index(given)
    except TypeError:
        raise InputError(f"{name} is {given!r}; allowed is a whole number") from None
    if not 0 <= number < 2**64:
        raise InputError(f"{name} is {number}; allowed is 0 to 2^64 - 1")
    return number


def _run(options: Mapping[str, Any] | None) -> int | None:
    """The run that is asked for."""
    unknown = set(options or ()) - {"run"}
    if unknown:
        raise InputError(f"options has {', '.join(sorted(map(str, unknown)))}; allowed is run")
    return _whole("run", options["run"]) if options else None


class PitchEnv(gymnasium.Env["Array", "Array"], _Loop):
    """The pitch loop of a scenario, with the controller's place open.

    Parameters
    ----------
    scenario : Scenario, str or path-like
        What flies: a scenario, the name of one of :meth:`fspid.Scenario.presets`, or a file.
    controller : str, optional
        Whose settings are flown with; by default the first one with equations.
    action : {"elevator", "gains"}
        What an action is. ``"elevator"``: the command, nose up positive, shape (1,). ``"gains"``: kp, ki (1/s) and kd (s)
        of a PID with all other settings of ``controller``, shape (3,): what a self-tuner answers.
    unit : {"deg", "rad"}
        Of angles in observations, commands and rewards.
    box : (float, float) or sequence of them, optional
        Lower and upper end of each number of an action, which is cut to it. By default a command has the output limits of
        the first controller and the limits of the servo, and a gain goes from nothing to twice the controller's own.
    reward : callable, optional
        ``reward(observation, action, next_observation, terminated)``. By default -T·|set-point - pitch| at the sample
        that was answered, with the true pitch and the sample period T, in deg s: an episode's sum is minus the ``iae``
        that the program measures. A flight that is lost pays its last error for all samples that are left.
    render_mode : {"svg"}, optional
        With it, :meth:`render` draws.

    Notes
    -----
    An episode begins at rest and is truncated behind the last sample of the scenario. It is terminated where the flight
    diverges or hits the ground. Then ``info["outcome"]`` has the program's words, such as ``diverged at t = 3.2 s``, or
    ``flown``; the observation is the last one, with the last command.

    ``reset(seed=s)`` begins run 0 of the seed, every reset without a seed the next run, ``options={"run": i}`` run *i*:
    the dispersions of the scenario are drawn as run *i* of ``scenario.campaign(seed=s)`` draws them, seeds of noise among
    them. What is not dispersed, noise too, is the same in every episode.

    Examples
    --------
    >>> env = PitchEnv("pitch-hold", unit="rad")
    >>> pid = env.scenario.controller("PID")
    >>> seen, info = env.reset()
    >>> over = False
    >>> while not over:
    ...     seen, reward, terminated, truncated, info = env.step([pid.step(seen[0], seen[1], seen[2])])
    ...     over = terminated or truncated
    >>> info["outcome"], env.flight["agent"].verdict
    ('flown', 'settled')
    """

    metadata: ClassVar[dict[str, Any]] = {"render_modes": ["svg"], "render_fps": 1}  # type: ignore[misc]

    def __init__(
        self,
        scenario: Scenario | str | PathLike[str] = "pitch-hold",
        controller: str | None = None,
        *,
        action: str = "elevator",
        unit: str = "deg",
        box: Ends | None = None,
        reward: Reward | None = None,
        render_mode: str | None = None,
    ) -> None:
        if render_mode not in (None, "svg"):
            raise InputError(f"render_mode is {render_mode!r}; allowed is svg")
        self._native = _core.Environment(*self._wanted(scenario, controller, action, unit, box))
        self.action_space = _action_space(self._native.ends)
        self.observation_space = _observation_space()
        self.render_mode = render_mode
        self._reward = reward
        self._of: tuple[int, int] | None = None
        self._seen: Array = numpy.zeros(_OBSERVED)

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Array, dict[str, Any]]:
        """Begin an episode; ``info`` has its ``seed`` and ``run``.

        Parameters
        ----------
        seed : int, optional
            Whose runs are flown from now on; drawn where none was ever given.
        options : dict, optional
            ``{"run": i}`` for run *i* of the seed.
        """
        run = _run(options)
        super().reset(seed=None if seed is None else _whole("seed", seed))
        before = self._of
        if seed is None and before is None:
            seed = int(self.np_random.integers(_SEEDS))
        if seed is not None:
            before = (int(seed), -1)
        assert before is not None
        self._of = (before[0], before[1] + 1 if run is None else run)
        self._seen = numpy.array(self._native.reset(*self._of))
        return self._seen.copy(), {"seed": self._of[0], "run": self._of[1]}

    def step(self, action: Any) -> tuple[Array, float, bool, bool, dict[str, Any]]:
        """Answer the sample that waits, and fly on to the next one."""
        given = _numbers(action, self.action_space.shape or ())
        told, reward, terminated, truncated, outcome = self._native.step(given.tolist())
        observation = numpy.array(told)
        if self._reward is not None:
            reward = float(self._reward(self._seen, given, observation, terminated))
            self._seen = observation.copy()
        return observation, reward, terminated, truncated, {} if outcome is None else {"outcome": outcome}

    def render(self) -> str | None:
        """The flight so far as SVG, if the environment was made to be drawn."""
        return self.flight.svg() if self.render_mode == "svg" else None

    @property
    def flight(self) -> Flight:
        """The flight so far, called ``agent``: columns, measures, verdict, a report, as of a scenario that was flown."""
        native = self._native.flight()
        if native is None:
            raise InputError("there is no flight yet; reset() begins one")
        return Flight(native)


class PitchVectorEnv(gymnasium.vector.VectorEnv["Array", "Array", "NDArray[Any]"], _Loop):
    """Many pitch loops of one scenario, stepped together; each with the bits of a :class:`PitchEnv`.

    Plants with first-order servos fly in lanes, as in campaigns; flights through sensors, in moving air, with other
    actuators and those of nonlinear aircraft fly one by one, on all threads.

    Parameters
    ----------
    num_envs : int
        How many.
    scenario, controller, action, unit, box : optional
        As of :class:`PitchEnv`.
    reward : callable, optional
        As of :class:`PitchEnv`, asked once for all: rows are loops.

    Notes
    -----
    ``reset(seed=s)`` gives loop *i* the seed s + i, as Gymnasium does. A loop that has ended begins its next run with the
    step after that (``AutoresetMode.NEXT_STEP``), which takes no action and has no reward.
    """

    metadata: ClassVar[dict[str, Any]] = {  # type: ignore[misc]
        "render_modes": [],
        "autoreset_mode": AutoresetMode.NEXT_STEP,
    }

    def __init__(
        self,
        num_envs: int = 1,
        scenario: Scenario | str | PathLike[str] = "pitch-hold",
        controller: str | None = None,
        *,
        action: str = "elevator",
        unit: str = "deg",
        box: Ends | None = None,
        reward: Reward | None = None,
        render_mode: None = None,
    ) -> None:
        if render_mode is not None:
            raise InputError("many loops are not drawn; PitchEnv draws one")
        self.num_envs = _whole("num_envs", num_envs)
        if num_envs < 1:
            raise InputError("num_envs is 0; allowed is at least 1")
        self._native = _core.Environments(*self._wanted(scenario, controller, action, unit, box), self.num_envs)
        self.single_action_space = _action_space(self._native.ends)
        self.single_observation_space = _observation_space()
        self.action_space = batch_space(self.single_action_space, self.num_envs)
        self.observation_space = batch_space(self.single_observation_space, self.num_envs)
        self._reward = reward
        self._begun = False
        self._over: NDArray[Any] = numpy.zeros(self.num_envs, dtype=bool)
        self._seen: Array = numpy.zeros((self.num_envs, _OBSERVED))

    @property
    def in_lanes(self) -> int:
        """How many of the loops that were begun fly in lanes."""
        return self._native.in_lanes

    def reset(
        self,
        *,
        seed: int | Sequence[int] | None = None,
        options: dict[str, Any] | None = None,
    ) -> tuple[Array, dict[str, Any]]:
        """Begin an episode in every loop; ``infos`` has their ``seed`` and ``run``.

        Parameters
        ----------
        seed : int or sequence of int, optional
            That of the first loop, the others have the next ones; or one for each.
        options : dict, optional
            ``{"run": i}`` for run *i* of each seed.
        """
        run = _run(options)
        seeds = self._seeds(seed)
        if seeds is None:
            of = [(before, last + 1) for before, last in self._native.runs]
        else:
            of = [(each, 0) for each in seeds]
        if run is not None:
            of = [(each, run) for each, _ in of]
        self._seen = self._rows(self._native.reset(of))
        self._begun, self._over = True, numpy.zeros(self.num_envs, dtype=bool)
        return self._seen.copy(), self._began({}, range(self.num_envs))

    def _seeds(self, seed: int | Sequence[int] | None) -> list[int] | None:
        """A seed for each loop; None for those that they have."""
        if seed is None and self._begun:
            return None
        if isinstance(seed, Sequence):
            if len(seed) != self.num_envs:
                raise InputError(f"there are {len(seed)} seeds; allowed is one for each of {self.num_envs} loops")
            return [_whole("seed", each) for each in seed]
        super().reset(seed=None if seed is None else _whole("seed", seed))
        first = int(self.np_random.integers(_SEEDS)) if seed is None else _whole("seed", seed)
        return [first + place for place in range(self.num_envs)]

    def step(self, actions: Any) -> tuple[Array, NDArray[Any], NDArray[Any], NDArray[Any], dict[str, Any]]:
        """Answer all samples that wait, and fly on to the next ones."""
        given = _numbers(actions, self.action_space.shape or ())
        told, rewards, ends = self._native.step(given)
        observations, ended = self._rows(told), numpy.asarray(ends)
        terminated, truncated = ended == 1.0, ended == 2.0
        reward = numpy.array(rewards)
        if self._reward is not None:
            asked = self._reward(self._seen, given, observations, terminated)
            reward = numpy.where(self._over, 0.0, asked)
            self._seen = observations.copy()
        infos: dict[str, Any] = {}
        if self._over.any():
            infos = self._began(infos, numpy.flatnonzero(self._over))
        self._over = terminated | truncated
        if self._over.any():
            for place, outcome in self._native.outcomes():
                infos = self._add_info(infos, {"outcome": outcome}, place)
        return observations, reward, terminated, truncated, infos

    def _rows(self, column: _core.Column) -> Array:
        return numpy.array(column).reshape(self.num_envs, _OBSERVED)

    def _began(self, infos: dict[str, Any], places: Any) -> dict[str, Any]:
        """Says of these loops which run they have begun."""
        runs = self._native.runs
        for place in places:
            seed, run = runs[place]
            infos = self._add_info(infos, {"seed": seed, "run": run}, int(place))
        return infos

    def render(self) -> None:
        """Many loops are not drawn."""
        return None


if "fspid/Pitch-v0" not in gymnasium.registry:
    gymnasium.register(
        id="fspid/Pitch-v0",
        entry_point="fspid.gym:PitchEnv",
        vector_entry_point="fspid.gym:PitchVectorEnv",
    )

__all__ = ["PitchEnv", "PitchVectorEnv"]
