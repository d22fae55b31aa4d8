"""Makes loop_stability.csv and neutral_gain.csv of fspid-sim: eigenvalues of the sampled closed loop, 40 digits."""
import warnings

import control
import numpy as np
from mpmath import mp, mpf

from fixture import write
from loop import B747, NAVION, SERVO_S, Controller, LinearPath, hold, simulate, with_servo

mp.dps = 40
PLANTS = {"b747-paper": B747, "navion-paper": NAVION}


def precise_hold(plant, dt):
    """Step matrices of plant and servo and the rows of theta and q."""
    f, g, outputs = with_servo(plant)
    n = len(g)
    block = mp.zeros(n + 1)
    for i in range(n):
        for j in range(n):
            block[i, j] = mpf(f[i, j]) * dt
        block[i, n] = mpf(g[i]) * dt
    block = mp.expm(block)
    return block[:n, :n], block[:n, n], mp.matrix(outputs[:2].tolist())


def closed_loop(plant, dt, kp, ki=0, kd=0, rate_gain=0):
    """x -> next x with r = 0, where x = (plant, servo[, I][, previous e]); e = -theta, D = (e - previous e) / dt.

    u = kp e + (I + ki e dt) + kd D - rate_gain q. I exists only with ki, the previous error only with kd.
    """
    phi, gamma, rows = precise_hold(plant, dt)
    n = phi.rows
    size = n + bool(ki) + bool(kd)
    error = mp.zeros(1, size)
    u = mp.zeros(1, size)
    for j in range(n):
        error[j] = -rows[0, j]
        u[j] = (kp + ki * dt + mpf(kd) / dt) * error[j] - rate_gain * rows[1, j]
    if ki:
        u[n] = 1
    if kd:
        u[size - 1] = -mpf(kd) / dt
    a = mp.zeros(size)
    for i in range(n):
        for j in range(size):
            a[i, j] = (phi[i, j] if j < n else 0) + gamma[i] * u[j]
    if ki:
        for j in range(size):
            a[n, j] = ki * dt * error[j]
        a[n, n] += 1
    if kd:
        for j in range(size):
            a[size - 1, j] = error[j]
    return a


def eigenvalues(a):
    return mp.eig(a, left=False, right=False)


def radius(*loop):
    return max(abs(z) for z in eigenvalues(closed_loop(*loop)))


def neutral(f, low, high):
    """Gain at which the largest eigenvalue leaves the unit circle; stable at `low`, unstable at `high`."""
    low, high = mpf(low), mpf(high)
    assert f(low) < 1 < f(high)
    for _ in range(100):
        middle = (low + high) / 2
        low, high = (middle, high) if f(middle) < 1 else (low, middle)
    return low


def neutral_rows():
    """Plant, period, gain and frequency of the neutral proportional loop."""
    for name, plant in PLANTS.items():
        for dt in (0.01, 0.05):
            kp = neutral(lambda k: radius(plant, dt, k), 2, 8)
            z = max(eigenvalues(closed_loop(plant, dt, kp)), key=abs)
            yield name, dt, kp, abs(mp.arg(z)) / dt


CASES = {  # kp, ki, kd, rate_gain
    "b747-paper": [
        (1, 0, 0, 0), (3.5287, 0, 0, 0.9144), (3.5314, 0, 0, 0.9316), (4.5, 0, 0, 0), (4.7, 0, 0, 0), (4.75, 0, 0, 0),
        (5, 0, 0, 0), (10, 0, 0, 0), (-0.1, 0, 0, 0), (-0.5, 0, 0, 0), (0, 0, 0, 0), (0, 0, 0, 0.9144),
        (2, 0.5, 1, 0), (5.63, 3.10, 2.15, 0), (3.25, 3.15, 2.86, 0), (1.33, 1.43, 1.22, 0),
        (2.28, 0.014, 3.08, 0.9144), (2, 0, 1, 0), (2, 0.5, 0, 0), (4, 3, 0, 0), (2, 0.5, 20, 0), (2, 0.5, -1, 0),
        (2, -0.05, 1, 0), (20, 5, 10, 0)],
    "navion-paper": [
        (0.1, 0, 0, 0), (1, 0, 0, 0), (3.8, 0, 0, 0), (3.9, 0, 0, 0), (4.005, 0, 0, 0), (4.1, 0, 0, 0), (10, 0, 0, 0),
        (-0.01, 0, 0, 0), (0, 0, 0, 0), (2, 0, 0, 0.3), (0.82, 0.43, 0.165, 0), (0.7019, 0.0739, 0.0554, 0),
        (0.5423, 0.0354, 0.177, 0), (0, 0.0739, 0.0554, 0), (0.7019, 5, 0.0554, 0), (3, 0.5, 1, 0), (0, 0.1, 0, 0),
        (0.7, 0.07, 5, 0), (0.7, -0.01, 0.05, 0)],
}


def stability_rows(found):
    for name, cases in CASES.items():
        near = {dt: kp for plant, dt, kp, _ in found if plant == name}
        for dt in (0.01, 0.05):
            edge = [(float(near[dt] * (1 + mpf(x))), 0, 0, 0) for x in ("-1e-3", "-1e-6", "1e-6", "1e-3")]
            for gains in edge + (cases if dt == 0.01 else cases[:4]):
                rho = radius(PLANTS[name], dt, *gains)
                yield name, dt, *map(float, gains), rho, "unstable" if rho > 1 - mpf(10) ** -25 else "stable"


def check_matrix():
    """The closed-loop matrix against the controller of the traces, from a disturbed start, r = 0."""
    worst = 0
    for plant, gains in ((B747, (2, 0.5, 1, 0.3)), (NAVION, (0.82, 0.43, 0.165, 0.1))):
        path, controller = LinearPath(plant, 0.01), Controller(*gains)
        path.state[:] = 0.1 * np.arange(1, len(path.state) + 1)
        a = np.array(closed_loop(plant, 0.01, *gains).tolist(), dtype=float)
        x = np.concatenate([path.state, [0.0, -path.read()[0]]])
        for row in simulate(path, controller, lambda k: 0.0, 0.01, 2.0):
            worst = max(worst, abs(row[2] - path.outputs[0] @ x[:-2]))
            x = a @ x
    print(f"  closed-loop matrix against the simulated loop, 2 s: differ by at most {worst:.1e} deg")


def handbook(found, rows):
    books = {"b747-paper": (4.750, 2.929), "navion-paper": (4.005, 6.327)}
    for name, plant in PLANTS.items():
        g = control.tf(plant.numerator, plant.denominator) * control.tf([plant.sign], [SERVO_S, 1])
        gain, _, frequency, _ = control.margin(g)
        print(f"  {name}, continuous: neutral gain {gain:.4f} at {frequency:.4f} rad/s (handbook {books[name]})")
        for dt in (0.01, 0.05):
            f, servo, outputs = with_servo(plant)
            phi, gamma = hold(f, servo, dt)
            sampled = control.ss(phi, gamma[:, None], outputs[:1], [[0]], dt)
            gain, _, frequency, _ = control.margin(sampled)
            _, _, ours, omega = next(row for row in found if row[0] == name and row[1] == dt)
            print(f"  {name}, T = {dt}: {mp.nstr(ours, 12)} at {mp.nstr(omega, 10)} rad/s; "
                  f"python-control differs by {abs(gain - float(ours)):.1e}, {abs(frequency - float(omega)):.1e}")
    ratio = 20 * mp.log10(next(row for row in found if row[:2] == ("b747-paper", 0.05))[2] / 2)
    print(f"  b747-paper, K = 2, T = 0.05: gain margin {mp.nstr(ratio, 5)} dB (handbook 5.64 dB)")
    double = max(abs(max(abs(np.linalg.eigvals(np.array(closed_loop(PLANTS[r[0]], *r[1:6]).tolist(), dtype=float))))
                     - float(r[6])) for r in rows)
    print(f"  eigenvalues in double precision differ from 40 digits by at most {double:.1e}")


if __name__ == "__main__":
    warnings.simplefilter("ignore")  # python-control announces which of its two methods it takes
    found = list(neutral_rows())
    rows = list(stability_rows(found))
    write("fspid-sim", "neutral_gain.csv", "plant,sample_period_s,neutral_kp,frequency_rad_s", found)
    write("fspid-sim", "loop_stability.csv",
          "plant,sample_period_s,kp,ki,kd,rate_gain,spectral_radius,verdict", rows)
    handbook(found, rows)
    check_matrix()
