"""Statistics of many runs: exact intervals of a probability, quantiles and their ranks, moments, correlation of ranks, shares.

Clopper-Pearson bounds solve the tail of the binomial distribution, added up term by term from its first probability, for its
logarithm in 60 digits; scipy is compared. Ranks of order statistics come from the same tails. Moments are exact fractions.
With `--simulate` it writes nothing and prints what the documentation says about the scatter of shares and the coverage of the
interval of a correlation.
"""
import sys
from fractions import Fraction
from random import Random

import mpmath as mp
import numpy as np
import scipy
from scipy import stats

from fixture import write

mp.mp.dps = 60
CRATE = "fspid-campaign"


def log_tail(count, runs, p):
    """ln P(X >= count) for X ~ Bin(runs, p), and its derivative by ln p; count >= 1, p below the middle."""
    first = mp.loggamma(runs + 1) - mp.loggamma(count + 1) - mp.loggamma(runs - count + 1)
    first += count * mp.log(p) + (runs - count) * mp.log1p(-p)
    odds, term, total = p / (1 - p), mp.mpf(1), mp.mpf(0)
    hits = count
    while term > total * mp.mpf(10) ** -50:
        total += term
        term *= odds * (runs - hits) / (hits + 1)
        hits += 1
    # d P / d p = count / p * P(X = count).
    return first + mp.log(total), count / total


def solve(count, runs, tail, start):
    """p with P(X >= count) = tail."""
    if count == runs:
        return mp.exp(mp.log(tail) / runs)
    log_p, wanted = mp.log(start), mp.log(tail)
    for _ in range(60):
        value, slope = log_tail(count, runs, mp.exp(log_p))
        step = (wanted - value) / slope
        log_p += step
        if abs(step) < mp.mpf(10) ** -30:
            return mp.exp(log_p)
    raise ArithmeticError((count, runs, tail))


def low_end(failures, runs, tail):
    if failures == 0:
        return mp.mpf(0)
    start = mp.mpf(float(stats.beta.ppf(float(tail), failures, runs - failures + 1)))
    return solve(failures, runs, tail, start)


def high_end(failures, runs, tail):
    """1 - q, q the chance not to fail at which at least runs - failures do not."""
    if failures == runs:
        return mp.mpf(1)
    start = mp.mpf(float(stats.beta.isf(float(tail), failures + 1, runs - failures)))
    return 1 - solve(runs - failures, runs, tail, 1 - start)


def binomial():
    rows, worst = [], (0.0,)
    for runs in (1, 2, 3, 5, 10, 15, 16, 17, 59, 100, 365, 1000, 3000, 10_000, 100_000, 1_000_000):
        some = {0, 1, 2, 3, 12, runs // 100, runs // 10, runs // 3, runs // 2, runs - 3, runs - 1, runs}
        for failures in sorted(k for k in some if 0 <= k <= runs):
            for confidence in (0.5, 0.9, 0.95, 0.999):
                rest = 1 - mp.mpf(confidence)
                bounds = [low_end(failures, runs, rest / 2), high_end(failures, runs, rest / 2),
                          high_end(failures, runs, rest), low_end(failures, runs, rest)]
                rows.append([failures, runs, confidence] + [float(bound) for bound in bounds])
                each = float(rest / 2)
                theirs = stats.beta.ppf(each, failures, runs - failures + 1), stats.beta.isf(each, failures + 1, runs - failures)
                for mine, other in zip(bounds, theirs):
                    # It has no beta distribution where an end is certain.
                    off = float(abs(other / mine - 1)) if 0 < mine < 1 else 0.0
                    worst = max(worst, (off, failures, runs, confidence))
    write(CRATE, "clopper_pearson.csv", "failures,runs,confidence,lower,upper,upper_bound,lower_bound", rows)
    print(f"  scipy {scipy.__version__}, beta distribution: worst difference {worst[0]:.1e} at {worst[1:]}")


def tail_at_least(count, runs, share):
    """P(X >= count), from the smaller of the two tails."""
    if count <= 0:
        return mp.mpf(1)
    if count > runs:
        return mp.mpf(0)
    if count > runs * share:
        return mp.exp(log_tail(count, runs, share)[0])
    return 1 - mp.exp(log_tail(runs - count + 1, runs, 1 - share)[0])


def ranks_of(runs, share, tail):
    """(largest r with P(X <= r - 1) <= tail, smallest r with P(X >= r) <= tail), r from 0 to runs + 1."""
    middle, spread = runs * float(share), 8 * (runs * float(share * (1 - share))) ** 0.5 + 8
    near = [r for r in range(max(0, int(middle - spread)), min(runs + 1, int(middle + spread)) + 1)]
    tails = {r: tail_at_least(r, runs, share) for r in near}
    assert all(abs(value / tail - 1) > 1e-9 and abs((1 - value) / tail - 1) > 1e-9 for value in tails.values())
    low = max((r for r in near if 1 - tails[r] <= tail), default=0)
    high = min(r for r in near if tails[r] <= tail)
    return low, high


def order_statistics():
    rows = []
    for runs in (1, 5, 6, 20, 58, 59, 100, 299, 1000, 30_000):
        for share in (0.001, 0.05, 0.25, 0.5, 0.9, 0.99):
            for confidence in (0.83, 0.95, 0.999):  # no tail is exactly what is allowed
                tail = (1 - mp.mpf(confidence)) / 2
                low, high = ranks_of(runs, mp.mpf(share), tail)
                theirs = int(stats.binom.ppf(float(tail), runs, share)), int(stats.binom.isf(float(tail), runs, share)) + 1
                assert (low, high) == theirs, (runs, share, confidence, low, high, theirs)
                rows.append([runs, share, confidence, low or "", high if high <= runs else ""])
    write(CRATE, "order_ranks.csv", "runs,share,confidence,lower_rank,upper_rank", rows)


def spaced(values):
    return " ".join(repr(float(value)) for value in values)


def columns():
    random = Random(7)
    yield [3.0]
    yield [1.0, 2.0]
    yield [random.gauss(0, 1) for _ in range(30)]
    yield [1e6 + random.random() for _ in range(101)]
    yield [float(random.randint(0, 5)) for _ in range(50)]
    yield [random.choice((-1, 1)) * 10.0 ** random.randint(-8, 8) for _ in range(64)]
    yield [random.expovariate(1.0) for _ in range(250)]


def root(fraction):
    return mp.sqrt(mp.mpf(fraction.numerator) / fraction.denominator)


def moments_and_quantiles():
    moments, quantiles = [], []
    for values in columns():
        exact = [Fraction(value) for value in values]
        mean = sum(exact) / len(exact)
        deviation = ""
        if len(values) > 1:
            deviation = float(root(sum((x - mean) ** 2 for x in exact) / (len(exact) - 1)))
        moments.append([spaced(values), float(mean), deviation])
        for share in (0.0, 0.013, 0.05, 0.25, 0.5, 0.75, 0.9, 0.999, 1.0):
            quantiles.append([len(moments) - 1, share, float(np.quantile(values, share, method="linear"))])
    write(CRATE, "moments.csv", "values,mean,standard_deviation", moments)
    write(CRATE, "quantiles.csv", "row_of_moments,share,quantile", quantiles)


def pairs():
    random = Random(11)
    for count, noise in ((4, 1.0), (10, 0.5), (60, 2.0), (300, 0.3)):
        x = [random.gauss(0, 1) for _ in range(count)]
        yield x, [value ** 3 + noise * random.gauss(0, 1) for value in x]
        yield [round(value) for value in x], [round(2 * value + noise * random.gauss(0, 1)) for value in x]
        yield x, [random.random() for _ in x]


def correlations():
    rows = []
    for x, y in pairs():
        r = float(stats.spearmanr(x, y).statistic)
        ends = ["", ""]
        if abs(r) < 1:
            half = mp.sqrt(2) * mp.erfinv(mp.mpf(95) / 100) * mp.sqrt((1 + mp.mpf(r) ** 2 / 2) / (len(x) - 3))
            ends = [float(mp.tanh(mp.atanh(r) - half)), float(mp.tanh(mp.atanh(r) + half))]
        rows.append([spaced(x), spaced(y), spaced(stats.rankdata(x)), r] + ends)
    write(CRATE, "spearman.csv", "x,y,ranks_of_x,coefficient,lower,upper", rows)


def kelley(groups):
    """Adjusted R squared of the analysis of variance with these groups."""
    every = np.concatenate(groups)
    inside = sum(((group - group.mean()) ** 2).sum() for group in groups)
    eta_squared = 1 - inside / ((every - every.mean()) ** 2).sum()
    return 1 - (1 - eta_squared) * (len(every) - 1) / (len(every) - len(groups))


def shares():
    generator, rows = np.random.default_rng(3), []
    for runs, curve in ((100, np.sin), (225, np.abs), (400, lambda x: x)):
        x = generator.uniform(-3, 3, runs)
        y = curve(x) + generator.normal(0, 0.7, runs)
        ordered = y[np.argsort(x)]
        classes = int(runs ** 0.5)
        rows.append([spaced(x), spaced(y), classes, float(kelley(np.split(ordered, classes)))])
    x = np.tile([0.0, 1.0, 2.5, 7.0], 20)
    y = x ** 2 / 9 + generator.normal(0, 3, 80)
    rows.append([spaced(x), spaced(y), 4, float(kelley([y[x == value] for value in np.unique(x)]))])
    write(CRATE, "shares.csv", "parameter,measure,classes,fraction", rows)


def share_and_error(x, y):
    """Kelley's share in classes of equal size, and the standard error from the influence of each run."""
    classes = int(len(x) ** 0.5)
    groups = np.array_split((y - y.mean())[np.argsort(x)], classes)
    share, variance = kelley(groups), y.var()
    influence = [(2 * g * g.mean() - g.mean() ** 2 - share * g ** 2) / variance for g in groups]
    return share, np.concatenate(influence).std() / len(x) ** 0.5


def ishigami(u):
    x = (2 * u - 1) * np.pi
    return np.sin(x[:, 0]) + 7 * np.sin(x[:, 1]) ** 2 + 0.1 * x[:, 2] ** 4 * np.sin(x[:, 0])


def simulate_shares():
    print("Ishigami, shares 0.3139, 0.4424, 0: mean, scatter, mean of the standard errors")
    generator = np.random.default_rng(1)
    samples = {
        "independent": lambda runs, seed: generator.random((runs, 3)),
        "Latin hypercube": lambda runs, seed: stats.qmc.LatinHypercube(3, rng=seed).random(runs),
        "Sobol sequence": lambda runs, seed: stats.qmc.Sobol(3, rng=seed).random(runs),
    }
    for name, draw in samples.items():
        for runs, campaigns in ((128, 1000), (1024, 1000), (8192, 200)):
            points = (draw(runs, seed) for seed in range(campaigns))
            found = np.array([[share_and_error(u[:, j], ishigami(u)) for j in range(3)] for u in points])
            print(f"  {name}, {runs} runs:", *(row.round(4) for row in
                  (found[:, :, 0].mean(0), found[:, :, 0].std(0), found[:, :, 1].mean(0))))


def simulate_correlations():
    print("Spearman's coefficient of normal pairs: how often the interval of 95 % holds it")
    generator = np.random.default_rng(2)
    for pairs_ in (10, 25, 100, 1000):
        for pearson in (0.0, 0.5, 0.9, 0.97):
            truth = np.arctanh(6 / np.pi * np.arcsin(pearson / 2))
            x, noise = generator.normal(size=(2, 10_000, pairs_))
            y = pearson * x + (1 - pearson ** 2) ** 0.5 * noise
            off = ((x.argsort(1).argsort(1) - y.argsort(1).argsort(1)) ** 2).sum(1)
            r = 1 - 6 * off / (pairs_ * (pairs_ ** 2 - 1))
            half = stats.norm.ppf(0.975) * np.sqrt((1 + r ** 2 / 2) / (pairs_ - 3))
            with np.errstate(divide="ignore"):  # a coefficient of 1 has no interval
                held = np.abs(np.arctanh(r) - truth) <= half
            print(f"  {pairs_} pairs, {np.tanh(truth):.3f}: {held.mean():.4f}")


if __name__ == "__main__":
    if "--simulate" in sys.argv[1:]:
        simulate_shares()
        simulate_correlations()
        sys.exit()
    moments_and_quantiles()
    correlations()
    shares()
    order_statistics()
    binomial()
