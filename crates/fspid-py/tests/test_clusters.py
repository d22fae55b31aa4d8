"""Campaigns on engines: the same bytes, whoever flew and whoever went away."""

from __future__ import annotations

from dataclasses import replace

import pytest

import fspid
from fspid.engines import Progress
from fspid.engines.job import ShardJob, WrongBuild

from conftest import ROOT

RUNS, SHARD_RUNS = 240, 20


@pytest.fixture(scope="module")
def scenario():
    return fspid.Scenario.from_file(ROOT / "scenarios" / "campaign.toml")


@pytest.fixture(scope="module")
def here(scenario, tmp_path_factory):
    """The file of a campaign that was flown on this machine."""
    folder = tmp_path_factory.mktemp("here")
    return scenario.campaign(folder / "c", runs=RUNS, shard_runs=SHARD_RUNS).file.read_bytes()


def planned(scenario, folder):
    return scenario.plan_campaign(folder / "c", runs=RUNS, shard_runs=SHARD_RUNS)


def test_a_job_flies_shards_where_the_drivers_folder_is_not_seen(scenario, here, tmp_path):
    campaign = planned(scenario, tmp_path)
    job = ShardJob.of(campaign)
    for number in campaign.missing():
        campaign.put(number, job.fly(number))
    campaign.merge()
    assert campaign.file.read_bytes() == here


def test_a_campaign_that_is_cut_otherwise_is_flown_as_it_is_cut_now(scenario, here, tmp_path):
    coarse = scenario.plan_campaign(tmp_path / "coarse", runs=RUNS, shard_runs=RUNS)
    ShardJob.of(coarse).fly(0)
    fine = planned(scenario, tmp_path)
    job = ShardJob.of(fine)
    assert fine.id == coarse.id
    fine.put(1, job.fly(1))
    assert 1 not in fine.missing()


def test_files_that_a_scenario_names_travel_with_it(tmp_path):
    (tmp_path / "plants").mkdir()
    (tmp_path / "work" / "scenarios").mkdir(parents=True)
    plant = (ROOT / "data" / "plants" / "b747-paper.toml").read_text()
    (tmp_path / "plants" / "ours.toml").write_text(plant)
    text = (ROOT / "scenarios" / "campaign.toml").read_text()
    text = text.replace('preset = "b747-paper"', 'file = "../../plants/ours.toml"').replace("plant.preset.", "plant.file.")
    path = tmp_path / "work" / "scenarios" / "campaign.toml"
    path.write_text(text)
    campaign = fspid.Scenario.from_file(path).plan_campaign(tmp_path / "c", runs=4, shard_runs=2)
    job = ShardJob.of(campaign)
    assert [name for name, _ in job.files] == ["../../plants/ours.toml"]
    # A worker elsewhere sees none of it.
    (tmp_path / "plants" / "ours.toml").unlink()
    part = job.fly(0)
    (tmp_path / "plants" / "ours.toml").write_text(plant)
    campaign.put(0, part)
    assert campaign.missing() == [1]


def test_a_worker_of_another_build_flies_nothing(scenario, tmp_path):
    job = replace(ShardJob.of(planned(scenario, tmp_path)), build="another")
    with pytest.raises(WrongBuild, match="install the same wheel everywhere"):
        job.fly(0)


def test_what_is_no_part_of_the_campaign_is_not_taken_in(scenario, tmp_path):
    campaign = planned(scenario, tmp_path)
    other = scenario.plan_campaign(tmp_path / "other", runs=RUNS, seed=2, shard_runs=SHARD_RUNS)
    part = ShardJob.of(campaign).fly(1)
    for number, wrong in [(0, part), (1, part[:-1]), (1, b""), (1, ShardJob.of(other).fly(1))]:
        with pytest.raises(fspid.Error, match="is not shard"):
            campaign.put(number, wrong)
    assert campaign.missing() == list(range(campaign.shards))
    with pytest.raises(fspid.Error, match="shard"):
        campaign.put(campaign.shards, part)


def test_progress_says_rate_and_time_left():
    now = [0.0]
    progress = Progress(10, 4, clock=lambda: now[0])
    assert progress.left_s is None and str(progress) == "4 of 10 shards"
    now[0], progress.flown = 4.0, 2
    assert progress.shards_s == 0.5 and progress.left_s == 8.0
    assert str(progress) == "6 of 10 shards, 0.5 a second, about 8 s left"


def test_an_engine_that_there_is_not_is_answered_with_those_that_there_are(scenario, tmp_path):
    with pytest.raises(fspid.InputError, match="local, ray, dask"):
        planned(scenario, tmp_path).run(engine="mpi")


@pytest.mark.parametrize(("engine", "address"), [("ray", "127.0.0.1:1"), ("ray", "nonsense"), ("dask", "tcp://127.0.0.1:1")])
def test_an_address_without_a_cluster_is_told_within_ten_seconds(engine, address, scenario, tmp_path):
    import time

    pytest.importorskip({"ray": "ray", "dask": "distributed"}[engine])
    begun = time.monotonic()
    with pytest.raises(fspid.InputError, match="there is no|is no address"):
        planned(scenario, tmp_path).run(engine=engine, address=address)
    # Importing an engine for the first time counts too.
    assert time.monotonic() - begun < 30.0


def test_a_node_of_ray_that_is_killed_does_not_show(cluster, scenario, here, tmp_path):
    second = cluster.add_node(num_cpus=1)
    killed = []

    def watch(progress):
        if progress.flown == 3:
            cluster.remove_node(second, allow_graceful=False)
            killed.append(progress.flown)

    campaign = scenario.campaign(tmp_path / "c", runs=RUNS, shard_runs=SHARD_RUNS, engine="ray", watch=watch)
    assert killed == [3]
    assert campaign.file.read_bytes() == here


def test_a_worker_of_dask_that_is_killed_does_not_show(scenario, here, tmp_path):
    distributed = pytest.importorskip("distributed")
    killed = []

    def watch(progress):
        if progress.flown == 3:
            pid = next(iter(client.run(__import__("os").getpid).values()))
            __import__("os").kill(pid, 9)
            killed.append(progress.flown)

    with (
        distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster,
        distributed.Client(cluster) as client,
    ):
        campaign = scenario.campaign(
            tmp_path / "c", runs=RUNS, shard_runs=SHARD_RUNS, engine="dask", client=client, watch=watch
        )
    assert killed == [3]
    assert campaign.file.read_bytes() == here
