"""The fuzzy supervisor from its definition: 7 x 7 rules, min, min, max, centre of area.

No closed form here: `exact` cuts the output polygon at its corners and integrates each straight piece.
Written from the paper's section 3 and Table 3; arithmetic is mpmath's, 40 digits.
"""
from functools import lru_cache

from mpmath import mp, mpf

mp.dps = 40
LABELS = "NB NM NS ZO PS PM PB".split()
GAINS = ("kp", "ki", "kd")
RULES = ("exact", "endpoints101", "midpoint100", "midpoint1000", "trapezoid101")

# Table 3 of the paper. Rows: e from NB to PB; columns: ec from NB to PB.
PRINTED_TEXT = {
    "kp": """PB PB PM PM PS PS ZO
             PB PB PM PS PS ZO NS
             PM PM PM PS ZO NS NM
             PM PM PS ZO NS NM NM
             PS PS ZO NS NS NM NM
             ZO ZO NS NM NM NM NB
             ZO NS NM NM NM NB NB""",
    "ki": """NB NB NB NM NS ZO ZO
             NB NB NM NS NS ZO ZO
             NB NM NS NS ZO PS PS
             NM NS NS ZO PS PM PM
             NS NS ZO PS PS PM PB
             ZO ZO PS PS PM PB PB
             ZO ZO PS PM PB PB PB""",
    "kd": """PS NM NB NB NB NM PS
             PS NS NB NM NM NS PS
             ZO NS NM NM NS NS ZO
             ZO NS NS NS NS NS ZO
             ZO NS ZO ZO ZO ZO PS
             PB NS PS PS PS PS PB
             PB PM PM PM PS PS PB""",
}


def parse(table):
    return [[LABELS.index(word) for word in line.split()] for line in table.splitlines()]


def mirror(printed):
    """Row i > 3 is row 6 - i turned round; so is the right half of the middle row."""
    rows = [list(printed[i]) for i in range(3)]
    rows.append([printed[3][j] if j <= 3 else printed[3][6 - j] for j in range(7)])
    rows += [[printed[6 - i][6 - j] for j in range(7)] for i in range(4, 7)]
    return rows


PRINTED = {gain: parse(table) for gain, table in PRINTED_TEXT.items()}
TABLES = {"printed": PRINTED, "mirrored": {gain: mirror(table) for gain, table in PRINTED.items()}}


def grades(x, half_range):
    """Seven Gaussians with peaks from -R to R; neighbours cross at one half."""
    spacing = mpf(half_range) / 3
    sigma = spacing / (2 * mp.sqrt(2 * mp.log(2)))
    return [mp.exp(-(((x - (i - 3) * spacing) / sigma) ** 2) / 2) for i in range(7)]


def strengths(e, ec, half_range, table):
    """For each output label the strongest rule that names it, for kp, ki and kd."""
    row, column = grades(mpf(e), half_range), grades(mpf(ec), half_range)
    result = []
    for gain in GAINS:
        clip = [mpf(0)] * 7
        for i in range(7):
            for j in range(7):
                label = TABLES[table][gain][i][j]
                clip[label] = max(clip[label], min(row[i], column[j]))
        result.append(clip)
    return result


def height(clip, gap, t):
    """Union of the clipped triangles at the fraction t between peaks `gap` and `gap` + 1."""
    return max(min(clip[gap], 1 - t), min(clip[gap + 1], t))


def exact(clip):
    """Centre of area, in spacings from the left peak.

    Gauss's two points integrate each straight piece exactly and lie inside it: a corner at 1 - 1e-170 is lost in
    40 digits, so nothing may be read off at the corners themselves.
    """
    node = 1 / (2 * mp.sqrt(3))
    area = moment = mpf(0)
    for gap in range(6):
        a, b = clip[gap], clip[gap + 1]
        # Every corner: where a triangle is cut, where both slopes meet, where a slope meets the other's top.
        corners = sorted({mpf(0), mpf(1), mpf(1) / 2, a, b, 1 - a, 1 - b})
        for left, right in zip(corners, corners[1:]):
            width, middle = right - left, (left + right) / 2
            for t in (middle - node * width, middle + node * width):
                weight = height(clip, gap, t) * width / 2
                area += weight
                moment += (gap + t) * weight
    return moment / area


@lru_cache
def grid(rule):
    """(gap, t, position, weight) of each sample; positions in spacings from the left peak."""
    count = int(rule.lstrip("abcdefghijklmnopqrstuvwxyz"))
    if rule.startswith("midpoint"):
        places = [mpf(6) * (2 * i + 1) / (2 * count) for i in range(count)]
    else:
        places = [mpf(6) * i / (count - 1) for i in range(count)]
    weights = [1] * count
    if rule.startswith("trapezoid"):
        weights[0] = weights[-1] = mpf(1) / 2
    gaps = [min(int(place), 5) for place in places]
    return [(gap, place - gap, place, w) for gap, place, w in zip(gaps, places, weights)]


def sampled(clip, rule):
    area = moment = mpf(0)
    for gap, t, place, weight in grid(rule):
        mu = weight * height(clip, gap, t)
        area += mu
        moment += place * mu
    return moment / area


def infer(e, ec, half_range=5, table="printed", rule="exact"):
    """Increments of kp, ki and kd, as 40-digit numbers. Nothing is clamped here."""
    spacing = mpf(half_range) / 3
    centre = exact if rule == "exact" else lambda clip: sampled(clip, rule)
    return [spacing * (centre(clip) - 3) for clip in strengths(e, ec, half_range, table)]
