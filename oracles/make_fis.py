"""Fuzzy systems as `.fis` files, and what they answer by MATLAB's rule.

The systems are written down here as data; files and answers both come from that data, so that a reader that
takes a number for another one is found out. Arithmetic is mpmath's, 40 digits.

MATLAB's rule: 101 samples of the range, both ends included and fully counted; sum(x mu) / sum(mu).
"""
from mpmath import mp, mpf

import fixture
from supervisor import LABELS, PRINTED

mp.dps = 40
FOLDER = fixture.CRATES / "fspid-formats" / "tests" / "data" / "fis"


def trapezoid(x, a, b, c, d):
    rise = 1 if x >= b else 0 if x <= a else (x - a) / (b - a)
    fall = 1 if x <= c else 0 if x >= d else (d - x) / (d - c)
    return min(rise, fall)


# Parameters in the order of the file.
SHAPES = {
    "trimf": lambda x, a, b, c: trapezoid(x, a, b, b, c),
    "trapmf": trapezoid,
    "gaussmf": lambda x, sigma, centre: mp.exp(-(((x - centre) / sigma) ** 2) / 2),
    "gbellmf": lambda x, a, b, c: 1 / (1 + abs((x - c) / a) ** (2 * b)),
    "sigmf": lambda x, slope, centre: 1 / (1 + mp.exp(-slope * (x - centre))),
    "constant": None,
    "linear": None,
}
AND = {"min": min, "prod": lambda a, b: a * b}
OR = {"max": max, "probor": lambda a, b: a + b - a * b}
AGGREGATION = OR | {"sum": lambda a, b: a + b}
POWER = {0: 1, 5: mpf(1) / 2, 20: 2, 30: 3, 40: 4, 15: mpf(3) / 2}


def graded(term, x):
    _, name, parameters = term
    return SHAPES[name](x, *map(mpf, parameters))


def index(entry):
    """(set from 1, hedge code, negated) of a number such as -2.20."""
    digits = f"{abs(entry):.2f}".split(".")
    return int(digits[0]), int(digits[1]), str(entry).startswith("-")


def strength(system, rule, inputs):
    entries, _, weight, connective = rule
    join = (AND if connective == 1 else OR)[system["and" if connective == 1 else "or"]]
    result = None
    for entry, variable, x in zip(entries, system["inputs"], inputs):
        number, code, negated = index(entry)
        if number == 0:
            continue
        grade = graded(variable[2][number - 1], x) ** POWER[code]
        grade = 1 - grade if negated else grade
        result = grade if result is None else join(result, grade)
    if result is None:
        result = mpf(1) if connective == 1 else mpf(0)
    return result * mpf(weight)


def weighted(system, terms, fired, inputs):
    total = moment = mpf(0)
    for level, (_, name, parameters) in fired:
        values = list(map(mpf, parameters))
        value = values[-1] + sum(c * x for c, x in zip(values[:-1], inputs))
        total += level
        moment += level * value
    if total == 0:
        return None
    return moment / total if system["defuzzifier"] == "wtaver" else moment


def centroid(system, bounds, fired):
    lower, upper = map(mpf, bounds)
    area = moment = mpf(0)
    for step in range(101):
        x = lower + step * (upper - lower) / 100
        mu = mpf(0)
        for level, term in fired:
            mu = AGGREGATION[system["aggregation"]](mu, AND[system["implication"]](level, graded(term, x)))
        area += mu
        moment += x * mu
    return moment / area if area else None


def answers(system, point):
    inputs = list(map(mpf, point))
    result = []
    for position, (_, bounds, terms) in enumerate(system["outputs"]):
        fired = []
        for rule in system["rules"]:
            number = rule[1][position]
            if number:
                fired.append((strength(system, rule, inputs), terms[number - 1]))
        sugeno = system["defuzzifier"].startswith("wt")
        answer = weighted(system, terms, fired, inputs) if sugeno else centroid(system, bounds, fired)
        result.append((mpf(bounds[0]) + mpf(bounds[1])) / 2 if answer is None else answer)
    return result


def numbers(values):
    return " ".join(str(int(value)) if value == int(value) else repr(value) for value in values)


def variable(kind, number, found):
    name, bounds, terms = found
    lines = [f"[{kind}{number}]", f"Name='{name}'", f"Range=[{numbers(bounds)}]", f"NumMFs={len(terms)}"]
    for place, (label, shape, parameters) in enumerate(terms, 1):
        lines.append(f"MF{place}='{label}':'{shape}',[{numbers(parameters)}]")
    return "\n".join(lines) + "\n\n"


def entry_text(entry):
    return str(entry) if isinstance(entry, int) else f"{entry:.2f}"


def text(system):
    lines = [
        "[System]",
        f"Name='{system['name']}'",
        f"Type='{'sugeno' if system['defuzzifier'].startswith('wt') else 'mamdani'}'",
        "Version=2.0",
        f"NumInputs={len(system['inputs'])}",
        f"NumOutputs={len(system['outputs'])}",
        f"NumRules={len(system['rules'])}",
        f"AndMethod='{system['and']}'",
        f"OrMethod='{system['or']}'",
        f"ImpMethod='{system['implication']}'",
        f"AggMethod='{system['aggregation']}'",
        f"DefuzzMethod='{system['defuzzifier']}'",
    ]
    parts = ["\n".join(lines) + "\n\n"]
    parts += [variable("Input", n, found) for n, found in enumerate(system["inputs"], 1)]
    parts += [variable("Output", n, found) for n, found in enumerate(system["outputs"], 1)]
    rules = [
        f"{' '.join(map(entry_text, left))}, {' '.join(map(entry_text, right))} ({numbers([weight])}) : {connective}"
        for left, right, weight, connective in system["rules"]
    ]
    return "".join(parts) + "[Rules]\n" + "\n".join(rules) + "\n"


def mamdani(name, inputs, outputs, rules, **other):
    methods = {"and": "min", "or": "max", "implication": "min", "aggregation": "max", "defuzzifier": "centroid"}
    return {"name": name, "inputs": inputs, "outputs": outputs, "rules": rules} | methods | other


def paper():
    """The paper's supervisor: Gaussians that cross at one half, triangles, Table 3 as printed."""
    spacing = mpf(5) / 3
    peaks = [float((i - 3) * spacing) for i in range(7)]
    sigma = float(spacing / (2 * mp.sqrt(2 * mp.log(2))))
    gauss = [(label, "gaussmf", [sigma, peak]) for label, peak in zip(LABELS, peaks)]
    edges = [float((i - 3) * spacing) for i in range(-1, 8)]
    triangles = [(label, "trimf", edges[i : i + 3]) for i, label in enumerate(LABELS)]
    rules = [
        ([i + 1, j + 1], [PRINTED[gain][i][j] + 1 for gain in ("kp", "ki", "kd")], 1.0, 1)
        for i in range(7)
        for j in range(7)
    ]
    inputs = [(name, [-5, 5], gauss) for name in ("e", "ec")]
    outputs = [(name, [-5, 5], triangles) for name in ("dkp", "dki", "dkd")]
    return mamdani("paper", inputs, outputs, rules)


def tipper():
    """MATLAB's introductory example; its answers at three points are printed in the documentation."""
    service = [("poor", "gaussmf", [1.5, 0]), ("good", "gaussmf", [1.5, 5]), ("excellent", "gaussmf", [1.5, 10])]
    food = [("rancid", "trapmf", [0, 0, 1, 3]), ("delicious", "trapmf", [7, 9, 10, 10])]
    tip = [("cheap", "trimf", [0, 5, 10]), ("average", "trimf", [10, 15, 20]), ("generous", "trimf", [20, 25, 30])]
    rules = [([1, 1], [1], 1.0, 2), ([2, 0], [2], 1.0, 1), ([3, 2], [3], 1.0, 2)]
    return mamdani("tip", [("service", [0, 10], service), ("food", [0, 10], food)], [("tip", [0, 30], tip)], rules)


def heater():
    """Hedges, negations, weights, products, a sum and every connective."""
    room = [("cold", "sigmf", [-0.9, 13]), ("mild", "gbellmf", [4, 2.5, 19]), ("hot", "sigmf", [0.9, 25])]
    drift = [("falls", "trapmf", [-3, -3, -1.5, 0]), ("rises", "trapmf", [0, 1.5, 3, 3])]
    power = [("off", "trimf", [-50, 0, 40]), ("half", "trimf", [20, 50, 80]), ("full", "trimf", [60, 100, 150])]
    valve = [("shut", "trimf", [-1, 0, 0.6]), ("open", "gaussmf", [0.3, 1])]
    rules = [
        ([1.20, 0], [3, 2], 1.0, 1),
        ([-1.05, 1], [2, 0], 0.8, 1),
        ([2, -2.30], [2, 1], 0.5, 2),
        ([3, 2.15], [1, 1], 1.0, 2),
        ([3.40, 0], [1, 0], 0.25, 1),
    ]
    return mamdani(
        "heater",
        [("room", [5, 35], room), ("drift", [-3, 3], drift)],
        [("power", [0, 100], power), ("valve", [0, 1], valve)],
        rules,
        **{"and": "prod", "or": "probor", "implication": "prod", "aggregation": "sum"},
    )


def sugeno():
    """Numbers and linear functions as conclusions, and a corner of the inputs where no rule fires."""
    x = [("low", "trimf", [-10, -10, 2]), ("high", "trimf", [-2, 10, 10])]
    y = [("near", "trapmf", [-1, -1, 0.5, 1.5]), ("far", "trapmf", [1, 2, 3, 3])]
    z = [("flat", "constant", [2]), ("plane", "linear", [0.5, -1, 3]), ("rest", "constant", [-4.25])]
    rules = [([1, 1], [1], 1.0, 1), ([1, 2], [2], 1.0, 1), ([2, 1], [3], 0.75, 1), ([2, 2], [2], 0.5, 1)]
    return mamdani(
        "planes",
        [("x", [-10, 10], x), ("y", [-1, 4], y)],
        [("z", [-10, 10], z)],
        rules,
        **{"and": "prod", "or": "probor", "implication": "prod", "aggregation": "sum", "defuzzifier": "wtaver"},
    )


def points(system):
    """Corners, a lattice that hits no corner, and one point outside."""
    (_, first, _), (_, second, _) = system["inputs"]
    def at(bounds, share):
        return bounds[0] + share * (bounds[1] - bounds[0])
    lattice = [(i * 0.37 % 1, i * 0.61 % 1) for i in range(1, 30)]
    corners = [(a, b) for a in (0, 0.5, 1) for b in (0, 0.5, 1)]
    return [(at(first, a), at(second, b)) for a, b in corners + lattice + [(1.1, -0.1)]]


def main():
    FOLDER.mkdir(parents=True, exist_ok=True)
    for make in (paper, tipper, heater, sugeno):
        system = make()
        (FOLDER / f"{make.__name__}.fis").write_text(text(system), newline="\n")
        extra = [(2.0, 1.0), (4.0, 5.0), (7.0, 8.0)] if make is tipper else []
        rows = [[*point, *map(float, answers(system, point))] for point in extra + points(system)]
        names = [name for name, *_ in system["inputs"] + system["outputs"]]
        fixture.write("fspid-formats", f"fis/{make.__name__}.csv", ",".join(names), rows)
    documented = [float(answers(tipper(), point)[0]) for point in [(2, 1), (4, 5), (7, 8)]]
    assert [round(value, 4) for value in documented] == [7.0169, 14.4585, 20.3414], documented


if __name__ == "__main__":
    main()
