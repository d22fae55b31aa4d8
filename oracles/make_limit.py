"""The least error within a travel, by another programme and another solver.

Here the response to every command is a column of the programme (the simulation has states as variables), the plant is sampled
by SciPy's matrix exponential, and the programme is solved by HiGHS (`scipy.optimize.linprog`).

Writes crates/fspid-limit/tests/data/limits.csv: case, travel, travel_deg, iae_deg_s.
"""

import csv
import sys
from pathlib import Path

import numpy as np
from scipy.linalg import expm, toeplitz
from scipy.optimize import linprog
from scipy.signal import tf2ss
from scipy.sparse import csr_matrix

OUT = Path(__file__).resolve().parent.parent / "crates/fspid-limit/tests/data/limits.csv"

# Numerator and denominator from elevator to pitch, nose up; time constant of the servo; period and length, s; limits of
# the command, deg; delay, samples; set-point and disturbances at servo and elevator, deg, as functions of time.
CASES = {
    # The paper's 747 with its servo, as a prototype had it.
    "747": dict(
        num=[1.69144, 0.84341, 0.0099096],
        den=[1.0, 1.17103, 1.55405, 0.012538, 0.0072771],
        tau=0.1, dt=0.05, end=20.0, limits=(-20.0, 20.0), delay=0,
        setpoint=lambda t: 5.0 if t >= 0 else 0.0,
        servo=lambda t: 0.0,
        elevator=lambda t: 0.0,
    ),
    # A light aircraft, disturbed at the servo before its step and at the elevator behind it, two samples late.
    "light": dict(
        num=[11.2, 20.0],
        den=[1.0, 5.05, 13.2, 0.0],
        tau=0.15, dt=0.04, end=8.0, limits=(-6.0, 9.0), delay=2,
        setpoint=lambda t: 4.0 if t >= 3.0 - 1e-9 else 0.0,
        servo=lambda t: 0.0,
        elevator=lambda t: 1.0 if t >= 1.0 - 1e-9 else 0.0,
    ),
}
TRAVELS = {"elevator": [4.0, 8.0, 16.0], "command": [4.0, 8.0, 16.0], "command-from-rest": [8.0, 10.0, 15.0, 20.0, 30.0]}


def sampled(case):
    """Impulse responses of pitch to the command and to the elevator, and of the deflection to the command, by samples."""
    a, b, c, _ = tf2ss(case["num"], case["den"])
    n, tau, dt = len(a), case["tau"], case["dt"]
    whole = np.zeros((n + 3, n + 3))
    whole[:n, :n], whole[:n, n], whole[n, n] = a, b[:, 0], -1.0 / tau
    whole[n, n + 1], whole[:n, n + 2] = 1.0 / tau, b[:, 0]
    step = expm(whole * dt)
    phi, by_command, by_elevator = step[: n + 1, : n + 1], step[: n + 1, n + 1], step[: n + 1, n + 2]
    rows = int(round(case["end"] / dt)) + 1
    pitch = np.concatenate([c[0], [0.0]])
    theta, deflection, disturbed = np.zeros(rows), np.zeros(rows), np.zeros(rows)
    x, d = by_command, by_elevator
    for k in range(1, rows):
        theta[k], deflection[k], disturbed[k] = pitch @ x, x[n], pitch @ d
        x, d = phi @ x, phi @ d
    return theta, deflection, disturbed, rows


def matrix(column):
    return np.tril(toeplitz(column))


def limit(case, counted, travel):
    theta, deflection, disturbed, rows = sampled(case)
    delay, dt = case["delay"], case["dt"]
    times = np.arange(rows) * dt
    column = lambda what: np.array([case[what](t) for t in times])
    setpoint, at_elevator = column("setpoint"), column("elevator")
    late = np.eye(rows, k=-delay)
    to_theta, to_deflection = matrix(theta) @ late, matrix(deflection) @ late
    error = setpoint - matrix(disturbed) @ at_elevator
    change = np.eye(rows) - np.eye(rows, k=-1)
    if counted == "elevator":
        way, offset = (change @ to_deflection)[1:], (change @ at_elevator)[1:]
    else:
        first = 0 if counted == "command-from-rest" else 1
        way, offset = change[first:], np.zeros(rows - first)
    m, eye = len(way), np.eye
    none = lambda r, c: np.zeros((r, c))
    a_ub = np.block([
        [-to_theta, -eye(rows), none(rows, m)],
        [to_theta, -eye(rows), none(rows, m)],
        [way, none(m, rows), -eye(m)],
        [-way, none(m, rows), -eye(m)],
        [none(1, rows), none(1, rows), np.ones((1, m))],
    ])
    b_ub = np.concatenate([-error, error, -offset, offset, [travel]])
    cost = np.concatenate([np.zeros(rows), dt * np.ones(rows), np.zeros(m)])
    bounds = [case["limits"]] * rows + [(0, None)] * (rows + m)
    found = linprog(cost, A_ub=csr_matrix(a_ub), b_ub=b_ub, bounds=bounds, method="highs")
    assert found.status == 0, found.message
    return found.fun


def main():
    rows = []
    for name, case in CASES.items():
        for counted, travels in TRAVELS.items():
            for travel in travels:
                value = limit(case, counted, travel)
                rows.append([name, counted, travel, f"{value:.9f}"])
                print(*rows[-1])
    # What a prototype had found.
    prototype = dict(zip([8.0, 10.0, 15.0, 20.0, 30.0], [5.90, 5.42, 4.63, 4.13, 3.52]))
    for name, counted, travel, value in rows:
        if name == "747" and counted == "command-from-rest":
            assert abs(float(value) - prototype[travel]) <= 0.005 + 1e-9, (travel, value)
    with open(OUT, "w", newline="") as out:
        writer = csv.writer(out, lineterminator="\n")
        writer.writerow(["case", "travel", "travel_deg", "iae_deg_s"])
        writer.writerows(rows)
    print("wrote", OUT.name, file=sys.stderr)


if __name__ == "__main__":
    main()
