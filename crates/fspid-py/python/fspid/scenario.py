"""Scenarios: an aircraft, controllers, a command, and what can be asked of them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any

from . import _core, engines
from ._toml import changes, text_of
from .answers import Analysis, Answer, Certification, Contest, Design, Flight, Verification
from .campaign import Campaign

if TYPE_CHECKING:
    from collections.abc import Callable

    from .controllers import Controller
    from .engines import SearchProgress


class Scenario:
    """A scenario without a mistake; whatever is wrong with it is a :class:`fspid.ScenarioError` when it is made.

    Made by :meth:`from_file`, :meth:`from_text`, :meth:`from_dict` or :meth:`preset`; never changed afterwards.
    """

    def __init__(self, core: _core.Scenario) -> None:
        self._core = core

    @classmethod
    def from_file(cls, path: str | PathLike[str]) -> Scenario:
        """Read a scenario file; files that it names are found from its folder.

        Parameters
        ----------
        path : path-like
            A TOML file, as ``fspid`` takes it.

        Raises
        ------
        FileError
            It cannot be read.
        ScenarioError
            It is wrong; ``.problems`` has everything.
        """
        return cls(_core.Scenario.read(Path(path), []))

    @classmethod
    def from_text(cls, text: str) -> Scenario:
        """Read a scenario from TOML; it cannot name files."""
        return cls(_core.Scenario.parse(text, []))

    @classmethod
    def from_dict(cls, scenario: Mapping[str, Any]) -> Scenario:
        """Make a scenario from a dictionary with the names of the scenario file.

        >>> Scenario.from_dict({
        ...     "schema": 1,
        ...     "name": "five degrees",
        ...     "plant": {"preset": "b747-paper"},
        ...     "loop": {"sample_period_s": 0.01, "duration_s": 20.0},
        ...     "setpoint": {"kind": "step", "amplitude_deg": 5.0},
        ...     "controller": [{"name": "PID", "kind": "pid", "kp": 2.0, "ki": 0.5, "kd": 1.0}],
        ... })
        <Scenario 'five degrees': PID>
        """
        return cls.from_text(text_of(scenario))

    @classmethod
    def preset(cls, name: str) -> Scenario:
        """A scenario that comes with fspid, by its name in :meth:`presets`."""
        return cls.from_text(_core.preset(name))

    @staticmethod
    def presets() -> dict[str, str]:
        """Names of the scenarios that come with fspid, each with what it is about."""
        return dict(_core.presets())

    def _beside(self, text: str) -> Scenario:
        return Scenario(self._core.beside(text))

    @property
    def name(self) -> str:
        """Its name."""
        return self._core.name

    @property
    def controllers(self) -> list[str]:
        """Names of its controllers, in their order."""
        return self._core.controllers

    @property
    def warnings(self) -> list[str]:
        """What is allowed and probably not meant."""
        return self._core.warnings

    @property
    def digest(self) -> str:
        """SHA-256 of everything that it says, with its changes and the files that it names."""
        return self._core.digest

    @property
    def toml(self) -> str:
        """Its text, without the changes of :meth:`with_`."""
        return self._core.text

    @property
    def changes(self) -> list[str]:
        """Its changes, as ``--set`` takes them."""
        return self._core.overrides

    def with_(self, paths: Mapping[str, Any] | None = None, /, **sections: Any) -> Scenario:
        """The same scenario with some values changed.

        Parameters
        ----------
        paths : mapping, optional
            Values by their paths, as ``--set`` takes them; :meth:`paths` lists them.
        **sections
            The same by sections: ``loop={"duration_s": 30.0}``, ``controller={"PID": {"kp": 2.0}}``.

        Raises
        ------
        ScenarioError
            With the changes, the scenario is wrong.

        Examples
        --------
        >>> scenario = Scenario.preset("pitch-hold")
        >>> scenario.with_({"loop.duration_s": 30.0}).changes
        ['loop.duration_s=30.0']
        >>> scenario.with_(controller={"PID": {"kp": 2.5}}).changes
        ['controller.PID.kp=2.5']
        """
        return Scenario(self._core.changed(changes({**(paths or {}), **sections})))

    def controller(self, name: str) -> Controller:
        """A controller of the scenario by itself, for loops that are written in Python."""
        from .controllers import Controller

        return Controller(_core.Controller(self._core, name))

    def paths(self) -> Answer:
        """Every place that :meth:`with_` and dispersions may change, with its value, unit and range."""
        return Answer(self._core.paths())

    def check(self) -> list[str]:
        """What is allowed and probably not meant, of a scenario that is right in all that it says of flights.

        Mistakes of the scenario as it stands were refused when it was made. What its dispersions draw and the cases that it
        is tuned on and judged by are checked here, as ``fspid check`` does.

        Raises
        ------
        ScenarioError
            A dispersion draws what is no scenario, or a case makes it wrong; a problem of a case has its name as ``.case``.
        """
        self._core.check()
        return self.warnings

    def simulate(self) -> Flight:
        """Fly it: traces, measures and verdicts of all controllers."""
        return Flight(self._core.simulate())

    def analyse(self, *, broken_at: str = "command", map_points: int = 9, fly: bool = False) -> Analysis:
        """Margins, poles and sensitivity of the sampled loops, around rest.

        Parameters
        ----------
        broken_at : {"command", "pitch", "rate"}
            Where the loop is broken; the others stay closed.
        map_points : int
            Points along each input of the map of frozen gains; 0 for none.
        fly : bool
            Fly as well: how much gain, delay and lag the flight bears with all its limits. Takes seconds.
        """
        return Analysis(self._core.analyse(broken_at, map_points, fly))

    def certify(
        self,
        controller: str | None = None,
        *,
        disturbances: bool = False,
        family: bool = False,
        nonlinear: bool = False,
        cases: str | None = None,
        steps: bool = False,
    ) -> Certification:
        """Prove that loops stay stable while their gains move; takes up to half a minute a controller.

        Parameters
        ----------
        controller : str, optional
            Only this one.
        disturbances : bool
            Bound as well, from rest, what gusts and disturbances at the elevator do to pitch angle and command.
        family : bool
            Certify as well, at once, all plants and actuators that the scenario's dispersions can draw.
        nonlinear : bool
            Certify as well the nonlinear aircraft in a box around its trim. Takes some seconds more.
        cases : {"tuning", "contest", "choices"}, optional
            Certify each of these cases in place of the scenario as it stands: those it is tuned on, those its contest judges
            by, or every combination of what its dispersions choose among. Its changes hold in every case.
        steps : bool
            With ``cases``: fly in sets what each case commands, and the steps of self-tuners that remember, as is done without
            ``cases``. Takes a minute or two for each case.

        Returns
        -------
        Certification
            True in a condition where all that was asked is proved. Its certificates have it all, and
            :meth:`Certificate.check` believes nothing of it without proving it anew.
        """
        wanted = {
            "controller": controller,
            "disturbances": disturbances,
            "family": family,
            "nonlinear": nonlinear,
            "cases": cases,
            "steps": steps,
        }
        return Certification(self._core.certify(wanted))

    def verify(
        self,
        sets: str | Iterable[str] = (),
        requirements: str | PathLike[str] | Iterable[str | PathLike[str]] = (),
        replays: str | PathLike[str] = ".",
    ) -> Verification:
        """Judge requirements: those of the scenario, of ready sets, and of files.

        Parameters
        ----------
        sets : str or iterable of str
            Ready sets, such as ``"ctms"`` or ``"mil-f-8785c:level=1,category=C"``.
        requirements : path-like or iterable of path-like
            Files of requirements.
        replays : path-like
            The folder in which replays will be written, from which they name files.
        """
        sets = [sets] if isinstance(sets, str) else sets
        requirements = [requirements] if isinstance(requirements, str | PathLike) else requirements
        files = [Path(file) for file in requirements]
        return Verification(self._core.verify(list(sets), files, Path(replays)))

    def tune(
        self,
        controller: str | None = None,
        *,
        optimiser: str | None = None,
        budget: int | None = None,
        seed: int | None = None,
        population: int | None = None,
        anywhere: bool = False,
        out: str | PathLike[str] | None = None,
        history: str | PathLike[str] | None = None,
        threads: int = 0,
        engine: str = "local",
        watch: Callable[[SearchProgress], None] | None = None,
        **options: Any,
    ) -> Design:
        """Choose the numbers that are marked free, so that flights become good.

        The same seed gives the same design on any number of threads, and on engines. Ctrl-C stops at once; with ``out``, or
        for a scenario of a file, the same call then goes on after the last whole generation.

        Parameters
        ----------
        controller : str, optional
            Needed only where several have free numbers.
        optimiser : str, optional
            ``cma-es``, ``de``, ``l-shade``, ``pso``, ``ga``, ``nelder-mead``, ``bfgs`` or
            ``nsga-ii``.
        budget, seed, population : int, optional
            Candidates to fly, seed, candidates of a generation; by default as the scenario says.
        anywhere : bool
            Begin anywhere within the bounds, and not about the start.
        out, history : path-like, optional
            Files for the design (TOML) and for every candidate (Parquet).
        threads : int
            0 for as many as the machine has.
        engine : {"local", "ray", "dask"}
            Who flies: ``engine="ray", address="10.0.0.1:6379"``, ``engine="dask", client=client``. The design is the same.
        watch : callable, optional
            Is told of the progress on an engine before each generation.
        **options
            What the engine takes: ``address``, ``client``.
        """
        wanted = {
            "controller": controller,
            "optimiser": optimiser,
            "budget": budget,
            "seed": seed,
            "population": population,
            "anywhere": anywhere,
            "out": None if out is None else Path(out),
            "history": None if history is None else Path(history),
            "threads": threads,
        }
        if engine == "local":
            engines.refuse(watch, options)
            return Design(self._core.tune(wanted), self)
        with engines.crew(self._core, engine, watch, options) as (fly, tell):
            return Design(self._core.tune(wanted, fly, tell), self)

    def tune_by_rule(
        self,
        rule: str,
        controller: str | None = None,
        *,
        form: str | None = None,
        closed_loop_s: float | None = None,
    ) -> Design:
        """The gains of a classical rule, such as ``"amigo"`` or ``"simc"``; nothing is searched.

        Parameters
        ----------
        rule : str
            Its name; one that is unknown is answered with all names.
        controller : str, optional
            Needed only where several have free numbers.
        form : {"p", "pi", "pid"}, optional
            By default what the rule is made for.
        closed_loop_s : float, optional
            Time constant that the closed loop shall have, s; for ``simc`` and ``lambda``.
        """
        return Design(self._core.tune_by_rule(rule, controller, form, closed_loop_s), self)

    def campaign(
        self,
        out: str | PathLike[str],
        *,
        runs: int = 1000,
        seed: int = 1,
        sampling: str = "random",
        shard_runs: int | None = None,
        threads: int = 0,
        engine: str = "local",
        **options: Any,
    ) -> Campaign:
        """Fly the dispersed scenario many times; interrupted and called again, it goes on where it was.

        Parameters
        ----------
        out : path-like
            The campaign's folder.
        runs, seed : int
            How many runs, and the seed of all that is drawn. Run *i* depends on the seed and on *i* alone.
        sampling : {"random", "latin-hypercube", "sobol"}
            How the points are spread.
        shard_runs : int, optional
            Runs of a shard; by default a second or two of flights, and less of a small campaign on other engines.
        threads : int
            0 for as many as the machine has. The result is the same.
        engine : {"local", "ray", "dask"}
            Who flies, with what :meth:`Campaign.run` takes for it: ``engine="ray", address="10.0.0.1:6379"``.
        """
        planned = self.plan_campaign(
            out, runs=runs, seed=seed, sampling=sampling, shard_runs=shard_runs, engine=engine
        )
        planned.run(threads=threads, engine=engine, **options)
        return planned

    def plan_campaign(
        self,
        out: str | PathLike[str],
        *,
        runs: int = 1000,
        seed: int = 1,
        sampling: str = "random",
        shard_runs: int | None = None,
        engine: str = "local",
    ) -> Campaign:
        """As :meth:`campaign`, and flies nothing yet."""
        cut = (shard_runs, engine != "local")
        return Campaign(_core.Campaign.plan(self._core, Path(out), runs, seed, sampling, cut))

    def contest(
        self,
        out: str | PathLike[str],
        *,
        seeds: int | None = None,
        budget: int | None = None,
        threads: int = 0,
        engine: str = "local",
        watch: Callable[[SearchProgress], None] | None = None,
        **options: Any,
    ) -> Contest:
        """Tune all controllers alike, and judge them on what none of them was tuned on.

        Parameters
        ----------
        out : path-like
            The folder for designs, flights and the page; a contest that was interrupted goes on there.
        seeds, budget : int, optional
            How often each controller is tuned, and with how many candidates; by default as the scenario says.
        threads : int
            0 for as many as the machine has.
        engine, watch, **options
            Who flies, as for :meth:`tune`. Every file is the same.
        """
        wanted = {"out": Path(out), "seeds": seeds, "budget": budget, "threads": threads}
        if engine == "local":
            engines.refuse(watch, options)
            return Contest(self._core.contest(wanted))
        with engines.crew(self._core, engine, watch, options) as (fly, tell):
            return Contest(self._core.contest(wanted, fly, tell))

    def __deepcopy__(self, memo: object) -> Scenario:
        # It never changes.
        return self

    def __repr__(self) -> str:
        return f"<Scenario {self.name!r}: {', '.join(self.controllers)}>"
