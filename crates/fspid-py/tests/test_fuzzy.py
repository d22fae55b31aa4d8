"""Fuzzy systems and supervisors from Python."""

from __future__ import annotations

import json
import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

import fspid

numbers = st.floats(-8.0, 8.0)


@pytest.fixture(scope="module")
def system():
    return fspid.FuzzySystem.read("mirrored", range=5.0)


@pytest.fixture(scope="module")
def supervisor():
    return fspid.Supervisor("mirrored", 5.0)


def test_a_system_answers_by_name_and_by_place(system):
    assert system(1.0, 0.5) == system(error=1.0, change=0.5) == system(1.0, change=0.5)
    assert set(system(1.0, 0.5)) == set(system.outputs)


def test_answers_are_those_of_the_program(system, supervisor, cli, tmp_path):
    told = json.loads(cli("infer", "--table", "mirrored", "--range", 5, "--error", 1.25, "--change", -0.5, "--format", "json"))
    found = supervisor(1.25, -0.5)
    assert [found.kp, found.ki, found.kd] == [told["delta_kp"], told["delta_ki"], told["delta_kd"]]
    explained = cli("explain", "mirrored", "--range", 5, "--error", 1.25, "--change", -0.5, "--format", "json")
    assert system.explain(1.25, -0.5).to_dict() == json.loads(explained)
    # Two inputs and one output: those of a supervisor take half a minute.
    cli("init", "--template", "fuzzy-system", "tip.toml")
    audit = fspid.FuzzySystem.read(tmp_path / "tip.toml").audit()
    assert audit.to_dict() == json.loads(cli("audit", "tip.toml", "--format", "json"))


@given(st.lists(st.tuples(numbers, numbers), min_size=1, max_size=20))
def test_many_answers_are_those_one_by_one(rows):
    supervisor = fspid.Supervisor("printed", 5.0)
    errors, changes = [row[0] for row in rows], [row[1] for row in rows]
    many = supervisor.infer_many(errors, changes)
    for place, (error, change) in enumerate(rows):
        one = supervisor(error, change)
        assert (many["delta_kp"][place], many["delta_ki"][place], many["delta_kd"][place]) == (one.kp, one.ki, one.kd)


def test_of_many_inputs_the_first_that_is_refused_is_told():
    strict = fspid.Supervisor("printed", 5.0, out_of_range="error")
    errors = [0.1 * (k % 40) for k in range(20_000)]
    changes = list(reversed(errors))
    many = strict.infer_many(errors, changes)
    for place in (0, 4095, 4096, 19_999):
        assert many["delta_kp"][place] == strict(errors[place], changes[place]).kp
    errors[9_000] = errors[17_000] = 6.0
    with pytest.raises(fspid.InputError, match="inputs 9000"):
        strict.infer_many(errors, changes)


def test_columns_of_a_system_are_its_answers(system):
    numpy = pytest.importorskip("numpy")
    error, change = numpy.meshgrid(numpy.linspace(-6, 6, 25), numpy.linspace(-6, 6, 25))
    many = system.infer_many(error.ravel(), change.ravel())
    for place in range(0, error.size, 17):
        one = system(float(error.ravel()[place]), float(change.ravel()[place]))
        assert {name: column[place] for name, column in many.items()} == one


def test_gradients_are_those_of_differences(system):
    step = 1e-6
    slope = system.gradient(0.7, -0.3, output="delta_kp")
    ahead, behind = system(0.7 + step, -0.3)["delta_kp"], system(0.7 - step, -0.3)["delta_kp"]
    assert math.isclose(slope["error"], (ahead - behind) / (2 * step), rel_tol=1e-5)


def test_arrays_of_every_kind_are_read_or_refused_in_words(supervisor):
    numpy = pytest.importorskip("numpy")
    base = numpy.linspace(-4.0, 4.0, 12)
    wanted = supervisor.infer_many(base.tolist(), base.tolist())["delta_kp"].tolist()

    def found(array):
        return supervisor.infer_many(array, array)["delta_kp"].tolist()

    frozen = base.copy()
    frozen.flags.writeable = False
    apart = numpy.repeat(base, 2)[::2]
    for same in (base, frozen, apart, numpy.ma.masked_array(base)):
        assert found(same) == wanted
    assert found(base.astype("f4")) == found([float(x) for x in base.astype("f4")])
    assert found(base.astype(">f8")) == wanted
    assert found(numpy.array([], dtype=float)) == []
    for wrong in (base.astype(complex), base.astype(str), numpy.array([None] * 12)):
        with pytest.raises(fspid.InputError, match="allowed are real numbers"):
            found(wrong)
    with pytest.raises(fspid.InputError, match="error 12, change 11"):
        supervisor.infer_many(base, base[:-1])
    with pytest.raises(fspid.InputError, match="allowed are an array or a sequence"):
        supervisor.infer_many("text", base)

    for shape in ((3, 4), (12, 1)):
        with pytest.raises(fspid.InputError, match="error is an array of 2 dimensions"):
            found(base.reshape(shape))
    with pytest.raises(fspid.InputError, match="change: numbers of it are masked"):
        supervisor.infer_many(base, numpy.ma.masked_greater(base, 0.0))

    class OnADevice:
        __cuda_array_interface__ = {}  # noqa: RUF012

    with pytest.raises(fspid.InputError, match="another device"):
        supervisor.infer_many(OnADevice(), base)


def test_numbers_of_numpy_are_numbers_wherever_one_is_asked_for(system, cli, tmp_path):
    numpy = pytest.importorskip("numpy")
    number = numpy.float64
    ours = system.surface("error", fixed={"change": number(0.25)}, nodes=5)
    assert ours.csv == system.surface("error", fixed={"change": 0.25}, nodes=5).csv
    assert system(number(1.0), number(0.5)) == system(1.0, 0.5)
    # Two inputs and one output: those of a supervisor take half a minute.
    cli("init", "--template", "fuzzy-system", "tip.toml")
    tip = fspid.FuzzySystem.read(tmp_path / "tip.toml")
    first, second = tip.inputs
    found = tip.audit(spans={first: (number(1.0), number(2.0))}, rest={second: number(5.0)})
    assert found.to_dict() == tip.audit(spans={first: (1.0, 2.0)}, rest={second: 5.0}).to_dict()


def test_what_no_rule_concludes_is_absent():
    text = """
[System]
Name='gap'
Type='mamdani'
NumInputs=1
NumOutputs=1
NumRules=1
AndMethod='min'
OrMethod='max'
ImpMethod='min'
AggMethod='max'
DefuzzMethod='centroid'

[Input1]
Name='x'
Range=[0 10]
NumMFs=1
MF1='low':'trimf',[0 1 2]

[Output1]
Name='y'
Range=[0 1]
NumMFs=1
MF1='small':'trimf',[0 0.5 1]

[Rules]
1, 1 (1) : 1
"""
    system = fspid.FuzzySystem.from_text(text, "fis")
    answer = system(9.0)["y"]
    assert isinstance(answer, fspid.Absent) or answer == 0.5


def test_questions_that_are_wrong_say_what_is_allowed(system):
    for ask, told in [
        (lambda: system(1.0), "change missing"),
        (lambda: system(1.0, 2.0, 3.0), "3 inputs are given"),
        (lambda: system(1.0, eror=2.0), "eror is no input; there are error, change"),
        (lambda: system(1.0, 2.0, error=1.0), "error is given twice"),
        (lambda: system.gradient(1.0, 2.0), "output is missing"),
        (lambda: fspid.FuzzySystem.read("nothing.fis"), "nothing.fis"),
        (lambda: fspid.Supervisor("mirrored", -1.0), "range"),
    ]:
        with pytest.raises(fspid.Error, match=told):
            ask()
