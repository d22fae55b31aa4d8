"""Writes sampled.csv: zero-order holds and exponentials, by a Taylor series with 200 digits, with SciPy's beside.

Run as `python make_sampled.py > sampled.csv`. The inputs are exact 64-bit numbers. Columns: name; states; sample
period; A row after row; B; A_d and B_d of mpmath; A_d and B_d of scipy.signal.cont2discrete.
"""

import sys

import mpmath
import numpy
import scipy
import scipy.signal

mpmath.mp.dps = 200


def companion(numerator, denominator):
    """Observability canonical form in 64-bit arithmetic, as the library forms it."""
    lead = denominator[0]
    alpha = [c / lead for c in denominator[1:]]
    n = len(alpha)
    beta = [0.0] * (n + 1 - len(numerator)) + [c / lead for c in numerator]
    h = []
    for k in range(n + 1):
        past = 0.0
        for i in range(min(k, n)):
            past = past + alpha[i] * h[k - 1 - i]
        h.append(beta[k] - past)
    a = [[1.0 if c == r + 1 else 0.0 for c in range(n)] for r in range(n - 1)] + [[-alpha[n - 1 - c] for c in range(n)]]
    return a, [[h[k]] for k in range(1, n + 1)]


def cases():
    b747 = ([-1.69144, -0.84341, -0.0099096], [1, 1.17103, 1.55405, 0.012538, 0.0072771])
    navion = ([11.7304, 22.578], [1, 4.9676, 12.941, 0.0])
    full = ([-11.730435, -23.10585, -1.173743], [1, 5.0126, 13.177826, 0.670174, 0.59409])
    servo = [1.0, 10.0]
    for dt in (0.001, 0.01, 0.02, 0.1, 1.0):
        yield f"b747_{dt}", *companion(*b747), dt
        yield f"b747_servo_{dt}", *companion([10 * c for c in b747[0]], list(numpy.polymul(b747[1], servo))), dt
        yield f"navion_{dt}", *companion(*navion), dt
        yield f"navion_full_{dt}", *companion(*full), dt
    yield "stiff_servo", [[-1e4, 1e4], [0.0, -1.0]], [[0.0], [1.0]], 0.1
    yield "large_input", [[-1.0, 1.0], [0.0, -2.0]], [[1e12], [3e11]], 0.02
    yield "small_input", [[-1.0, 1.0], [0.0, -2.0]], [[1e-15], [-1e-15]], 0.02
    yield "badly_scaled", [[-1.0, 1e6], [-1e-6, -2.0]], [[0.0], [1.0]], 0.5
    yield "lightly_damped", [[0.0, 1.0], [-400.0, -0.04]], [[0.0], [400.0]], 0.05
    yield "unstable", [[1.5, 2.0], [0.3, 0.7]], [[1.0], [-0.5]], 0.25


def exact(a, b, dt):
    """Exponential of the augmented matrix: scaled below 2^-40, forty terms, squared."""
    n = len(a)
    m = mpmath.matrix(n + 1, n + 1)
    for r in range(n):
        for c in range(n):
            m[r, c] = mpmath.mpf(a[r][c]) * mpmath.mpf(dt)
        m[r, n] = mpmath.mpf(b[r][0]) * mpmath.mpf(dt)
    squarings = max(0, int(mpmath.ceil(mpmath.log(mpmath.mnorm(m, 1), 2)))) + 40
    m = m / mpmath.mpf(2) ** squarings
    term, total = mpmath.eye(n + 1), mpmath.eye(n + 1)
    for k in range(1, 40):
        term = term * m / k
        total = total + term
    for _ in range(squarings):
        total = total * total
    return [total[r, c] for r in range(n) for c in range(n)], [total[r, n] for r in range(n)]


def text(values):
    return " ".join(repr(float(v)) for v in values)


def main():
    print(f"# made by make_sampled.py with mpmath {mpmath.__version__}, 200 digits, and SciPy {scipy.__version__}")
    for name, a, b, dt in cases():
        a = [[float(v) for v in row] for row in a]
        a_d, b_d = exact(a, b, dt)
        n = len(a)
        scipy_a, scipy_b, *_ = scipy.signal.cont2discrete((numpy.array(a), numpy.array(b), numpy.eye(n), numpy.zeros((n, 1))), dt)
        flat = [v for row in a for v in row]
        columns = [text(flat), text(v[0] for v in b), text(a_d), text(b_d), text(scipy_a.ravel()), text(scipy_b.ravel())]
        print(";".join([name, str(n), repr(dt), *columns]))


if __name__ == "__main__":
    sys.exit(main())
