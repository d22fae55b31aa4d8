"""Makes step_metrics.csv, integrals.csv and the sampled signals step_*.csv of fspid-study.

y(t) comes from partial fractions with 40 digits; crossings and extremes are roots, not grid points.
"""
from mpmath import mp, mpf

from fixture import write

mp.dps = 40
METRICS = ("rise_time_s", "settling_time_s", "settling_min", "settling_max", "overshoot_pct", "undershoot_pct", "peak",
           "peak_time_s")


def transfer_step(numerator, denominator):
    """Unit step response and slope of a transfer function with distinct poles, and its final value."""
    poles = mp.polyroots([mpf(c) for c in denominator], maxsteps=200, extraprec=200)
    slope = [c * (len(denominator) - 1 - i) for i, c in enumerate(denominator[:-1])]
    residues = [mp.polyval(numerator, p) / (p * mp.polyval(slope, p)) for p in poles]
    final = mpf(numerator[-1]) / denominator[-1]

    def y(t):
        return final + mp.re(sum(r * mp.exp(p * t) for r, p in zip(residues, poles)))

    def dy(t):
        return mp.re(sum(p * r * mp.exp(p * t) for r, p in zip(residues, poles)))

    return y, dy, final


def bisect(f, low, high):
    """Root of a function that changes sign once between low and high."""
    positive = f(high) > 0
    for _ in range(120):
        middle = (low + high) / 2
        low, high = (low, middle) if (f(middle) > 0) == positive else (middle, high)
    return high


def roots(f, window, count=4000):
    """All sign changes of f in (0, window], each located by bisection."""
    times = [mpf(window) * i / count for i in range(count + 1)]
    values = [f(t) for t in times]
    return [bisect(f, times[i], times[i + 1]) for i in range(count) if (values[i] > 0) != (values[i + 1] > 0)]


def metrics(y, dy, start, final, window):
    """Definitions of the control handbook, section 2.1; None where there is no such value within the window."""
    way = final - start

    def share(t):
        return (y(t) - start) / way

    extremes = [mpf(0), *roots(dy, window), mpf(window)]
    at_10, at_90 = roots(lambda t: share(t) - mpf(1) / 10, window), roots(lambda t: share(t) - mpf(9) / 10, window)
    band = abs(way) / 50
    outside = roots(lambda t: abs(y(t) - final) - band, window)
    settled = abs(y(window) - final) <= band
    peak_time = max(extremes, key=lambda t: abs(y(t) - start))
    result = dict.fromkeys(METRICS)
    result["peak"], result["peak_time_s"] = abs(y(peak_time) - start), peak_time
    result["overshoot_pct"] = 100 * max(mp.chop(max(map(share, extremes)) - 1, 1e-30), 0)
    result["undershoot_pct"] = 100 * max(mp.chop(-min(map(share, extremes)), 1e-30), 0)
    if settled:
        result["settling_time_s"] = outside[-1]
    if at_90:
        result["rise_time_s"] = at_90[0] - at_10[0]
        late = [y(t) for t in [at_90[0], *extremes] if t >= at_90[0]]
        result["settling_min"], result["settling_max"] = min(late), max(late)
    return result


def cases():
    """name, y, dy, start, final, window, sample period."""
    y, dy, final = transfer_step((1, 5, 5), (1, mpf("1.65"), 5, mpf("6.5"), 2))
    yield "fourth_order", y, dy, mpf(0), final, 60, "0.02"
    y, dy, final = transfer_step((8, 18, 32), (1, 6, 14, 24))
    yield "third_order", y, dy, mpf(0), final, 10, "0.005"
    one = mpf(1)
    decay = lambda t: mp.exp(-t)
    yield "first_order", lambda t: 1 - decay(t), decay, 0 * one, one, 40, "0.01"
    yield "offset", lambda t: 2 - decay(t), decay, one, 2 * one, 20, "0.01"
    yield "downward", lambda t: 2 * decay(t) - 1, lambda t: -2 * decay(t), one, -one, 20, "0.01"
    yield "regulation", decay, lambda t: -decay(t), one, 0 * one, 20, "0.01"
    # (1 - s) / (1 + s)^2 starts the wrong way.
    yield ("wrong_way", lambda t: 1 - decay(t) - 2 * t * decay(t), lambda t: (2 * t - 1) * decay(t), 0 * one, one, 20,
           "0.01")
    yield "not_risen", lambda t: 1 - decay(t), decay, 0 * one, 2 * one, 20, "0.01"


def integrals():
    """IAE, ISE, ITAE of e = exp(-t) on [0, inf) and by the rectangle rule T * sum over all samples."""
    yield "closed_form", 0.0, 1.0, 0.5, 1.0
    for period in ("0.01", "0.1"):
        dt = mpf(period)
        ratio, square = mp.exp(-dt), mp.exp(-2 * dt)
        yield "rectangle", dt, dt / (1 - ratio), dt / (1 - square), dt**2 * ratio / (1 - ratio) ** 2


BOOK = {
    "fourth_order": (3.8434, 27.9801, 2.0688, 2.6878, 7.5130, None, None, 8.0840),
    "third_order": (0.20867, 3.49725, 1.1956, 1.68725, 26.5435, None, None, 0.6080),
    "first_order": (2.197225, 3.912023) + (None,) * 6,
    "offset": (2.197225,) + (None,) * 7,
    "regulation": (2.197225, 3.912023) + (None,) * 6,
}

if __name__ == "__main__":
    rows = []
    for name, y, dy, start, final, window, period in cases():
        found = metrics(y, dy, start, final, window)
        values = ["" if found[metric] is None else found[metric] for metric in METRICS]
        rows.append([name, start, final, window, float(period), *values])
        samples = [(k * float(period), y(k * mpf(period))) for k in range(round(window / float(period)) + 1)]
        write("fspid-study", f"step_{name}.csv", "time_s,y", samples)
        differences = [abs(float(found[metric]) - book) for metric, book in zip(METRICS, BOOK.get(name, ())) if book]
        if differences:
            print("  against the handbook:", ", ".join(f"{d:.1e}" for d in differences))
    write("fspid-study", "step_metrics.csv", "name,start,final,window_s,sample_period_s," + ",".join(METRICS), rows)
    write("fspid-study", "integrals.csv", "rule,sample_period_s,iae,ise,itae", list(integrals()))
    half_percent = [t for t in roots(lambda t, y=transfer_step((8, 18, 32), (1, 6, 14, 24))[0]:
                                     abs(y(t) - mpf(4) / 3) - mpf(4) / 600, 10)][-1]
    print(f"  third order, 0.5 % settling {float(half_percent):.6f} (handbook 4.88977)")
