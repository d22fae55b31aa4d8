"""fspid beside python-control and scikit-fuzzy, in one run: times as ratios, answers as differences.

    python compare.py [path of the program fspid]

The loop is the paper's (arXiv 1510.02588): the 747's pitch behind a servo 10/(s + 10), sampled at 100 Hz, a step of one
degree for 50 s, a PID whose derivative acts on the measurement, so that it is linear from the first sample on. The
supervisor is its fuzzy one: 7 x 7 rules, Gaussian inputs, triangular outputs, centroids.

Every time is the best of rounds that take turns, so that what else runs on the machine hits both alike.
"""

from __future__ import annotations

import json
import subprocess
import sys
import time
import tomllib
import warnings
from functools import partial
from pathlib import Path

import control
import gymnasium
import numpy as np
import skfuzzy
import skfuzzy.control

import fspid
from fspid.gym import PitchEnv, PitchVectorEnv

ROOT = Path(__file__).resolve().parents[3]
ROUNDS = 5
PERIOD_S, DURATION_S = 0.01, 50.0
KP, KI, KD = 2.0, 0.5, 1.0
# Negated: an elevator down pitches down, and commands are nose up.
NUMERATOR = [1.69144, 0.84341, 0.0099096]
DENOMINATOR = [1.0, 1.17103, 1.55405, 0.012538, 0.0072771]
RANGE = 5.0
LABELS = ["NB", "NM", "NS", "ZO", "PS", "PM", "PB"]
INFERENCES = 1_000_000
# So many are answered by scikit-fuzzy, which is slow.
ASKED = 8


def seconds(work):
    """How long a call takes: the mean of as many as fit into a tenth of a second."""
    calls, begun = 0, time.perf_counter()
    while True:
        work()
        calls += 1
        passed = time.perf_counter() - begun
        if passed > 0.1:
            return passed / calls


def in_turn(**works):
    """The best of rounds of each, which take turns."""
    best = dict.fromkeys(works, float("inf"))
    for _ in range(ROUNDS):
        for name, work in works.items():
            best[name] = min(best[name], seconds(work))
    return best


def told(what, ours, theirs, difference):
    print(f"{what:<66}{theirs / ours:>10.3g}  {ours:>9.3g} s beside {theirs:.3g} s; {difference}")


def imports():
    """Import in a fresh interpreter, less what the interpreter itself takes."""

    def start(module):
        return lambda: subprocess.run([sys.executable, "-c", f"import {module}"], check=True)

    best = in_turn(sys=start("sys"), fspid=start("fspid"), control=start("control"), skfuzzy=start("skfuzzy.control"))
    ours = best["fspid"] - best["sys"]
    for name, module in [("python-control", "control"), ("scikit-fuzzy", "skfuzzy")]:
        told(f"import, {name}", ours, best[module] - best["sys"], "")


def scenario():
    return fspid.Scenario.from_dict(
        {
            "schema": 1,
            "name": "compare",
            "plant": {"preset": "b747-paper"},
            "actuator": {"time_constant_s": 0.1},
            "loop": {"sample_period_s": PERIOD_S, "duration_s": DURATION_S},
            "setpoint": {"kind": "step", "amplitude_deg": 1.0},
            "controller": [
                {"name": "PID", "kind": "pid", "kp": KP, "ki": KI, "kd": KD, "derivative_on": "measurement"}
            ],
        }
    )


def aircraft():
    return control.tf(NUMERATOR, DENOMINATOR) * control.tf([10.0], [1.0, 10.0])


def sampled():
    return control.sample_system(control.tf2ss(aircraft()), PERIOD_S, "zoh")


def closed_loop(held):
    """From set-point to pitch, with the PID as transfer functions of z."""
    # The integral takes in the sample that it answers, as fspid's does.
    answer = control.tf2ss(control.tf([KP + KI * PERIOD_S, -KP], [1.0, -1.0], PERIOD_S))
    rate = control.tf2ss(control.tf([KD / PERIOD_S, -KD / PERIOD_S], [1.0, 0.0], PERIOD_S))
    return control.feedback(control.feedback(held, rate) * answer, 1)


def loops():
    flown = scenario()
    times = PERIOD_S * np.arange(round(DURATION_S / PERIOD_S) + 1)
    closed, step = closed_loop(sampled()), np.ones(len(times))
    respond = lambda: control.forced_response(closed, times, step)  # noqa: E731
    whole = lambda: control.forced_response(closed_loop(sampled()), times, step)  # noqa: E731
    best = in_turn(ours=flown.simulate, respond=respond, whole=whole)
    pitch = np.asarray(flown.simulate()["PID"]["theta_deg"])
    far = f"largest difference {np.max(np.abs(respond().outputs - pitch)):.1e} deg"
    told("closed loop, simulate with all measures : forced_response alone", best["ours"], best["respond"], far)
    told("closed loop, simulate : sampled, closed and answered", best["ours"], best["whole"], far)


def of_scikit_fuzzy(points):
    """The paper's supervisor in the words of scikit-fuzzy, on so many points."""
    universe, spacing = np.linspace(-RANGE, RANGE, points), RANGE / 3.0
    # Neighbouring Gaussians cross at 0.5.
    sigma = spacing / 2.0 / np.sqrt(2.0 * np.log(2.0))
    error, change = (skfuzzy.control.Antecedent(universe, name) for name in ("error", "change"))
    names = ("delta_kp", "delta_ki", "delta_kd")
    outputs = {name: skfuzzy.control.Consequent(universe, name, "centroid") for name in names}
    for place, label in enumerate(LABELS):
        centre = spacing * (place - 3.0)
        error[label], change[label] = (skfuzzy.gaussmf(universe, centre, sigma) for _ in range(2))
        for output in outputs.values():
            output[label] = skfuzzy.trimf(universe, [centre - spacing, centre, centre + spacing])
    rules = [
        skfuzzy.control.Rule(error[one] & change[other], [outputs[n][grid[n][i][j]] for n in names])
        for grid in [rule_table()]
        for i, one in enumerate(LABELS)
        for j, other in enumerate(LABELS)
    ]
    # Without its cache of answers: no input comes twice.
    system = skfuzzy.control.ControlSystemSimulation(skfuzzy.control.ControlSystem(rules), cache=False)

    def answer(of_error, of_change):
        system.input["error"], system.input["change"] = of_error, of_change
        system.compute()
        return [system.output[name] for name in names]

    return answer


def rule_table():
    """The printed rules, as fspid ships them: of each gain 7 rows of 7 labels."""
    table = tomllib.loads((ROOT / "data/rule-tables/printed.toml").read_text(encoding="utf-8"))
    rows = {name: table[name].split() for name in ("delta_kp", "delta_ki", "delta_kd")}
    return {name: [words[7 * i : 7 * i + 7] for i in range(7)] for name, words in rows.items()}


def supervisors():
    ours, theirs, fine = fspid.Supervisor("printed", RANGE), of_scikit_fuzzy(101), of_scikit_fuzzy(2001)
    error, change = np.random.default_rng(1).uniform(-RANGE, RANGE, (2, INFERENCES))
    few = list(zip(error[:ASKED].tolist(), change[:ASKED].tolist(), strict=True))

    def ask(answer):
        return lambda: [answer(*inputs) for inputs in few]

    best = in_turn(one=ask(ours), theirs=ask(theirs), many=lambda: ours.infer_many(error, change))
    one, other, many = best["one"] / ASKED, best["theirs"] / ASKED, best["many"] / INFERENCES
    exact = np.array([(it.kp, it.ki, it.kd) for it in ask(ours)()])
    far = [np.max(np.abs(np.array(ask(answer)()) - exact)) for answer in (theirs, fine)]
    differ = f"largest difference {far[0]:.1e} of {RANGE} on 101 points, {far[1]:.1e} on 2001"
    told("supervisor, one answer : scikit-fuzzy", one, other, differ)
    told("supervisor, one answer of infer_many : scikit-fuzzy", many, other, differ)


def margins():
    # Without the derivative, which leaves no gain margin to find.
    loop = aircraft() * control.tf([KP, KI], [1.0, 0.0])
    ours = lambda: fspid.lti.margins(loop)  # noqa: E731
    theirs = lambda: control.stability_margins(loop)  # noqa: E731
    best, found = in_turn(ours=ours, theirs=theirs), ours()
    gain, phase, sensitivity, *_ = theirs()
    far = [
        ("gain", found["gain_margin"], gain),
        ("phase", found["phase_margin_deg"], phase),
        ("1 / sensitivity peak", 1.0 / found["sensitivity_peak"], sensitivity),
    ]
    differ = ", ".join(f"{name} {abs(mine - other) / abs(other):.0e}" for name, mine, other in far)
    told("margins of a loop : python-control", best["ours"], best["theirs"], f"relative differences {differ}")


def environments():
    """Steps a second of many environments, with all that Python takes; actions are there."""
    flown = scenario()
    one = PitchEnv(flown, box=(-1.0, 1.0))
    one.reset(seed=0)
    begin = lambda env: (env.reset(seed=0), env.action_space.sample())[1]  # noqa: E731

    def step_one():
        *_, terminated, truncated, _ = one.step(action)
        if terminated or truncated:
            one.reset()

    action, works = one.action_space.sample(), {"1 alone": (step_one, 1)}
    for count in (1, 64, 1024):
        many = PitchVectorEnv(count, flown, box=(-1.0, 1.0))
        works[f"{count} at once"] = (partial(many.step, begin(many)), count)
    sync = gymnasium.vector.SyncVectorEnv([lambda: PitchEnv(flown, box=(-1.0, 1.0))] * 64)
    works["64 of SyncVectorEnv"] = (partial(sync.step, begin(sync)), 64)
    best = in_turn(**{name: work for name, (work, _) in works.items()})
    rates = {name: count / best[name] for name, (_, count) in works.items()}
    for name, rate in rates.items():
        print(f"{f'environments, steps a second, {name}':<66}{rate / rates['1 alone']:>10.3g}  {rate:.3g}")


def batch_of_the_crate(program):
    """A million answers of `infer_many` from NumPy and the batch of `fspid bench`, in turn, on one thread each.

    The bench's best rounds are so short that nobody interrupts them; a million answers take longer, and so are counted in
    processor time, that of the kernel for fresh memory included.
    """
    supervisor = fspid.Supervisor("mirrored", RANGE)
    error, change = np.random.default_rng(2).uniform(-RANGE, RANGE, (2, INFERENCES))
    ours, crate = 0.0, 0.0
    for _ in range(2 * ROUNDS):
        begun = time.process_time()
        supervisor.infer_many(error, change)
        ours = max(ours, INFERENCES / (time.process_time() - begun))
        command = [program, "bench", "--quick", "--threads", "1", "--format", "json"]
        answer = json.loads(subprocess.run(command, check=True, capture_output=True).stdout)
        rates = answer["details"]["measurements"]
        crate = max(crate, *(it["best_per_s"] for it in rates if it["name"] == "inference_batch"))
    print(f"{'infer_many from NumPy : the batch of the crate':<66}{ours / crate:>10.3g}", end="")
    print(f"  {ours / 1e6:.3g} beside {crate / 1e6:.3g} million answers a second")


def main():
    warnings.filterwarnings("ignore", category=FutureWarning)
    print(f"fspid {fspid.__version__}, control {control.__version__}, scikit-fuzzy {skfuzzy.__version__}")
    print(f"{'ours : theirs':<66}{'ratio':>10}")
    imports()
    loops()
    supervisors()
    margins()
    environments()
    if len(sys.argv) > 1:
        batch_of_the_crate(sys.argv[1])


if __name__ == "__main__":
    main()
