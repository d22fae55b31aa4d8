"""Check figures of crates/fspid-daveml/tests/data/toy.dml, with exact fractions where the model is rational.

The model is invented: no aircraft has these numbers. It uses each feature of the subset once. Interpolation is the sum
over the corners of a cell with products of weights, in fractions; the elementary functions are mpmath's with 40 digits.
Prints the <checkData> that the file holds, and compares with --check.
"""

import sys
from fractions import Fraction as F
from itertools import product
from pathlib import Path

from mpmath import mp, mpf

mp.dps = 40
FILE = Path(__file__).resolve().parents[1] / "crates/fspid-daveml/tests/data/toy.dml"

ALPHA = [F(-10), F(0), F(10), F(25)]
MACH = [F("0.2"), F("0.6"), F("0.9")]
FLAP = [F(0), F(30)]
LIFT = [F("-0.8"), F("0.1"), F("0.95"), F("1.3")]
DRAG = [F(n, 1000) for n in (45, 52, 80, 21, 23, 40, 60, 66, 95, 210, 230, 300)]
PITCH = [F(n, 1000) for n in (
    60, 40, 70, 45, 90, 50, 20, -5, 22, -10, 31, -20, -40, -70, -45, -81, -60, -99, -200, -260, -220, -290, -250, -333)]


def place(points, x, low, high):
    x = min(max(x, low), high) if low is not None else x
    cell = max(i for i in range(len(points) - 1) if i == 0 or x >= points[i])
    return cell, (x - points[cell]) / (points[cell + 1] - points[cell])


def read(values, axes, xs, holds):
    places = [place(points, x, *hold) for points, x, hold in zip(axes, xs, holds)]
    total = F(0)
    for corner in product((0, 1), repeat=len(axes)):
        weight, index = F(1), 0
        for (cell, part), bit, points in zip(places, corner, axes):
            weight *= part if bit else 1 - part
            index = index * len(points) + cell + bit
        total += weight * values[index]
    return total


def number(value):
    return mpf(value.numerator) / value.denominator if isinstance(value, F) else mpf(value)


def model(speed, alpha, mach, flap, gust):
    speed = max(speed, F(1))
    flap = min(max(flap, F(0)), F(40))
    held = (ALPHA[0], ALPHA[-1])
    lift = read(LIFT, [ALPHA], [alpha], [(None, None)])            # goes on straight at both ends
    drag = read(DRAG, [ALPHA, MACH], [alpha, mach], [held, (F("0.2"), F("0.9"))])
    pitch = read(PITCH, [ALPHA, MACH, FLAP], [alpha, mach, flap],
                 [held, (F("0.3"), F("0.8")), (F(0), F(30))])
    stall = F(1) if alpha > 15 or (alpha < -8 and not mach >= F("0.6")) else F(0)
    factor = F("0.5") if stall else (F(1) if mach <= F("0.5") else 1 - (mach - F("0.5")) ** 2)
    total = lift * factor
    induced = total * total / (F("3.25") * F(8))
    rate = number(pitch) * mp.exp(-abs(number(gust)) / 10) + mp.sqrt(number(speed)) / 1000
    path = mp.atan2(number(gust), number(speed)) * 180 / mp.pi
    trig = mp.sin(number(alpha) * mp.pi / 180) ** 2 + mp.cos(number(alpha) * mp.pi / 180) - mp.log(number(speed), 10)
    return {"stall": stall, "CL": total, "CD": drag + induced, "Cm": rate, "path": path, "trig": trig}


SHOTS = [
    ("between all breakpoints", 80, "3.7", "0.47", "12.5", "2"),
    ("on breakpoints", 100, "10", "0.6", "30", "0"),
    ("below every end", "0.5", "-14", "0.1", "-3", "-4"),
    ("above every end", 300, "31", "0.97", "55", "11"),
    ("case of low speed and small angle", 60, "-9", "0.25", "7", "-1.5"),
]
INPUTS = [("trueAirspeed", "m_s"), ("angleOfAttack", "deg"), ("mach", "nd"), ("flapDeflection", "deg"), ("gustVelocity", "m_s")]
OUTPUTS = [("liftCoefficient", "nd", "CL"), ("dragCoefficient", "nd", "CD"), ("pitchingMomentCoefficient", "nd", "Cm"),
           ("windAngle", "deg", "path"), ("trigonometry", "nd", "trig")]


def signal(name, units, value, tolerance=None):
    tol = f" <tol>{tolerance}</tol>" if tolerance else ""
    return (f"        <signal><signalName>{name}</signalName> <signalUnits>{units}</signalUnits> "
            f"<signalValue>{value}</signalValue>{tol}</signal>\n")


def shot(name, *inputs):
    answers = model(*[F(value) for value in inputs])
    text = f'    <staticShot name="{name}">\n      <checkInputs>\n'
    text += "".join(signal(n, u, v) for (n, u), v in zip(INPUTS, inputs))
    text += "      </checkInputs>\n      <internalValues>\n"
    text += f"        <signal><varID>stall</varID> <signalValue>{int(answers['stall'])}</signalValue></signal>\n"
    text += "      </internalValues>\n      <checkOutputs>\n"
    text += "".join(signal(n, u, mp.nstr(number(answers[k]), 17), "1e-13") for n, u, k in OUTPUTS)
    return text + "      </checkOutputs>\n    </staticShot>\n"


if __name__ == "__main__":
    written = "  <checkData>\n" + "".join(shot(*line) for line in SHOTS) + "  </checkData>\n"
    if "--check" in sys.argv:
        assert written in FILE.read_text(), "toy.dml holds other figures"
        print(f"{len(SHOTS)} check cases of toy.dml are as computed")
    else:
        print(written, end="")
