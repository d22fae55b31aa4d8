"""How often the interval of a rank correlation holds the truth: by what each pair does to the coefficient, by Bonett and Wright's
variance, and by the larger of both, which is told. Needs nothing but Python; takes two minutes.

    python oracles/coverage_of_ranks.py
"""
import math
import random


def ranks(values):
    order = sorted(range(len(values)), key=lambda at: values[at])
    found, begin = [0.0] * len(values), 0
    while begin < len(order):
        end = begin
        while end + 1 < len(order) and values[order[end + 1]] == values[order[begin]]:
            end += 1
        for at in range(begin, end + 1):
            found[order[at]] = (begin + end) / 2 + 1
        begin = end + 1
    return found


def sides(of, values):
    """For each pair the sum of the values of a higher rank less that of those of a lower one; the values' own sum is 0."""
    count = len(of)
    here, below, total = [0.0] * (2 * count + 1), [], 0.0
    for rank, value in zip(of, values):
        here[int(2 * rank)] += value
    for value in here:
        below.append(total)
        total += value
    return [total - 2 * below[int(2 * rank)] - here[int(2 * rank)] for rank in of]


def correlation(x, y):
    """The coefficient and both variances of its hyperbolic arctangent."""
    count, of_x, of_y = len(x), ranks(x), ranks(y)
    a = [rank - (count + 1) / 2 for rank in of_x]
    b = [rank - (count + 1) / 2 for rank in of_y]
    xx, yy, xy = (sum(p * q for p, q in zip(*two)) for two in ((a, a), (b, b), (a, b)))
    if xx * yy == 0:
        return None
    scale = math.sqrt(xx * yy)
    r = xy / scale
    if abs(r) >= 1:
        return None
    moved = zip(a, b, sides(of_x, b), sides(of_y, a), sides(of_x, a), sides(of_y, b))
    each = [(p * q + (s + t) / 2) / scale - r / 2 * ((p * p + u) / xx + (q * q + v) / yy) for p, q, s, t, u, v in moved]
    mean = sum(each) / count
    variance = sum((it - mean) ** 2 for it in each) * count / (count - 1)
    return r, variance / (1 - r * r) ** 2, (1 + r * r / 2) / (count - 3)


def normal(pearson):
    def pair():
        x = random.gauss(0, 1)
        return x, pearson * x + math.sqrt(1 - pearson**2) * random.gauss(0, 1)

    return pair


def parabola():
    x = random.uniform(-1, 1)
    return x, x * x + 0.05 * random.gauss(0, 1)


def yes_or_no():
    x = random.uniform(-1, 1)
    return x, float(abs(x) > 0.7)


def main():
    kinds = [(f"normal, {p}", normal(p), 6 / math.pi * math.asin(p / 2)) for p in (0.0, 0.5, 0.9)]
    kinds += [("parabola", parabola, 0.0), ("yes far from the middle", yes_or_no, 0.0)]
    for name, pair, truth in kinds:
        for pairs, samples in ((10, 2000), (25, 2000), (100, 2000), (1000, 300)):
            random.seed(1)
            found = [correlation(*zip(*(pair() for _ in range(pairs)))) for _ in range(samples)]
            found = [it for it in found if it]
            held = [0, 0, 0]
            for r, of_pairs, of_normal in found:
                off = abs(math.atanh(r) - math.atanh(truth))
                for at, variance in enumerate((of_pairs, of_normal, max(of_pairs, of_normal))):
                    held[at] += off <= 1.959964 * math.sqrt(variance)
            print(f"{name}, {pairs} pairs:", *(f"{100 * it / len(found):.1f} %" for it in held))


main()
