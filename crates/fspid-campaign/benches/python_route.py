"""The usual Python routes to the loop that `fspid bench` flies, timed side by side.

    python python_route.py [path of fspid]

Boeing 747 of the paper (arXiv 1510.02588) behind a servo 10/(s + 10), sampled at 100 Hz with a
zero-order hold, a step of 1 degree, 50 s; a PID whose gains a fuzzy supervisor moves (Table 3 as
printed, Gaussian inputs, triangular outputs, minimum and maximum, centroid). All angles are in
degrees: the loop is linear but for the supervisor, which is asked in degrees.

Every route is a program of its own from the equations; each one's pitch angle is compared with that of
`fspid simulate` where a program is given, with the plain loop's where not.
"""

import csv
import json
import subprocess
import sys
import tempfile
import time
import tomllib
from pathlib import Path

import control
import numba
import numpy as np
import scipy.linalg
import scipy.signal
import skfuzzy
import skfuzzy.control

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[2]
SCENARIO = HERE.parent / "src" / "bench" / "scenario.toml"

PERIOD_S = 0.01
ROWS = 5001
STEP_DEG = 1.0
NOMINAL = np.array([2.0, 0.5, 1.0])  # kp, ki, kd
OUTPUT_SCALE = np.array([0.1, 0.02, 0.05])
ERROR_SCALE, CHANGE_SCALE = 1.0, 0.2
RANGE = 5.0
SPACING = RANGE / 3.0
CENTRES = SPACING * np.arange(-3.0, 4.0)
# Neighbouring Gaussians cross at 0.5.
SIGMA = SPACING / 2.0 / np.sqrt(2.0 * np.log(2.0))
LABELS = ["NB", "NM", "NS", "ZO", "PS", "PM", "PB"]

# About how long a route is timed, s of wall time.
TIMED_S = 1.0


def rules():
    """Labels of the three outputs as numbers 0 to 6: output, error, change."""
    table = tomllib.loads((ROOT / "data/rule-tables/printed.toml").read_text(encoding="utf-8"))
    grids = [table[name].split() for name in ("delta_kp", "delta_ki", "delta_kd")]
    return np.array([[LABELS.index(word) for word in grid] for grid in grids]).reshape(3, 7, 7)


def plant():
    """The sampled plant behind its servo, from command (nose up) to pitch."""
    numerator = [1.69144, 0.84341, 0.0099096]  # negated: an elevator down pitches down
    denominator = [1.0, 1.17103, 1.55405, 0.012538, 0.0072771]
    a, b, c, _ = scipy.signal.tf2ss(np.multiply(10.0, numerator), np.polymul(denominator, [1.0, 10.0]))
    order = len(a)
    whole = np.zeros((order + 1, order + 1))
    whole[:order, :order], whole[:order, order:] = a * PERIOD_S, b * PERIOD_S
    held = scipy.linalg.expm(whole)
    return held[:order, :order].copy(), held[:order, order].copy(), c[0].copy()


RULES = rules()
A, B, C = plant()


def centroid(strengths):
    """Centre of gravity of seven clipped triangles whose neighbours cross at 0.5, joined by maximum.

    Between two peaks, with the clips a and b and t from 0 to 1, the union is
    max(min(a, 1 - t), min(b, t)): both trapezoids less what they share, which is clipped at min(a, b, 1/2).
    """
    a, b = strengths[:-1], strengths[1:]
    shared = np.minimum(np.minimum(a, b), 0.5)
    area = (a - a * a / 2) + (b - b * b / 2) - (shared - shared * shared)
    moment = (a / 2 - a * a / 2 + a**3 / 6) + (b / 2 - b**3 / 6) - (shared - shared * shared) / 2
    return SPACING * (np.sum(np.arange(6) * area + moment) / np.sum(area) - 3.0)


def increments_numpy(error, change):
    """What the supervisor adds to the gains, before its output factors."""
    error, change = np.clip([error, change], -RANGE, RANGE)
    of_error = np.exp(-0.5 * ((error - CENTRES) / SIGMA) ** 2)
    of_change = np.exp(-0.5 * ((change - CENTRES) / SIGMA) ** 2)
    firing = np.minimum(of_error[:, None], of_change[None, :])
    answer = np.empty(3)
    for output in range(3):
        strengths = np.zeros(7)
        np.maximum.at(strengths, RULES[output].ravel(), firing.ravel())
        answer[output] = centroid(strengths)
    return answer


def fly(increments, rows):
    """The loop, sample after sample, with any supervisor."""
    x, integral, before = np.zeros(len(A)), 0.0, None
    pitch = np.empty(rows)
    for k in range(rows):
        y = C @ x
        pitch[k] = y
        error = STEP_DEG - y
        rate = 0.0 if before is None else (error - before) / PERIOD_S
        before = error
        kp, ki, kd = NOMINAL + OUTPUT_SCALE * increments(ERROR_SCALE * error, CHANGE_SCALE * rate)
        integral += ki * error * PERIOD_S
        x = A @ x + B * (kp * error + integral + kd * rate)
    return pitch


def fly_numpy(rows):
    return fly(increments_numpy, rows)


@numba.njit(cache=False, fastmath=False)
def fly_compiled(rows, a, b, c, table, centres, sigma, spacing, nominal, scale):
    order = len(b)
    x, moved = np.zeros(order), np.zeros(order)
    pitch = np.empty(rows)
    integral, before = 0.0, 0.0
    of_error, of_change, gains, strengths = np.zeros(7), np.zeros(7), np.zeros(3), np.zeros(7)
    for k in range(rows):
        y = 0.0
        for i in range(order):
            y += c[i] * x[i]
        pitch[k] = y
        error = 1.0 - y
        rate = 0.0 if k == 0 else (error - before) / 0.01
        before = error
        seen, seen_change = min(max(error, -5.0), 5.0), min(max(0.2 * rate, -5.0), 5.0)
        for i in range(7):
            of_error[i] = np.exp(-0.5 * ((seen - centres[i]) / sigma) ** 2)
            of_change[i] = np.exp(-0.5 * ((seen_change - centres[i]) / sigma) ** 2)
        for output in range(3):
            strengths[:] = 0.0
            for i in range(7):
                for j in range(7):
                    label = table[output, i, j]
                    strengths[label] = max(strengths[label], min(of_error[i], of_change[j]))
            areas, moments = 0.0, 0.0
            for i in range(6):
                p, q = strengths[i], strengths[i + 1]
                h = min(min(p, q), 0.5)
                area = (p - p * p / 2) + (q - q * q / 2) - (h - h * h)
                moment = (p / 2 - p * p / 2 + p * p * p / 6) + (q / 2 - q * q * q / 6) - (h - h * h) / 2
                areas += area
                moments += i * area + moment
            gains[output] = nominal[output] + scale[output] * spacing * (moments / areas - 3.0)
        integral += gains[1] * error * 0.01
        command = gains[0] * error + integral + gains[2] * rate
        for i in range(order):
            moved[i] = b[i] * command
            for j in range(order):
                moved[i] += a[i, j] * x[j]
        x[:] = moved
    return pitch


def fly_numba(rows):
    return fly_compiled(rows, A, B, C, RULES, CENTRES, SIGMA, SPACING, NOMINAL, OUTPUT_SCALE)


def loop_of_python_control():
    """Plant and controller as two discrete systems, connected by name."""
    aircraft = control.ss(A, B[:, None], C[None, :], 0.0, PERIOD_S, inputs="u", outputs="y", name="aircraft")

    def answer(state, error):
        integral, before, has_before = state
        rate = (error - before) / PERIOD_S if has_before else 0.0
        gains = NOMINAL + OUTPUT_SCALE * increments_numpy(ERROR_SCALE * error, CHANGE_SCALE * rate)
        integral += gains[1] * error * PERIOD_S
        return integral, gains[0] * error + integral + gains[2] * rate

    def update(_time, state, inputs, _params):
        error = inputs[0] - inputs[1]
        return np.array([answer(state, error)[0], error, 1.0])

    def output(_time, state, inputs, _params):
        return answer(state, inputs[0] - inputs[1])[1]

    controller = control.nlsys(
        update, output, inputs=["r", "y"], outputs=["u"], states=3, dt=PERIOD_S, name="controller"
    )
    return control.interconnect([aircraft, controller], inputs=["r"], outputs=["y"])


def fly_python_control(rows):
    times = PERIOD_S * np.arange(rows)
    response = control.input_output_response(loop_of_python_control(), times, np.full(rows, STEP_DEG))
    return np.asarray(response.outputs).ravel()


def supervisor_of_scikit_fuzzy():
    """The supervisor in the words of scikit-fuzzy, on the 101 points of MATLAB's default."""
    universe = np.linspace(-RANGE, RANGE, 101)
    error = skfuzzy.control.Antecedent(universe, "error")
    change = skfuzzy.control.Antecedent(universe, "change")
    outputs = [skfuzzy.control.Consequent(universe, name, "centroid") for name in ("kp", "ki", "kd")]
    for label, centre in zip(LABELS, CENTRES):
        for variable in (error, change):
            variable[label] = skfuzzy.gaussmf(universe, centre, SIGMA)
        for output in outputs:
            output[label] = skfuzzy.trimf(universe, [centre - SPACING, centre, centre + SPACING])
    stated = [
        skfuzzy.control.Rule(
            error[LABELS[i]] & change[LABELS[j]],
            [output[LABELS[RULES[n, i, j]]] for n, output in enumerate(outputs)],
        )
        for i in range(7)
        for j in range(7)
    ]
    # Without its cache of answers: no input comes twice.
    simulation = skfuzzy.control.ControlSystemSimulation(skfuzzy.control.ControlSystem(stated), cache=False)

    def increments(of_error, of_change):
        simulation.input["error"] = float(np.clip(of_error, -RANGE, RANGE))
        simulation.input["change"] = float(np.clip(of_change, -RANGE, RANGE))
        simulation.compute()
        return np.array([simulation.output[name] for name in ("kp", "ki", "kd")])

    return increments


# Name, how to fly so many rows, most rows of a flight, and how far from fspid it may be, deg. The last is for
# rounding, but for scikit-fuzzy, which reads curves off its grid of 101 points by straight lines.
def routes():
    scikit_fuzzy = supervisor_of_scikit_fuzzy()
    return [
        ("scikit-fuzzy 0.5, its simulation in a loop", lambda rows: fly(scikit_fuzzy, rows), 40, 2e-4),
        ("python-control, interconnected systems", fly_python_control, ROWS, 1e-9),
        ("numpy, loop by hand", fly_numpy, ROWS, 1e-9),
        ("numba, whole loop compiled", fly_numba, ROWS, 1e-9),
    ]


def timed(flight, most_rows):
    """Steps a second of repeated blocks: the median and the best, by wall time."""
    flight(3)  # compiles and warms up
    rows = min(most_rows, 5)
    while True:
        begin = time.perf_counter()
        flight(rows)
        took_s = time.perf_counter() - begin
        if rows == most_rows or took_s >= TIMED_S / 10:
            break
        rows = min(most_rows, 1 + int(rows * min(100.0, TIMED_S / 10 / took_s)))
    rates, begin = [], time.perf_counter()
    while time.perf_counter() - begin < TIMED_S:
        before = time.perf_counter()
        flight(rows)
        rates.append(rows / (time.perf_counter() - before))
    return float(np.median(rates)), max(rates)


def simulated(fspid):
    """Pitch angles of `fspid simulate`, deg."""
    with tempfile.TemporaryDirectory() as folder:
        trace = Path(folder) / "trace.csv"
        command = [fspid, "simulate", str(SCENARIO), "--trace", str(trace)]
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
        with trace.open(newline="", encoding="utf-8") as file:
            return np.array([float(row["theta_deg"]) for row in csv.DictReader(file)])


def best_of_fspid(rates, kind):
    """Rate of the best round on one thread."""
    measurements = rates["details"]["measurements"]
    return next(it["best_per_s"] for it in measurements if it["name"] == kind and it["threads"] == 1)


def main():
    fspid = sys.argv[1] if len(sys.argv) > 1 else None
    expected = simulated(fspid) if fspid else fly_numpy(ROWS)
    rates = None
    if fspid:
        answer = subprocess.run([fspid, "bench", "--format", "json"], check=True, capture_output=True)
        rates = json.loads(answer.stdout)
    print(f"{'route':<44}{'steps/s':>12}{'best':>12}{'max |dy|, deg':>16}{'allowed':>10}", end="")
    print(f"{'fspid one':>12}{'side by side':>14}" if rates else "")
    failed = False
    for name, flight, most_rows, allowed in routes():
        off = np.max(np.abs(flight(most_rows) - expected[:most_rows]))
        failed |= not off <= allowed
        rate, best = timed(flight, most_rows)
        print(f"{name:<44}{rate:>12.4g}{best:>12.4g}{off:>16.1e}{allowed:>10.0e}", end="", flush=True)
        if rates:
            # Best against best: medians of a busy machine say how busy it was.
            scalar, batch = (best_of_fspid(rates, kind) / best for kind in ("step_scalar", "step_batch"))
            print(f"{scalar:>10.3g} x{batch:>12.3g} x", end="")
        print()
    if rates:
        for kind in ("step_scalar", "step_batch"):
            median, best = rates[f"{kind}_per_s"], best_of_fspid(rates, kind)
            print(f"fspid, {kind} on one thread: {median:.4g} steps/s, best {best:.4g}")
        print(f"fspid, flights with all measures on all threads: {rates['flights_per_s'] * ROWS:.4g} steps/s")
        print(f"largest spread of fspid's rates: {rates['details']['largest_spread_pct']:.0f} %")
    if failed:
        sys.exit("a route does not fly the same loop")


if __name__ == "__main__":
    main()
