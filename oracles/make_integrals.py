"""Makes integrals.csv of fspid-fuzzy: area, moment, centroid and bisector of unions of clipped sets."""
import math
import random
import struct

from mpmath import mp, mpf

from fixture import write

mp.dps = 45
HEADER = "lower,upper,sets,area_down,moment_down,centroid_down,bisector_down,area,centroid,bisector"


def gaussian(x, centre, sigma):
    return mp.exp(-((x - centre) / sigma) ** 2 / 2)


def bell(x, centre, width, slope):
    return 1 / (1 + abs((x - centre) / width) ** (2 * slope))


def sigmoid(x, slope, centre):
    return 1 / (1 + mp.exp(-slope * (x - centre)))


def block(x, left, right):
    return mpf(1) if left <= x < right else mpf(0)


def levels(kind, params, grade):
    """Where a set has that grade."""
    p = [mpf(value) for value in params]
    if kind is gaussian:
        reach = p[1] * mp.sqrt(-2 * mp.log(grade))
        return [p[0] - reach, p[0] + reach]
    if kind is bell:
        reach = p[1] * (1 / grade - 1) ** (1 / (2 * p[2]))
        return [p[0] - reach, p[0], p[0] + reach]
    if kind is sigmoid:
        return [p[1] - mp.log(1 / grade - 1) / p[0]]
    return p


def crossings(one, other, lower, upper):
    """Where two sets have the same grade: sign changes on a grid, then bisection."""
    def gap(x):
        return one[0](x, *map(mpf, one[1])) - other[0](x, *map(mpf, other[1]))
    grid = [mpf(lower) + (mpf(upper) - lower) * (k + mpf("0.31")) / 300 for k in range(-1, 301)]
    for left, right in zip(grid, grid[1:]):
        if gap(left) * gap(right) < 0:
            for _ in range(170):
                middle = (left + right) / 2
                left, right = (middle, right) if gap(middle) * gap(left) > 0 else (left, middle)
            yield left


class Union:
    """The largest of the sets, each cut at its clip."""

    def __init__(self, lower, upper, sets):
        self.lower, self.upper, self.sets = mpf(lower), mpf(upper), sets
        breaks = {self.lower, self.upper}
        for kind, params, _ in sets:
            for _, _, clip in sets:
                if 0 < clip < 1:
                    breaks.update(levels(kind, params, mpf(clip)))
        for i, one in enumerate(sets):
            for other in sets[:i]:
                breaks.update(crossings(one, other, lower, upper))
        self.breaks = sorted(x for x in breaks if self.lower <= x <= self.upper)

    def at(self, x):
        return max(min(kind(x, *map(mpf, params)), mpf(clip)) for kind, params, clip in self.sets)

    def integral(self, function, breaks):
        total = mpf(0)
        for left, right in zip(breaks, breaks[1:]):
            # A piece around a set's centre is not analytic for odd powers; the centre is a break.
            value, error = mp.quad(function, mp.linspace(left, right, 4), error=True)
            assert error < mpf(10) ** -30, error
            total += value
        return total

    def bisector(self, area):
        left_area = mpf(0)
        for left, right in zip(self.breaks, self.breaks[1:]):
            here = self.integral(self.at, [left, right])
            if left_area + here >= area / 2:
                break
            left_area += here
        x = (left + right) / 2
        for _ in range(12):
            x -= (left_area + self.integral(self.at, [left, x]) - area / 2) / self.at(x)
            x = min(max(x, left), right)
        return x


def down(exact):
    """The largest double not above `exact`."""
    near = float(exact)
    return near if mpf(near) <= exact else math.nextafter(near, -math.inf)


def bits(exact):
    return struct.pack(">d", down(exact)).hex()


def row(lower, upper, sets):
    union = Union(lower, upper, sets)
    about = (mpf(lower) + mpf(upper)) / 2
    area = union.integral(union.at, union.breaks)
    moment = union.integral(lambda x: (x - about) * union.at(x), union.breaks)
    values = [area, moment, about + moment / area, union.bisector(area)]
    text = ";".join(" ".join([kind.__name__, repr(clip)] + [repr(float(p)) for p in params]) for kind, params, clip in sets)
    return (float(lower), float(upper), text, *map(bits, values), *(mp.nstr(v, 25) for v in (values[0], *values[2:])))


def cases():
    rng = random.Random(20260302)
    spacing, sigma = 10 / 6, 0.7077681669066825
    clips = [[0.1, 0.35, 0.8, 0.62, 0.2, 0.05, 0.5], [0.3] * 7, [0.0, 0.0, 0.0, 0.7, 0.2, 0.0, 0.0]]
    clips += [[rng.random() for _ in range(7)] for _ in range(3)] + [[1.0] * 7]
    for seven in clips:
        yield -5.0, 5.0, [(gaussian, (-5 + spacing * k, sigma), clip) for k, clip in enumerate(seven)]
    # The exact area is sigma sqrt(2 pi) erf: no kink at all.
    yield -8.0, 8.0, [(gaussian, (0.25, 1.0), 1.0)]
    yield 990.0, 1010.0, [(gaussian, (1000 + rng.uniform(-8, 8), rng.uniform(0.5, 3)), rng.random()) for _ in range(5)]
    for slope in (1.0, 2.0, 2.5, 6.0):
        yield -10.0, 10.0, [(bell, (-4.0 + 3 * k, 1.5, slope), rng.random()) for k in range(4)]
    yield -6.0, 6.0, [(sigmoid, (2.0, 1.0), 0.8), (sigmoid, (-3.0, -1.5), 0.45), (gaussian, (0.3, 0.4), 0.95)]
    yield 0.0, 4.0, [(block, (0.5, 1.3), 0.3), (block, (2.1, 3.7), 0.9), (gaussian, (2.0, 0.3), 0.7)]


if __name__ == "__main__":
    write("fspid-fuzzy", "integrals.csv", HEADER, [row(*case) for case in cases()])
