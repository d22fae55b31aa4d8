"""Makes exponential.csv of fspid-proof: exponentials of matrices, 120 digits, rounded down.

The last `inputs` rows of a matrix are zero: its exponential holds the zero-order hold of the states above.
"""
import math

from mpmath import mp, mpf

from fixture import write

mp.dps = 120
HEADER = "name,inputs,time_s,row,column,entry,down,exact"
# A value that is a float to so many digits is that float: closed forms give 1, 6 and the like.
SAME = mpf(10) ** -90

B747 = ([-1.69144, -0.84341, -0.0099096], [1, 1.17103, 1.55405, 0.012538, 0.0072771], -1)
NAVION = ([11.7304, 22.578], [1, 4.9676, 12.941, 0.0], 1)


def companion(numerator, denominator, sign):
    """Observability form of sign * numerator / denominator, whose leading coefficient is 1, in doubles."""
    alpha, n = denominator[1:], len(denominator) - 1
    beta = [0.0] * (n + 1 - len(numerator)) + numerator
    h = []
    for k in range(n + 1):
        h.append(beta[k] - sum(alpha[i] * h[k - 1 - i] for i in range(min(k, n))))
    a = [[float(c == r + 1) for c in range(n)] for r in range(n - 1)] + [[-c for c in reversed(alpha)]]
    return a, [sign * value for value in h[1:]]


def with_actuator(plant, own, by_command):
    """Plant, actuator states and one held input as one generator."""
    a, b = companion(*plant)
    n, m = len(a), len(own)
    rows = [row + [entry] + [0.0] * m for row, entry in zip(a, b)]
    rows += [[0.0] * n + row + [by_command if i == m - 1 else 0.0] for i, row in enumerate(own)]
    return rows + [[0.0] * (n + m + 1)]


def cases():
    """Name, number of inputs, time, generator."""
    yield "rotation_0.3", 0, 0.3, [[0.0, -1.0], [1.0, 0.0]]
    yield "rotation_3", 0, 3.0, [[0.0, -1.0], [1.0, 0.0]]
    yield "jordan", 0, 1.0, [[-0.5, 1.0, 0.0], [0.0, -0.5, 1.0], [0.0, 0.0, -0.5]]
    yield "diagonal", 0, 1.0, [[-3.0, 0.0, 0.0], [0.0, 0.25, 0.0], [0.0, 0.0, 2.0]]
    yield "nilpotent", 0, 1.0, [[0.0, 6.0, 0.0, 0.0], [0.0, 0.0, 6.0, 0.0], [0.0, 0.0, 0.0, 6.0], [0.0] * 4]
    for dt in (0.01, 0.02, 0.05):
        yield f"b747_servo_{dt}", 1, dt, with_actuator(B747, [[-10.0]], 10.0)
        yield f"navion_servo_{dt}", 1, dt, with_actuator(NAVION, [[-10.0]], 10.0)
    yield "b747_second_order", 1, 0.02, with_actuator(B747, [[0.0, 1.0], [-2500.0, -70.0]], 2500.0)
    yield "navion_second_order", 1, 0.05, with_actuator(NAVION, [[0.0, 1.0], [-900.0, -42.0]], 900.0)
    yield "stiff", 1, 0.1, [[-1e4, 1e4, 0.0], [0.0, -1.0, 1.0], [0.0, 0.0, 0.0]]
    yield "badly_scaled", 1, 0.5, [[-1.0, 1e6, 0.0], [-1e-6, -2.0, 1.0], [0.0, 0.0, 0.0]]
    yield "worse_scaled", 1, 0.5, [[-1.0, 1e30, 1e-20], [-1e-30, -2.0, 1e-50], [0.0, 0.0, 0.0]]
    yield "large_input", 1, 0.02, [[-1.0, 1.0, 1e12], [0.0, -2.0, 3e11], [0.0, 0.0, 0.0]]
    yield "small_input", 1, 0.02, [[-1.0, 1.0, 1e-15], [0.0, -2.0, -1e-15], [0.0, 0.0, 0.0]]
    yield "lightly_damped", 1, 0.05, [[0.0, 1.0, 0.0], [-400.0, -0.04, 400.0], [0.0, 0.0, 0.0]]
    yield "unstable", 1, 0.25, [[1.5, 2.0, 1.0], [0.3, 0.7, -0.5], [0.0, 0.0, 0.0]]
    yield "companion_far_apart", 1, 0.01, [
        [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [-1e4, -1.01e4, -1101.0, 1e4], [0.0] * 4]


def precise(rows, time):
    return mp.matrix([[mpf(entry) * mpf(time) for entry in row] for row in rows])


def exponential(matrix):
    """Taylor series of the matrix over 2^80, squared 80 times, with digits to spare."""
    with mp.workdps(300):
        small = matrix / mpf(2) ** 80
        term = total = mp.eye(matrix.rows)
        for k in range(1, 30):
            term = term * small / k
            total = total + term
        for _ in range(80):
            total = total * total
        return total


def down(value):
    """The largest double not above, and whether it is the value itself."""
    nearest = float(value)
    if abs(value - mpf(nearest)) <= SAME * abs(value):
        return nearest, 1
    return (math.nextafter(nearest, -math.inf) if mpf(nearest) > value else nearest), 0


def main():
    rows, worst = [], mpf(0)
    for name, inputs, time, generator in cases():
        matrix = precise(generator, time)
        result = exponential(matrix)
        largest = max(abs(value) for value in result)
        other = mp.expm(matrix, method="taylor")
        worst = max(worst, max(abs(x - y) for x, y in zip(result, other)) / largest)
        size = len(generator)
        for i in range(size):
            for j in range(size):
                value, exact = down(result[i, j])
                rows.append((name, inputs, time, i, j, generator[i][j], value, exact))
    write("fspid-proof", "exponential.csv", HEADER, rows)
    print(f"  {len(list(cases()))} matrices; mpmath's expm differs by at most {mp.nstr(worst, 2)} of the largest entry")
    angle = exponential(precise([[0.0, -1.0], [1.0, 0.0]], 3.0))
    print(f"  rotation by 3: off by {mp.nstr(abs(angle[0, 0] - mp.cos(3)) + abs(angle[1, 0] - mp.sin(3)), 2)}")


if __name__ == "__main__":
    main()
