"""Pitch loops as environments of Gymnasium."""

from __future__ import annotations

import subprocess
import sys
import warnings

import pytest
from conftest import STEP

import fspid

gymnasium = pytest.importorskip("gymnasium")
numpy = pytest.importorskip("numpy")

from fspid.gym import PitchEnv, PitchVectorEnv  # noqa: E402

SHORT = {"sample_period_s": 0.01, "duration_s": 0.3}
PID = {"name": "PID", "kind": "pid", "kp": 2.0, "ki": 0.5, "kd": 1.0}
DISPERSED = {
    **STEP,
    "loop": SHORT,
    "actuator": {"time_constant_s": 0.1, "delay_samples": 2, "rate_limit_deg_s": 30.0},
    "disturbance": [{"enters_at": "measurement", "kind": "noise", "standard_deviation_deg": 0.2, "seed": 1}],
    "dispersion": [
        {"path": "plant.preset.denominator[1]", "distribution": "uniform", "lower": 0.7, "upper": 1.3, "relative": True},
        {"path": "disturbance[0].seed", "distribution": "seed"},
    ],
}
SENSORS = {
    **STEP,
    "loop": {"sample_period_s": 0.01, "duration_s": 2.0},
    "actuator": {"natural_frequency_rad_s": 30.0, "damping": 0.7, "rate_limit_deg_s": 40.0},
    "sensor": {"preset": "mems", "seed": 3},
    "controller": [{**PID, "output_limits_deg": [-4.0, 4.0], "rate_gain": 0.2}],
}


def scenario(text):
    return fspid.Scenario.from_dict(text)


def flown(env, answer):
    """Flies an episode and answers observations, rewards and the last info."""
    seen, _ = env.reset(seed=0)
    observations, rewards, over = [seen], [], False
    while not over:
        seen, reward, terminated, truncated, info = env.step(answer(seen, len(rewards)))
        observations.append(seen)
        rewards.append(reward)
        over = terminated or truncated
    return observations, rewards, info


def by_its_own(env, name):
    controller = env.scenario.controller(name)
    return lambda seen, k: [controller.step(*seen[:3])]


@pytest.mark.parametrize(
    "asked", [STEP, {**DISPERSED, "dispersion": []}, SENSORS, "pitch-hold", "aircraft-in-turbulence"], ids=str
)
def test_the_scenarios_own_controller_flown_through_the_environment_has_the_bits_of_simulate(asked):
    asked = scenario(asked) if isinstance(asked, dict) else fspid.Scenario.preset(asked).with_(loop={"duration_s": 3.0})
    name = asked.controllers[0]
    env = PitchEnv(asked, unit="rad")
    observations, rewards, info = flown(env, by_its_own(env, name))
    wanted, found = asked.simulate()[name], env.flight["agent"]
    assert set(found) == set(wanted)
    for column in set(wanted) - {"kp", "ki", "kd"}:
        assert found[column].tolist() == wanted[column].tolist(), column
    assert len(observations) == len(rewards) + 1 == len(wanted["time_s"]) + 1
    assert info == {"outcome": "flown"}
    assert "<svg" in env.flight.svg()


def test_rewards_of_an_episode_sum_up_to_minus_the_iae_that_the_program_measures(step):
    wanted = step.simulate()["PID"].measures["iae"]
    env = PitchEnv(step)
    pid = step.controller("PID")
    radians, degrees = numpy.deg2rad, numpy.rad2deg
    _, rewards, _ = flown(env, lambda seen, k: [degrees(pid.step(*radians(seen[:3])))])
    assert -sum(rewards) == pytest.approx(wanted, rel=1e-9)
    assert env.flight["agent"].measures["iae"] == pytest.approx(wanted, rel=1e-9)


@pytest.mark.parametrize("name", ["PID", "FSPID"])
def test_gains_that_are_given_are_flown_as_those_of_a_self_tuner(name):
    asked = fspid.Scenario.preset("pitch-hold").with_(loop={"duration_s": 3.0})
    trace = asked.simulate()[name]
    env = PitchEnv(asked, name, action="gains", box=[(-100.0, 100.0)] * 3)
    flown(env, lambda seen, k: [trace["kp"][k], trace["ki"][k], trace["kd"][k]])
    for column in trace:
        assert env.flight["agent"][column].tolist() == trace[column].tolist(), column


def test_boxes_follow_from_limits_and_gains(step):
    servo, pid = {"time_constant_s": 0.1, "position_limit_deg": 3.0}, {**PID, "output_limits_deg": [-5.0, 2.0]}
    command = PitchEnv(scenario({**STEP, "actuator": servo, "controller": [pid]})).action_space
    assert (command.low[0], command.high[0]) == pytest.approx((-3.0, 2.0))
    gains = PitchEnv(step, action="gains").action_space
    assert (gains.low.tolist(), gains.high.tolist()) == ([0.0] * 3, [4.0, 1.0, 2.0])
    assert PitchEnv(step).action_space.high.tolist() == [numpy.inf]
    env = PitchEnv(step, box=(-1.0, 1.0))
    env.reset(seed=0)
    assert env.step([7.0])[0][4] == 1.0


def test_the_check_of_gymnasium_passes():
    from gymnasium.utils.env_checker import check_env

    for wanted in ({"box": (-1.0, 1.0)}, {"action": "gains"}):
        env = gymnasium.make("fspid/Pitch-v0", scenario=scenario(DISPERSED), render_mode="svg", **wanted)
        with warnings.catch_warnings():
            warnings.filterwarnings("error")
            # An observation has no ends, and gains are not normalised.
            warnings.filterwarnings("ignore", message=".*(infinity|normalized).*")
            check_env(env.unwrapped)


@pytest.mark.parametrize("asked", [DISPERSED, {**SENSORS, "loop": SHORT}], ids=["lanes", "one by one"])
@pytest.mark.parametrize("action", ["elevator", "gains"])
def test_the_same_seed_has_the_same_bits_vectorised_or_not(asked, action):
    count, text = 11, scenario(asked)
    box = {"box": (-5.0, 5.0)} if action == "elevator" else {}
    many = PitchVectorEnv(count, text, action=action, **box)
    each = gymnasium.vector.SyncVectorEnv([lambda: PitchEnv(text, action=action, **box)] * count)
    many.action_space.seed(3)
    found, wanted = many.reset(seed=5), each.reset(seed=5)
    assert many.in_lanes == (count if asked is DISPERSED else 0)
    for k in range(80):
        assert _bits(found) == _bits(wanted), k
        actions = many.action_space.sample()
        found, wanted = many.step(actions), each.step(actions)
    assert numpy.ptp(found[0][:, 1]) > 0.0 or asked is not DISPERSED


def _bits(answers):
    def of(answer):
        if isinstance(answer, dict):
            return {key: of(value) for key, value in answer.items()}
        return answer.tolist() if answer.dtype == object else (answer.dtype.kind, answer.tobytes())

    return [of(answer) for answer in answers]


def test_an_episode_flies_what_a_run_of_a_campaign_does(tmp_path):
    asked = scenario(DISPERSED)
    table = asked.campaign(tmp_path / "c", runs=4, seed=9).table()
    rows = pytest.importorskip("pyarrow").table(table).to_pydict()
    env = PitchEnv(asked, unit="rad")
    env.reset(seed=9)
    for run in range(4):
        seen, info = env.reset(options={"run": run})
        assert info == {"seed": 9, "run": run}
        answer, over, total = by_its_own(env, "PID"), False, 0.0
        while not over:
            seen, reward, *ends, _ = env.step(answer(seen, 0))
            over, total = any(ends), total - reward
        assert numpy.rad2deg(total) == pytest.approx(rows["iae_deg_s"][run], rel=1e-9)


def test_runs_follow_each_other_and_a_seed_begins_anew():
    env, many = PitchEnv(scenario(DISPERSED)), PitchVectorEnv(2, scenario(DISPERSED))
    runs = [env.reset(seed=1), env.reset(), env.reset(seed=1), env.reset(options={"run": 7}), env.reset()]
    assert [(info["seed"], info["run"]) for _, info in runs] == [(1, 0), (1, 1), (1, 0), (1, 7), (1, 8)]
    assert runs[0][0].tolist() == runs[2][0].tolist() != runs[1][0].tolist()
    assert PitchEnv(scenario(DISPERSED)).reset()[1]["seed"] != PitchEnv(scenario(DISPERSED)).reset()[1]["seed"]
    infos = [many.reset(seed=[3, 8])[1], many.reset()[1], many.reset(seed=3)[1]]
    assert [(list(it["seed"]), list(it["run"])) for it in infos] == [([3, 8], [0, 0]), ([3, 8], [1, 1]), ([3, 4], [0, 0])]


def test_a_flight_that_is_lost_is_terminated_and_ending_it_does_not_pay(step):
    gains = [-1e6, 0.0, -1e4]
    env = PitchEnv(step, action="gains", box=[(-1e9, 1e9)] * 3)
    observations, rewards, info = flown(env, lambda seen, k: gains)
    verdict = env.flight["agent"].verdict
    assert info["outcome"] == verdict
    assert verdict.startswith("diverged at t = ")
    assert numpy.isfinite(observations).all()
    rows = len(rewards)
    last = abs(env.flight["agent"]["setpoint_deg"][-1] - env.flight["agent"]["theta_deg"][-1])
    assert rewards[-1] == pytest.approx(-last * 0.01 * (2001 - rows + 1))
    many = PitchVectorEnv(3, step, action="gains", box=[(-1e9, 1e9)] * 3)
    many.reset(seed=0)
    quiet = [2.0, 0.5, 1.0]
    for k in range(rows):
        seen, reward, terminated, _, infos = many.step([gains, quiet, quiet])
        assert terminated.tolist() == [k == rows - 1, False, False]
    assert (seen[0].tolist(), reward[0]) == (observations[-1].tolist(), rewards[-1])
    assert infos["outcome"][0] == verdict
    seen, reward, terminated, truncated, infos = many.step([gains, quiet, quiet])
    assert (reward[0], terminated.any(), infos["run"][0]) == (0.0, False, 1)
    assert seen[0].tolist() == observations[0].tolist()


def test_a_reward_of_ones_own_sees_what_was_and_what_came(step):
    def reward(seen, action, then, terminated):
        return -(then[..., 3] ** 2) - 0.1 * (action[..., 0] - seen[..., 4]) ** 2

    env, many = PitchEnv(step, reward=reward), PitchVectorEnv(2, step, reward=reward)
    first, _ = env.reset(seed=0)
    many.reset(seed=0)
    for k in range(3):
        then, found, *_ = env.step([0.5 * k])
        assert found == reward(first, numpy.array([0.5 * k]), then, False)
        assert many.step([[0.5 * k]] * 2)[1].tolist() == [found] * 2
        first = then


def test_input_that_cannot_be_used_is_refused_in_words(step, tmp_path):
    def told(match, do):
        with pytest.raises(fspid.InputError, match=match):
            do()

    env, many = PitchEnv(step), PitchVectorEnv(2, step)
    told("reset", lambda: env.step([0.0]))
    told("reset", lambda: many.step([[0.0]] * 2))
    told("no flight yet", lambda: env.flight)
    env.reset(seed=0)
    many.reset(seed=0)
    told("finite", lambda: env.step([float("nan")]))
    told("finite", lambda: many.step([[0.0], [float("inf")]]))
    told(r"shape \(2,\); allowed is \(1,\)", lambda: env.step([0.0, 1.0]))
    told(r"shape \(\)", lambda: env.step(0.0))
    told(r"shape \(2,\); allowed is \(2, 1\)", lambda: many.step([0.0, 1.0]))
    told("array of <U4", lambda: env.step(["much"]))
    told("array of complex", lambda: env.step([1j]))
    # Nothing of that was flown.
    assert env.step([0.0])[0].tolist() == many.step([[0.0]] * 2)[0][0].tolist()
    for _ in range(2000):
        env.step([0.0])
    told(r"over: flown; reset\(\)", lambda: env.step([0.0]))
    told("allowed is elevator or gains", lambda: PitchEnv(step, action="rudder"))
    told("allowed is deg or rad", lambda: PitchEnv(step, unit="grad"))
    told("no controller `PIT`", lambda: PitchEnv(step, "PIT"))
    told("2 intervals; an action has 3", lambda: PitchEnv(step, action="gains", box=[(0, 1), (0, 1)]))
    told("lower end first", lambda: PitchEnv(step, box=(1.0, -1.0)))
    told("the box is 3", lambda: PitchEnv(step, box=3))
    told("the box is", lambda: PitchEnv(step, box=(1.0, "a")))
    told("there is no scenario", lambda: PitchEnv("pitch-hald"))
    told("allowed is svg", lambda: PitchEnv(step, render_mode="human"))
    told("allowed is at least 1", lambda: PitchVectorEnv(0, step))
    told("3 seeds", lambda: many.reset(seed=[1, 2, 3]))
    told("seed is -1", lambda: env.reset(seed=-1))
    told("whole number", lambda: env.reset(seed=0.5))
    told("allowed is run", lambda: env.reset(options={"low": 0}))
    with pytest.raises(fspid.Error, match="cannot be read|No such file"):
        PitchEnv(tmp_path / "nothing.toml")


def test_gains_are_not_given_to_a_program(step, tmp_path):
    (tmp_path / "mine.so").write_bytes(b"no library")
    program = "[[controller]]\nname = 'other'\nkind = 'external'\nlibrary = 'mine.so'\n"
    alone = tmp_path / "alone.toml"
    alone.write_text(step.toml.split("controller = ")[0] + program)
    with pytest.raises(fspid.InputError, match="is a program"):
        PitchEnv(alone, "other", action="gains")
    with pytest.raises(fspid.InputError, match="no controller with equations"):
        PitchEnv(alone, action="gains")
    assert PitchEnv(alone).reset(seed=0)[0][0] == 5.0


def test_nothing_is_imported_before_it_is_asked_for():
    program = """
import sys, fspid
assert not {"numpy", "gymnasium"} & set(sys.modules)
sys.modules["gymnasium"] = None
try:
    fspid.gym
except fspid.Error as told:
    assert "pip install fspid[gym]" in str(told)
else:
    raise SystemExit("gymnasium was not missed")
"""
    subprocess.run([sys.executable, "-c", program], check=True)


def test_gymnasium_makes_them_by_name():
    env = gymnasium.make("fspid/Pitch-v0")
    assert env.reset(seed=0)[0].shape == (5,)
    many = gymnasium.make_vec("fspid/Pitch-v0", num_envs=3, scenario="pitch-hold", box=(-2.0, 2.0))
    assert isinstance(many.unwrapped, PitchVectorEnv)
    assert many.metadata["autoreset_mode"].value == "NextStep"
    assert many.reset(seed=0)[0].shape == (3, 5)
