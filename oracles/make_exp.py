"""Makes exp_f64.csv and exp_f32.csv: exp(x), correctly rounded, for arguments that are hard or typical."""
import math
import random
import struct

import numpy as np
from mpmath import mp, mpf

from fixture import write

mp.prec = 1300  # enough to tell exp(5e-324) from 1
HEADER = "kind,x_bits,x,exp_bits,exp,remainder_ulp"


class Format:
    """One IEEE 754 binary format."""

    def __init__(self, name, precision, lowest_exponent, overflow_exponent, code):
        self.name, self.precision, self.code = name, precision, code
        self.lowest, self.overflow = lowest_exponent, overflow_exponent

    def nearest(self, x):
        return float(np.float32(x)) if self.code == "f" else float(x)

    def beside(self, x, direction):
        kind = np.float32 if self.code == "f" else np.float64
        return float(np.nextafter(kind(x), kind(direction)))

    def bits(self, x):
        return struct.pack(">" + self.code, x).hex()

    def decimal(self, x):
        return str(np.float32(x)) if self.code == "f" else repr(x)

    def round(self, exact):
        """The nearest value, ties to even, and the exponent of its last place, in integer arithmetic."""
        _, man, exponent, bitcount = exact._mpf_
        last = max(exponent + bitcount - self.precision, self.lowest)
        shift = last - exponent
        if shift <= 0:
            units = int(man) << -shift
        else:
            units, rest = divmod(int(man), 1 << shift)
            half = 1 << (shift - 1)
            units += rest > half or (rest == half and units & 1)
        if units == 1 << self.precision:
            units, last = units >> 1, last + 1
        if units and units.bit_length() + last > self.overflow:
            return math.inf, last
        return math.ldexp(units, last), last


F64 = Format("f64", 53, -1074, 1024, "d")
F32 = Format("f32", 24, -149, 128, "f")


def row(fmt, kind, x):
    if abs(x) > 1000:
        result, remainder = (math.inf, "") if x > 0 else (0.0, "0.0")
    else:
        exact = mp.exp(mpf(x))
        result, last = fmt.round(exact)
        remainder = "" if math.isinf(result) else f"{float((exact - mpf(result)) / mpf(2) ** last):.6g}"
    return kind, fmt.bits(x), fmt.decimal(x), fmt.bits(result), fmt.decimal(result), remainder


def arguments(fmt, lowest, normal, highest, count, tiny_exponent):
    """Pairs (kind, x); `count` scales the number of rows, `tiny_exponent` is the least power of ten."""
    rng = random.Random(20260101)
    ln2 = mp.log(2)
    for _ in range(10 * count):
        yield "random", rng.uniform(lowest, highest)
    for i in range(8 * count):
        yield "dense", -40 + 41 * (i + rng.random()) / (8 * count)
    whole = range(-30, 31) if fmt is F64 else range(-15, 16)
    edges = list(whole) + [k / 2 for k in range(-61, 62, 2) if fmt is F64 or abs(k) < 31]
    edges += [rng.randrange(int(2 * lowest / 0.7), int(2 * highest / 0.7)) / 2 for _ in range(count // 2)]
    for half_steps in edges:
        x = fmt.nearest(mpf(half_steps) * ln2)
        for near in (fmt.beside(x, -math.inf), x, fmt.beside(x, math.inf)):
            yield "boundary", near
    for i in range(count + 1):
        power = tiny_exponent + (-8 - tiny_exponent) * i / count
        magnitude = rng.uniform(1, 9.99) * 10.0**power if i else 10.0**tiny_exponent
        yield "tiny", magnitude
        yield "tiny", -magnitude
    least = math.ldexp(1, fmt.lowest)
    for x in (0.0, -0.0, least, -least, 1e-8, -1e-8):
        yield "tiny", x
    unit = 2.0 ** (1 - fmt.precision)
    for factor in (0.25, 0.4999, 0.5, 0.5001, 0.75, 1, 1.5, 2):
        yield "near-one", factor * unit
        yield "near-one", -factor * unit
    for _ in range(2 * count):
        yield "subnormal", rng.uniform(lowest, normal)
    for _ in range(4 * count):
        z = fmt.nearest(rng.uniform(0, 14 if fmt is F64 else 10))
        yield "gaussian", -0.5 * z * z
    last_finite = fmt.nearest(mp.log(mpf(2) ** fmt.overflow))
    last_positive = fmt.nearest(mp.log(mpf(2) ** (fmt.lowest - 1)))
    for limit in (last_finite, last_positive, fmt.nearest(normal)):
        x = limit
        for _ in range(3):
            x = fmt.beside(x, -math.inf)
        for _ in range(7):
            yield "limit", x
            x = fmt.beside(x, math.inf)
    largest = 1.7976931348623157e308 if fmt is F64 else 3.4028234663852886e38
    for x in (highest, lowest, 1e3, -1e3, 1e30, -1e30, largest, -largest, math.inf, -math.inf, 1.0, -1.0):
        yield "limit", x


def make(fmt, *limits):
    rows = [row(fmt, kind, fmt.nearest(x)) for kind, x in arguments(fmt, *limits)]
    write("fspid-numeric", f"exp_{fmt.name}.csv", HEADER, rows)
    return rows


def check(fmt, rows, library):
    """The platform's own exp against the rounded one, in last places, where the result is normal."""
    worst = 0
    for kind, x_bits, _, bits, _, _ in rows:
        if kind in ("limit", "subnormal"):
            continue
        (x,) = struct.unpack(">" + fmt.code, bytes.fromhex(x_bits))
        ours = int(library(x), 16)
        worst = max(worst, abs(ours - int(bits, 16)))
    remainder = max(abs(float(r[5])) for r in rows if r[5])
    print(f"  {fmt.name}: largest |remainder| {remainder} ulp (must be <= 0.5); other exp differs by at most {worst} ulp")


if __name__ == "__main__":
    np.seterr(all="ignore")
    rows = make(F64, -745.2, -708.4, 709.8, 100, -300)
    check(F64, rows, lambda x: F64.bits(math.exp(x) if x < 709.78 else math.inf))
    rows = make(F32, -104.0, -87.4, 88.8, 50, -37)
    check(F32, rows, lambda x: F32.bits(float(np.float32(np.exp(np.float64(x))))))
