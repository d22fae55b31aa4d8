"""Scenarios in Python: made, changed, refused."""

from __future__ import annotations

import enum
import json
import math
import pickle
import subprocess
import sys
import threading
import time

import pytest
from hypothesis import given
from hypothesis import strategies as st

import fspid
from fspid._toml import value_of

from conftest import ROOT, STEP


def test_a_scenario_says_what_it_is(step):
    assert repr(step) == "<Scenario 'five degrees': PID>"
    assert step.controllers == ["PID"]
    assert step.check() == []


def test_a_dictionary_that_was_handed_out_is_the_callers_own(step):
    flight = step.simulate()
    for answer in (flight, flight["PID"], step.analyse()):
        told = answer.to_dict()
        answer.to_dict().clear()
        assert answer.to_dict() == told != {}
    flight.to_dict()["controllers"][0]["failed"] = True
    step.analyse()["PID"].clear()
    assert flight["PID"].failed is False


def test_everything_that_is_wrong_is_told_at_once():
    wrong = {**STEP, "loop": {"sample_period_s": -1.0, "duratio_s": 20.0}}
    with pytest.raises(fspid.ScenarioError) as told:
        fspid.Scenario.from_dict(wrong)
    problems = {problem.path: problem for problem in told.value.problems}
    assert set(problems) >= {"loop.sample_period_s", "loop.duratio_s"}
    assert problems["loop.sample_period_s"].found == "-1.0"
    assert problems["loop.sample_period_s"].allowed
    assert "did you mean `duration_s`" in problems["loop.duratio_s"].message
    assert isinstance(told.value, fspid.InputError) and isinstance(told.value, ValueError)


def test_check_tells_of_the_cases_that_make_no_scenario_in_the_words_of_the_program(cli, tmp_path):
    case = {"name": "misspelt", "group": "commands", "set": ["plant.presett=navion-paper"]}
    judged = {**case, "name": "backwards", "set": ["loop.duration_s=-1"]}
    tuning = {"objective": [{"measure": "iae_deg_s"}], "case": [{"name": case["name"], "set": case["set"]}]}
    scenario = fspid.Scenario.from_dict({**STEP, "tuning": tuning, "contest": {"case": [judged]}})
    with pytest.raises(fspid.ScenarioError, match='case "misspelt" makes the scenario wrong') as told:
        scenario.check()
    problems = [(problem.case, problem.path) for problem in told.value.problems]
    assert problems == [("misspelt", "plant.presett"), ("backwards", "loop.duration_s")]
    assert "in case misspelt" in repr(told.value.problems[0])
    (tmp_path / "scenario.toml").write_text(scenario.toml)
    error = json.loads(cli("check", "scenario.toml", "--format", "json"))["error"]
    assert error["message"] == str(told.value)
    assert [problem["case"] for problem in error["problems"]["problems"]] == ["misspelt", "backwards"]


def test_check_tells_of_what_dispersions_draw(step):
    drawn = {"path": "loop.duration_s", "name": "end", "distribution": "uniform", "lower": -1.0, "upper": 1.0}
    with pytest.raises(fspid.ScenarioError) as told:
        fspid.Scenario.from_dict({**STEP, "dispersion": [drawn]}).check()
    assert all(problem.case is None for problem in told.value.problems)


def test_an_unknown_preset_is_answered_with_those_that_there_are():
    with pytest.raises(fspid.InputError, match="pitch-hold"):
        fspid.Scenario.preset("pitch-hol")


def test_a_file_that_is_not_there_is_told_by_name(tmp_path):
    with pytest.raises(fspid.FileError, match="nothing.toml"):
        fspid.Scenario.from_file(tmp_path / "nothing.toml")


def test_a_file_that_changed_since_it_was_read_is_not_flown_as_another(tmp_path):
    path = tmp_path / "pitch.toml"
    path.write_text(fspid.Scenario.preset("requirements").toml)
    scenario = fspid.Scenario.from_file(path)
    path.write_text(path.read_text() + "\n# more\n")
    with pytest.raises(fspid.InputError, match="has changed since it was read"):
        scenario.verify()


def test_a_measure_that_there_is_not_says_why_and_is_no_number(step):
    slow = step.with_(controller={"PID": {"kp": 0.05, "ki": 0.0, "kd": 0.0}}, loop={"duration_s": 1.0})
    found = slow.simulate()["PID"].measures["settling_time_s"]
    assert isinstance(found, fspid.Absent)
    assert not found and "not settled" in found.reason


def test_an_unstable_loop_is_an_answer_and_not_good(step):
    flight = step.with_({"controller.PID.kp": -20.0}).simulate()
    assert not flight.good and not flight
    assert flight["PID"].failed


def test_a_controller_that_there_is_not_is_answered_with_those_that_there_are(step):
    with pytest.raises(KeyError, match="there are PID"):
        step.simulate()["FSPID"]
    with pytest.raises(KeyError, match="theta_deg"):
        step.simulate()["PID"]["theta"]


values = st.recursive(
    st.booleans() | st.integers(-(2**63), 2**63 - 1) | st.floats(allow_nan=False, allow_infinity=False) | st.text(),
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.text(), inner, max_size=4),
    max_leaves=12,
)


@given(values)
def test_every_value_is_written_as_toml_reads_it(value):
    tomllib = pytest.importorskip("tomllib")
    try:
        read = tomllib.loads(f"it = {value_of(value)}")["it"]
    except UnicodeEncodeError:
        return
    assert read == value


class Size(float, enum.Enum):
    """A number that has a name."""

    LARGE = 1.5


def test_numbers_that_have_words_of_their_own_are_written_as_numbers():
    numpy = pytest.importorskip("numpy")
    for value in [numpy.float64(1.5), numpy.float32(1.5), Size.LARGE]:
        assert value_of(value) == "1.5"
        assert value_of([value]) == "[1.5]"
    assert value_of(numpy.linspace(0.0, 1.0, 3)[1]) == "0.5"


@pytest.mark.parametrize("wrong", [None, object(), {1: 2}, {"plant": None}, {"plant": {1, 2}}, b"bytes"])
def test_what_is_no_scenario_is_refused_in_words(wrong):
    with pytest.raises(fspid.Error):
        fspid.Scenario.from_dict(wrong)


def test_flights_do_not_hold_the_interpreter(step):
    counted, stop = [0], threading.Event()

    def count():
        while not stop.is_set():
            counted[0] += 1
            time.sleep(0.001)

    slow = fspid.Scenario.from_file(ROOT / "scenarios" / "gallery" / "tune-navion.toml")
    beside = threading.Thread(target=count)
    beside.start()
    slow.tune(budget=60)
    stop.set()
    beside.join()
    assert counted[0] > 5


@pytest.mark.skipif(sys.platform == "win32", reason="sends a signal as a terminal does")
def test_ctrl_c_leaves_a_campaign_that_goes_on(tmp_path):
    import signal

    work = f"""
import fspid
scenario = fspid.Scenario.from_file({str(ROOT / "scenarios" / "campaign.toml")!r})
print("begun", flush=True)
scenario.campaign({str(tmp_path / "c")!r}, runs=200000, shard_runs=200, threads=1)
"""
    flying = subprocess.Popen([sys.executable, "-c", work], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    assert flying.stdout is not None and flying.stdout.readline() == "begun\n"
    shards = tmp_path / "c" / "shards"
    while flying.poll() is None and not (shards.exists() and any(shards.glob("*.parquet"))):
        time.sleep(0.05)
    flying.send_signal(signal.SIGINT)
    begun = time.monotonic()
    _, told = flying.communicate(timeout=30)
    assert "KeyboardInterrupt" in told
    # Far above what is promised, on a machine that does other things: it must not wait for the campaign.
    assert time.monotonic() - begun < 10.0
    assert fspid.Campaign.from_folder(tmp_path / "c").fly_shard(0) is False


def test_numpy_reads_columns_where_they_lie(step):
    numpy = pytest.importorskip("numpy")
    column = step.simulate()["PID"]["theta_deg"]
    array = numpy.asarray(column)
    assert array.dtype == numpy.float64 and array.shape == (len(column),)
    assert array.__array_interface__["data"][0] == column.__array_interface__["data"][0]
    assert not array.flags.writeable
    assert array.tolist() == column.tolist() == [column[k] for k in range(len(column))]
    assert math.isclose(column[-1], array[-1])
    with pytest.raises(IndexError):
        column[len(column)]


def test_import_needs_nothing_and_is_quick():
    asked = "import sys, fspid; print([m for m in ('numpy', 'matplotlib', 'json') if m in sys.modules])"
    told = subprocess.run([sys.executable, "-c", asked], capture_output=True, text=True, check=True).stdout
    assert told.strip() == "[]"


def test_errors_travel_between_processes():
    error = fspid.ScenarioError("wrong", "{}")
    assert str(pickle.loads(pickle.dumps(error))) == "wrong"


def test_margins_of_a_loop_that_is_unstable_are_absent_with_the_reason():
    analysis = fspid.Scenario.preset("paper/own/figure-5").analyse()
    assert analysis["PC"]["phase_margin_deg"] > 0.0
    found = analysis["FSPID"]
    assert (found["stable"], found["stability"]) == (False, "unstable")
    assert found["phase_margin_deg"] == fspid.Absent(found["absent"])
    assert found["absent"].startswith("the loop is unstable: spectral radius 1.")
    assert found["absent"] in str(analysis)


def test_every_preset_is_a_scenario_and_pages_have_drawings_by_their_titles():
    presets = fspid.Scenario.presets()
    assert {"pitch-hold", "paper/own/figure-8b", "paper/shared/figure-5"} <= set(presets)
    assert all(presets.values()) and all(fspid.Scenario.preset(name) for name in presets)
    analysis = fspid.Scenario.preset("pitch-hold").analyse()
    figures = analysis.figures
    # Two of them have one title.
    assert len(figures) == (analysis._native.page or "").count("<svg")
    assert figures["Open loop: gain and phase"].startswith("<svg")


def test_an_open_loop_has_its_margins_where_they_are_read_off_and_is_drawn_on_two_axes():
    pyplot = pytest.importorskip("matplotlib.pyplot")
    pyplot.switch_backend("agg")
    analysis = fspid.Scenario.preset("pitch-hold").analyse()
    for name, loop in analysis.open_loops.items():
        known = analysis[name]
        above = [gain > 0.0 for gain in loop["gain_db"]]
        last = max(number for number, it in enumerate(above) if it)
        # The gain crossover lies between two neighbouring points.
        assert loop["frequency_rad_s"][last] <= known["gain_crossover_rad_s"] <= loop["frequency_rad_s"][last + 1]
        margins = sorted(180.0 + loop["phase_deg"][number] for number in (last, last + 1))
        assert margins[0] <= known["phase_margin_deg"] <= margins[1]
    gain, phase = analysis.plot()
    assert list(phase.lines[0].get_ydata()) == list(analysis.open_loops["PID"]["phase_deg"])
    assert [text.get_text() for text in gain.get_legend().get_texts()] == list(analysis.open_loops)
    with pytest.raises(fspid.InputError, match="this draws on two"):
        analysis.plot(ax=[gain])
    pyplot.close("all")


def test_answers_draw_themselves_into_axes_that_are_given(step, tmp_path):
    pyplot = pytest.importorskip("matplotlib.pyplot")
    pyplot.switch_backend("agg")

    def drawn(answer):
        figure, ax = pyplot.subplots()
        assert answer.plot(ax=ax) is ax
        labels = [text.get_text() for text in ax.get_yticklabels()]
        figure.savefig(tmp_path / "drawn.png")
        pyplot.close(figure)
        return ax, labels

    verification = fspid.Scenario.preset("requirements").verify()
    ax, labels = drawn(verification)
    assert labels[0] == "R-1 PID: overshoot_pct at most 30 %"
    first = verification.to_dict()["requirements"][0]
    assert ax.patches[0].get_width() == pytest.approx(first["value"] / first["most"])
    design = fspid.Scenario.preset("tuning").tune(budget=10)
    assert drawn(design)[1] == [each["path"] for each in design.to_dict()["parameters"]]
    summary = fspid.Scenario.preset("campaign").campaign(tmp_path / "c", runs=20).summary()
    assert drawn(summary)[1] == ["PID", "FSPID"]
    proofs = fspid.Scenario.preset("campaign").certify()
    assert drawn(proofs)[1][0].startswith(f"PID, {proofs.to_dict()['controllers'][0]['verdict']}: kp ")
    contest = fspid.Scenario.preset("contest").contest(tmp_path / "contest", budget=8)
    ax, labels = drawn(contest)
    facts = contest.to_dict()
    assert [label.split(" (")[0] for label in labels] == facts["ranking"]
    assert ax.get_title() == facts["verdict"]["words"]
    with pytest.raises(fspid.InputError, match="iae_deg_s"):
        contest.plot(measure="beauty")
    ax, _ = drawn(step.simulate()["PID"])
    assert list(ax.lines[0].get_ydata()) == list(step.simulate()["PID"]["theta_deg"])
