"""Python and the program answer with the same bits, for every command."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

import fspid

from conftest import ROOT

PRESETS = ["pitch-hold", "requirements"]


def written(scenario: fspid.Scenario, folder: Path) -> Path:
    path = folder / "scenario.toml"
    path.write_text(scenario.toml, encoding="utf-8")
    return path


@pytest.mark.parametrize("name", list(fspid.Scenario.presets()))
def test_a_flight_has_the_bits_of_the_program(name, cli, tmp_path):
    scenario = fspid.Scenario.preset(name)
    path = written(scenario, tmp_path)
    flight = scenario.simulate()
    assert flight.to_dict() == json.loads(cli("simulate", path, "--format", "json", "--trace", "trace.csv"))
    assert flight.to_csv() == (tmp_path / "trace.csv").read_text()
    assert str(flight) == cli("simulate", path)


def test_columns_are_those_of_the_trace(step, tmp_path):
    lines = step.simulate().to_csv().splitlines()
    trace = step.simulate()["PID"]
    assert lines[0].split(",") == list(trace)
    for line, *values in zip(lines[1:], *(trace[name] for name in trace), strict=True):
        assert [float(text) for text in line.split(",")] == values


def test_changes_are_those_of_set(cli, tmp_path):
    scenario = fspid.Scenario.preset("pitch-hold")
    path = written(scenario, tmp_path)
    changed = scenario.with_(controller={"PID": {"kp": 1.5}}, loop={"duration_s": 12.0})
    asked = [word for change in changed.changes for word in ("--set", change)]
    assert changed.simulate().to_dict() == json.loads(cli("simulate", path, *asked, "--format", "json"))
    assert changed.simulate().to_dict() != scenario.simulate().to_dict()


@pytest.mark.parametrize("broken_at", ["command", "pitch"])
def test_margins_are_those_of_the_program(broken_at, cli, tmp_path):
    scenario = fspid.Scenario.preset("pitch-hold")
    path = written(scenario, tmp_path)
    answer = scenario.analyse(broken_at=broken_at)
    assert answer.to_dict() == json.loads(cli("analyse", path, "--broken-at", broken_at, "--format", "json"))


def test_verdicts_of_requirements_are_those_of_the_program(cli, tmp_path):
    scenario = fspid.Scenario.preset("requirements")
    path = written(scenario, tmp_path)
    assert scenario.verify("ctms").to_dict() == scenario.verify(["ctms"]).to_dict()
    ours, theirs = scenario.verify(["ctms"]).to_dict(), json.loads(cli("verify", path, "--set", "ctms", "--format", "json"))
    # Where the scenario lies is all that may differ.
    assert json.dumps(ours).replace(str(Path(ours["file"])), "") == json.dumps(theirs).replace(str(path), "")


def test_certificates_are_those_of_the_program(step, cli, tmp_path):
    path = written(step, tmp_path)
    answer = step.certify()
    assert answer.to_dict() == json.loads(cli("certify", path, "--out", "certificates", "--format", "json"))
    for name, text in answer.certificates.items():
        assert (tmp_path / "certificates" / name).read_text() == text


NAVION = {
    "schema": 1,
    "name": "a nonlinear aircraft",
    "aircraft": {"name": "navion", "airspeed_ft_s": 176.0, "altitude_ft": 1000.0},
    "actuator": {"time_constant_s": 0.1},
    "loop": {"sample_period_s": 0.01, "duration_s": 8.0},
    "setpoint": {"kind": "step", "amplitude_deg": 2.0},
    "controller": [
        {"name": "PID", "kind": "pid", "kp": 0.82, "ki": 0.43, "kd": 0.165, "derivative_filter_s": 0.05}
    ],
}


@pytest.mark.parametrize("asked", [("disturbances",), ("nonlinear",), ("family",)])
def test_what_is_asked_beside_stability_is_answered_as_by_the_program(asked, cli, tmp_path):
    drawn = {"path": "actuator.time_constant_s", "name": "servo", "distribution": "uniform", "lower": 0.09, "upper": 0.11}
    scenario = fspid.Scenario.from_dict({**NAVION, "dispersion": [drawn]} if "family" in asked else NAVION)
    path = written(scenario, tmp_path)
    answer = scenario.certify(**dict.fromkeys(asked, True))
    words = [f"--{word}" for word in asked]
    theirs = cli("certify", path, *words, "--out", "certificates", "--format", "json")
    assert answer.good and answer.to_dict() == json.loads(theirs)
    assert str(answer) == cli("certify", path, *words)
    for name, text in answer.certificates.items():
        certificate = tmp_path / "certificates" / name
        assert certificate.read_text() == text
        checked = json.loads(cli("certify", "--check", certificate, "--against", path, "--format", "json"))
        assert checked["answer"] == "holds"
        assert ("nonlinear" in checked) == ("nonlinear" in asked)
    controller = answer.to_dict()["controllers"][0]
    assert ("nonlinear" in controller) == ("nonlinear" in asked)
    assert bool(controller["scope"].get("disturbances")) == ("disturbances" in asked)
    assert ("family" in controller) == ("family" in asked)


CASES = {
    **NAVION,
    "tuning": {
        "objective": [{"measure": "iae_deg_s"}],
        "case": [{"name": "quick servo", "set": []}, {"name": "slow servo", "set": ["actuator.time_constant_s=0.2"]}],
    },
}


@pytest.mark.parametrize("steps", [False, True])
def test_cases_are_certified_as_by_the_program_and_each_certificate_is_proved_anew(steps, cli, tmp_path):
    scenario = fspid.Scenario.from_dict(CASES).with_(loop={"duration_s": 6.0})
    path = written(scenario, tmp_path)
    answer = scenario.certify(cases="tuning", steps=steps)
    words = ["--cases", "tuning", *(["--steps"] if steps else []), "--set", "loop.duration_s=6.0"]
    assert answer.to_dict() == json.loads(cli("certify", path, *words, "--out", "certificates", "--format", "json"))
    assert str(answer) == cli("certify", path, *words)
    assert answer.good and sorted(answer.certificates) == [
        "quick-servo/pid.certificate.json",
        "slow-servo/pid.certificate.json",
    ]
    answer.save(tmp_path / "ours")
    for name, text in answer.certificates.items():
        assert (tmp_path / "certificates" / name).read_text() == (tmp_path / "ours" / name).read_text() == text
    slow = scenario.with_(actuator={"time_constant_s": 0.2})
    certificate = fspid.Certificate.from_file(tmp_path / "ours" / "slow-servo" / "pid.certificate.json")
    assert certificate.check(slow) and certificate.check().verdict == "holds"
    assert certificate.check(scenario).verdict == "another loop"


def test_a_certificate_is_checked_as_by_the_program(step, cli, tmp_path):
    path = written(step, tmp_path)
    step.certify().save(tmp_path / "certificates")
    for file in sorted((tmp_path / "certificates").iterdir()):
        certificate = fspid.Certificate.from_file(file)
        for against, words in ((None, ()), (step, ("--against", path))):
            answer = certificate.check(against)
            theirs = cli("certify", "--check", file, *words, "--format", "json")
            assert answer.to_dict() == json.loads(theirs)
            assert str(answer) == cli("certify", "--check", file, *words)
        edited = fspid.Certificate.from_text(certificate.text.replace('"program"', '"programme"'))
        with pytest.raises(fspid.InputError, match="certificate: .*program"):
            edited.check()
        edited = fspid.Certificate.from_text(certificate.text.replace(step.digest, "1" * 64))
        assert not edited.check() and edited.check().verdict == "edited"


def test_what_cannot_be_certified_or_checked_is_told_with_what_is_allowed(step, tmp_path):
    with pytest.raises(fspid.InputError, match="no cases `tunings`.*`tuning`"):
        step.certify(cases="tunings")
    with pytest.raises(fspid.InputError, match=r"the scenario has no cases of \[contest\]"):
        step.certify(cases="contest")
    with pytest.raises(fspid.InputError, match="steps=True goes with cases"):
        step.certify(steps=True)
    cases = [{"name": f"case {key}", "set": [f"loop.{key}=-1.0"]} for key in ("sample_period_s", "duration_s")]
    wrong = fspid.Scenario.from_dict({**NAVION, "tuning": {"objective": [{"measure": "iae_deg_s"}], "case": cases}})
    with pytest.raises(fspid.ScenarioError) as refused:
        wrong.certify(cases="tuning")
    assert [problem.case for problem in refused.value.problems] == ["case sample_period_s", "case duration_s"]
    with pytest.raises(fspid.FileError, match="none"):
        fspid.Certificate.from_file(tmp_path / "none")
    with pytest.raises(fspid.InputError, match="certificate: "):
        fspid.Certificate.from_text("{}").check()


def test_a_tuned_design_is_that_of_the_program(cli, tmp_path):
    path = ROOT / "scenarios" / "gallery" / "tune-navion.toml"
    design = fspid.Scenario.from_file(path).tune(budget=40, out=tmp_path / "ours.toml")
    answer = json.loads(cli("tune", path, "--budget", 40, "--quiet", "--out", "theirs.toml", "--format", "json"))
    assert design.to_dict() == answer
    ours, theirs = (tmp_path / "ours.toml").read_text(), (tmp_path / "theirs.toml").read_text()
    assert ours == theirs == design.toml


def test_a_rule_gives_the_gains_of_the_program(cli):
    path = ROOT / "scenarios" / "gallery" / "tune-navion.toml"
    design = fspid.Scenario.from_file(path).tune_by_rule("amigo")
    assert design.to_dict() == json.loads(cli("tune", path, "--rule", "amigo", "--format", "json"))


def test_a_campaign_leaves_the_file_of_the_program(cli, tmp_path):
    path = ROOT / "scenarios" / "campaign.toml"
    campaign = fspid.Scenario.from_file(path).campaign(tmp_path / "ours", runs=60, seed=7, shard_runs=25)
    cli("campaign", "run", path, "--runs", 60, "--seed", 7, "--shard-runs", 25, "--quiet", "--out", "theirs")
    assert campaign.file.read_bytes() == (tmp_path / "theirs" / "campaign.parquet").read_bytes()
    report = json.loads(cli("campaign", "report", tmp_path / "ours" / "campaign.parquet", "--format", "json"))
    assert campaign.summary().to_dict() == report


def test_a_contest_answers_as_the_program(cli, tmp_path):
    path = written(fspid.Scenario.preset("contest"), tmp_path)
    ours = fspid.Scenario.from_file(path).contest(tmp_path / "contest", budget=4, seeds=1).to_dict()
    theirs = cli("contest", path, "--budget", 4, "--seeds", 1, "--quiet", "--out", "theirs/contest", "--format", "json")
    assert ours == json.loads(theirs)
