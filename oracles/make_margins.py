"""Makes margins.csv of fspid-lti: margins of sampled loops from polynomials in cos(omega T), 80 digits.

L = n/d with n and d from the state matrices exactly as stored (Faddeev and Le Verrier). On the unit circle
|n|^2, |d|^2 and Im(n conj d)/sin are polynomials in x = cos(omega T), so crossings and stationary points are all the real
roots in [-1, 1] of polynomials: nothing depends on a grid. Stability is decided by the roots of d + k n.
python-control, with its own eigenvalues and grids, is compared at the end.
"""
import warnings
from random import Random

import control
import numpy as np
from mpmath import mp, mpc, mpf

from fixture import CRATES
from loop import B747, NAVION, hold, with_servo

mp.dps = 80
REAL = mpf(10) ** -30  # imaginary part of a real root; double ones are known to 40 digits
FILE = CRATES / "fspid-lti" / "tests" / "data" / "margins.csv"

# ---- polynomials, lowest power first


def trimmed(p):
    size = max((abs(v) for v in p), default=mpf(0))
    while p and abs(p[-1]) <= size * mpf(10) ** -60:
        p = p[:-1]
    return p


def times(p, q):
    out = [mpf(0)] * (len(p) + len(q) - 1)
    for i, a in enumerate(p):
        for j, b in enumerate(q):
            out[i + j] += a * b
    return out


def plus(p, q, factor=1):
    size = max(len(p), len(q))
    at = lambda r, i: r[i] if i < len(r) else mpf(0)
    return [at(p, i) + factor * at(q, i) for i in range(size)]


def slope(p):
    return [i * v for i, v in enumerate(p)][1:]


def roots(p):
    p = trimmed(list(p))
    zeros = 0
    while p and p[0] == 0:
        p, zeros = p[1:], zeros + 1
    found = mp.polyroots(p[::-1], maxsteps=2000, extraprec=1500) if len(p) > 1 else []
    return list(found) + [mpf(0)] * zeros


def real_roots_inside(p):
    """Real roots in the open interval (-1, 1), rising."""
    found = (mpc(r) for r in roots(p))
    return sorted(r.real for r in found if abs(r.imag) < REAL and abs(r.real) < 1 - mpf(10) ** -40)


def chebyshev(kind, size):
    """T_k or U_k as polynomials in x."""
    found = [[mpf(1)], [mpf(0), mpf(kind)]]
    while len(found) < size:
        found.append(plus(times([mpf(0), mpf(2)], found[-1]), found[-2], -1))
    return found[:size]


def combined(coefficients, basis):
    out = [mpf(0)]
    for c, p in zip(coefficients, basis):
        out = plus(out, p, c)
    return out


def cross(p, q, shift):
    """Sum of p_i q_(i + shift)."""
    return sum((p[i] * q[i + shift] for i in range(len(p)) if 0 <= i + shift < len(q)), mpf(0))


def squared(p):
    """|p|^2 on the unit circle as a polynomial in x."""
    r = [cross(p, p, k) * (1 if k == 0 else 2) for k in range(len(p))]
    return combined(r, chebyshev(1, len(p)))


def real_part(p, q):
    """Re(p conj q) as a polynomial in x."""
    size = max(len(p), len(q))
    r = [cross(p, q, 0)] + [cross(p, q, k) + cross(p, q, -k) for k in range(1, size)]
    return combined(r, chebyshev(1, size))


def imaginary_part(p, q):
    """Im(p conj q) / sin as a polynomial in x."""
    size = max(len(p), len(q))
    r = [cross(p, q, -k) - cross(p, q, k) for k in range(1, size)]
    return combined(r, chebyshev(2, size - 1))


# ---- the loop


def quotient(a, b, c):
    """Numerator and denominator of c (zI - a)^-1 b."""
    order = a.rows
    m, d, n = mp.eye(order), [mpf(1)], []
    for k in range(1, order + 1):
        n.append((c * m * b)[0])
        am = a * m
        coefficient = -sum(am[i, i] for i in range(order)) / k
        d.append(coefficient)
        m = am + coefficient * mp.eye(order)
    # What the exact arithmetic would cancel is left with the size of the rounding.
    size = max(abs(v) for v in n)
    n = [v if abs(v) > size * mpf(10) ** -60 else mpf(0) for v in n]
    d = [v if abs(v) > mpf(10) ** -60 else mpf(0) for v in d]
    return trimmed(n[::-1]), d[::-1]


def value(p, z):
    return mp.polyval(p[::-1], z)


def circle(angle):
    return mp.expjpi(angle / mp.pi)


class Loop:
    def __init__(self, a, b, c, dt):
        self.dt = mpf(dt)
        self.n, self.d = quotient(mp.matrix(a.tolist()), mp.matrix(b.tolist()), mp.matrix([c.tolist()]))

    def radius(self, k=1):
        return max(abs(r) for r in roots(plus(self.d, self.n, k)))

    def unstable(self, k):
        return sum(abs(r) >= 1 for r in roots(plus(self.d, self.n, k)))

    def real_angles(self):
        """Without poles on the circle that rounding of the stored matrices has split: beyond a gain of 10^10."""
        found = sorted(mp.acos(v) for v in real_roots_inside(imaginary_part(self.n, self.d)))
        finite = lambda z: abs(value(self.n, z)) < mpf(10) ** 10 * abs(value(self.d, z))
        return [angle for angle in [mpf(0)] + found + [mp.pi] if finite(circle(angle))]

    def gain_limits(self):
        """Nearest factors below and above 1 with other counts of unstable poles on their far sides."""
        found = []
        for angle in self.real_angles():
            z = circle(angle)
            factor = mpc(-value(self.d, z) / value(self.n, z)).real
            if factor > mpf(10) ** -7:
                found.append((factor, angle))
        rank = lambda f: mpf(mp.nstr(f[0], 30))
        found.sort(key=lambda f: f[1])
        low = sorted((f for f in found if f[0] < 1), key=lambda f: -rank(f))
        high = sorted((f for f in found if f[0] > 1), key=rank)
        return self.first(low, mpf(1) / 2), self.first(high, mpf(2))

    def first(self, limits, step):
        """The lowest frequency, where several have the same factor."""
        for factor, angle in limits:
            others = [f for f, _ in limits if abs(f / factor - 1) > mpf(10) ** -25 and (f > factor) == (step > 1)]
            beyond = mp.sqrt(factor * min(others, key=lambda f: abs(mp.log(f / factor)))) if others else factor * step
            if self.unstable(beyond):
                return factor, angle / self.dt
        return None

    def crossovers(self):
        x = real_roots_inside(plus(squared(self.n), squared(self.d), -1))
        found, ends = [], [mp.pi] if abs(abs(value(self.n, -1)) - abs(value(self.d, -1))) < REAL else []
        for angle in sorted([mp.acos(v) for v in x] + ends):
            z = circle(angle)
            ratio = -value(self.n, z) / value(self.d, z)
            found.append((angle / self.dt, mp.arg(ratio)))
        return found

    def peak(self, centre):
        """Largest |T - centre| and its frequency, the lowest if there are several."""
        closed = plus(self.d, self.n)
        over, under = squared(plus(self.n, closed, -mpf(centre))), squared(closed)
        turning = plus(times(slope(over), under), times(over, slope(under)), -1)
        places = real_roots_inside(turning) + [mpf(-1), mpf(1)]
        at = lambda x: mp.polyval(over[::-1], x) / mp.polyval(under[::-1], x)
        best = max(at(x) for x in places)
        lowest = max(x for x in places if at(x) > best * (1 - REAL))
        return mp.sqrt(best), mp.acos(lowest) / self.dt

    def bandwidth(self):
        closed = plus(self.d, self.n)
        over, under = squared(self.n), squared(closed)
        level = mp.polyval(over[::-1], 1) / mp.polyval(under[::-1], 1) * mpf(10) ** (mpf(-3) / 10)
        x = real_roots_inside(plus(over, under, -level))
        return mp.acos(x[-1]) / self.dt if x and level > 0 else None


# ---- the cases


def joined(plant, dt, gains, rate_gain=0.0, filter_s=0.05, delay=0):
    """Broken at the command: plant and servo after a delay, then the controller on theta.

    v = kp y + I + ki dt y + kd D, D = (filter D_prev + y - y_prev) / (filter + dt), the rate loop closed inside.
    """
    f, g, outputs = with_servo(plant)
    phi, gamma = hold(f, g, dt)
    n, (kp, ki, kd) = len(gamma), gains
    phi = phi - rate_gain * np.outer(gamma, outputs[1])
    integral, slopes = int(ki != 0), 2 * int(kd != 0)
    order = n + integral + slopes + delay
    a, b, c = np.zeros((order, order)), np.zeros(order), np.zeros(order)
    a[:n, :n], y = phi, outputs[0]
    c[:n] = kp * y
    if integral:
        a[n, :n], a[n, n] = ki * dt * y, 1
        c[:n] += ki * dt * y
        c[n] = 1
    if slopes:
        i, share = n + integral, filter_s + dt
        a[i, :n], a[i, i], a[i, i + 1] = y / share, filter_s / share, -1 / share
        a[i + 1, :n] = y
        c[:n] += kd * y / share
        c[i], c[i + 1] = kd * filter_s / share, -kd / share
    if delay:
        first = order - delay
        a[:n, first] = gamma
        for k in range(first, order - 1):
            a[k, k + 1] = 1
        b[-1] = 1
    else:
        b[:n] = gamma
    return a, b, c


def modes(poles, b, c, random=None):
    """Real blocks for the poles given (a complex one stands for its pair), mixed by a random change of states."""
    size = sum(1 if np.isreal(p) else 2 for p in poles)
    a, i = np.zeros((size, size)), 0
    for p in poles:
        if np.isreal(p):
            a[i, i] = np.real(p)
            i += 1
        else:
            a[i:i + 2, i:i + 2] = [[np.real(p), np.imag(p)], [-np.imag(p), np.real(p)]]
            i += 2
    b, c = np.array(b, dtype=float), np.array(c, dtype=float)
    if random is None:
        return a, b, c
    t = np.eye(size) + np.array([[random.randint(-8, 8) / 16 for _ in range(size)] for _ in range(size)])
    return np.linalg.solve(t, a @ t), np.linalg.solve(t, b), c @ t


def companion(zeros, poles, gain):
    """Phase variables of gain times the product of (z - zero) over that of (z - pole)."""
    d, n = np.real(np.poly(poles)), gain * np.atleast_1d(np.real(np.poly(zeros)))
    order = len(d) - 1
    a, b, c = np.eye(order, k=1), np.zeros(order), np.zeros(order)
    a[-1] = -d[:0:-1]
    b[-1] = 1
    c[: len(n)] = n[::-1]
    return a, b, c


def paper_cases():
    for name, plant, gains in (("b747", B747, (1, 2, 4, 4.7)), ("navion", NAVION, (1, 3.9))):
        for k in gains:
            yield f"{name}-p{k}-10ms", joined(plant, 0.01, (k, 0, 0)), 0.01
    yield "b747-p2-20hz", joined(B747, 0.05, (2, 0, 0)), 0.05
    yield "b747-p2-10hz-delay", joined(B747, 0.1, (2, 0, 0), delay=1), 0.1
    yield "b747-p5-20hz", joined(B747, 0.05, (5, 0, 0)), 0.05
    yield "b747-p10-20hz", joined(B747, 0.05, (10, 0, 0)), 0.05
    yield "b747-p-rate", joined(B747, 0.01, (3.5287, 0, 0), rate_gain=0.9144), 0.01
    yield "b747-pid", joined(B747, 0.01, (1.33, 1.43, 1.22)), 0.01
    yield "b747-pid-1ms", joined(B747, 0.001, (1.33, 1.43, 1.22)), 0.001
    yield "b747-pid-delay3", joined(B747, 0.02, (1.33, 1.43, 1.22), delay=3), 0.02
    yield "b747-pid-delay14", joined(B747, 0.01, (1.33, 0.7, 0.6), delay=14), 0.01
    yield "b747-pi-hot", joined(B747, 0.05, (4, 3, 0)), 0.05
    yield "b747-pid-fig6", joined(B747, 0.01, (5.63, 3.10, 2.15)), 0.01
    yield "navion-pid", joined(NAVION, 0.01, (0.82, 0.43, 0.165)), 0.01
    yield "navion-pid-50ms", joined(NAVION, 0.05, (0.82, 0.43, 0.165), delay=1), 0.05
    yield "navion-pi", joined(NAVION, 0.02, (0.5, 0.4, 0)), 0.02
    yield "navion-fig8", joined(NAVION, 0.01, (0.5423, 0.0354, 0.177)), 0.01
    yield "navion-rate-delay", joined(NAVION, 0.02, (2, 0.5, 0.3), rate_gain=0.2, delay=2), 0.02
    f, g, h = np.array([[0, 1, 0], [0, 0, 1], [0, -2, -3.0]]), np.array([0, 0, 1.0]), np.array([2.0, 0, 0])
    a, b = hold(f, g, 0.05)
    yield "documented-50ms", (a, b, h), 0.05


def other_cases():
    yield "one-state", (np.array([[0.5]]), np.array([1.0]), np.array([0.75])), 1.0
    yield "one-state-at-its-limit", (np.array([[0.5]]), np.array([1.0]), np.array([1.5])), 1.0
    yield "pure-delay", companion([], [0, 0, 0], 0.5), 0.1
    yield "double-integrator-lead", companion([0.9], [1, 1, 0.3], 0.15), 0.1
    yield "triple-integrator-conditional", companion([0.95, 0.95], [1, 1, 1, 0.1], 0.45), 0.1
    yield "unstable-plant", companion([0.2], [1.15, 0.6], 0.6), 0.1
    yield "unstable-plant-delay", companion([0.3], [1.1, 0.5, 0, 0], 0.35), 0.1
    yield "unstable-pair", companion([0.7, 0.1], [1.02 + 0.2j, 1.02 - 0.2j, 0.4], 0.6), 0.1
    yield "pole-at-minus-one", companion([0.5, -0.9], [-1, 0.9, 0.4], 0.3), 0.1
    yield "lightly-damped", modes([0.8, 0.999 * np.exp(0.5j), 0.9995 * np.exp(1.9j)],
                                  [0.3, 0.01, 0.02, 0.004, 0.003], [0.5, 0.05, 0.02, 0.03, 0.01]), 0.02
    yield "negative-gain", companion([0.5], [0.9, 0.2], -0.04), 0.1
    yield "far-below-one", companion([0.1], [0.5, 0.2, 0.3], 0.01), 0.1
    yield "zero-outside", companion([1.5], [0.9, 0.7, 0.1], -0.02), 0.1
    yield "unit-gain-at-nyquist", (np.array([[-0.5]]), np.array([1.0]), np.array([-0.5])), 0.5


def random_cases():
    random = Random(5)
    for index in range(14):
        poles = []
        for _ in range(random.randint(1, 3)):
            poles.append(random.uniform(-0.5, 0.98))
        for _ in range(random.randint(0, 2)):
            poles.append(random.uniform(0.5, 0.995) * np.exp(1j * random.uniform(0.02, 2.5)))
        if index % 4 == 1:
            poles.append(1.0)
        size = sum(1 if np.isreal(p) else 2 for p in poles)
        b = [random.uniform(-1, 1) for _ in range(size)]
        c = [random.uniform(-1, 1) for _ in range(size)]
        a, b, c = modes(poles, b, c, random)
        yield f"random-{index}", (a, b, c * random.choice([0.03, 0.1, 0.3])), random.choice([0.01, 0.1, 1.0])


# ---- what is written

HEADER = """# Margins of sampled loops by oracles/make_margins.py; 80 digits, written to 17.
# name;period s;A by rows;b;c;stable;spectral radius;low limit and frequency;high limit and frequency;
# crossovers as frequency,phase margin rad;delay margin s;Ms and frequency;Mt and frequency;
# disk of skew 0 and frequency;disk of skew 0.5;disk of skew -1;bandwidth;real crossings;closed poles;zeros
# An empty field: there is no such value. Frequencies in rad/s. Unstable loops have poles and crossings only."""


def text(v):
    return mp.nstr(v, 17, strip_zeros=True, min_fixed=-5, max_fixed=17)


def pair(v):
    v = mpc(v)
    return text(v.real) + "," + text(v.imag)


def row(name, system, dt):
    a, b, c = system
    loop = Loop(a, b, c, dt)
    rho = loop.radius()
    stable = rho < 1 - mpf(10) ** -9
    numbers = lambda values: " ".join(repr(float(v)) for v in values)
    many = lambda values: " ".join(text(v) for v in values) if values is not None else ""
    crossovers = loop.crossovers()
    fields = [name, repr(dt), numbers(a.ravel()), numbers(b), numbers(c), str(int(stable)), text(rho)]
    margins = [""] * 8
    if stable:
        low, high = loop.gain_limits()
        lags = [(pm if pm >= 0 else pm + 2 * mp.pi) / w for w, pm in crossovers]
        s, t, disk = loop.peak(1), loop.peak(0), loop.peak(mpf(1) / 2)
        margins = [many(low), many(high), text(min(lags)) if lags else "", many(s), many(t),
                   many((1 / disk[0], disk[1])), text(1 / loop.peak(mpf(3) / 4)[0]), text(1 / loop.peak(0)[0])]
    bandwidth = loop.bandwidth() if stable else None
    fields += margins[:2] + [" ".join(text(w) + "," + text(pm) for w, pm in crossovers)] + margins[2:]
    fields += ["" if bandwidth is None else text(bandwidth), many([v / loop.dt for v in loop.real_angles()])]
    key = lambda r: (mpc(r).real, mpc(r).imag)
    fields += [" ".join(pair(r) for r in sorted(roots(plus(loop.d, loop.n)), key=key)),
               " ".join(pair(r) for r in sorted(roots(loop.n), key=key))]
    return ";".join(fields), loop, stable


def compare(name, system, dt, loop, worst):
    """python-control on a stable loop: its nearest crossings, and its disk from 4000 frequencies."""
    a, b, c = system
    open_loop = control.ss(a, b[:, None], c[None, :], [[0]], dt)
    gains, phases, *_ = control.stability_margins(open_loop, returnall=True)
    disk, *_ = control.disk_margins(open_loop, np.linspace(1e-4, 1, 4001)[:-1] * np.pi / dt, 0.0)
    inside = lambda limit: limit and 0 < limit[1] < mp.pi / loop.dt * (1 - mpf(10) ** -9)  # it leaves out both ends
    ours = [("gain", limit[0], gains) for limit in loop.gain_limits() if inside(limit)]
    ours += [("phase", mp.degrees(pm), phases) for _, pm in loop.crossovers()]
    ours += [("disk", 1 / loop.peak(mpf(1) / 2)[0], [disk])]
    for what, mine, theirs in ours:
        off = min((abs(float(mine) / float(other) - 1) for other in theirs), default=mp.inf)  # inf: none found
        worst.setdefault(what, []).append((float(off), name))


def main():
    rows, worst, stable_loops = [], {}, 0
    for cases in (paper_cases, other_cases, random_cases):
        for name, system, dt in cases():
            line, loop, stable = row(name, system, dt)
            rows.append(line)
            stable_loops += stable
            print(f"  {name}: order {len(system[1])}, {'stable' if stable else 'unstable'}", flush=True)
            if stable:
                compare(name, system, dt, loop, worst)
    FILE.write_text(HEADER + "\n" + "\n".join(rows) + "\n", newline="\n")
    print(f"fspid-lti/margins.csv: {len(rows)} loops, {stable_loops} stable, {FILE.stat().st_size} bytes")
    for what, found in worst.items():
        found.sort(reverse=True)
        shown = ", ".join(f"{name} {off:.1e}" for off, name in found[:4])
        print(f"  python-control {control.__version__}, {what}: median {found[len(found) // 2][0]:.1e}, worst {shown}")


if __name__ == "__main__":
    warnings.simplefilter("ignore")  # python-control announces which of its two methods it takes
    main()
