"""Makes six_dof/flight.csv of fspid-study: a flight of the Navion in six degrees of freedom, by equations of our own.

Bank, pitch and heading as Euler angles (the program has a quaternion), SI units, Runge and Kutta at 0.5 ms (the program
steps by 10 ms). Data: Nelson, Flight Stability and Automatic Control, 2nd edition, appendix B; equations of motion: Table 2
of the paper with r p in the pitching moment; air: the standard atmosphere's first layer. The scenario is
six_dof/flight.toml beside what is written.
"""

from math import atan2, cos, degrees, exp, hypot, log, radians, sin, sqrt, tan

from fixture import write

FOOT, POUND = 0.3048, 4.4482216152605
# The mass is that of the source's gravity; what pulls in the standard atmosphere is the standard's.
MASS = 2750.0 * POUND / (32.2 * FOOT)
G = 9.80665
SLUG_FT2 = POUND * FOOT
IX, IY, IZ = (number * SLUG_FT2 for number in (1048.0, 3000.0, 3530.0))
S, B, C = 184.0 * FOOT**2, 33.4 * FOOT, 5.7 * FOOT
U0 = 176.0 * FOOT
# The lift of the reference carries the weight there: 0.4058, which the book rounds to 0.41.
CL1 = 2750.0 / (0.5 * 0.002378 * 176.0**2 * 184.0)

SAMPLE, SUBSTEPS, SECONDS = 0.01, 20, 40
ENGINE_LAG, SERVO_LAG, BANK_TIME = 1.0, 0.1, 3.0
WIND_FROM, WIND_SPEED, WIND_UP = radians(60.0), 8.0, 0.5
WIND = (-WIND_SPEED * cos(WIND_FROM), -WIND_SPEED * sin(WIND_FROM), -WIND_UP)


def density(height):
    """The standard atmosphere below 11 km."""
    temperature = 288.15 - 0.0065 * height
    pressure = 101325.0 * exp(9.80665 / (287.05287 * 0.0065) * log(temperature / 288.15))
    return pressure / (287.05287 * temperature)


def rotation(phi, theta, psi):
    """Rows: north, east, down of the body's axes."""
    sf, cf, st, ct, sp, cp = sin(phi), cos(phi), sin(theta), cos(theta), sin(psi), cos(psi)
    return (
        (ct * cp, sf * st * cp - cf * sp, cf * st * cp + sf * sp),
        (ct * sp, sf * st * sp + cf * cp, cf * st * sp - sf * cp),
        (-st, sf * ct, cf * ct),
    )


def cross(a, b):
    """The vector product."""
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def rates(state, command, aileron, trim_elevator, throttle):
    """Rates of north, east, down, u, v, w, phi, theta, psi, p, q, r, elevator's deflection, power."""
    _, _, down, u, v, w, phi, theta, psi, p, q, r, deflection, power = state
    turn = rotation(phi, theta, psi)
    wind = tuple(sum(turn[row][axis] * WIND[row] for row in range(3)) for axis in range(3))
    ua, va, wa = u - wind[0], v - wind[1], w - wind[2]
    speed = sqrt(ua * ua + va * va + wa * wa)
    alpha, beta = atan2(wa, ua), atan2(va, hypot(ua, wa))
    pressure = 0.5 * density(-down) * speed * speed
    elevator = trim_elevator - deflection
    half_chord, half_span = 0.5 * C / speed, 0.5 * B / speed
    lift = CL1 + 4.44 * alpha + 3.8 * half_chord * q + 0.355 * elevator
    drag = 0.05 + 0.33 * alpha
    side = -0.564 * beta
    roll = -0.074 * beta + half_span * (-0.41 * p + 0.107 * r) - 0.134 * aileron
    yaw = 0.071 * beta + half_span * (-0.0575 * p - 0.125 * r) - 0.0035 * aileron
    force = (
        pressure * S * (lift * sin(alpha) - drag * cos(alpha)) + power * pressure * S * 0.05,
        pressure * S * side,
        -pressure * S * (lift * cos(alpha) + drag * sin(alpha)),
    )
    weight = tuple(G * turn[2][axis] for axis in range(3))
    omega = (p, q, r)
    turning = cross(omega, (u, v, w))
    moving = tuple(force[axis] / MASS + weight[axis] - turning[axis] for axis in range(3))
    # Through the air: the wind is the same everywhere, and its components in the body turn.
    through = tuple(a + b for a, b in zip(moving, cross(omega, wind)))
    alpha_rate = (ua * through[2] - wa * through[0]) / (ua * ua + wa * wa)
    pitch = -0.683 * alpha + half_chord * (-4.36 * alpha_rate - 9.96 * q) - 0.923 * elevator
    return (
        *(sum(turn[row][axis] * (u, v, w)[axis] for axis in range(3)) for row in range(3)),
        *moving,
        p + tan(theta) * (q * sin(phi) + r * cos(phi)),
        q * cos(phi) - r * sin(phi),
        (q * sin(phi) + r * cos(phi)) / cos(theta),
        (pressure * S * B * roll - (IZ - IY) * q * r) / IX,
        (pressure * S * C * pitch - (IX - IZ) * r * p) / IY,
        (pressure * S * B * yaw - (IY - IX) * p * q) / IZ,
        (command - deflection) / SERVO_LAG,
        (throttle - power) / ENGINE_LAG,
    )


def stepped(state, held, step):
    """One step of Runge and Kutta."""
    def moved(slopes, time):
        return tuple(value + time * slope for value, slope in zip(state, slopes))

    first = rates(state, *held)
    second = rates(moved(first, 0.5 * step), *held)
    third = rates(moved(second, 0.5 * step), *held)
    fourth = rates(moved(third, step), *held)
    return tuple(
        value + step / 6.0 * (a + 2.0 * b + 2.0 * c + d)
        for value, a, b, c, d in zip(state, first, second, third, fourth)
    )


def trim():
    """Angle of attack, elevator and throttle of level flight through the air, by elimination and iteration."""
    pressure = 0.5 * density(1000.0 * FOOT) * U0 * U0
    alpha = 0.0
    for _ in range(200):
        elevator = -0.683 * alpha / 0.923
        drag = 0.05 + 0.33 * alpha
        # Along the path: T cos(alpha) = D; across it: L + T sin(alpha) = W.
        lift = MASS * G / (pressure * S) - drag * tan(alpha)
        alpha = (lift - CL1 - 0.355 * elevator) / 4.44
    elevator = -0.683 * alpha / 0.923
    throttle = (0.05 + 0.33 * alpha) / cos(alpha) / 0.05
    return alpha, elevator, throttle


def main():
    """The flight, a row a second."""
    alpha, elevator, throttle_trim = trim()
    turn = rotation(0.0, alpha, 0.0)
    wind = tuple(sum(turn[row][axis] * WIND[row] for row in range(3)) for axis in range(3))
    state = (
        0.0, 0.0, -1000.0 * FOOT,
        U0 * cos(alpha) + wind[0], wind[1], U0 * sin(alpha) + wind[2],
        0.0, alpha, 0.0, 0.0, 0.0, 0.0, 0.0, throttle_trim,
    )
    gain = -(-0.41 * 0.5 * B / U0) / (-0.134 * BANK_TIME)
    limit, bank = radians(25.0), 0.0
    rows = []
    for k in range(SECONDS * 100 + 1):
        north, east, down, u, v, w, phi, theta, psi, _, q, _, _, power = state
        turn = rotation(phi, theta, psi)
        wind = tuple(sum(turn[row][axis] * WIND[row] for row in range(3)) for axis in range(3))
        speed = sqrt((u - wind[0]) ** 2 + (v - wind[1]) ** 2 + (w - wind[2]) ** 2)
        if k % 100 == 0:
            angles = (degrees(angle) for angle in (phi, theta, psi, q))
            rows.append((k // 100, north, east, -down, speed, *angles, power))
        # The leveller has heard of the bank that was asked for a sample before.
        aileron = -gain * (phi - bank)
        # At its first sample a loop takes over what is commanded.
        bank = min(max(1.2 * (radians(60.0) - psi), -limit), limit) if k else 0.0
        command = 1.5 * ((radians(2.0) if k >= 200 else 0.0) - (theta - alpha))
        throttle = min(max(throttle_trim + 0.1 * (U0 - speed), 0.0), 2.0)
        for _ in range(SUBSTEPS):
            state = stepped(state, (command, aileron, elevator, throttle), SAMPLE / SUBSTEPS)
    header = "time_s,north_m,east_m,altitude_m,airspeed_m_s,bank_deg,pitch_deg,heading_deg,pitch_rate_deg_s,power"
    write("fspid-study", "six_dof/flight.csv", header, rows)


main()
