"""Makes elementary.csv: elementary functions, rounded down, for arguments that are hard or typical."""
import math
import random
import struct

from mpmath import mp, mpf

from fixture import write

mp.prec = 1300  # sine at 1e300 needs a thousand bits of pi
HEADER = "function,x_bits,p_bits,down_bits,exact,x"


def bits(x):
    return struct.pack(">d", x).hex()


def down(exact):
    """The largest double not above `exact`."""
    near = float(exact)
    if math.isinf(near):
        return math.nextafter(math.inf, 0)
    return near if mpf(near) <= exact else math.nextafter(near, -math.inf)


def around(rng, count, *limits):
    """Uniform and logarithmic arguments between limits, and the limits."""
    low, high = limits
    yield from (low, high)
    for _ in range(count):
        yield rng.uniform(low, high)
    for _ in range(count):
        magnitude = 10.0 ** rng.uniform(-12, math.log10(max(abs(low), abs(high))))
        for x in (magnitude, -magnitude):
            if low <= x <= high:
                yield x


def angles(rng, count):
    """Angles, large ones, and the doubles next to multiples of a quarter turn."""
    yield from around(rng, count, -30.0, 30.0)
    for exponent in (3, 6, 9, 15, 22, 100, 300):
        yield rng.uniform(1, 10) * 10.0**exponent
    for quarter in list(range(-12, 13)) + [rng.randrange(1, 10**6) for _ in range(20)]:
        x = float(quarter * mp.pi / 2)
        yield from (math.nextafter(x, -math.inf), x, math.nextafter(x, math.inf))


def rows(count=60):
    rng = random.Random(20260301)
    arguments = {
        "ln": around(rng, count, 1e-300, 1e3),
        "sqrt": around(rng, count, 0.0, 1e6),
        "sin": angles(rng, count),
        "cos": angles(rng, count),
        "tan": angles(rng, count),
        "asin": around(rng, count, -1.0, 1.0),
        "acos": around(rng, count, -1.0, 1.0),
        "atan": around(rng, count, -1e6, 1e6),
        "sinh": around(rng, count, -700.0, 700.0),
        "cosh": around(rng, count, -700.0, 700.0),
        "tanh": around(rng, count, -25.0, 25.0),
    }
    for name, values in arguments.items():
        function = getattr(mp, name)
        for x in values:
            exact = function(mpf(x))
            yield name, bits(x), "", bits(down(exact)), int(mpf(down(exact)) == exact), x
    for _ in range(4 * count):
        x, p = 10.0 ** rng.uniform(-8, 8), rng.uniform(-12, 12)
        yield power(x, p)
    for whole in range(-7, 8):
        for x in (-3.0, -1.7, -1e-3, 0.3, 10.0, 1e10):
            yield power(x, float(whole))


def power(x, p):
    exact = mpf(x) ** (int(p) if p == int(p) else mpf(p))
    return "pow", bits(x), bits(p), bits(down(exact)), int(mpf(down(exact)) == exact), x


if __name__ == "__main__":
    made = list(rows())
    write("fspid-numeric", "elementary.csv", HEADER, made)
