"""Direction numbers and points of Sobol's sequence; values of the normal distribution, truncated and not."""
import os

import mpmath
import numpy
import scipy
from fixture import CRATES, write
from mpmath import mp, mpf
from scipy.stats import qmc, truncnorm

mp.dps = 60
BITS = 32
HIGHEST_DEGREE = 10


def published():
    """Polynomials and initial numbers of new-joe-kuo-6 up to the highest degree, from SciPy's copy; dimension 0 has none."""
    stored = numpy.load(os.path.join(os.path.dirname(scipy.__file__), "stats", "_sobol_direction_numbers.npz"))
    rows = []
    for polynomial, initial in zip(stored["poly"][1:].tolist(), stored["vinit"][1:].tolist()):
        degree = polynomial.bit_length() - 1
        if degree > HIGHEST_DEGREE:
            return rows
        rows.append((polynomial, initial[:degree]))
    raise AssertionError("the table ended early")


def times_x(value, polynomial):
    value <<= 1
    return value ^ polynomial if value >> (polynomial.bit_length() - 1) else value


def order_of_x(polynomial):
    """Smallest k > 0 with x^k = 1 modulo the polynomial over GF(2)."""
    power, k = times_x(1, polynomial), 1
    while power != 1:
        power, k = times_x(power, polynomial), k + 1
    return k


def directions(polynomial, initial):
    """The numbers m_1 to m_32 by the recurrence of Bratley and Fox (1988), as fractions m_k / 2^k in units of 2^-32."""
    m, degree = list(initial), len(initial)
    while len(m) < BITS:
        new = m[-degree] ^ (m[-degree] << degree)
        for j in range(1, degree):
            if polynomial >> (degree - j) & 1:
                new ^= m[-j] << j
        m.append(new)
    return [value << (BITS - 1 - k) for k, value in enumerate(m)]


def point(table, index):
    """The point number `index` in natural order, in units of 2^-32."""
    coordinates = []
    for numbers in table:
        coordinate = 0
        for k in range(BITS):
            if index >> k & 1:
                coordinate ^= numbers[k]
        coordinates.append(coordinate)
    return coordinates


def sobol():
    rows = published()
    assert len({polynomial for polynomial, _ in rows}) == len(rows) == 160
    for polynomial, initial in rows:
        assert order_of_x(polynomial) == 2 ** len(initial) - 1, "not primitive"
        assert all(m % 2 == 1 and m < 2 << k for k, m in enumerate(initial))
    table = [[1 << (BITS - 1 - k) for k in range(BITS)]] + [directions(*row) for row in rows]
    points = []
    for count in [*range(9), 100, 1001, 4095, 65535, 2**20 + 12345]:
        engine = qmc.Sobol(len(table), scramble=False, bits=BITS)
        drawn = engine.fast_forward(count).random(1)[0] if count else engine.random(1)[0]
        natural = count ^ (count >> 1)
        coordinates = [int(value * 2**BITS) for value in drawn]
        assert coordinates == point(table, natural), count
        points.append((natural, *coordinates))
    for index in [0x9E3779B9, 2**31, 2**32 - 1]:
        points.append((index, *point(table, index)))
    write("fspid-campaign", "sobol.csv", "index,digits of each dimension", points)
    lines = [f"    ({polynomial}, &{initial}),\n" for polynomial, initial in rows]
    path = CRATES / "fspid-campaign" / "src" / "sample" / "directions.rs"
    path.write_text(DIRECTIONS.format(rows="".join(lines)), newline="\n")
    print(f"{path.name}: {len(rows)} polynomials, all primitive; points equal SciPy's {scipy.__version__}")


DIRECTIONS = """\
//! Direction numbers of Sobol's sequence; written by `oracles/make_sampling.py`.

/// Polynomial and initial numbers $m_1, m_2, \\ldots$ of each dimension but the first, which needs
/// none. The bits of a polynomial are its coefficients, the highest power first; these are all
/// the primitive ones up to degree 10.
///
/// # Source
/// S. Joe and F. Y. Kuo, "Constructing Sobol sequences with better two-dimensional projections",
/// SIAM Journal on Scientific Computing 30 (2008), table new-joe-kuo-6.
#[rustfmt::skip]
pub(super) const DIRECTIONS: [(u32, &[u32]); 160] = [
{rows}];
"""


def pairs(runs):
    """Second eigenvalue of a round of swap-or-not, as a walk on ordered pairs of different numbers."""
    states = [(x, y) for x in range(runs) for y in range(runs) if x != y]
    index = {state: i for i, state in enumerate(states)}
    walk = numpy.zeros((len(states), len(states)))
    for x, y in states:
        for turn in range(runs):
            a, b = (turn - x) % runs, (turn - y) % runs
            # Partners of each other share a bit, others have one each.
            ends = [(x, y), (y, x)] if a == y else [(x, y), (a, y), (x, b), (a, b)]
            for end in ends:
                walk[index[x, y], index[end]] += 1 / runs / len(ends)
    return numpy.sort(numpy.abs(numpy.linalg.eigvalsh(walk)))[-2]


def permutation():
    for runs in [4, 5, 7, 8, 12, 16, 23, 32]:
        assert abs(pairs(runs) - (1 + 1 / runs) / 2) < 1e-12, runs
    print("swap-or-not: second eigenvalue of pairs (1 + 1/N) / 2 for N from 4 to 32")


def exact(value):
    """A double nearest to an exact value."""
    return float(mp.nstr(value, 40))


def above(z):
    return mp.erfc(mpf(z) / mp.sqrt(2)) / 2


def quantile(p, q):
    """z with probability p below and q above; whichever is smaller decides."""
    if p > q:
        return -quantile(q, p)
    if p == q:
        return mpf(0)
    start = -mp.sqrt(-2 * mp.log(2 * p)) if p < mpf("0.1") else -mp.sqrt(2 * mp.pi) * (mpf("0.5") - p)
    z = start
    for _ in range(200):
        density = mp.exp(-z * z / 2) / mp.sqrt(2 * mp.pi)
        # Newton on the logarithm, which is nearly straight in the tail.
        step = mp.log(above(-z) / p) * above(-z) / density
        z -= step
        if abs(step) < mpf(10) ** -50 * max(abs(z), mpf(10) ** -20):
            return z
    raise AssertionError(f"no quantile of {p}")


def normal():
    smallest = [2.0**-k for k in (1, 2, 3, 4, 8, 16, 32, 53, 54, 100, 500, 1000, 1022)]
    grid = [k / 64 + 1 / 256 for k in range(64)]
    near = [0.5 - 2.0**-54, 0.5 + 2.0**-53, 0.5 + 2.0**-30, 0.075, 0.925, 0.07499, 1e-11, 1.3887943864964021e-11, 1.4e-11]
    high = [1 - 2.0**-k for k in (3, 10, 30, 53)]
    rows = []
    for p in sorted({*smallest, *grid, *near, *high}):
        z = quantile(mpf(p), 1 - mpf(p))
        assert abs(above(-z) - mpf(p)) < mpf(p) * mpf(10) ** -45
        rows.append((p, exact(z)))
    write("fspid-scenario", "normal_quantile.csv", "probability,quantile", rows)
    points = [0.0, 1e-20, -1e-9, *[k / 4 for k in range(-32, 33) if k], -37.5, -30.0, -20.0, -12.3, 12.3, 20.0, 37.5]
    write("fspid-scenario", "normal_cdf.csv", "z,below,above", [(z, exact(above(-z)), exact(above(z))) for z in points])


def truncated():
    cases = [
        (0.0, 1.0, -1.0, 1.0), (0.0, 1.0, 8.0, 9.0), (0.0, 1.0, -9.0, -8.0), (0.0, 1.0, -1.0, 6.0), (0.0, 1.0, 36.0, 37.0),
        (0.0, 1.0, -37.0, -36.5), (5.0, 2.0, 4.0, 4.5), (1e6, 1.0, 1e6 - 0.5, 1e6 + 3.0), (-3.0, 0.25, -2.0, -1.0), (0.0, 1.0, -30.0, 30.0),
    ]
    rows = []
    for mean, deviation, lower, upper in cases:
        a, b = ((mpf(limit) - mpf(mean)) / mpf(deviation) for limit in (lower, upper))
        for u in [2.0**-53, 1e-9, 0.001, 0.25, 0.5, 0.75, 0.999, 1 - 2.0**-53]:
            below = above(-a) + mpf(u) * (above(-b) - above(-a)) if a < 0 else 1 - (above(b) + (1 - mpf(u)) * (above(a) - above(b)))
            over = above(b) + (1 - mpf(u)) * (above(a) - above(b)) if a >= 0 else 1 - below
            # Sixty digits are not enough for 1 - x far out, so that the tail is computed by itself.
            z = quantile(below, over) if below <= over else -quantile(over, below)
            value = mpf(mean) + mpf(deviation) * z
            near = truncnorm.ppf(u, float(a), float(b), loc=mean, scale=deviation)
            assert abs(near - value) <= 1e-7 * abs(value), (mean, deviation, lower, upper, u)
            rows.append((mean, deviation, lower, upper, u, exact(value)))
    write("fspid-scenario", "truncated_normal.csv", "mean,standard_deviation,lower,upper,u,value", rows)


if __name__ == "__main__":
    sobol()
    permutation()
    normal()
    truncated()
    print(f"mpmath {mpmath.__version__}: {mp.dps} digits")
