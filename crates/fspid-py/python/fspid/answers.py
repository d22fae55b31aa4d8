"""What was found out: sentences, numbers, columns, drawings."""

from __future__ import annotations

import copy
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from . import _core

if TYPE_CHECKING:
    from os import PathLike

    from matplotlib.axes import Axes

    from .scenario import Scenario


class Absent(NamedTuple):
    """A measure that there is not, and why: never NaN, and false in a condition.

    Attributes
    ----------
    reason : str
        Why there is none, such as ``not settled within 3 s``.
    """

    reason: str

    def __bool__(self) -> bool:
        return False

    def __repr__(self) -> str:
        return f"Absent({self.reason!r})"


def _with_absent(values: Mapping[str, Any], reasons: Mapping[str, str]) -> dict[str, Any]:
    """Measures, each a number or an :class:`Absent`."""
    return {
        name: Absent(reasons.get(name, "not asked")) if value is None else value for name, value in values.items()
    }


#: Drawings of a page that a notebook shows with an answer; the others are in ``figures``.
_SHOWN = 2


def _as_html(text: str) -> str:
    import html

    return f"<pre>{html.escape(text)}</pre>"


class Answer:
    """An answer of fspid.

    ``print(answer)`` shows what the program prints, ``answer.to_dict()`` is what it prints as JSON.
    """

    def __init__(self, core: _core.Answer | _core.Flight) -> None:
        self._native = core
        self._dict: dict[str, Any] | None = None

    @property
    def good(self) -> bool:
        """True where the program would end with exit code 0: nothing fails, everything asked is met or proved."""
        return self._native.good

    def to_dict(self) -> dict[str, Any]:
        """What the program prints with ``--format json``, as a dictionary of the caller's own."""
        return copy.deepcopy(self._known())

    def _known(self) -> dict[str, Any]:
        import json

        if self._dict is None:
            self._dict = json.loads(self._native.json)
        return self._dict

    def __bool__(self) -> bool:
        return self.good

    def __str__(self) -> str:
        return self._native.text

    def __repr__(self) -> str:
        return self._native.text.rstrip()

    def _repr_html_(self) -> str:
        return _as_html(self._native.text)


class _Saved(Answer):
    """An answer with a report that can be kept."""

    def save(self, path: str | PathLike[str]) -> Path:
        """Write the report, one HTML file that opens offline.

        Parameters
        ----------
        path : path-like
            Where to.

        Returns
        -------
        pathlib.Path
            The file.

        Raises
        ------
        FileError
            It cannot be written; what was there is as it was.
        InputError
            It is a file that the answer is made of, such as the scenario.
        """
        target = Path(path)
        self._native.save_page(target)
        return target


class _Paged(_Saved):
    """An answer with a page that opens offline."""

    _native: _core.Answer

    @property
    def figures(self) -> dict[str, str]:
        """Every drawing of the page as SVG, by its title; a second one of the same title has its number behind it."""
        import html
        import re

        found: dict[str, str] = {}
        for number, drawing in enumerate(re.findall(r"<svg.*?</svg>", self._native.page or "", re.DOTALL)):
            told = re.search(r"<title[^>]*>(.*?)</title>", drawing, re.DOTALL)
            title = html.unescape(told.group(1)) if told else "drawing"
            found[f"{title} ({number})" if title in found else title] = drawing
        return found

    def _repr_html_(self) -> str:
        first = list(self.figures.values())[:_SHOWN]
        return "".join(first) + _as_html(self._native.text)


class Columns(Mapping[str, "_core.Column"]):
    """Columns of one length by name, which ends in the unit.

    They are sequences of numbers of 64 bits. ``numpy.asarray(columns["theta_deg"])`` takes no copy.
    """

    def __init__(self, name: str, columns: list[_core.Column]) -> None:
        self._columns = {column.name: column for column in columns}
        self.name = name

    def __arrow_c_schema__(self) -> object:
        return self._table().__arrow_c_schema__()

    def __arrow_c_stream__(self, requested_schema: object | None = None) -> object:
        """The columns for Arrow: ``polars.DataFrame(trace)`` and ``pyarrow.table(trace)`` take no copy."""
        return self._table().__arrow_c_stream__(requested_schema)

    def _table(self) -> _core.Table:
        return _core.Table(list(self._columns.values()))

    def __getitem__(self, column: str) -> _core.Column:
        try:
            return self._columns[column]
        except KeyError:
            raise KeyError(f"no column {column!r}; there are {', '.join(self._columns)}") from None

    def __iter__(self) -> Iterator[str]:
        return iter(self._columns)

    def __len__(self) -> int:
        return len(self._columns)

    def __repr__(self) -> str:
        rows = len(next(iter(self._columns.values())))
        return f"<{type(self).__name__} {self.name}: {rows} rows of {', '.join(self._columns)}>"


class Trace(Columns):
    """One controller's flight: columns by name, one number a sample; measures, verdict.

    Angles are in degrees, nose up is positive.
    """

    def __init__(self, name: str, columns: list[_core.Column], facts: dict[str, Any]) -> None:
        super().__init__(name, columns)
        self._facts = facts

    @property
    def verdict(self) -> str:
        """What the flight comes to, in words: ``settled``, ``not settled within 20 s``, ``diverged …``."""
        return str(self._facts["verdict"])

    @property
    def failed(self) -> bool:
        """True where the flight fails whatever is required of it."""
        return bool(self._facts["failed"])

    @property
    def measures(self) -> dict[str, float | Absent]:
        """Measures of the first step and of the whole flight; what there is not is :class:`Absent` with its reason."""
        return _with_absent(self._facts["metrics"], self._facts.get("absent", {}))

    def plot(self, ax: Axes | None = None, column: str = "theta_deg") -> Axes:
        """Draw a column over time with matplotlib."""
        from .plot import axes

        ax = axes(ax)
        ax.plot(list(self["time_s"]), list(self[column]), label=self.name)
        ax.set_xlabel("time [s]")
        ax.set_ylabel(column)
        return ax

    def to_dict(self) -> dict[str, Any]:
        """All that is known of the flight but its columns, as a dictionary of the caller's own."""
        return copy.deepcopy(self._facts)

    def __repr__(self) -> str:
        rows = len(self._columns["time_s"])
        return f"<Trace {self.name}: {self.verdict}; {rows} samples of {', '.join(self._columns)}>"


class Flight(_Saved, Mapping[str, Trace]):
    """A scenario that was flown: a :class:`Trace` for each controller."""

    _native: _core.Flight

    def __init__(self, core: _core.Flight) -> None:
        super().__init__(core)
        self._traces: dict[str, Trace] = {}

    def __getitem__(self, controller: str) -> Trace:
        if controller not in self._traces:
            columns = self._native.columns(controller)
            if columns is None:
                raise KeyError(f"no controller {controller!r}; there are {', '.join(self._native.controllers)}")
            facts = next(it for it in self._known()["controllers"] if it["name"] == controller)
            self._traces[controller] = Trace(controller, columns, facts)
        return self._traces[controller]

    def __iter__(self) -> Iterator[str]:
        return iter(self._native.controllers)

    def __len__(self) -> int:
        return len(self._native.controllers)

    def __bool__(self) -> bool:
        return self.good

    def to_csv(self, path: str | PathLike[str] | None = None) -> str:
        """All traces as CSV, as ``fspid simulate --trace`` writes them.

        Parameters
        ----------
        path : path-like, optional
            A file to write as well, as :meth:`save` does.
        """
        text = self._native.csv()
        if path is not None:
            self._native.save_csv(Path(path))
        return text

    def svg(self) -> str:
        """The time response as a drawing."""
        return self._native.svg()

    def plot(self, ax: Axes | None = None, column: str = "theta_deg") -> Axes:
        """Draw a column of every controller over time with matplotlib.

        Parameters
        ----------
        ax : matplotlib.axes.Axes, optional
            Where to; new axes if left out.
        column : str
            Which column.

        Returns
        -------
        matplotlib.axes.Axes
        """
        from .plot import axes

        ax = axes(ax)
        for name, trace in self.items():
            ax.plot(list(trace["time_s"]), list(trace[column]), label=name)
        if column == "theta_deg" and len(self) > 0:
            first = next(iter(self.values()))
            ax.plot(list(first["time_s"]), list(first["setpoint_deg"]), "k--", linewidth=0.8, label="set-point")
        ax.set_xlabel("time [s]")
        ax.set_ylabel(column)
        ax.legend()
        return ax

    def _repr_html_(self) -> str:
        return self._native.svg() + _as_html(self._native.text)


#: What only a stable loop has.
_MARGINS = (
    "gain_margin_db",
    "phase_margin_deg",
    "delay_margin_s",
    "disk_margin",
    "sensitivity_peak",
    "complementary_peak",
    "gain_crossover_rad_s",
    "phase_crossover_rad_s",
    "disk_gain_db",
    "disk_phase_deg",
)


class Analysis(_Paged):
    """Margins, poles and sensitivity of every controller's loop."""

    def __getitem__(self, controller: str) -> dict[str, Any]:
        """What is known of a controller's loop; a margin that there is not is :class:`Absent` with its reason."""
        known = _by_name(self.to_dict()["controllers"], controller)
        if "absent" not in known:
            return known
        return {**dict.fromkeys(_MARGINS, Absent(known["absent"])), **known}

    @property
    def open_loops(self) -> dict[str, Columns]:
        """Each controller's open loop over ``frequency_rad_s``: ``real``, ``imaginary``, ``gain_db``, ``phase_deg``.

        Beside them are ``sensitivity_db`` and ``complementary_db``. Of several plants it is the worst. The phase is continuous and begins between -270 and 90 deg.
        """
        return {name: Columns(name, columns) for name, columns in self._native.curves}

    def plot(self, ax: Sequence[Axes] | None = None) -> Sequence[Axes]:
        """Draw gain and phase of the open loops over frequency (Bode) with matplotlib.

        Parameters
        ----------
        ax : two of matplotlib.axes.Axes, optional
            For the gain and for the phase; new ones if left out.

        Returns
        -------
        two of matplotlib.axes.Axes
        """
        from .plot import bode

        return bode(ax, self.open_loops)


class Verification(Answer):
    """Requirements, each judged by its worst case."""

    _native: _core.Answer

    @property
    def replays(self) -> dict[str, str]:
        """A scenario for each requirement that is not met, by file name: it flies what fails."""
        return dict(self._native.files)

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw each requirement's value over its limit with matplotlib; those with a limit of 0 are left out."""
        from .plot import over_limits

        return over_limits(ax, self.to_dict()["requirements"])


class Certification(Answer):
    """Proofs that loops stay stable while their gains move, or why there is none."""

    _native: _core.Answer

    @property
    def certificates(self) -> dict[str, str]:
        """Certificates by file name, with the name of the case before it where there are cases.

        :meth:`fspid.Certificate.check` and ``fspid certify --check`` verify them without trust in who wrote them.
        """
        return dict(self._native.files)

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the gains that each verdict is about with matplotlib, each over the middle of its range."""
        from .plot import boxes

        answer = self.to_dict()
        if "cases" not in answer:
            return boxes(ax, answer["controllers"])
        each = [(case["name"], it) for case in answer["cases"] for it in case["controllers"]]
        return boxes(ax, [{**it, "name": f"{it['name']} at {case}"} for case, it in each])

    def save(self, folder: str | PathLike[str]) -> list[Path]:
        """Write the certificates into a folder, which is made if it is not there: all of them, or none.

        Raises
        ------
        FileError
            One cannot be written; what was there is as it was.
        InputError
            One would be written over a file that it is made of.
        """
        return [Path(path) for path in self._native.save_files(Path(folder))]


class CertificateCheck(Answer):
    """A certificate that was proved anew, or why it does not hold."""

    @property
    def verdict(self) -> str:
        """``holds``, or what it comes to in place of that: ``refutes``, ``not proved``, ``edited``, ``another loop``, …"""
        answer: str = self.to_dict()["answer"]
        return answer


class Design(Answer):
    """Numbers that were chosen, and the scenario that flies them."""

    _native: _core.Answer

    def __init__(self, core: _core.Answer, origin: Scenario) -> None:
        super().__init__(core)
        self._origin = origin

    @property
    def toml(self) -> str:
        """The scenario with what was found in place of its marks."""
        return self._native.files[0][1]

    @property
    def scenario(self) -> Scenario:
        """The scenario that flies the design."""
        return self._origin._beside(self.toml)

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw where the numbers of a search began and ended between their bounds, with matplotlib."""
        from .plot import between_bounds

        return between_bounds(ax, self.to_dict().get("parameters", []))


class Contest(_Paged):
    """Controllers tuned alike and judged on what none of them was tuned on."""

    def plot(self, ax: Axes | None = None, measure: str = "iae_deg_s") -> Axes:
        """Draw a measure of every controller, best first, with matplotlib: median and quartiles of its searches.

        Parameters
        ----------
        ax : matplotlib.axes.Axes, optional
            Where to; new axes if left out.
        measure : str
            Which measure, such as ``cost``, by which controllers are ranked.
        """
        from .plot import ranked

        return ranked(ax, self.to_dict(), measure)


def _by_name(facts: list[dict[str, Any]], name: str) -> dict[str, Any]:
    for each in facts:
        if each["name"] == name:
            return _with_absent(each, each.get("reasons", {}))
    raise KeyError(f"no controller {name!r}; there are {', '.join(each['name'] for each in facts)}")
