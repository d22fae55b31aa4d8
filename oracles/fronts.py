"""How often the band of a front leaves zero between two controllers that are alike; it should in 5 % of fronts.

Written from the equations of docs/decisions/0040-fronts.md. It writes no fixture, and prints for each kind of scatter, in per cent:
the band until 2026-11-28, a bootstrap of cases and seeds (where all places move as one), and the one since then. What cases and
seeds scatter is the same along the front, or drawn for each of so many rungs; between rungs it is straight.
"""
import numpy as np
from scipy import stats

PLACES, DRAWS, TRIALS = 9, 2000, 1000


def along(generator, shape, size, rungs):
    """Normal numbers of a shape, at each place; one rung is the same number everywhere."""
    if rungs == 1:
        return np.repeat(generator.normal(0, size, (*shape, 1)), PLACES, axis=-1)
    at = np.linspace(0, rungs - 1, PLACES)
    weights = np.maximum(0, 1 - np.abs(at[None, :] - np.arange(rungs)[:, None]))
    return generator.normal(0, size, (*shape, rungs)) @ weights


def drawn(generator, cases, seeds, spreads, rungs):
    """Logarithms of the errors of two, by seed, case and place."""
    of_case, of_seed, of_flight = spreads
    out = [along(generator, (seeds, 1), of_seed, rungs) + along(generator, (seeds, cases), of_flight, rungs) for _ in "ab"]
    out[0] = out[0] + along(generator, (1, cases), of_case, rungs)
    return out


def bootstrap(generator, a, b):
    """As it was: cases and seeds drawn with replacement, each on its own; the largest standardised deviation."""
    seeds, cases, _ = a.shape
    case = generator.integers(0, cases, (DRAWS, cases))
    both = [values.mean(0)[case].mean(1) for values in (a, b)]
    for values, sign in ((a, 1), (b, -1)):
        seed = generator.integers(0, seeds, (DRAWS, seeds))
        off = values.mean(1) - values.mean((0, 1))
        both[0] = both[0] + sign * off[seed].mean(1)
    found, middle = both[0] - both[1], a.mean((0, 1)) - b.mean((0, 1))
    deviation = np.sqrt(((found - middle) ** 2).mean(0))
    largest = np.sort((np.abs(found - middle) / deviation).max(1))
    return (np.abs(middle) > largest[-1 - int(0.05 * DRAWS)] * deviation).any()


def student(generator, a, b):
    """As it is: the contest's error at each place, widened by the largest of Student's t along the front."""
    parts = [a.mean(0) - b.mean(0), a.mean(1), b.mean(1)]
    shares = [part.var(0, ddof=1) / len(part) for part in parts]
    error = np.sqrt(sum(shares))
    freedom = (error**4 / sum(share**2 / (len(part) - 1) for share, part in zip(shares, parts))).min()
    moved = sum(
        generator.normal(0, 1, (DRAWS, len(part))) @ (part - part.mean(0)) / np.sqrt(len(part) * (len(part) - 1.0))
        for part in parts
    )
    t = np.abs(moved / error) / np.sqrt(generator.chisquare(freedom, (DRAWS, 1)) / freedom)
    quantile = np.sort(t.max(1))[-1 - int(0.05 * DRAWS)]
    chance = np.clip((t > quantile).mean(), 0.05 / PLACES, 0.05)
    return (np.abs(parts[0].mean(0)) > stats.t.isf(chance / 2, freedom) * error).any()


if __name__ == "__main__":
    generator = np.random.default_rng(1)
    for seeds in (2, 3, 5):
        for cases in (6, 12, 50):
            for name, spreads in (("cases", (0.05, 0.01, 0.005)), ("seeds", (0.01, 0.05, 0.005)), ("both", (0.05, 0.05, 0.005))):
                for rungs in (1, 5):
                    told = np.zeros(2)
                    for _ in range(TRIALS):
                        a, b = drawn(generator, cases, seeds, spreads, rungs)
                        told += [bootstrap(generator, a, b), seeds > 2 and student(generator, a, b)]
                    before, now = 100 * told / TRIALS
                    now = f"{now:.1f} %" if seeds > 2 else "no band"
                    print(f"{seeds} seeds, {cases} cases, {name} scatter, {rungs} rungs: {before:.1f} %, now {now}", flush=True)
