"""Refutes margins of sampled loops with slow modes by evaluating them: python check_slow_loops.py loops.csv

The lines are those of `cargo run --release -p fspid-lti --example slow_loops`. A loop is its printed coefficients: the
zero-order hold is the sum of its modes, r (e^(p T) - 1) / (p (z - e^(p T))), with poles and residues of 60 digits, times
the controller and the dead time. Peaks are looked for on a logarithmic ladder with refinement, at all modes, at random
frequencies and at the answer's own; what counts is the value there at 60 digits. No peak may be below such a value, no
disk margin above, no limit of the gain beyond a real value of L, no phase margin above that of a gain of 1.

With --table it writes the loops with the peaks found, for slow_modes.csv of the tests.
"""
import cmath
import math
import sys
from random import Random

import flint
from flint import acb, acb_poly, arb, ctx

ctx.dps = 60
# Peaks are promised to 1e-9, and limits and phases are located from 64-bit matrices.
ALLOWED = 2e-9
ALLOWED_CROSSING = 1e-6


class Loop:
    def __init__(self, fields):
        numbers = [[float(word) for word in field.split()] for field in fields]
        self.num, self.den, self.gains = numbers[0], numbers[1], numbers[2]
        self.filter_s, self.delay, self.dt = numbers[3][0], int(numbers[4][0]), numbers[5][0]
        self.ms, self.mt, self.disk, self.limits, self.phase, self.brackets = numbers[6:12]
        self.exact = self.modes()
        self.plain = [(complex(z.mid()), complex(c.mid())) for z, c in self.exact]

    def modes(self):
        """Of each pole its e^(pT) - 1 and the factor over (z - e^(pT))."""
        den = [arb(c) for c in reversed(self.den)]
        poles = []
        while den[0] == 0:
            poles.append(acb(0))
            den = den[1:]
        rest = acb_poly(den)
        for root in rest.roots():
            # What isolates the roots has few digits; Newton's steps double them.
            root = acb(root.real.mid(), root.imag.mid())
            for _ in range(8):
                root -= rest(root) / rest.derivative()(root)
                root = acb(root.real.mid(), root.imag.mid())
            poles.append(root)
        full = acb_poly([arb(c) for c in reversed(self.den)])
        num, slope = acb_poly([arb(c) for c in reversed(self.num)]), full.derivative()
        out = []
        for p in poles:
            residue = num(p) / slope(p)
            change = (p * self.dt).exp() - 1
            out.append((change, residue * (self.dt if p == 0 else change / p)))
        self.sizes = [abs(complex(p.mid())) for p in poles if p != 0]
        return out

    def control(self, zeta):
        kp, ki, kd = self.gains
        z = zeta + 1
        return kp + ki * self.dt * z / zeta + kd * zeta / ((self.filter_s + self.dt) * zeta + self.dt)

    def at(self, omega):
        """L in 64-bit numbers."""
        half = 0.5 * omega * self.dt
        zeta = complex(-2 * math.sin(half) ** 2, 2 * math.sin(half) * math.cos(half))
        plant = sum(c / (zeta - change) for change, c in self.plain)
        return plant * self.control(zeta) * cmath.exp(-1j * self.delay * omega * self.dt)

    def at_exactly(self, omega):
        """L at 60 digits."""
        kp, ki, kd = (arb(gain) for gain in self.gains)
        dt, filter_s = arb(self.dt), arb(self.filter_s)
        angle = acb(0, arb(omega) * dt)
        z = angle.exp()
        zeta = z - 1
        plant = sum((c / (zeta - change) for change, c in self.exact), acb(0))
        control = kp + ki * dt * z / zeta + kd * zeta / ((filter_s + dt) * zeta + dt)
        return plant * control * (-self.delay * angle).exp()


PEAKS = {"Ms": lambda l: 1 / (1 + l), "Mt": lambda l: l / (1 + l), "disk": lambda l: 0.5 * (1 - l) / (1 + l)}


def refined(value, low, middle, high):
    """Top of a peak between two places, by golden sections in the logarithm."""
    low, middle, high = (math.log(place) for place in (low, middle, high))
    ratio = 0.5 * (math.sqrt(5) - 1)
    a, b = high - ratio * (high - low), low + ratio * (high - low)
    fa, fb = value(math.exp(a)), value(math.exp(b))
    for _ in range(60):
        if fa > fb:
            high, b, fb = b, a, fa
            a = high - ratio * (high - low)
            fa = value(math.exp(a))
        else:
            low, a, fa = a, b, fb
            b = low + ratio * (high - low)
            fb = value(math.exp(b))
        if high - low < 1e-9:
            break
    return math.exp(a if fa > fb else b)


def ladder(loop, random):
    nyquist = math.pi / loop.dt
    kp, ki, kd = loop.gains
    slow = min(loop.sizes + [abs(ki / kp)]) / 30
    count = int(14 * math.log10(nyquist / slow)) + 2
    places = [slow * (nyquist / slow) ** (i / (count - 1)) for i in range(count)]
    for size in loop.sizes:
        places += [size * (1 + x) for x in (-0.1, -0.03, -0.01, -0.003, -0.001, 0, 0.001, 0.003, 0.01, 0.03, 0.1)]
    places += [slow * (nyquist / slow) ** random.random() for _ in range(10)]
    # Nearly at rest, where an integral makes T = 1.
    places += [slow * 10.0**-k for k in range(1, 8)]
    return sorted(p for p in places if 0 < p <= nyquist)


def crossing(value, low, high):
    a = value(low)
    for _ in range(80):
        middle = math.sqrt(low * high)
        if (value(middle) > 0) == (a > 0):
            low = middle
        else:
            high = middle
    return math.sqrt(low * high)


def check(loop, random):
    """Complaints about one loop, and the peaks found."""
    complaints, found = [], {}
    places = ladder(loop, random)
    values = [loop.at(p) for p in places]
    for name, answer, map_of in [("Ms", loop.ms, PEAKS["Ms"]), ("Mt", loop.mt, PEAKS["Mt"]), ("disk", loop.disk, PEAKS["disk"])]:
        sizes = [abs(map_of(v)) for v in values]
        tops = [i for i in range(1, len(sizes) - 1) if sizes[i] >= sizes[i - 1] and sizes[i] >= sizes[i + 1]]
        tops = sorted(tops, key=lambda i: -sizes[i])[:3]
        candidates = [max(range(len(sizes)), key=sizes.__getitem__)]
        omegas = [places[candidates[0]], answer[1] or places[0]]
        omegas += [refined(lambda w: abs(map_of(loop.at(w))), places[i - 1], places[i], places[i + 1]) for i in tops]
        best = max((float(abs(map_of(loop.at_exactly(w))).mid()), w) for w in omegas)
        found[name] = best
        peak = (1 / answer[0] if answer[0] else math.inf) if name == "disk" else answer[0]
        if not peak >= best[0] * (1 - ALLOWED):
            complaints.append((name, peak / best[0] - 1, best[1]))
        if peak > best[0] * (1 + 1e-6):
            complaints.append((name + " too high", peak / best[0] - 1, best[1]))
    for i in range(len(places) - 1):
        a, b = values[i], values[i + 1]
        if (a.imag > 0) != (b.imag > 0):
            w = crossing(lambda w: loop.at(w).imag, places[i], places[i + 1])
            value = loop.at_exactly(w)
            size, real = float(abs(value).mid()), float(value.real.mid())
            if real < 0 and abs(float(value.imag.mid())) < 1e-9 * size and size > 1e-6:
                factor = 1 / size
                if loop.limits[0] * (1 + ALLOWED_CROSSING) < factor < loop.limits[1] * (1 - ALLOWED_CROSSING):
                    complaints.append(("limit", factor, w))
        if (abs(a) > 1) != (abs(b) > 1):
            w = crossing(lambda w: abs(loop.at(w)) - 1, places[i], places[i + 1])
            value = loop.at_exactly(w)
            phase = abs(cmath.phase(-complex(value.mid())))
            if abs(float(abs(value).mid()) - 1) < 1e-8 and not loop.phase[0] <= phase * (1 + ALLOWED_CROSSING) + 1e-9:
                complaints.append(("phase", loop.phase[0] - phase, w))
    return complaints, found


def main():
    random, table = Random(1), "--table" in sys.argv
    counted, refuted, loose, kinds = 0, 0, 0, {}
    for line in open(sys.argv[1]):
        if line.startswith("#"):
            print(line.strip())
            continue
        loop = Loop(line.strip().split(";"))
        counted += 1
        b = loop.brackets
        loose += any(b[i + 1] > b[i] * (1 + 1e-8) for i in (0, 2, 4))
        complaints, found = check(loop, random)
        if complaints:
            refuted += 1
            for name, by, _ in complaints:
                kinds.setdefault(name, []).append(by)
            if refuted <= 20 and not table:
                print(complaints, line.strip())
        if table:
            fields = line.strip().split(";")[:6]
            fields += [" ".join(repr(x) for x in found[name]) for name in ("Ms", "Mt", "disk")]
            print(";".join(fields))
    print(f"# {counted} loops, {refuted} refuted, {loose} with brackets that do not meet; python-flint {flint.__version__}, 60 digits")
    for name, by in kinds.items():
        print(f"# {name}: {len(by)}, worst {max(by, key=abs)}")


if __name__ == "__main__":
    main()
