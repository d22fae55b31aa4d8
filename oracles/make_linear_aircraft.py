"""The linear Boeing 747 of Etkin and Reid after a step of its elevator, and what a turning air does to it.

Everything is in feet, pounds and seconds, as the book has it; the Rust code computes in metres and with polynomials, this with
the matrix exponential. Dimensional derivatives (Etkin and Reid, Dynamics of Flight, 3rd edition, section 6.2) are recalled; they
are trusted because they give back the matrix, digit by digit, and are asserted to.
"""
import numpy as np
from scipy.linalg import expm

from fixture import write

# 40 000 ft, Mach 0.8: speed in ft/s, weight in lbf, inertia in slug ft2.
SPEED, WEIGHT, GRAVITY, INERTIA = 774.0, 636_636.0, 32.2, 0.331e8
MASS = WEIGHT / GRAVITY
# By u, w, q and the rate of w: lbf and lbf ft by ft/s, rad/s, ft/s2.
X = {"u": -1.358e2, "w": 2.758e2}
Z = {"u": -1.778e3, "w": -6.188e3, "q": -1.017e5, "w_rate": 1.308e2}
M = {"u": 3.581e3, "w": -3.515e4, "q": -1.122e7, "w_rate": -3.826e3}

A = np.array([
    [-0.006868, 0.01395, 0.0, -32.2],
    [-0.09055, -0.3151, 773.98, 0.0],
    [0.0001187, -0.001026, -0.4285, 0.0],
    [0.0, 0.0, 1.0, 0.0],
])
B = np.array([-0.000187, -17.85, -1.158, 0.0])


def matrix():
    """The longitudinal matrix from derivatives; the rate of w is eliminated."""
    heave = np.array([Z["u"], Z["w"], Z["q"] + MASS * SPEED, 0.0]) / (MASS - Z["w_rate"])
    pitch = (np.array([M["u"], M["w"], M["q"], 0.0]) + M["w_rate"] * heave) / INERTIA
    return np.array([[X["u"] / MASS, X["w"] / MASS, 0.0, -GRAVITY], heave, pitch, [0.0, 0.0, 1.0, 0.0]])


def by_pitch_gust():
    """Rates of w and q by the pitch rate of air that is frozen: the gust's own rate of w is -V q."""
    heave = (SPEED * Z["w_rate"] - Z["q"]) / (MASS - Z["w_rate"])
    return heave, (SPEED * M["w_rate"] - M["q"] + M["w_rate"] * heave) / INERTIA


def main():
    # The derivatives have four digits, the inertia three.
    found = matrix()
    assert np.allclose(found, A, rtol=5e-4, atol=0), found - A
    print("worst entry of the matrix from derivatives, parts of it:", np.nanmax(np.abs(found[A != 0] / A[A != 0] - 1)))
    print("by the air's pitch rate: w %.4g ft/s2, q %.4g rad/s2 per rad/s" % by_pitch_gust())
    print("eigenvalues, rad/s:", np.linalg.eigvals(A))
    # One degree of elevator from t = 0 on; the input as a fifth state that stays.
    system = np.zeros((5, 5))
    system[:4, :4], system[:4, 4] = A, B
    times = np.arange(0, 201, 4) * 1.0
    states = [expm(system * time) @ np.array([0.0, 0, 0, 0, 1.0]) for time in times]
    rows = [(float(time), float(state[3]), float(state[2])) for time, state in zip(times, states)]
    write("fspid-study", "etkin_step.csv", "time_s,theta_deg,q_deg_s", rows)


if __name__ == "__main__":
    main()
