"""Hedges in conclusions as pyfuzzylite 8.0.6 has them: a system, rules about it, and what it answers.

Needs pyfuzzylite, which `requirements.txt` does not have, for it asks for an old NumPy.
"""
import math
from importlib.metadata import version

import fuzzylite

import fixture

FOLDER = fixture.CRATES / "fspid-formats/tests/data/fll"
VERSION = "8.0.6"
OUTPUTS = {"a": "true", "b": "true", "c": "true", "off": "false"}
# Not 0: from version 8 on, rules that do not fire conclude what a negation makes of that, which fuzzylite did not before.
DEGREES = [0.05, 0.2, 0.5, 0.9, 1.0]
# Several rules of one system are separated by semicolons.
RULES = [
    "if x is up then a is very s and b is s",
    "if x is up then b is s and a is very s",
    "if x is up then a is not s and b is s",
    "if x is up then b is s and a is not s",
    "if x is up then a is very s and b is not s and c is s",
    "if x is up then a is s and b is very s and c is not s",
    "if x is up then a is not very s and b is seldom somewhat s",
    "if x is up then a is extremely s and b is not s and c is not s with 0.5",
    "if x is up then off is not s and a is s",
    "if x is up then a is very s and off is not s and b is s",
    "if x is up then a is any s and b is s",
    "if x is up then a is very s; if x is up then b is not s",
    "if x is up then c is s and a is very s; if x is up then b is somewhat s",
    "if x is up then a is very s and b is s and c is not s",
]


def system(rules):
    """The text of a system with these rules."""
    lines = ["Engine: hedged", "InputVariable: x", "  enabled: true", "  range: 0 1", "  lock-range: false",
             "  term: up Ramp 0 1"]
    for name, enabled in OUTPUTS.items():
        lines += [f"OutputVariable: {name}", f"  enabled: {enabled}", "  range: 0 10", "  lock-range: false",
                  "  aggregation: Maximum", "  defuzzifier: Centroid 100", "  default: nan", "  lock-previous: false",
                  "  term: s Triangle 0 2 10"]
    lines += ["RuleBlock: rules", "  enabled: true", "  conjunction: Minimum", "  disjunction: Maximum",
              "  implication: Minimum", "  activation: General"]
    return "\n".join(lines + [f"  rule: {rule}" for rule in rules.split("; ")]) + "\n"


def answers(rules):
    """What the outputs that are switched on are, at each degree; NaN where they have no answer."""
    engine = fuzzylite.FllImporter().from_string(system(rules))
    for degree in DEGREES:
        engine.input_variable("x").value = degree
        engine.process()
        found = [float(engine.output_variable(name).value) for name in "abc"]
        yield [degree, *("nan" if math.isnan(value) else value for value in found)]


if __name__ == "__main__":
    if version("pyfuzzylite") != VERSION:
        raise SystemExit(f"the values are those of pyfuzzylite {VERSION}")
    (FOLDER / "hedged.fll").write_text(system(RULES[0]), newline="\n")
    rows = [[rules, *row] for rules in RULES for row in answers(rules)]
    fixture.write("fspid-formats", "fll/hedged.csv", "rules,x,a,b,c", rows)
