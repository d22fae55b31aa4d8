"""Makes membership.csv of fspid-fuzzy: every membership function from its published piecewise definition, 40 digits.

Definitions as documented for MATLAB's toolbox (trimf, trapmf, linsmf, ...) and for fuzzylite (Arc, Concave, ...), not
in the forms that the code computes with.
"""
import math

from mpmath import cos, exp, mp, mpf, pi, sqrt

from fixture import text, write

mp.dps = 40
INF = math.inf


def triangle(x, a, b, c):
    if x == b:
        return mpf(1)
    if a < x < b:
        return (x - a) / (b - a)
    return (c - x) / (c - b) if b < x < c else mpf(0)


def trapezoid(x, a, b, c, d):
    left = 1 if x >= b or a == -INF else 0 if x < a else (x - a) / (b - a)
    right = 1 if x <= c or d == INF else 0 if x > d else (d - x) / (d - c)
    return mpf(min(left, right))


def linear_s(x, a, b):
    if a == b:
        return mpf(0) if x < a else mpf(1)
    return mpf(0) if x < a else mpf(1) if x > b else (x - a) / (b - a)


def linear_z(x, a, b):
    if a == b:
        return mpf(1) if x < a else mpf(0)
    return mpf(1) if x < a else mpf(0) if x > b else (b - x) / (b - a)


def smooth_s(x, a, b):
    if a >= b:
        return mpf(1) if x >= (a + b) / 2 else mpf(0)
    if x <= a:
        return mpf(0)
    if x <= (a + b) / 2:
        return 2 * ((x - a) / (b - a)) ** 2
    return 1 - 2 * ((x - b) / (b - a)) ** 2 if x <= b else mpf(1)


def smooth_z(x, a, b):
    if a >= b:
        return mpf(1) if x <= (a + b) / 2 else mpf(0)
    if x <= a:
        return mpf(1)
    if x <= (a + b) / 2:
        return 1 - 2 * ((x - a) / (b - a)) ** 2
    return 2 * ((x - b) / (b - a)) ** 2 if x <= b else mpf(0)


def gaussian(x, centre, sigma):
    return exp(-((x - centre) ** 2) / (2 * sigma**2))


def gaussian_product(x, left, left_sigma, right, right_sigma):
    a = gaussian(x, left, left_sigma) if x < left else 1
    b = gaussian(x, right, right_sigma) if x > right else 1
    return mpf(a * b)


def sigmoid(x, centre, slope):
    return 1 / (1 + exp(-slope * (x - centre)))


def arc(x, start, end):
    if (start < end and x >= end) or (start > end and x <= end):
        return mpf(1)
    if (start < end and x <= start) or (start > end and x >= start):
        return mpf(0)
    return sqrt((end - start) ** 2 - (x - end) ** 2) / abs(end - start)


def concave(x, i, e):
    if i <= e and x < e:
        return (e - i) / (2 * e - i - x)
    return (i - e) / (-2 * e + i + x) if i > e and x > e else mpf(1)


def ramp(x, start, end):
    if start < end:
        return linear_s(x, start, end)
    return mpf(1) if x <= end else mpf(0) if x >= start else (start - x) / (start - end)


def semi_ellipse(x, start, end):
    c, r = (start + end) / 2, (end - start) / 2
    return sqrt(r**2 - (x - c) ** 2) / r if start < x < end else mpf(0)


def points(x, *list_of_points):
    pairs = list(zip(list_of_points[::2], list_of_points[1::2]))
    here = [grade for at, grade in pairs if at == x]
    if here:
        return max(here)
    left = [pair for pair in pairs if pair[0] < x]
    right = [pair for pair in pairs if pair[0] > x]
    if not left or not right:
        return (right[0] if right else left[-1])[1]
    (x0, y0), (x1, y1) = left[-1], right[0]
    return y0 + (x - x0) / (x1 - x0) * (y1 - y0)


def cosine(x, c, w):
    return (1 + cos(2 * pi / w * (x - c))) / 2 if c - w / 2 <= x <= c + w / 2 else mpf(0)


def bell(x, centre, width, slope):
    return 1 / (1 + abs((x - centre) / width) ** (2 * slope))


def crisp(inside):
    return mpf(1 if inside else 0)


SHAPES = {
    "arc": (arc, [(-1, 1), (2.5, -0.75)]),
    "bell": (bell, [(0.3, 1.2, 2.5), (1, -2, 0.75), (0, 1, 4)]),
    "concave": (concave, [(-1, 1.3), (2.5, 0.7)]),
    "cosine": (cosine, [(0.5, 3), (-1, 0.7)]),
    "gaussian": (gaussian, [(0, 1), (1.7, 0.7077681669066825)]),
    "gaussian-product": (gaussian_product, [(-1, 0.7, 0.5, 1.3), (1, 0.5, -0.5, 0.9)]),
    "linear-s": (linear_s, [(-1, 2.3), (1, 1)]),
    "linear-z": (linear_z, [(-1, 2.3), (1, 1)]),
    "pi": (lambda x, a, b, c, d: smooth_s(x, a, b) * smooth_z(x, c, d), [(-2, -0.5, 0.7, 3), (-2, 1, 0, 3)]),
    "points": (points, [(-2, 0, -1, 0.8, 0.3, 1, 1.7, 0.25), (-1, 0.2, -1, 1, 1, 1, 1, 0)]),
    "ramp": (ramp, [(-1, 2.3), (2, -0.7)]),
    "rectangle": (lambda x, s, e: crisp(s <= x <= e), [(-1, 1.3), (-INF, 0.5), (0.5, INF)]),
    "semi-ellipse": (semi_ellipse, [(-1, 1), (-0.5, 3)]),
    "sigmoid": (sigmoid, [(0, 2), (1.3, -7)]),
    "sigmoid-difference": (
        lambda x, c1, s1, c2, s2: abs(sigmoid(x, c1, s1) - sigmoid(x, c2, s2)),
        [(-1, 10, 1.3, 10), (0, 1.7, 1, -2)],
    ),
    "sigmoid-product": (
        lambda x, c1, s1, c2, s2: sigmoid(x, c1, s1) * sigmoid(x, c2, s2),
        [(-1, 10, 1.3, -8), (0, 2, 1, 3)],
    ),
    "singleton": (lambda x, v: crisp(x == v), [(0.3,)]),
    "smooth-s": (smooth_s, [(-1, 2.3), (1, 1), (2, 1)]),
    "smooth-z": (smooth_z, [(-1, 2.3), (1, 1), (2, 1)]),
    "spike": (lambda x, c, w: exp(-abs(10 / w * (x - c))), [(0.5, 3)]),
    "step": (lambda x, t, d: crisp(x >= t if d > 0 else x <= t), [(0.3, 1), (0.3, -1)]),
    "trapezoid": (
        trapezoid,
        [(-2, -0.7, 0.5, 3), (-1, -1, 1, 1), (-INF, -INF, 0, 1), (-INF, -2, 0, 1), (0, 1, INF, INF), (-2, 2, 1, 2.5)],
    ),
    "triangle": (triangle, [(-1, 0.3, 2), (0, 0, 1), (0, 1, 1)]),
}


def places(parameters):
    """A grid of doubles that are no round numbers, the parameters themselves, and places far off."""
    grid = [-4 + k * 0.37 for k in range(23)]
    return sorted({*grid, *(float(p) for p in parameters if math.isfinite(p)), -1e5, 1e5})


def rows():
    for name, (grade, members) in SHAPES.items():
        for parameters in members:
            exact = [mpf(p) for p in parameters]
            words = " ".join(text(float(p)) for p in parameters)
            for x in places(parameters):
                value = grade(mpf(x), *exact)
                assert -mpf(10) ** -39 <= value <= 1 + mpf(10) ** -39, (name, parameters, x, value)
                yield name, words, x, value


write("fspid-fuzzy", "membership.csv", "shape,params,x,grade", list(rows()))
