"""Makes integral_regulator.csv of fspid-lti: optimal feedback with integral action for a damped integrator.

x = (integral, position, rate), x' = A x + B u. SciPy solves the equation of Riccati; Newton's method on it (Kleinman 1968:
one equation of Lyapunov a step) then sharpens the solution in 60 digits. SciPy's own gains are stored beside, as it has
them, and the largest difference is printed.
"""
from random import Random

import numpy as np
from mpmath import lu_solve, matrix, mp, mpf
from scipy.linalg import solve_continuous_are

from fixture import write

mp.dps = 60


def kleinman(a, b, q, gain):
    """Gain from a stabilising one: solves (A - B K)' P + P (A - B K) = -(Q + K' K) until K stands still."""
    for _ in range(60):
        closed = a - b * gain
        weight = q + gain.T * gain
        left, right = matrix(9, 9), matrix(9, 1)
        for i in range(3):
            for j in range(3):
                right[3 * i + j] = -weight[i, j]
                for k in range(3):
                    left[3 * i + j, 3 * k + j] += closed[k, i]
                    left[3 * i + j, 3 * i + k] += closed[k, j]
        cost = lu_solve(left, right)
        new = matrix([[sum(b[k] * cost[3 * k + j] for k in range(3)) for j in range(3)]])
        change = max(abs(new[j] / gain[j] - 1) for j in range(3))
        gain = new
        if change < mpf(10) ** -45:
            return gain
    raise ArithmeticError("Newton's method has not converged")


def case(damping, power, integral, position, rate):
    a = np.array([[0, 1, 0], [0, 0, 1], [0, 0, -damping]])
    b = np.array([[0], [0], [power]])
    q = np.diag([integral, position, rate])
    rough = (b.T @ solve_continuous_are(a, b, q, np.eye(1)))[0]
    exact = lambda m: matrix([[mpf(float(v)) for v in row] for row in m])
    gain = kleinman(exact(a), exact(b), exact(q), matrix([[mpf(float(v)) for v in rough]]))
    return rough, [gain[j] for j in range(3)]


random = Random(7)
drawn = lambda low, high: float(f"{10 ** random.uniform(low, high):.6g}")
models = [(4.97, 11.73, 1.0, 1.0, 1.0), (0.669, 1.158, 0.25, 4.0, 0.5), (0.0, 1.0, 1.0, 1.0, 1.0), (-0.8, 3.0, 2.0, 5.0, 0.1)]
models += [(random.choice([1, 1, -1]) * drawn(-2, 1.5), drawn(-2, 2), drawn(-3, 3), drawn(-3, 3), drawn(-3, 3)) for _ in range(36)]
rows, worst = [], 0.0
for model in models:
    rough, gain = case(*model)
    worst = max(worst, max(abs(float(r / g - 1)) for r, g in zip(rough, gain)))
    rows.append([*map(float, model), *gain, *map(float, rough)])
header = "damping_per_s,power_per_s2,integral_per_s2,position,rate_s2,gain_integral,gain_position,gain_rate,scipy_integral,scipy_position,scipy_rate"
write("fspid-lti", "integral_regulator.csv", header, rows)
print(f"SciPy's gains differ by at most {worst:.1e} of themselves")
