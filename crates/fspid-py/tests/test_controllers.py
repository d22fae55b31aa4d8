"""Controllers by themselves, transfer functions, aircraft."""

from __future__ import annotations

import json
import math
import threading

import pytest

import fspid
from fspid import aircraft, lti


def test_a_controller_by_itself_commands_what_it_does_in_flight():
    scenario = fspid.Scenario.preset("pitch-hold")
    flight = scenario.simulate()
    if "measured_theta_deg" in flight["PID"]:
        pytest.skip("the scenario has sensors")
    for name in scenario.controllers:
        controller, trace = scenario.controller(name), flight[name]
        command = controller.step_many(
            [math.radians(x) for x in trace["setpoint_deg"]], [math.radians(x) for x in trace["theta_deg"]]
        )
        assert max(abs(math.degrees(a) - b) for a, b in zip(command, trace["command_deg"], strict=True)) < 1e-9
        assert controller.gains == pytest.approx((trace["kp"][-1], trace["ki"][-1], trace["kd"][-1]), rel=1e-9)


def test_many_steps_are_those_one_by_one():
    one, many = (fspid.Pid(0.01, kp=2.0, ki=0.5, kd=0.1) for _ in range(2))
    samples = [(0.1, 0.01 * k, 0.0) for k in range(50)] + [(math.nan, 0.0, 0.0), (0.1, 0.2, 0.0)]
    alone = [one.step(*sample) for sample in samples]
    assert many.step_many(*zip(*samples, strict=True)).tolist() == alone
    assert one.faults == many.faults != "none"
    one.reset()
    assert one.faults == "none"


def test_no_sample_is_lost_between_threads():
    # Enough that threads meet: a call takes tens of milliseconds without the interpreter.
    setpoints, measurements = [1e-9] * 1_000_000, [0.0] * 1_000_000
    pid = fspid.Pid(0.01, kp=1.0, ki=1.0, kd=0.0)
    refused, answered = [], []

    def many():
        try:
            answered.append(pid.step_many(setpoints, measurements))
        except fspid.InputError as told:
            refused.append(str(told))

    threads = [threading.Thread(target=many) for _ in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(answered) + len(refused) == 8
    assert answered
    assert all("each thread needs a controller of its own" in told for told in refused)
    # What is remembered is what so many samples one after the other leave: whoever was refused left nothing.
    alone = fspid.Pid(0.01, kp=1.0, ki=1.0, kd=0.0)
    for _ in answered:
        alone.step_many(setpoints, measurements)
    assert pid.step(1e-9, 0.0) == alone.step(1e-9, 0.0)


def test_a_controller_that_uses_the_rate_is_not_answered_without():
    damped, plain = fspid.Pid(0.01, kp=2.0, ki=0.5, kd=0.0, rate_gain=0.4), fspid.Pid(0.01, kp=2.0, ki=0.5, kd=0.0)
    assert (damped.uses_rate, plain.uses_rate) == (True, False)
    for asked in (
        lambda: damped.step(0.1, 0.0),
        lambda: damped.step_many([0.1], [0.0]),
        lambda: damped.track(0.1, 0.0, 0.02),
    ):
        with pytest.raises(fspid.InputError, match="give `rate` with each sample"):
            asked()
    # What was refused left nothing, and a rate that is not needed moves nothing.
    assert damped.step(0.1, 0.0, 0.25) == pytest.approx(plain.step(0.1, 0.0, 0.25) - 0.1)
    assert plain.track(0.1, 0.0, 0.02) == 0.02


def test_settings_of_a_controller_are_checked_as_in_the_file():
    with pytest.raises(fspid.ScenarioError) as told:
        fspid.Pid(0.01, kp="much", ki=0.5, kd=0.1, kq=1.0)
    assert {problem.path for problem in told.value.problems} >= {"controller[0].kp", "controller[0].kq"}
    with pytest.raises(fspid.InputError, match="name and kind cannot be set"):
        fspid.Pid(0.01, kp=1.0, name="q", kind="fspid")


def test_a_controller_follows_who_flies_and_takes_over_without_a_bump():
    pid = fspid.Pid(0.01, kp=2.0, ki=0.5, kd=0.0)
    for _ in range(5):
        assert pid.track(0.1, 0.05, 0.02) == 0.02
    assert abs(pid.step(0.1, 0.05) - 0.02) < 0.001
    assert pid.hold() == pid.hold()


def test_margins_are_those_of_python_control():
    control = pytest.importorskip("control")
    system = control.tf([11.7304, 22.578], [1.0, 4.9676, 12.941, 0.0]) * control.tf([10.0], [1.0, 10.0])
    found = lti.margins(system)
    gain, phase, *_ = control.margin(system)
    assert found["gain_margin"] == pytest.approx(gain, rel=1e-6)
    assert found["phase_margin_deg"] == pytest.approx(phase, rel=1e-6)
    assert found["stable"] is True
    signal = pytest.importorskip("scipy.signal")
    assert lti.margins(signal.TransferFunction([11.7304, 22.578], [1.0, 4.9676, 12.941, 0.0]))["stable"] is True


def test_an_unstable_loop_has_no_margins():
    found = lti.margins([10.0], [1.0, 1.0, 1.0, 0.0])
    assert found["stable"] is False
    assert isinstance(found["gain_margin"], fspid.Absent)
    assert "unstable" in found["gain_margin"].reason


def test_aircraft_answer_as_the_program(cli):
    name = "navion"
    names = [each["name"] for each in aircraft.known().to_dict()["aircraft"]]
    name = next(each for each in names if "navion" in each)
    for what, ours in [("trim", aircraft.trim(name, speed="60m/s")), ("modes", aircraft.modes(name, speed="60m/s"))]:
        assert ours.to_dict() == json.loads(cli("aircraft", what, name, "--speed", "60m/s", "--format", "json"))
    told = json.loads(cli("aircraft", "linearise", name, "--format", "json"))
    assert aircraft.linearise(name).to_dict() == told


def test_other_states_of_a_linear_model_are_refused():
    with pytest.raises(fspid.InputError, match="allowed are 'components' and 'speed-and-angle'"):
        aircraft.linearise("navion", states="speed_and_angle")


def test_an_aircraft_of_one_s_own_is_checked_as_by_the_program(cli, tmp_path):
    mine = tmp_path / "mine.toml"
    cli("init", "--template", "aircraft", str(mine))
    mine.write_text(mine.read_text().replace("elevator = -0.8488", "elevator = 0.8488"))
    checked = aircraft.check(mine)
    assert checked.to_dict() == json.loads(cli("check", str(mine), "--format", "json"))
    assert checked.to_dict()["warnings"][0].startswith("pitch by elevator is 0.8488: ")
