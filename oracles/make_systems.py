"""Random small fuzzy systems with answers to 30 digits: every norm and method, piecewise-linear sets.

Grades, strengths and degrees are fractions, exact. The joined set is cut where a term has a corner,
where implication or joining changes from one case to the other (found by bisection to 40 digits),
and integrated piece by piece by Gauss and Legendre's rule; between those places it is rational.
"""
from fractions import Fraction
from pathlib import Path
from random import Random

from mpmath import mp, mpf
from mpmath.calculus.quadrature import GaussLegendre

mp.dps = 40
FILE = Path(__file__).resolve().parent.parent / "crates/fspid-fuzzy/tests/data/systems.txt"
SYSTEMS = 200

T_NORMS = {
    "minimum": lambda a, b: min(a, b),
    "algebraic-product": lambda a, b: a * b,
    "bounded-difference": lambda a, b: max(0 * a, a + b - 1),
    "drastic-product": lambda a, b: min(a, b) if max(a, b) == 1 else 0 * a,
    "einstein-product": lambda a, b: a * b / (2 - (a + b - a * b)),
    "hamacher-product": lambda a, b: a * b / (a + b - a * b) if a + b > 0 else 0 * a,
    "nilpotent-minimum": lambda a, b: min(a, b) if a + b > 1 else 0 * a,
}
S_NORMS = {
    "maximum": lambda a, b: max(a, b),
    "algebraic-sum": lambda a, b: a + b - a * b,
    "bounded-sum": lambda a, b: min(1 + 0 * a, a + b),
    "drastic-sum": lambda a, b: max(a, b) if min(a, b) == 0 else 1 + 0 * a,
    "einstein-sum": lambda a, b: (a + b) / (1 + a * b),
    "hamacher-sum": lambda a, b: (a + b - 2 * a * b) / (1 - a * b) if a * b != 1 else 1 + 0 * a,
    "nilpotent-maximum": lambda a, b: max(a, b) if a + b < 1 else 1 + 0 * a,
    "normalized-sum": lambda a, b: (a + b) / max(1, a + b),
    "unbounded-sum": lambda a, b: a + b,
}
# The ones that keep straight sets straight come up more often; drastic implication leaves no area.
IMPLICATIONS = ["minimum"] * 5 + ["algebraic-product"] * 5 + [
    "bounded-difference", "einstein-product", "hamacher-product", "nilpotent-minimum"] * 2
JOINS = ["maximum"] * 6 + ["unbounded-sum"] * 3 + ["bounded-sum"] * 3 + list(S_NORMS)


def grade(corners, x):
    """Grade in a trapezoid; its vertical sides belong to it."""
    a, b, c, d = corners
    if x < b:
        return (x - a) / (b - a) if x > a else 0 * x
    if x > c:
        return (d - x) / (d - c) if x < d else 0 * x
    return 1 + 0 * x


def cuts(corners, level):
    """Where the sides of a trapezoid have that grade."""
    a, b, c, d = corners
    return [a + (b - a) * level, d - (d - c) * level]


class System:
    """One input of three sets, another of two, rules of one or two statements, one output."""

    def __init__(self, random):
        self.conjunction, self.disjunction = random.choice(list(T_NORMS)), random.choice(list(S_NORMS)[:7])
        self.implication, self.join = random.choice(IMPLICATIONS), random.choice(JOINS)
        self.inputs = [[self.trapezoid(random, 0, 1) for _ in range(n)] for n in (3, 2)]
        self.universe = (float(random.randint(-5, 0)), float(random.randint(1, 6)))
        self.terms = [self.trapezoid(random, *self.universe) for _ in range(random.randint(2, 4))]
        self.rules = [self.rule(random) for _ in range(random.randint(2, 5))]
        self.values = [round(random.random(), 3) for _ in self.inputs]

    @staticmethod
    def trapezoid(random, lower, upper):
        margin = 0.2 * (upper - lower)
        corners = sorted(round(random.uniform(lower - margin, upper + margin), 2) for _ in range(4))
        kind = random.randrange(5)
        corners[1] = corners[0] if kind == 0 else corners[1]
        corners[2] = corners[3] if kind == 1 else corners[2]
        corners[2] = corners[1] if kind == 2 else corners[2]
        return corners

    def rule(self, random):
        statements = [(i, random.randrange(len(sets)), random.random() < 0.25) for i, sets in enumerate(self.inputs)]
        word = random.choice(["and", "or", "one"])
        statements = statements if word != "one" else [random.choice(statements)]
        return random.choice([1.0, 1.0, 0.75, 0.3]), word, statements, random.randrange(len(self.terms))

    def strength(self, rule):
        weight, word, statements, _ = rule
        grades = []
        for i, term, negated in statements:
            found = grade([Fraction(c) for c in self.inputs[i][term]], Fraction(self.values[i]))
            grades.append(1 - found if negated else found)
        norm = T_NORMS[self.conjunction] if word == "and" else S_NORMS[self.disjunction]
        joined = grades[0]
        for further in grades[1:]:
            joined = norm(joined, further)
        return joined * Fraction(weight)

    def conclusions(self):
        """Strength and corners of each rule's conclusion, as numbers of 40 digits."""
        for rule in self.rules:
            strength = self.strength(rule)
            if strength > 0:
                yield mpf(strength.numerator) / strength.denominator, [mpf(c) for c in self.terms[rule[3]]]

    def joined(self, conclusions, x):
        """Grade at x, and which cases were taken on the way."""
        total, cases = mpf(0), []
        for strength, corners in conclusions:
            own = grade(corners, x)
            cases += [own < strength, own + strength < 1]
            own = T_NORMS[self.implication](strength, own)
            cases += [total < own, total + own < 1, total > 0, own > 0]
            total = S_NORMS[self.join](total, own)
        return total, cases

    def pieces(self, conclusions):
        """Places between which the joined set is one rational function."""
        lower, upper = map(mpf, self.universe)
        corners = {c for strength, own in conclusions for c in own + cuts(own, strength) + cuts(own, 1 - strength)}
        corners = sorted({c for c in corners if lower < c < upper} | {lower, upper})
        places = [lower]
        for begin, end in zip(corners, corners[1:]):
            places += self.changes(conclusions, begin, end) + [end]
        return places

    def changes(self, conclusions, begin, end):
        steps, found = 64, []
        width, tiny = end - begin, mpf(10) ** -25
        inside = [begin + width * t for t in [tiny] + [(mpf(k) + mpf(1) / 3) / steps for k in range(steps)] + [1 - tiny]]
        for left, right in zip(inside, inside[1:]):
            found += self.located(conclusions, left, right)
        return found

    def located(self, conclusions, left, right):
        before, after = (self.joined(conclusions, x)[1] for x in (left, right))
        if before == after:
            return []
        for _ in range(130):
            middle = (left + right) / 2
            case = self.joined(conclusions, middle)[1]
            if case == before:
                left = middle
            elif case == after:
                right = middle
            else:
                return self.located(conclusions, left, middle) + self.located(conclusions, middle, right)
        return [(left + right) / 2]


NODES = GaussLegendre(mp).calc_nodes(5, mp.prec + 20)


def gauss(function, begin, end):
    """Gauss and Legendre's 48 points: rational functions without poles nearby, to 30 digits."""
    half, middle = (end - begin) / 2, (end + begin) / 2
    return half * sum(w * function(middle + half * t) for t, w in NODES)


def answers(system):
    conclusions = list(system.conclusions())
    places = system.pieces(conclusions)
    curve = lambda x: system.joined(conclusions, x)[0]
    cells = [(a, b) for a, b in zip(places, places[1:]) if a < b]
    areas = [gauss(curve, a, b) for a, b in cells]
    area = sum(areas)
    if not area > mpf(10) ** -20:
        return None
    moment = sum(gauss(lambda x: x * curve(x), a, b) for a, b in cells)
    found = {"centroid": moment / area, "bisector": bisector(curve, cells, areas, area)}
    if system.implication in ("minimum", "algebraic-product") and system.join in (
            "maximum", "unbounded-sum", "bounded-sum", "normalized-sum"):
        found |= maxima(curve, cells)
    return found


def bisector(curve, cells, areas, area):
    """By halving; of several such points (a gap) the middle."""
    below, tiny = mpf(0), area * mpf(10) ** -30
    for (begin, end), own in zip(cells, areas):
        if abs(below + own - area / 2) < tiny:
            beyond = [a for (a, _), further in zip(cells, areas) if a >= end and further > tiny]
            return (end + beyond[0]) / 2
        if below + own > area / 2:
            left, right = begin, end
            for _ in range(105):
                middle = (left + right) / 2
                if below + gauss(curve, begin, middle) < area / 2:
                    left = middle
                else:
                    right = middle
            return (left + right) / 2
        below += own
    raise ValueError("no bisector")


def maxima(curve, cells):
    """Of straight pieces, from limits at their ends: smallest, mean by length or number, largest."""
    ends = []
    for a, b in cells:
        # Two points inside tell a straight line.
        p, q = a + (b - a) / 3, a + 2 * (b - a) / 3
        yp, yq = curve(p), curve(q)
        ends.append((a, b, 2 * yp - yq, 2 * yq - yp))
    top = max(max(ya, yb) for _, _, ya, yb in ends)
    is_top = lambda y: y > top - mpf(10) ** -28
    flat = [(a, b) for a, b, ya, yb in ends if is_top(ya) and is_top(yb)]
    points = sorted({mp.nstr(x, 30): x for a, b, ya, yb in ends for x, y in ((a, ya), (b, yb)) if is_top(y)}.values())
    if flat:
        mean = sum((b - a) * (a + b) / 2 for a, b in flat) / sum(b - a for a, b in flat)
    else:
        mean = sum(points) / len(points)
    return {"smallest-of-maximum": points[0], "mean-of-maximum": mean, "largest-of-maximum": points[-1]}


def text(system, found):
    lines = [f"norms {system.conjunction} {system.disjunction} {system.implication} {system.join}"]
    for sets, value in zip(system.inputs, system.values):
        lines += [f"input {value!r}"] + ["set " + " ".join(map(repr, corners)) for corners in sets]
    lines += ["output {!r} {!r}".format(*system.universe)]
    lines += ["set " + " ".join(map(repr, corners)) for corners in system.terms]
    for weight, word, statements, term in system.rules:
        said = " ".join(f"{'not ' if negated else 'is '}{i} {t}" for i, t, negated in statements)
        lines += [f"rule {weight!r} {word} {term} {said}"]
    if found is None:
        lines += ["nothing"]
    else:
        lines += [f"{method} {mp.nstr(value, 30)}" for method, value in found.items()]
    return "\n".join(lines)


def main():
    random, blocks, empty = Random(20240607), [], 0
    while len(blocks) < SYSTEMS:
        system = System(random)
        if any(c[0] >= c[3] for sets in system.inputs + [system.terms] for c in sets):
            continue
        found = answers(system)
        empty += found is None
        if found is not None or empty <= 10:
            blocks.append(text(system, found))
    FILE.write_text("\n\n".join(blocks) + "\n", newline="\n")
    print(f"fspid-fuzzy/systems.txt: {len(blocks)} systems, {FILE.stat().st_size} bytes")


if __name__ == "__main__":
    main()
