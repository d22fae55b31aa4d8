"""Prints the nodes and weights of Gauss and Legendre's rule, rounded down, for `quadrature/gauss.rs`."""
import math

from mpmath import mp, mpf

mp.dps = 60
COUNT = 10


def down(exact):
    near = float(exact)
    return near if mpf(near) <= exact else math.nextafter(near, -math.inf)


def legendre(x):
    """P_n and its derivative."""
    before, here = mpf(1), x
    for k in range(2, COUNT + 1):
        before, here = here, ((2 * k - 1) * x * here - (k - 1) * before) / k
    return here, COUNT * (x * here - before) / (x * x - 1)


if __name__ == "__main__":
    total = mpf(0)
    for k in range(COUNT // 2):
        x = mp.cos(mp.pi * (k + mpf(3) / 4) / (COUNT + mpf(1) / 2))
        for _ in range(20):
            value, slope = legendre(x)
            x -= value / slope
        weight = 2 / ((1 - x * x) * legendre(x)[1] ** 2)
        total += 2 * weight
        print(f"    ({down(x)!r}, {down(weight)!r}),")
    assert abs(total - 2) < mpf(10) ** -50
    remainder = mp.factorial(COUNT) ** 4 / ((2 * COUNT + 1) * mp.factorial(2 * COUNT) ** 2)
    print(f"remainder: {down(remainder)!r}")
