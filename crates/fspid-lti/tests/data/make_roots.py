"""Writes roots.csv: polynomials as 64-bit coefficients, and their roots to 60 digits, rounded.

Run as `python make_roots.py > roots.csv`. The roots are those of the coefficients as stored: mpmath reads each
64-bit number exactly. Columns: name; coefficients, highest power first; roots as re,im, sorted by re then im.
"""

import random
import sys

import mpmath
import numpy

mpmath.mp.dps = 60


def from_roots(roots):
    """Coefficients of the monic polynomial with these roots, rounded once to 64 bits."""
    coefficients = [mpmath.mpf(1)]
    for root in roots:
        shifted = coefficients + [mpmath.mpf(0)]
        for i, c in enumerate(coefficients):
            shifted[i + 1] -= root * c
        coefficients = shifted
    return [float(mpmath.re(c)) for c in coefficients]


def stable_roots(generator, degree):
    """Real poles and pairs in the left half plane, with sizes over four decades."""
    roots = []
    while len(roots) < degree:
        size = mpmath.mpf(10) ** generator.uniform(-2, 2)
        if degree - len(roots) >= 2 and generator.random() < 0.5:
            damping = mpmath.mpf(generator.uniform(0.02, 0.99))
            imaginary = size * mpmath.sqrt(1 - damping**2)
            roots += [mpmath.mpc(-damping * size, imaginary), mpmath.mpc(-damping * size, -imaginary)]
        else:
            roots.append(-size)
    return roots


def cases():
    yield "b747", [1, 1.17103, 1.55405, 0.012538, 0.0072771]
    yield "b747_numerator", [-1.69144, -0.84341, -0.0099096]
    yield "navion", [1, 4.9676, 12.941]
    yield "navion_full", [1, 5.0126, 13.177826, 0.670174, 0.59409]
    yield "navion_full_numerator", [-11.730435, -23.10585, -1.173743]
    yield "wilkinson_10", from_roots(range(1, 11))
    yield "wilkinson_20", from_roots(range(1, 21))
    yield "wilkinson_geometric", from_roots([mpmath.mpf(2) ** -k for k in range(1, 16)])
    yield "chebyshev_20", [float(c) for c in numpy.polynomial.chebyshev.cheb2poly([0] * 20 + [1])[::-1]]
    yield "near_double", from_roots([mpmath.mpf(-1), mpmath.mpf(-1) - mpmath.mpf(10) ** -6, -30])
    yield "near_double_pair", from_roots([mpmath.mpc(-1, "1e-6"), mpmath.mpc(-1, "-1e-6"), -30])
    yield "sixty_decades", [1, 1e30, 1, 1e-30]
    yield "all_ones_40", [1] * 41
    generator = random.Random(2026)
    for i in range(60):
        yield f"stable_{i}", from_roots(stable_roots(generator, 2 + i % 9))


def main():
    print(f"# made by make_roots.py with mpmath {mpmath.__version__}, 60 digits")
    for name, coefficients in cases():
        exact = [mpmath.mpf(float(c)) for c in coefficients]
        roots = mpmath.polyroots(exact, maxsteps=5000, extraprec=2000)
        tiny = mpmath.mpf(10) ** -50
        pairs = [(mpmath.re(r), mpmath.im(r) if abs(mpmath.im(r)) > tiny * abs(r) else mpmath.mpf(0)) for r in roots]
        pairs = sorted((float(re), float(im)) for re, im in pairs)
        fields = [name, " ".join(repr(float(c)) for c in coefficients), " ".join(f"{a!r},{b!r}" for a, b in pairs)]
        print(";".join(fields))


if __name__ == "__main__":
    sys.exit(main())
