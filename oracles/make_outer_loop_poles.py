#!/usr/bin/env python3
"""Closed-loop poles of a Navion with outer loops, from its derivatives, by equations written here and nowhere else.

Writes crates/fspid-sim/tests/data/outer_loop_poles.csv, which a test of the simulation compares with:

    python3 oracles/make_outer_loop_poles.py

Needs numpy and scipy. The aircraft pitches only: u, w, q, theta, h. Lift and drag are linear in the angle of attack, the air
and gravity are the same everywhere, and the thrust is in proportion to the throttle. The servo is a lag of 0.1 s, the engine
one of 1 s. Derivatives: Nelson (1998), appendix B, as they stand in the data of the aircraft.
"""

import numpy as np
import scipy
from scipy.linalg import expm

from fixture import CRATES

FOOT, SLUG, POUND = 0.3048, 14.593902937206364, 4.4482216152605
T = 0.02
G = 32.2 * FOOT
RHO = 0.002378 * SLUG / FOOT**3
V = 176.0 * FOOT
S, C = 184.0 * FOOT**2, 5.7 * FOOT
MASS = 2750.0 * POUND / G
IY = 3000.0 * SLUG * FOOT**2
QS = 0.5 * RHO * V * V * S
CL1 = MASS * G / QS
CD1 = 0.05
CLA, CDA, CMA = 4.44, 0.33, -0.683
CMAD, CLQ, CMQ, CLDE, CMDE = -4.36, 3.8, -9.96, 0.355, -0.923
THRUST = QS * CD1
SERVO_S, ENGINE_S = 0.1, 1.0


def rates(state, elevator, throttle):
    """d/dt of u, w, q, theta, h; elevator trailing edge down positive, throttle in parts of the trim's thrust."""
    u, w, q, theta, _ = state
    speed = np.sqrt(u * u + w * w)
    alpha = np.arctan2(w, u)
    scale = 0.5 * RHO * speed * speed * S
    lift = scale * (CL1 + CLA * alpha + C / (2 * speed) * CLQ * q + CLDE * elevator)
    drag = scale * (CD1 + CDA * alpha)
    x = -drag * np.cos(alpha) + lift * np.sin(alpha) + THRUST * throttle
    z = -lift * np.cos(alpha) - drag * np.sin(alpha)
    du = -q * w - G * np.sin(theta) + x / MASS
    dw = q * u + G * np.cos(theta) + z / MASS
    alpha_rate = (u * dw - w * du) / (speed * speed)
    pitch = CMA * alpha + C / (2 * speed) * (CMQ * q + CMAD * alpha_rate) + CMDE * elevator
    dq = scale * C * pitch / IY
    return np.array([du, dw, dq, q, u * np.sin(theta) - w * np.cos(theta)])


def jacobian():
    """Of the rates over state, elevator and throttle at the trim."""
    trim = np.array([V, 0.0, 0.0, 0.0, 0.0])
    assert np.abs(rates(trim, 0.0, 1.0)).max() < 1e-12
    columns = []
    for index in range(7):
        step = 1e-5
        def moved(by):
            state, inputs = trim.copy(), [0.0, 1.0]
            if index < 5:
                state[index] += by
            else:
                inputs[index - 5] += by
            return rates(state, *inputs)
        columns.append((moved(step) - moved(-step)) / (2 * step))
    return np.column_stack(columns)


def sampled():
    """One sample of u, w, q, theta, h, deflection (nose up) and power under held command and throttle."""
    j = jacobian()
    a = np.zeros((9, 9))
    a[:5, :5] = j[:, :5]
    a[:5, 5] = -j[:, 5]  # A positive deflection turns the nose up.
    a[:5, 6] = j[:, 6]
    a[5, 5], a[5, 7] = -1 / SERVO_S, 1 / SERVO_S
    a[6, 6], a[6, 8] = -1 / ENGINE_S, 1 / ENGINE_S
    step = expm(a * T)
    return step[:7, :7], step[:7, 7:]


class Pid:
    """Parallel PID: I + ki e T, derivative of the error behind a filter; memory: I, d, last error."""

    def __init__(self, kp, ki=0.0, kd=0.0, filter_s=0.0, weight=1.0):
        self.kp, self.ki, self.kd, self.filter_s, self.weight = kp, ki, kd, filter_s, weight

    def answer(self, memory, target, found):
        integral, derivative, last = memory
        error = target - found
        integral = integral + self.ki * error * T
        if self.kd:
            derivative = (self.filter_s * derivative + error - last) / (self.filter_s + T)
        command = self.kp * (self.weight * target - found) + integral + self.kd * derivative
        return command, [integral, derivative, error]

    def kept(self):
        return [self.ki != 0.0, self.kd != 0.0, self.kd != 0.0]


PITCH = Pid(0.82, 0.43, 0.165, 0.05)
VERTICAL_SPEED = Pid(0.008, 0.004)
ALTITUDE = Pid(0.15)
FLIGHT_PATH = Pid(0.6, 0.4)
SPEED_BY_THROTTLE = Pid(0.2, 0.02)
SPEED_BY_PITCH = Pid(0.012, 0.0015)
BEAM = Pid(0.0015, 0.00008)
ENERGY = Pid(3.0, 2.5, weight=0.0)
DISTRIBUTION = Pid(0.3, 0.45, weight=0.0)
ENERGY_GAINS = (0.12, 0.12)


def climb(x):
    """Vertical speed and airspeed from the trim."""
    u, w, _, theta = x[:4]
    return V * theta - w, u


def path_acceleration(x):
    """d/dt of u as it is now."""
    j = jacobian()
    full = np.concatenate([x[:5], [-x[5], x[6]]])
    return j[0] @ full


def outer(mode, x, memories):
    """Pitch set-point and throttle of a mode, and the memories of its controllers."""
    vertical, speed = climb(x)
    pitch = throttle = 0.0
    if mode in ("vertical speed", "altitude"):
        target, after = 0.0, []
        if mode == "altitude":
            target, kept = ALTITUDE.answer(memories[0], 0.0, x[4])
            after = [kept]
        pitch, kept = VERTICAL_SPEED.answer(memories[len(after)], target, vertical)
        after.append(kept)
        throttle, kept = SPEED_BY_THROTTLE.answer(memories[len(after)], 0.0, speed)
        after.append(kept)
    elif mode == "airspeed by pitch":
        pitch, kept = SPEED_BY_PITCH.answer(memories[0], 0.0, speed)
        pitch, after = -pitch, [kept]
    elif mode in ("flight path", "glide slope"):
        target, after = 0.0, []
        if mode == "glide slope":
            target, kept = BEAM.answer(memories[0], 0.0, x[4])
            after = [kept]
        pitch, kept = FLIGHT_PATH.answer(memories[len(after)], target, vertical / V)
        after.append(kept)
        throttle, kept = SPEED_BY_THROTTLE.answer(memories[len(after)], 0.0, speed)
        after.append(kept)
    else:
        up, push = -ENERGY_GAINS[0] * x[4] / V, -ENERGY_GAINS[1] * speed / 9.80665
        found, rate = vertical / V, path_acceleration(x) / 9.80665
        throttle, first = ENERGY.answer(memories[0], up + push, found + rate)
        pitch, second = DISTRIBUTION.answer(memories[1], up - push, found - rate)
        after = [first, second]
    return pitch, throttle, after


CONTROLLERS = {
    "vertical speed": [VERTICAL_SPEED, SPEED_BY_THROTTLE],
    "altitude": [ALTITUDE, VERTICAL_SPEED, SPEED_BY_THROTTLE],
    "airspeed by pitch": [SPEED_BY_PITCH],
    "flight path": [FLIGHT_PATH, SPEED_BY_THROTTLE],
    "glide slope": [BEAM, FLIGHT_PATH, SPEED_BY_THROTTLE],
    "total energy": [ENERGY, DISTRIBUTION],
}


def poles(mode):
    phi, gamma = sampled()
    controllers = [PITCH] + CONTROLLERS[mode]
    kept = [(n, i) for n, c in enumerate(controllers) for i in range(3) if c.kept()[i]]
    holds_altitude = mode in ("altitude", "glide slope", "total energy")
    plant = [i for i in range(7) if i != 4 or holds_altitude]
    size = len(plant) + len(kept)

    def step(values):
        x = np.zeros(7)
        x[plant] = values[: len(plant)]
        memories = [[0.0] * 3 for _ in controllers]
        for (n, i), value in zip(kept, values[len(plant) :]):
            memories[n][i] = value
        pitch, throttle, after = outer(mode, x, memories[1:])
        command, own = PITCH.answer(memories[0], pitch, x[3])
        x = phi @ x + gamma @ np.array([command, throttle])
        memories = [own] + after
        return np.concatenate([x[plant], [memories[n][i] for n, i in kept]])

    matrix = np.column_stack([step(column) for column in np.eye(size)])
    z = np.linalg.eigvals(matrix)
    z = z[np.abs(z) > 1e-9]
    return sorted(np.log(z) / T, key=lambda s: (s.real, s.imag))


def main():
    lines = [f"# by oracles/make_outer_loop_poles.py, numpy {np.__version__}, scipy {scipy.__version__}", "mode,re_1_s,im_1_s"]
    for mode in CONTROLLERS:
        for s in poles(mode):
            lines.append(f"{mode},{s.real:.10e},{s.imag:.10e}")
            if abs(s.imag) < 3:
                print(mode, f"{s.real:9.4f} {s.imag:9.4f}")
    target = CRATES / "fspid-sim/tests/data/outer_loop_poles.csv"
    target.write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
