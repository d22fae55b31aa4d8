"""Makes rules.json of fspid-tune: ultimate points, models, placed poles, quadratic costs, relays, gains; from equations."""
import json
import math
import warnings

import control
import numpy as np
from mpmath import mp, mpc, mpf
from scipy.linalg import solve_continuous_are, solve_discrete_lyapunov
from scipy.optimize import minimize

from fixture import CRATES
from loop import B747, NAVION, SERVO_S, LimitedPath, LinearPath, Plant, hold, with_servo
from make_loop_stability import closed_loop, eigenvalues, neutral, precise_hold

mp.dps = 40
DT = 0.01
CTMS = Plant((1.15101, 0.17742), (1, 0.739, 0.921468, 0), +1)
PLANTS = {"navion-paper": NAVION, "b747-paper": B747, "ctms-pitch": CTMS}
WEIGHTS = {"error": 1.0, "rate": 0.0, "integral": 0.25, "command": 1.0}


# The process: servo and plant behind a hold.

def response(parts, z):
    phi, gamma, rows = parts
    state = mp.lu_solve(z * mp.eye(phi.rows) - phi, gamma)
    return (rows[0, :] * state)[0]


def on_circle(parts, omega):
    return response(parts, mp.exp(mpc(0, omega * DT)))


def steady(plant):
    """Steady angle per command, or steady rate per command with an integrator."""
    low = plant.denominator[-1] or plant.denominator[-2]
    return mpf(plant.numerator[-1]) / mpf(low) * plant.sign


def ultimate(plant):
    """Gain and frequency of the neutral proportional loop, by bisection on its eigenvalues."""
    gain = neutral(lambda k: max(abs(z) for z in eigenvalues(closed_loop(plant, DT, k))), 1, 12)
    z = max(eigenvalues(closed_loop(plant, DT, gain)), key=abs)
    return gain, abs(mp.arg(z)) / DT


def check_ultimate(plant, gain, omega):
    f, g, outputs = with_servo(plant)
    phi, gamma = hold(f, g, DT)
    system = control.ss(phi, gamma.reshape(-1, 1), outputs[:1], [[0.0]], DT)
    margins = control.stability_margins(system, returnall=True)
    candidates = zip(margins[0], margins[3])
    factor, at = min(candidates, key=lambda pair: abs(pair[0] - float(gain)))
    return abs(factor - float(gain)), abs(at - float(omega))


# Models through the point at -180 deg.

def lag(k, gain, omega):
    ratio = k * gain
    t = mp.sqrt(ratio ** 2 - 1) / omega
    return {"K": k, "T": t, "L": (mp.pi - mp.atan(t * omega)) / omega}


def integrator(gain, omega):
    return {"K'": omega / gain, "L": mp.pi / 2 / omega}


def integrator_lag(slope, gain, omega):
    t = mp.sqrt((slope * gain / omega) ** 2 - 1) / omega
    return {"K'": slope, "T2": t, "L": (mp.pi / 2 - mp.atan(t * omega)) / omega}


def value(model, omega):
    s = mpc(0, omega)
    top = model.get("K", model.get("K'")) * mp.exp(-s * model["L"])
    below = mpf(1) if "K" in model else s
    for name in ("T", "T2"):
        below *= model.get(name, 0) * s + 1
    return top / below


def fit_error(parts, model, high):
    grid = [high / 10 * mpf(10) ** (mpf(i) / 32) for i in range(33)]
    return max(abs(value(model, w) / on_circle(parts, w) - 1) for w in grid)


# Gains K, Ti, Td by the published formulas.

def series(k, ti, td):
    f = 1 + td / ti
    return [k * f, ti * f, td / f]


def by_ultimate(ku, tu):
    return {
        "ziegler-nichols p": [ku / 2, None, 0], "ziegler-nichols pi": [0.45 * ku, tu / 1.2, 0],
        "ziegler-nichols pid": [0.6 * ku, tu / 2, tu / 8],
        "tyreus-luyben pi": [ku / 3.2, 2.2 * tu, 0], "tyreus-luyben pid": [ku / 2.2, 2.2 * tu, tu / 6.3],
    }


def by_lag(m):
    k, t, l = m["K"], m["T"], m["L"]
    r = l / t
    lam = max(t, 3 * l)
    return {
        "simc pi": [t / k / (2 * l), min(t, 8 * l), 0],
        "lambda pi": [t / k / (lam + l), t, 0],
        "lambda pid": [(t + l / 2) / k / (lam + l / 2), t + l / 2, t * l / (2 * t + l)],
        "amigo pi": [0.15 / k + (0.35 - l * t / (l + t) ** 2) * t / (k * l),
                     0.35 * l + 13 * l * t ** 2 / (t ** 2 + 12 * l * t + 7 * l ** 2), 0],
        "amigo pid": [(0.2 + 0.45 * t / l) / k, (0.4 * l + 0.8 * t) / (l + 0.1 * t) * l, 0.5 * l * t / (0.3 * l + t)],
        "itae pi": [0.586 / k * r ** -0.916, t / (1.03 - 0.165 * r), 0],
        "itae pid": [0.965 / k * r ** -0.85, t / (0.796 - 0.1465 * r), 0.308 * t * r ** 0.929],
    }


def by_integrator(m):
    k, l = m["K'"], m["L"]
    lam = 3 * l
    ti = 2 * lam + l
    w = 1 / (4 * l)
    return {
        "simc pi": [1 / k / (2 * l), 8 * l, 0],
        "lambda pi": [ti / k / (lam + l) ** 2, ti, 0],
        "lambda pid": [ti / k / (lam + l / 2) ** 2, ti, (lam * l + l * l / 4) / ti],
        "amigo pi": [0.35 / k / l, 13.4 * l, 0],
        "amigo pid": [0.45 / k / l, 8 * l, l / 2],
        "itae pi": [1.4 * w / k, 1.4 / w, 0],
    }


# Dominant poles.

def placed(parts, damping, omega, third, filter_s):
    """kp, ki, kd with poles at exp(s T): the controller's value there is -1/P."""
    pair = mp.exp(DT * omega * mpc(-damping, mp.sqrt(1 - mpf(damping) ** 2)))
    real = mp.exp(-mpf(third) * omega * DT)
    rows, right = [], []
    for z, parts_of in ((pair, (mp.re, mp.im)), (real, (mp.re,))):
        terms = [mpf(1), DT * z / (z - 1), (z - 1) / ((filter_s + DT) * z - filter_s)]
        for part in parts_of:
            rows.append([part(mpc(term)) for term in terms])
            right.append(part(mpc(-1 / response(parts, z))))
    gains = mp.lu_solve(mp.matrix(rows), mp.matrix(right))
    check_placed(parts, gains, filter_s, (pair, real))
    return list(gains)


def check_placed(parts, gains, filter_s, wanted):
    """The poles are eigenvalues of the closed loop with states plant, integral, filtered derivative, last -y."""
    phi, gamma, rows = parts
    kp, ki, kd = gains
    n = phi.rows
    c = rows[0, :]
    time = mpf(filter_s) + DT
    u, d = mp.zeros(1, n + 3), mp.zeros(1, n + 3)
    for j in range(n):
        d[j] = -c[j] / time
        u[j] = -(kp + ki * DT) * c[j]
    d[n + 1], d[n + 2] = mpf(filter_s) / time, -1 / time
    u[n] = 1
    u += kd * d
    a = mp.zeros(n + 3)
    for i in range(n):
        for j in range(n + 3):
            a[i, j] = (phi[i, j] if j < n else 0) + gamma[i] * u[j]
    for j in range(n):
        a[n, j] = -ki * DT * c[j]
        a[n + 2, j] = -c[j]
    a[n, n] = 1
    for j in range(n + 3):
        a[n + 1, j] = d[j]
    found = eigenvalues(a)
    for pole in wanted:
        assert min(abs(z - pole) for z in found) < mpf(10) ** -20, pole


# Quadratic cost of kp, ki and rate gain.

def cost(plant, gains):
    """Sum of T (we e^2 + wq q^2 + wI I^2 + wu u^2) from a pitch of 1, by a Lyapunov equation."""
    kp, ki, rate = gains
    f, g, outputs = with_servo(plant)
    phi, gamma = hold(f, g, DT)
    n = len(gamma)
    y, q = (np.append(outputs[i], 0.0) for i in (0, 1))
    integral = -DT * y
    integral[n] = 1.0  # the sum of e T up to the last sample, and this one
    u = -kp * y + ki * integral - rate * q
    a = np.zeros((n + 1, n + 1))
    a[:n, :n] = phi
    a[:n] += np.outer(gamma, u)
    a[n] = integral
    if max(abs(np.linalg.eigvals(a))) >= 1:
        return math.inf
    weights = ((WEIGHTS["error"], y), (WEIGHTS["rate"], q), (WEIGHTS["integral"], integral), (WEIGHTS["command"], u))
    weight = sum(w * DT * np.outer(row, row) for w, row in weights)
    p = solve_discrete_lyapunov(a.T, weight)
    # A pitch of 1 with everything else at rest: q and the higher derivatives of the phase variables at zero.
    start = np.zeros(n + 1)
    start[:n] = at_rest_with_pitch(plant)
    return float(start @ p @ start)


def at_rest_with_pitch(plant):
    """State of the observability form theta = 1, others 0, in the phase variables of `loop.realise`."""
    f, g, outputs = with_servo(plant)
    n = len(g) - 1
    rows = [outputs[0, :n]]
    for _ in range(n - 1):
        rows.append(rows[-1] @ f[:n, :n])
    state = np.linalg.solve(np.array(rows), np.eye(n)[0])
    return np.append(state, 0.0)


def least_cost(plant):
    """Minimum over the three gains from several starts."""
    best = None
    for start in ((1.0, 0.5, 0.3), (0.5, 0.1, 0.1), (1.5, 1.0, 1.0)):
        x = np.log(start)
        for _ in range(4):
            found = minimize(lambda x: cost(plant, np.exp(x)), x, method="Nelder-Mead",
                             options={"xatol": 1e-9, "fatol": 1e-13, "maxiter": 4000})
            x = found.x
        if best is None or found.fun < best.fun:
            best = found
    return list(np.exp(best.x)), float(best.fun)


def state_feedback(slope, time):
    """Gains on theta, q and the integral of -theta."""
    a = np.array([[0, 1, 0], [0, -1 / time, 0], [-1, 0, 0]])
    b = np.array([[0], [slope / time], [0]])
    q = np.diag([WEIGHTS["error"], WEIGHTS["rate"], WEIGHTS["integral"]])
    p = solve_continuous_are(a, b, q, np.array([[WEIGHTS["command"]]]))
    k = (b.T @ p)[0] / WEIGHTS["command"]
    return [k[0], -k[2], k[1]]


# The relay.

def relay(path, d, epsilon, samples):
    """Amplitude and period over the last ten cycles."""
    up, switches, values = True, [], []
    for k in range(samples):
        theta = path.read()[0]
        values.append(theta)
        if up and theta > epsilon:
            up = False
        elif not up and theta < -epsilon:
            up = True
            switches.append(k)
        path.advance(d if up else -d)
    first, last = switches[-11], switches[-1]
    tail = values[first:last]
    return (max(tail) - min(tail)) / 2, (last - first) * DT / 10


def entry(name, plant):
    gain, omega = ultimate(plant)
    off = check_ultimate(plant, gain, omega)
    parts = precise_hold(plant, DT)
    slow = steady(plant)
    integrating = plant.denominator[-1] == 0
    models = {"integrator": integrator(gain, omega)}
    gains = by_ultimate(gain, 2 * mp.pi / omega)
    gains.update({f"integrating {rule}": isa for rule, isa in by_integrator(models["integrator"]).items()})
    if integrating and slow * gain > omega:
        models["integrator_lag"] = integrator_lag(slow, gain, omega)
        m = models["integrator_lag"]
        gains["integrating simc pid"] = series(1 / m["K'"] / (2 * m["L"]), 8 * m["L"], m["T2"])
    if not integrating:
        models["lag"] = lag(slow, gain, omega)
        gains.update({f"lag {rule}": isa for rule, isa in by_lag(models["lag"]).items()})
    errors = {kind: fit_error(parts, model, omega) for kind, model in models.items()}
    poles = {"damping": 0.7, "frequency_rad_s": 0.5 * float(omega), "third": 1.0, "filter_s": 0.05}
    poles["gains"] = placed(parts, 0.7, mpf(0.5 * float(omega)), 1, mpf(0.05))
    best, least = least_cost(plant)
    lq = {"gains": best, "cost": least, "cost_of": [[g, cost(plant, g)] for g in ((1.0, 0.5, 0.3), (1.5, 0.2, 0.6))]}
    if "integrator_lag" in models:
        m = models["integrator_lag"]
        lq["state_feedback"] = state_feedback(float(m["K'"]), float(m["T2"]))
    relays = []
    for position, rate in ((None, None), (20.0, 5.0)):
        path = LinearPath(plant, DT) if rate is None else LimitedPath(plant, DT, position, rate)
        amplitude, period = relay(path, 1.0, 0.02, 20_000)
        relays.append({"relay_deg": 1.0, "hysteresis_deg": 0.02, "position_deg": position, "rate_deg_s": rate,
                       "oscillation_deg": amplitude, "period_s": period})
    print(f"  {name}: Ku {mp.nstr(gain, 8)}, {mp.nstr(omega, 8)} rad/s; python-control differs by {off[0]:.1e}, {off[1]:.1e}; "
          f"least cost {least:.6f} at {np.round(best, 4).tolist()}")
    return {"ultimate_gain": gain, "ultimate_rad_s": omega, "steady": slow, "models": models, "fit_errors": errors,
            "gains": gains, "poles": poles, "lq": lq, "relays": relays}


def plain(found):
    """Doubles, to the shortest digits that read back."""
    if isinstance(found, dict):
        return {key: plain(part) for key, part in found.items()}
    if isinstance(found, (list, tuple)):
        return [plain(part) for part in found]
    return found if found is None or isinstance(found, (str, int)) else float(found)


if __name__ == "__main__":
    warnings.simplefilter("ignore")  # python-control announces which of its two methods it takes
    answer = {"sample_period_s": DT, "servo_s": SERVO_S, "weights": WEIGHTS,
              "plants": {name: entry(name, plant) for name, plant in PLANTS.items()}}
    path = CRATES / "fspid-tune" / "tests" / "data" / "rules.json"
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(json.dumps(plain(answer), indent=1, ensure_ascii=False) + "\n", newline="\n")
    print(f"fspid-tune/rules.json: {path.stat().st_size} bytes")
