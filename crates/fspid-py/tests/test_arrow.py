"""Columns cross over by Arrow, traces where they lie."""

from __future__ import annotations

import pytest

import fspid

from conftest import ROOT

pyarrow = pytest.importorskip("pyarrow")


def test_a_trace_is_a_table_of_the_same_memory(step):
    trace = step.simulate()["PID"]
    table = pyarrow.table(trace)
    assert table.column_names == list(trace)
    for name, column in trace.items():
        chunk = table[name].chunk(0)
        assert chunk.null_count == 0 and chunk.to_pylist() == column.tolist()
        assert chunk.buffers()[1].address == column.__array_interface__["data"][0]


def test_a_table_outlives_what_it_came_from(step):
    table = pyarrow.table(step.simulate()["PID"])
    assert table["theta_deg"].to_pylist() == step.simulate()["PID"]["theta_deg"].tolist()


def test_the_rows_of_a_campaign_are_those_of_its_file(tmp_path):
    parquet = pytest.importorskip("pyarrow.parquet")
    scenario = fspid.Scenario.from_file(ROOT / "scenarios" / "campaign.toml")
    campaign = scenario.campaign(tmp_path / "c", runs=20, shard_runs=10)
    found, wanted = pyarrow.table(campaign.table()), parquet.read_table(campaign.file)
    assert len(campaign.table()) == wanted.num_rows
    assert found.column_names == wanted.column_names
    for name in found.column_names:
        assert found[name].to_pylist() == wanted[name].to_pylist(), name
