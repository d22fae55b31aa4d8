"""Writes eigenvalues.csv: small real matrices with their eigenvalues by SciPy and by mpmath with 60 digits.

Run as `python make_eigenvalues.py > eigenvalues.csv`. Columns: name; size; entries row after row; eigenvalues of
scipy.linalg.eigvals; of mpmath.eig, both as re,im sorted by re then im; largest condition number of an eigenvalue
that SciPy finds, 1/|y'x| with unit vectors, relative to eigenvalue size (norm / |lambda|).
"""

import sys

import mpmath
import numpy
import scipy
import scipy.linalg

mpmath.mp.dps = 60


def cases():
    generator = numpy.random.default_rng(2026)
    for size in (2, 3, 4, 5, 6, 8, 10, 15):
        for i in range(4):
            yield f"random_{size}_{i}", generator.normal(size=(size, size))
        graded = generator.normal(size=(size, size)) * 10.0 ** generator.uniform(-2, 2, size=(size, 1))
        yield f"graded_{size}", graded
        diagonal = 2.0 ** generator.integers(-20, 20, size=size)
        yield f"other_units_{size}", generator.normal(size=(size, size)) * diagonal[:, None] / diagonal[None, :]
    etkin = [[-0.00687, 0.01395, 0, -9.81], [-0.09055, -0.3151, 235.9, 0], [3.894e-4, -3.362e-3, -0.4282, 0], [0, 0, 1, 0]]
    yield "longitudinal", numpy.array(etkin)
    yield "rotation", numpy.array([[0.0, -1.0], [1.0, 0.0]])
    yield "upper_triangle", numpy.triu(generator.normal(size=(7, 7)))
    yield "symmetric", (lambda m: m + m.T)(generator.normal(size=(9, 9)))


def ordered(values):
    pairs = sorted((float(mpmath.re(v)), float(mpmath.im(v))) for v in values)
    return " ".join(f"{re!r},{im!r}" for re, im in pairs)


def condition(matrix):
    values, left, right = scipy.linalg.eig(matrix, left=True, right=True)
    overlap = numpy.abs(numpy.sum(left.conj() * right, axis=0))
    return float(numpy.max(numpy.linalg.norm(matrix, 2) / numpy.abs(values) / overlap))


def clean(values):
    tiny = mpmath.mpf(10) ** -40
    return [mpmath.mpc(mpmath.re(v), mpmath.im(v) if abs(mpmath.im(v)) > tiny * abs(v) else 0) for v in values]


def main():
    print(f"# made by make_eigenvalues.py with SciPy {scipy.__version__} and mpmath {mpmath.__version__}, 60 digits")
    for name, matrix in cases():
        entries = " ".join(repr(float(v)) for v in matrix.ravel())
        ours = clean(mpmath.eig(mpmath.matrix(matrix.tolist()), left=False, right=False))
        fields = [name, str(len(matrix)), entries, ordered(scipy.linalg.eigvals(matrix)), ordered(ours), f"{condition(matrix):.3e}"]
        print(";".join(fields))


if __name__ == "__main__":
    sys.exit(main())
