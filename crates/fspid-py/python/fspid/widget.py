"""A flight in a notebook whose gains can be moved, by anywidget: ``pip install 'fspid[widget]'``.

>>> import fspid
>>> shown = fspid.widget.FlightWidget(fspid.Scenario.preset("pitch-hold"), {"controller.PID.kp": (0.5, 4.0)})
>>> shown.values = {"controller.PID.kp": 2.5}
>>> shown.scenario.changes
['controller.PID.kp=2.5']
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from .answers import Flight
from .errors import Error, InputError
from .scenario import Scenario

try:
    import anywidget
    import traitlets
except ImportError as missing:
    raise Error("this needs anywidget: pip install 'fspid[widget]'") from missing

__all__ = ["FlightWidget"]

#: Steps of a slider from one end to the other.
_STEPS = 200

_PAGE = """
function render({ model, el }) {
  const sliders = document.createElement("div");
  const drawing = document.createElement("div");
  const words = document.createElement("pre");
  words.setAttribute("aria-live", "polite");
  for (const [path, [low, high]] of Object.entries(model.get("ranges"))) {
    const row = document.createElement("label");
    const slider = document.createElement("input");
    const number = document.createElement("output");
    row.style.cssText = "display:grid;grid-template-columns:20em 20em 8em;gap:1em;align-items:center";
    Object.assign(slider, { type: "range", min: low, max: high, step: (high - low) / STEPS });
    const show = () => {
      slider.value = model.get("values")[path];
      number.textContent = Number(model.get("values")[path]).toPrecision(4);
    };
    slider.addEventListener("input", () => {
      model.set("values", { ...model.get("values"), [path]: Number(slider.value) });
      model.save_changes();
    });
    model.on("change:values", show);
    show();
    row.append(path, slider, number);
    sliders.append(row);
  }
  const told = () => {
    drawing.innerHTML = model.get("drawing");
    words.textContent = model.get("words");
  };
  model.on("change:drawing change:words", told);
  told();
  el.append(sliders, drawing, words);
}
export default { render };
""".replace("STEPS", str(_STEPS))


class FlightWidget(anywidget.AnyWidget):
    """A scenario's flight with a slider for each number that may move; every move flies again.

    Parameters
    ----------
    scenario : Scenario
        What is flown.
    ranges : mapping of str to (float, float)
        Paths, as :meth:`Scenario.with_` takes them, each with the ends of its slider; :meth:`Scenario.paths` lists
        paths with their units.

    Attributes
    ----------
    values : dict of str to float
        Where the sliders stand; may be set.
    scenario : Scenario
        The scenario as it is flown now.
    flight : Flight
        Its flight. Numbers with which there is no scenario leave it as it was, and ``words`` tells what is wrong.
    """

    _esm = _PAGE
    ranges = traitlets.Dict().tag(sync=True)
    values = traitlets.Dict().tag(sync=True)
    drawing = traitlets.Unicode().tag(sync=True)
    words = traitlets.Unicode().tag(sync=True)

    def __init__(self, scenario: Scenario, ranges: Mapping[str, tuple[float, float]]) -> None:
        wrong = [path for path, (low, high) in ranges.items() if not low < high]
        if wrong:
            raise InputError(f"{', '.join(wrong)}: a slider goes from a lower end to a higher one")
        self._asked, self._begun = scenario, _stands(scenario, ranges)
        super().__init__(ranges={path: list(ends) for path, ends in ranges.items()}, values=self._begun)
        self._fly(self.values)
        self.observe(lambda change: self._fly(change["new"]), "values")

    @property
    def flight(self) -> Flight:
        return self._flight

    @property
    def scenario(self) -> Scenario:
        return self._now

    def _fly(self, values: Mapping[str, float]) -> None:
        moved = {path: value for path, value in values.items() if value != self._begun.get(path)}
        try:
            now = self._asked.with_(moved) if moved else self._asked
            flight = now.simulate()
        except Error as error:
            self.words = f"{error}\n\nWhat is drawn is the last flight that there was, with other numbers."
            return
        self._now, self._flight = now, flight
        self.drawing, self.words = flight.svg(), str(flight)


def _stands(scenario: Scenario, paths: Iterable[str]) -> dict[str, float]:
    """Where numbers of a scenario stand."""
    known = {each["path"]: each["value"] for each in scenario.paths().to_dict()["paths"]}
    none = [path for path in paths if not isinstance(known.get(path), int | float)]
    if none:
        raise InputError(f"{', '.join(none)}: no number of this scenario; scenario.paths() lists them")
    return {path: float(known[path]) for path in paths}
