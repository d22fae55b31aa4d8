"""The sampled pitch loop from its definitions: plant, servo, controllers, trace. Angles in degrees.

At sample k: theta_k and q_k are read, u_k is computed and held until sample k + 1; plant and servo are advanced by
the matrix exponential. A positive command is nose up; `sign` turns it into the plant's own elevator.
"""
from dataclasses import dataclass, field

import numpy as np
from mpmath import mp, mpf
from scipy.linalg import expm

from supervisor import infer

SERVO_S = 0.1


@dataclass(frozen=True)
class Plant:
    """theta / elevator, coefficients from the highest power down; sign = elevator per nose-up command."""

    numerator: tuple
    denominator: tuple
    sign: int


B747 = Plant((-1.69144, -0.84341, -0.0099096), (1, 1.17103, 1.55405, 0.012538, 0.0072771), -1)
NAVION = Plant((11.7304, 22.578), (1, 4.9676, 12.941, 0), +1)


def realise(plant):
    """Phase-variable form (A, B, C) of theta / elevator."""
    order = len(plant.denominator) - 1
    a = np.eye(order, k=1)
    a[-1] = [-c for c in plant.denominator[:0:-1]]
    b = np.zeros(order)
    b[-1] = 1
    c = np.zeros(order)
    c[: len(plant.numerator)] = plant.numerator[::-1]
    assert c @ b == 0, "theta' must not depend on the elevator directly"
    return a, b, c


def with_servo(plant):
    """Plant and servo: state (x, servo), input command; rows for theta, q and elevator."""
    a, b, c = realise(plant)
    n = len(b)
    f = np.zeros((n + 1, n + 1))
    f[:n, :n], f[:n, n], f[n, n] = a, b * plant.sign, -1 / SERVO_S
    g = np.zeros(n + 1)
    g[n] = 1 / SERVO_S
    outputs = np.zeros((3, n + 1))
    outputs[0, :n], outputs[1, :n], outputs[2, n] = c, c @ a, plant.sign
    return f, g, outputs


def hold(f, g, dt):
    """Exact step for an input held over dt."""
    n = len(g)
    block = np.zeros((n + 1, n + 1))
    block[:n, :n], block[:n, n] = f * dt, g * dt
    block = expm(block)
    return block[:n, :n], block[:n, n]


class LinearPath:
    """Servo without limits, then the plant."""

    def __init__(self, plant, dt):
        f, g, self.outputs = with_servo(plant)
        self.phi, self.gamma = hold(f, g, dt)
        self.state = np.zeros(len(g))

    def read(self):
        return self.outputs @ self.state

    def advance(self, command):
        self.state = self.phi @ self.state + self.gamma * command


class PrecisePath(LinearPath):
    """The same with 40 digits, to measure the round-off of the double-precision traces."""

    def __init__(self, plant, dt):
        f, g, self.outputs = with_servo(plant)
        n = len(g)
        block = mp.zeros(n + 1)
        for i in range(n):
            for j in range(n):
                block[i, j] = mpf(f[i, j]) * dt
            block[i, n] = mpf(g[i]) * dt
        block = np.array(mp.expm(block).tolist(), dtype=object)
        self.phi, self.gamma = block[:n, :n], block[:n, n]
        self.state = np.array([mpf(0)] * n, dtype=object)


class LimitedPath:
    """Servo with position and rate limit: each hold is split where the rate leaves its limit, each part is exact."""

    def __init__(self, plant, dt, position, rate):
        self.f, self.g, self.outputs = with_servo(plant)
        self.dt, self.position, self.rate = dt, position, rate
        self.state = np.zeros(len(self.g))

    def read(self):
        return self.outputs @ self.state

    def advance(self, command):
        wanted = min(max(command, -self.position), self.position)
        gap = wanted - self.state[-1]
        # The rate stays at its limit until the gap has shrunk to rate * tau.
        limited_s = min(max(abs(gap) - self.rate * SERVO_S, 0) / self.rate, self.dt)
        if limited_s > 0:
            ramp, slope = self.f.copy(), np.zeros(len(self.g))
            ramp[-1], slope[-1] = 0, np.copysign(self.rate, gap)
            phi, gamma = hold(ramp, slope, limited_s)
            self.state = phi @ self.state + gamma
        if limited_s < self.dt:
            phi, gamma = hold(self.f, self.g, self.dt - limited_s)
            self.state = phi @ self.state + gamma * wanted


@dataclass
class Supervisor:
    """e and its change, scaled and clamped, to increments of the three gains."""

    half_range: float = 5.0
    table: str = "printed"
    error_sign: int = +1  # -1: measurement minus set-point
    error_scale: float = 1.0
    change: str = "rate"
    change_scale: float = 0.2
    output_scale: tuple = (0.2, 0.05, 0.1)
    number: type = float

    def increments(self, error, delta, dt):
        change = delta / dt if self.change == "rate" else delta
        inputs = (self.error_sign * self.error_scale * error, self.error_sign * self.change_scale * change)
        e, ec = (min(max(x, -self.half_range), self.half_range) for x in inputs)
        deltas = infer(e, ec, self.half_range, self.table)
        return [scale * self.number(d) for scale, d in zip(self.output_scale, deltas)]


@dataclass
class Controller:
    """P, PID and FSPID in one: what is not used stays at its default."""

    kp: float
    ki: float = 0.0
    kd: float = 0.0
    rate_gain: float = 0.0
    setpoint_weight: float = 1.0
    derivative_on: str = "error"
    filter_s: float = 0.0
    limit: float = float("inf")
    tracking_s: float = 0.0  # 0: no anti-windup
    literal_integral: bool = False
    supervisor: Supervisor | None = None
    law: str = "memoryless"
    gain_floor: float | None = None
    state: dict = field(default_factory=dict)

    def gains(self, error, delta, dt):
        nominal = [self.kp, self.ki, self.kd]
        if self.supervisor is None:
            return nominal
        increments = self.supervisor.increments(error, delta, dt)
        if self.law == "memoryless":
            gains = [k + d for k, d in zip(nominal, increments)]
        else:
            gains = [g + d * dt for g, d in zip(self.state.get("gains", nominal), increments)]
        if self.gain_floor is not None:
            gains = [max(g, self.gain_floor) for g in gains]
        self.state["gains"] = gains
        return gains

    def step(self, r, y, q, dt):
        """Command and gains of this sample."""
        s = self.state
        e = r - y
        kp, ki, kd = self.gains(e, e - s.get("e", e), dt)

        s["sum"] = s.get("sum", 0.0) + e
        s["integral"] = ki * s["sum"] * dt if self.literal_integral else s.get("integral", 0.0) + ki * e * dt

        x = e if self.derivative_on == "error" else -y
        if "x" in s:
            s["d"] = (self.filter_s * s["d"] + (x - s["x"])) / (self.filter_s + dt)
        else:
            s["d"] = 0.0
        s["x"], s["e"] = x, e

        unlimited = kp * (self.setpoint_weight * r - y) + s["integral"] + kd * s["d"] - self.rate_gain * q
        u = min(max(unlimited, -self.limit), self.limit)
        if self.tracking_s:
            s["integral"] += (u - unlimited) * dt / self.tracking_s
        return u, (kp, ki, kd)


def step_command(amplitude):
    return lambda k: amplitude


def square_command(amplitude, half_period_samples):
    """Bipolar: + first, then -."""
    return lambda k: amplitude if (k // half_period_samples) % 2 == 0 else -amplitude


def simulate(path, controller, setpoint, dt, duration):
    """Rows (time, r, theta, q, command, elevator, kp, ki, kd), the first at t = 0, the last at the end."""
    rows = []
    for k in range(round(duration / dt) + 1):
        theta, q, elevator = path.read()
        r = setpoint(k)
        u, gains = controller.step(r, theta, q, dt)
        rows.append((k * dt, r, theta, q, u, elevator, *gains))
        path.advance(u)
    return rows
