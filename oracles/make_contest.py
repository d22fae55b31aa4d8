"""Statistics of contests: signed ranks, the interval of Hodges and Lehmann, Student's tails, mean ratios over cases and designs.

The exact test of signed ranks is counted out by trying every combination of signs (up to 12 differences), with SciPy's as a
check where there are neither ties nor zeros; ends of the interval are found by asking the test itself which shifts it does not
refuse. Student's tails are SciPy's. With `--simulate` it writes nothing and prints how often the interval over cases and designs
holds the true difference.
"""
import itertools
import sys
from random import Random

import numpy as np
from scipy import stats

from fixture import write

CRATE = "fspid-tune"


def signed_rank_p(differences):
    """Two-sided p-value over all combinations of signs; zeros are ranked, then left out (Pratt)."""
    ranks = stats.rankdata(np.abs(differences))
    kept = [(d, r) for d, r in zip(differences, ranks) if d != 0]
    if not kept:
        return 1.0
    found = sum(r for d, r in kept if d > 0)
    sums = np.array([sum(s) for s in itertools.product(*[(0, r) for _, r in kept])])
    tail = min(np.mean(sums <= found + 1e-9), np.mean(sums >= found - 1e-9))
    return min(1.0, 2 * tail)


def interval(differences, confidence):
    """Shifts that the test without ties does not refuse; the ends are means of pairs."""
    count = len(differences)
    means = sorted((a + b) / 2 for i, a in enumerate(differences) for b in differences[i:])
    sums = [sum(s) for s in itertools.product(*[(0, r) for r in range(1, count + 1)])]
    rank = 0
    while np.mean(np.array(sums) <= rank) <= (1 - confidence) / 2 * (1 + 1e-12):
        rank += 1
    ends = (-np.inf, np.inf) if rank == 0 else (means[rank - 1], means[-rank])
    return float(np.median(means)), *ends


def signed_ranks(random):
    rows = []
    for count in (3, 5, 6, 8, 10, 12):
        for kind in ("plain", "ties"):
            values = [random.gauss(0.3, 1.0) for _ in range(count)]
            if kind == "ties":
                values = [round(2 * v) / 2 for v in values]
            p = signed_rank_p(values)
            if kind == "plain":
                theirs = stats.wilcoxon(values, method="exact").pvalue
                assert abs(p - theirs) < 1e-12, (values, p, theirs)
            for confidence in (0.8, 0.95):
                rows.append((confidence, " ".join(repr(v) for v in values), p, *interval(values, confidence)))
    return rows


def two_way(mine, theirs, confidence):
    """Estimate, error, degrees of freedom, p and interval; rows are designs, columns cases."""
    mine, theirs = np.array(mine), np.array(theirs)
    differences = mine.mean(axis=0) - theirs.mean(axis=0)
    parts = [(differences.var(ddof=1), differences.size)]
    for values in (mine.mean(axis=1), theirs.mean(axis=1)):
        if values.size > 1:
            parts.append((values.var(ddof=1), values.size))
    shares = [(variance / n, n - 1) for variance, n in parts]
    whole = sum(share for share, _ in shares)
    freedom = whole**2 / sum(share**2 / f for share, f in shares)
    estimate, error = differences.mean(), np.sqrt(whole)
    p = 2 * stats.t.sf(abs(estimate) / error, freedom)
    reach = error * stats.t.isf((1 - confidence) / 2, freedom)
    return estimate, error, freedom, p, estimate - reach, estimate + reach


def flat(rows):
    return "|".join(" ".join(repr(float(v)) for v in row) for row in rows)


def drawn(generator, designs, cases, spreads, difference):
    """Logarithms of two controllers: a part of the case, of the design, of the pair of controller and case, of the flight."""
    case, of_pair, of_design, of_flight = spreads
    level = generator.normal(0, case, cases)
    out = []
    for count, shift in zip(designs, (difference, 0.0)):
        pair = generator.normal(0, of_pair, cases)
        design = generator.normal(0, of_design, (count, 1)) if count > 1 else np.zeros((1, 1))
        out.append(shift + level + pair + design + generator.normal(0, of_flight, (count, cases)))
    return out


def two_ways():
    generator = np.random.default_rng(7)
    rows = []
    for designs in ((1, 1), (1, 5), (5, 5), (3, 8)):
        for cases in (3, 8, 30):
            mine, theirs = drawn(generator, designs, cases, (0.5, 0.1, 0.05, 0.03), 0.1)
            for confidence in (0.95, 0.995):
                rows.append((flat(mine), flat(theirs), confidence, *two_way(mine, theirs, confidence)))
    return rows


def tails():
    rows = []
    for freedom in (1.0, 2.0, 3.7, 10.0, 48.3, 1000.0):
        for t in (0.0, 0.01, 0.5, 1.0, 2.0, 4.0, 12.0, 60.0):
            rows.append((t, freedom, 2 * stats.t.sf(t, freedom)))
    return rows


def simulate():
    generator = np.random.default_rng(1)
    trials = 4000
    for designs in ((1, 5), (5, 5), (10, 10)):
        for cases in (6, 12, 30):
            for name, spreads in (
                ("cases alone", (0.5, 0.1, 0.0, 0.0)),
                ("seeds alone", (0.5, 0.0, 0.1, 0.0)),
                ("both", (0.5, 0.1, 0.1, 0.05)),
                ("flights alone", (0.5, 0.0, 0.0, 0.1)),
            ):
                held = 0
                for _ in range(trials):
                    found = two_way(*drawn(generator, designs, cases, spreads, 0.1), 0.95)
                    held += found[4] <= 0.1 <= found[5]
                print(f"designs {designs}, {cases} cases, {name}: {100 * held / trials:.1f} %")


if __name__ == "__main__":
    if "--simulate" in sys.argv:
        simulate()
    else:
        write(CRATE, "signed_rank.csv", "confidence,differences,p,estimate,lower,upper", signed_ranks(Random(3)))
        write(CRATE, "student.csv", "t,freedom,two_sided", tails())
        write(CRATE, "two_way.csv", "mine,theirs,confidence,estimate,error,freedom,p,lower,upper", two_ways())
