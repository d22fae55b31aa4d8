"""Makes supervisor.csv. `make_supervisor.py FILE` also compares with a reference file at range 5."""
import csv
import random
import sys

from fixture import write
from supervisor import GAINS, RULES, infer, strengths

COLUMNS = [f"d{gain}_{rule}" for rule in RULES for gain in GAINS]


def clamp(x, limit):
    return min(max(x, -limit), limit)


def points(half_range, randoms, stride):
    """Triples (kind, e, ec); `stride` thins the regular ones."""
    r = float(half_range)
    peaks = [r * (i - 3) / 3 for i in range(7)]
    centres = [r * (2 * i - 5) / 6 for i in range(6)]
    yield from [("peak", a, b) for a in peaks for b in peaks][::stride]
    yield from [("gap-centre", a, b) for a in centres for b in centres][::stride]
    outside = [(1.2, 0.0), (-1.2, 0.3), (0.1, 1.5), (1.1, -1.1), (-1.5, -1.5), (1.5, 1.4)]
    outside = [(r * a, r * b) for a, b in outside]
    yield from [("outside", a, b) for a, b in outside]
    yield from [("clamped", clamp(a, r), clamp(b, r)) for a, b in outside]
    yield from [("far", 2 * r, 0.0), ("far", -3.5 * r, 0.25 * r), ("far", 5 * r, -5 * r)]
    yield from [("tiny", r * x, -r * x) for x in (1e-12, 1e-9, 1e-6, 1e-3)]
    rng = random.Random(7)
    yield from [("random", rng.uniform(-r, r), rng.uniform(-r, r)) for _ in range(randoms)]


def outputs(e, ec, half_range, table):
    return [value for rule in RULES for value in infer(e, ec, half_range, table, rule)]


def rows():
    for table in ("printed", "mirrored"):
        for half_range, randoms, stride in ((5, 146, 1), (40, 37, 3)):
            for kind, e, ec in points(half_range, randoms, stride):
                yield [table, half_range, kind, e, ec, *outputs(e, ec, half_range, table)]


def compare(path):
    with open(path, newline="") as file:
        worst = dict.fromkeys(RULES, 0.0)
        for reference in csv.DictReader(file):
            ours = outputs(float(reference["e"]), float(reference["ec"]), 5, "printed")
            for name, value in zip(COLUMNS, ours):
                rule = name.split("_")[1]
                worst[rule] = max(worst[rule], abs(float(value - float(reference[name]))))
    print("  largest difference from the reference file:", {rule: f"{d:.1e}" for rule, d in worst.items()})


def closed_form(clip):
    """The handbook's closed form (control 3.4) in double precision, in spacings from the left peak."""
    area = moment = 0.0
    for i, (a, b) in enumerate(zip(clip, clip[1:])):
        h = min(a, b, 0.5)
        piece = (a - a * a / 2) + (b - b * b / 2) - (h - h * h)
        area += piece
        moment += i * piece + (a / 2 - a * a / 2 + a**3 / 6) + (b / 2 - b**3 / 6) - (h - h * h) / 2
    return moment / area


def check_closed_form(rows):
    worst = dict.fromkeys(("far", "other"), 0.0)
    for table, half_range, kind, e, ec, *values in rows:
        for clip, value in zip(strengths(e, ec, half_range, table), values):
            double = half_range / 3 * (closed_form([float(s) for s in clip]) - 3)
            key = "far" if kind == "far" else "other"
            worst[key] = max(worst[key], abs(double - float(value)) / half_range)
    print("  polygon against the closed form in doubles, shares of the range:", {k: f"{d:.1e}" for k, d in worst.items()})


if __name__ == "__main__":
    made = list(rows())
    write("fspid-fuzzy", "supervisor.csv", "table,range,kind,e,ec," + ",".join(COLUMNS), made)
    check_closed_form(made)
    spots = {(0, 0): (0.216500696638, 0, -1.666610153842), (5, 5): (-4.234089847555, 4.444274913314, 3.902748775224),
             (-5, -5): (4.444385106649, -4.444274913314, 1.020352034411), (5, -5): (-0.144014896878, 0, 3.188836309895),
             (1, -2): (0.995958158631, -0.608034418811, -0.642500373380),
             (-3.3, 0.7): (1.628328059925, -1.628352085306, -3.151303923865)}
    worst = max(abs(a - b) for point, book in spots.items() for a, b in zip(infer(*point), book))
    print(f"  six spot values of the handbook: largest difference {float(worst):.1e} (printed to 5e-13)")
    if len(sys.argv) > 1:
        compare(sys.argv[1])
