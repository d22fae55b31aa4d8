"""Flights whose gains are moved in a notebook."""

import pytest

import fspid

pytest.importorskip("anywidget")


@pytest.fixture
def shown(step):
    return fspid.widget.FlightWidget(step, {"controller.PID.kp": (0.5, 4.0), "setpoint.amplitude_deg": (1.0, 10.0)})


def test_sliders_begin_where_the_scenario_stands_and_show_its_flight(shown, step):
    assert shown.values == {"controller.PID.kp": 2.0, "setpoint.amplitude_deg": 5.0}
    assert shown.scenario.changes == []
    assert shown.drawing == step.simulate().svg()
    assert "settled" in shown.words


def test_a_number_that_moves_flies_again(shown, step):
    shown.values = {**shown.values, "controller.PID.kp": 3.0}
    flown = step.with_({"controller.PID.kp": 3.0}).simulate()
    assert shown.drawing == flown.svg() and shown.words == str(flown)
    assert list(shown.flight["PID"]["theta_deg"]) == list(flown["PID"]["theta_deg"])


def test_a_number_with_which_there_is_no_scenario_is_told_and_the_flight_stays(step):
    shown = fspid.widget.FlightWidget(step, {"loop.sample_period_s": (0.01, 0.1)})
    before = shown.drawing
    shown.values = {"loop.sample_period_s": -1.0}
    assert "loop.sample_period_s" in shown.words
    assert shown.drawing == before
    shown.values = {"loop.sample_period_s": 0.02}
    assert "settled" in shown.words and shown.drawing != before


@pytest.mark.parametrize(
    ("ranges", "told"),
    [({"controller.PID.kq": (0.0, 1.0)}, "kq"), ({"setpoint.kind": (0.0, 1.0)}, "setpoint.kind"), ({"loop.duration_s": (2.0, 1.0)}, "higher")],
)
def test_what_is_no_number_and_ends_the_wrong_way_round_are_refused(ranges, told, step):
    with pytest.raises(fspid.InputError, match=told):
        fspid.widget.FlightWidget(step, ranges)
