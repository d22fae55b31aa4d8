"""Fuzzy systems of any size, and the supervisor of a self-tuning controller."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

from . import _core
from .answers import Absent, Answer, _Paged
from .errors import InputError

if TYPE_CHECKING:
    from os import PathLike

#: What a column of numbers may be given as.
Numbers = Any


class _Drawn(Answer):
    """An answer with drawings."""

    _native: _core.Answer

    @property
    def figures(self) -> dict[str, str]:
        """Drawings as SVG, by name."""
        return {name.removesuffix(".svg"): text for name, text in self._native.files if name.endswith(".svg")}

    def _repr_html_(self) -> str:
        return "".join(self.figures.values()) + super()._repr_html_()


class Explanation(_Drawn):
    """Which rules fired, what each has in the answers, and why a conclusion was not drawn."""


class Surface(_Drawn):
    """A system along one or two of its inputs."""

    @property
    def csv(self) -> str:
        """The values as CSV."""
        return dict(self._native.files)["values.csv"]

    def __repr__(self) -> str:
        return f"<Surface of {', '.join(self.figures)}: {self.csv.count(chr(10)) - 1} points>"


class Audit(_Paged):
    """What is true of a system's rules and surfaces, proved or refuted."""


class FuzzySystem:
    """A fuzzy system: Mamdani, Takagi-Sugeno, Tsukamoto, interval type 2; read from files of many tools.

    >>> system = FuzzySystem.read("mirrored", range=5.0)
    >>> system.inputs
    ['error', 'change']
    >>> round(system(1.0, 0.5)["delta_kp"], 3)
    1.518
    """

    def __init__(self, core: _core.FuzzySystem) -> None:
        self._native = core

    @classmethod
    def read(
        cls,
        name: str | PathLike[str],
        *,
        range: float | None = None,
        defuzzifier: str | None = None,
        out_of_range: str | None = None,
        block: str | None = None,
        controller: str | None = None,
    ) -> FuzzySystem:
        """Read a system from a file, or take a shipped rule table.

        Parameters
        ----------
        name : path-like
            A file (``.toml``, ``.fis``, ``.t2fis``, ``.fcl``, ``.fll``, ``.xml``), a scenario for its supervisor, or
            ``printed``, ``mirrored`` or ``sugeno-grid``.
        range : float, optional
            Half range of a rule table's inputs and outputs.
        defuzzifier : str, optional
            How integrals are computed, such as ``exact`` or ``endpoints:101``; by default as the file's tool does.
        out_of_range : {"clamp", "evaluate", "error"}, optional
            What to do with inputs beyond their range.
        block : str, optional
            The function block of an ``.fcl`` file, if there are several.
        controller : str, optional
            The controller of a scenario, if several have a supervisor.
        """
        text = str(name)
        return cls(_core.FuzzySystem.read(text, range, defuzzifier, out_of_range, block, controller))

    @classmethod
    def from_text(cls, text: str, format: str = "toml") -> FuzzySystem:
        """Read a system from a text; the format is the ending of its files."""
        return cls(_core.FuzzySystem.parse(text, format))

    @property
    def name(self) -> str:
        """Its name."""
        return self._native.name

    @property
    def inputs(self) -> list[str]:
        """Names of the inputs, in their order."""
        return [name for name, _ in self._native.inputs]

    @property
    def universes(self) -> dict[str, tuple[float, float] | None]:
        """The range of each input; None where there is none."""
        return dict(self._native.inputs)

    @property
    def outputs(self) -> list[str]:
        """Names of the outputs, in their order."""
        return self._native.outputs

    @property
    def notes(self) -> list[str]:
        """What was assumed and repaired while the system was read."""
        return self._native.notes

    def __call__(self, *inputs: float, **named: float) -> dict[str, float | Absent]:
        """The answers at these inputs, by name; :class:`Absent` where no rule has one.

        Parameters
        ----------
        *inputs, **named : float
            A number for each input: in their order, by name, or some of both.
        """
        answers = self._native.infer(self._row(inputs, named))
        none = Absent("no rule concludes it here")
        return {name: none if value is None else value for name, value in zip(self.outputs, answers, strict=True)}

    def infer_many(self, *inputs: Numbers) -> dict[str, _core.Column]:
        """The answers at many inputs: a column for each output.

        Parameters
        ----------
        *inputs : array or sequence of float
            A column for each input, in their order. Arrays of NumPy of 64 bits are read where they lie; arrays of more
            dimensions than one, and masked numbers, are refused.

        Returns
        -------
        dict of str to Column
            ``numpy.asarray`` takes no copy of a column. NaN where no rule has an answer.

        Notes
        -----
        Each row is answered by itself, as by a call of the system. Where an output keeps its previous answer
        (``lock-previous``, ``NC``), or a formula names an output, ``fspid infer --points`` answers otherwise: there a row
        comes after the one before it.
        """
        return {column.name: column for column in self._native.infer_many(inputs)}

    def gradient(self, *inputs: float, output: str | None = None, **named: float) -> dict[str, float]:
        """Derivatives of an output's answer by each input, exact and not by differences.

        Parameters
        ----------
        *inputs, **named : float
            As for calling the system.
        output : str, optional
            Which output; needed only where there are several.
        """
        names = self.outputs
        if output is None and len(names) > 1:
            raise InputError(f"output is missing; there are {', '.join(names)}")
        if output is not None and output not in names:
            raise InputError(f"there is no output {output!r}; there are {', '.join(names)}")
        place = 0 if output is None else names.index(output)
        _, slopes = self._native.gradient(self._row(inputs, named), place)
        return dict(zip(self.inputs, slopes, strict=True))

    def explain(self, *inputs: float, why_not: str | None = None, **named: float) -> Explanation:
        """Why the system answers as it does here.

        Parameters
        ----------
        *inputs, **named : float
            As for calling the system.
        why_not : str, optional
            A conclusion ``output=term`` that was not drawn.
        """
        row = self._row(inputs, named)
        values = [f"{name}={value!r}" for name, value in zip(self.inputs, row, strict=True)]
        return Explanation(self._native.explain(values, why_not))

    def audit(
        self,
        spans: Mapping[str, tuple[float, float]] | None = None,
        rest: Mapping[str, float] | None = None,
    ) -> Audit:
        """What is true of it: coverage, holes, symmetry, monotony, values; proved where it says so.

        Parameters
        ----------
        spans : mapping of str to (float, float), optional
            Ranges to look at, where not those of the system.
        rest : mapping of str to float, optional
            Inputs at rest.
        """
        over = [f"{name}={float(lower)!r}..{float(upper)!r}" for name, (lower, upper) in (spans or {}).items()]
        return Audit(self._native.audit(over, _pairs(rest)))

    def surface(
        self,
        x: str | None = None,
        y: str | None = None,
        *,
        fixed: Mapping[str, float] | None = None,
        nodes: int | None = None,
    ) -> Surface:
        """The answers along one or two inputs.

        Parameters
        ----------
        x, y : str, optional
            The inputs; the first that are free if left out.
        fixed : mapping of str to float, optional
            Values of others; the middle of their ranges if left out.
        nodes : int, optional
            Points along each input.
        """
        return Surface(self._native.surface(x, y, _pairs(fixed), nodes))

    def _row(self, inputs: Sequence[float], named: Mapping[str, float]) -> list[float]:
        names = self.inputs
        if len(inputs) > len(names):
            raise InputError(f"{len(inputs)} inputs are given; there are {', '.join(names)}")
        row = dict(zip(names, inputs, strict=False))
        for name, value in named.items():
            if name not in names or name in row:
                told = "is given twice" if name in row else f"is no input; there are {', '.join(names)}"
                raise InputError(f"{name} {told}")
            row[name] = value
        missing = [name for name in names if name not in row]
        if missing:
            raise InputError(f"{', '.join(missing)} missing; the inputs are {', '.join(names)}")
        return [float(row[name]) for name in names]

    def __repr__(self) -> str:
        return f"<FuzzySystem {self.name!r}: {', '.join(self.inputs)} -> {', '.join(self.outputs)}>"


class Increments(NamedTuple):
    """What a supervisor answers: increments of the three gains, in units of its range.

    Attributes
    ----------
    kp, ki, kd : float
        The increments.
    clamped : bool
        An input was moved to the end of its range.
    underflowed : bool
        Every rule underflowed; answered as for the clamped inputs.
    """

    kp: float
    ki: float
    kd: float
    clamped: bool
    underflowed: bool


class Supervisor:
    """The supervisor of a self-tuning controller: seven labels for the error and seven for its change.

    Parameters
    ----------
    table : str or path-like
        ``printed`` or ``mirrored`` for the paper's rules, or a file.
    range : float
        Half range of inputs and outputs; the paper uses 5 and 40.
    defuzzifier : str
        How the centroid is computed; ``exact`` without sampling.
    out_of_range : {"clamp", "evaluate", "error"}
        What to do with inputs beyond the range.

    Examples
    --------
    >>> supervisor = Supervisor("mirrored", 5.0)
    >>> supervisor(0.0, 0.0).clamped
    False
    """

    def __init__(
        self,
        table: str | PathLike[str] = "mirrored",
        range: float = 5.0,
        defuzzifier: str = "exact",
        out_of_range: str = "clamp",
    ) -> None:
        self._native = _core.Supervisor(str(table), range, defuzzifier, out_of_range)

    @property
    def range(self) -> float:
        """Half range of inputs and outputs."""
        return self._native.range

    def __call__(self, error: float, change: float) -> Increments:
        """Increments of the gains for an error and its change, both in units of the range."""
        (kp, ki, kd), clamped, underflowed = self._native.infer(error, change)
        return Increments(kp, ki, kd, clamped, underflowed)

    def infer_many(self, error: Numbers, change: Numbers) -> dict[str, _core.Column]:
        """Increments at many errors and changes, on all threads: columns ``delta_kp``, ``delta_ki``, ``delta_kd``.

        Parameters
        ----------
        error, change : array or sequence of float
            Of one length and one dimension. Arrays of NumPy of 64 bits are read where they lie; masked numbers are refused.
        """
        return {column.name: column for column in self._native.infer_many((error, change))}

    def ask(self, error: float, change: float) -> Answer:
        """As ``fspid infer`` answers."""
        return Answer(self._native.ask(error, change))

    def __repr__(self) -> str:
        return f"<Supervisor of range {self.range}>"


def _pairs(values: Mapping[str, float] | None) -> list[str]:
    return [f"{name}={float(value)!r}" for name, value in (values or {}).items()]
