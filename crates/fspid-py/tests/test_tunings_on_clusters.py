"""Tunings and contests on engines: the same design and the same bytes, whoever flew and whoever went away."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
import time
from dataclasses import replace
from pathlib import Path

import pytest

import fspid
from fspid import _core
from fspid.engines import SearchProgress
from fspid.engines.flights import Flights, blocks
from fspid.engines.job import FlightsJob, WrongBuild
from fspid.engines.window import Engine, Lost

from conftest import ROOT, program

#: A case of the tuning names a file, and so does one of the contest: both have to travel.
TEXT = """
schema = 1
name = "tuned elsewhere"

[plant]
preset = "navion-paper"

[actuator]
time_constant_s = 0.1

[loop]
sample_period_s = 0.01
duration_s = 10.0

[setpoint]
kind = "step"
amplitude_deg = 2.0

[[controller]]
name = "PID"
kind = "pid"
kp = { tune = [0.1, 40.0], scale = "log", start = 1.0 }
ki = { tune = [0.01, 5.0], scale = "log", start = 0.5 }
kd = 0.1
derivative_filter_s = 0.05

[[controller]]
name = "P"
kind = "p"
kp = { tune = [0.1, 3.0], scale = "log", start = 0.8 }

[[requirement]]
measure = "overshoot_pct"
most = 30.0
controller = "PID"

[[dispersion]]
path = "actuator.time_constant_s"
distribution = "uniform"
lower = 0.7
upper = 1.3
relative = true

[tuning]
controller = "PID"
budget = 40
runs = 10

[[tuning.objective]]
measure = "iae_deg_s"

[[tuning.case]]
name = "as it is"
set = []

[[tuning.case]]
name = "ours"
set = ["plant={ file = 'ours.toml' }"]

[contest]
seeds = 2
runs = 5

[[contest.case]]
name = "ours, 4 deg"
set = ["plant={ file = 'ours.toml' }", "setpoint.amplitude_deg=4.0"]

[[contest.case]]
name = "1 deg"
set = ["setpoint.amplitude_deg=1.0"]
"""


@pytest.fixture(scope="module")
def path(tmp_path_factory):
    folder = tmp_path_factory.mktemp("scenario")
    (folder / "ours.toml").write_text((ROOT / "data" / "plants" / "navion-paper.toml").read_text())
    (folder / "pitch.toml").write_text(TEXT)
    return folder / "pitch.toml"


@pytest.fixture(scope="module")
def scenario(path):
    return fspid.Scenario.from_file(path)


def tuned(scenario, folder, **options):
    """The bytes of a design, its text for people, and those of its history."""
    # Beside the scenario, from where it names files.
    folder.mkdir(exist_ok=True)
    history = folder / "history.parquet"
    design = scenario.tune("PID", history=history, **options)
    return design.toml, str(design), history.read_bytes()


@pytest.fixture(scope="module")
def here(scenario, tmp_path_factory):
    """What a tuning on this machine comes to."""
    return tuned(scenario, tmp_path_factory.mktemp("here"))


@pytest.fixture(scope="module")
def contest_here(scenario, tmp_path_factory):
    """The folder of a contest that was held on this machine."""
    folder = tmp_path_factory.mktemp("contest") / "c"
    scenario.contest(folder, budget=8)
    return files(folder)


def files(folder):
    everything = sorted(it for it in Path(folder).rglob("*") if it.is_file() and it.name != "lock")
    return {str(it.relative_to(folder)): it.read_bytes() for it in everything}


class Here(Engine):
    """An engine whose workers are this process; every third task is lost once."""

    def __init__(self, processors=2, losing=0):
        super().__init__()
        self._processors, self._losing = processors, losing
        self.given = self.cancelled = 0

    def __enter__(self):
        return self

    def __exit__(self, *_):
        pass

    @property
    def processors(self):
        return self._processors

    def share(self, job):
        return job

    def _give(self, job, unit):
        self.given += 1
        return (self.given, job, unit)

    def _ready(self, waiting):
        # The last first: an order's answers come in any order.
        return [(0, None, None), waiting[-1]]

    def _answer(self, task):
        number, job, unit = task
        if self._losing and number % self._losing == 0:
            raise Lost
        return job.fly(unit)

    def _cancel(self, waiting):
        self.cancelled += len(waiting)


def test_blocks_hold_every_flight_once_and_lanes_whole():
    for flights in [1, 7, 8, 9, 100, 1001]:
        for processors in [1, 2, 7]:
            for flight_s in [None, 0.0, 0.001, 0.1, 3.0]:
                parts = blocks(flights, 8, processors, flight_s)
                assert [first for first, _ in parts] == [0, *(end for _, end in parts[:-1])]
                assert parts[-1][1] == flights and all(first % 8 == 0 and first < end for first, end in parts)
                assert len(parts) >= min(processors, -(-flights // 8))


def test_blocks_last_two_to_twenty_seconds_where_there_is_so_much():
    for processors in [2, 100]:
        for flight_s in [0.001, 0.02, 0.5]:
            seconds = [flight_s * (end - first) for first, end in blocks(200_000, 8, processors, flight_s)]
            if flight_s * 200_000 / processors >= 2.0:
                assert 1.9 <= min(seconds) and max(seconds) <= 24.0, (processors, flight_s)
            else:
                assert len(seconds) == processors


def test_a_tuning_has_the_same_design_and_history_whoever_flies_and_whatever_is_lost(scenario, here, tmp_path):
    engine = Here(losing=3)
    fly = Flights(engine, scenario._core)
    wanted = {"controller": "PID", "history": tmp_path / "h.parquet", "threads": 1, "anywhere": False}
    wanted |= dict.fromkeys(["optimiser", "budget", "seed", "population", "out"])
    answer = scenario._core.tune(wanted, fly)
    assert (answer.files[0][1], answer.text, (tmp_path / "h.parquet").read_bytes()) == here
    assert engine.lost > 3 and fly.tasks > 10


def test_a_worker_of_another_build_flies_nothing(scenario):
    job = replace(FlightsJob.of(scenario._core), build="another")
    with pytest.raises(WrongBuild, match="install the same wheel everywhere"):
        job.fly(("{}", 0, 1))


def test_what_is_no_order_or_about_another_scenario_is_refused(scenario):
    job = FlightsJob.of(scenario._core)
    with pytest.raises(fspid.Error, match="this is no order"):
        job.fly(("{}", 0, 1))
    orders = []

    def fly(order, flights, at_once):
        orders.append(order)
        raise fspid.Error("enough")

    for changed in [scenario, scenario.with_({"actuator.time_constant_s": 0.2})]:
        with pytest.raises(fspid.Error, match="enough"):
            changed._core.tune(dict.fromkeys(["optimiser", "budget", "seed", "population", "out", "history"])
                               | {"controller": "PID", "threads": 1, "anywhere": False}, fly)
    assert job.fly((orders[0], 0, 1))[1]
    with pytest.raises(fspid.Error, match="not what the driver asks about"):
        job.fly((orders[1], 0, 1))


def test_what_a_carrier_raises_goes_on_as_it_was_raised(scenario, tmp_path):
    class Own(Exception):
        pass

    def fly(order, flights, at_once):
        raise Own("mine")

    with pytest.raises(Own, match="mine"):
        scenario._core.contest({"out": tmp_path / "c", "seeds": 1, "budget": 4, "threads": 1}, fly)


@pytest.mark.parametrize("what", ["tune", "contest"])
def test_engines_that_there_are_not_and_options_without_one_are_refused(what, scenario, tmp_path):
    ask = {"tune": lambda **it: scenario.tune("PID", **it), "contest": lambda **it: scenario.contest(tmp_path / "c", **it)}[what]
    with pytest.raises(fspid.InputError, match="local, ray, dask"):
        ask(engine="slurm")
    with pytest.raises(fspid.InputError, match="address: this goes with an engine"):
        ask(address="127.0.0.1:1")


@pytest.mark.parametrize(("engine", "address"), [("ray", "127.0.0.1:1"), ("dask", "tcp://127.0.0.1:1")])
def test_an_address_without_a_cluster_is_told(engine, address, scenario):
    pytest.importorskip({"ray": "ray", "dask": "distributed"}[engine])
    with pytest.raises(fspid.InputError, match="there is no"):
        scenario.tune("PID", engine=engine, address=address)


def test_progress_says_which_search_and_what_was_lost():
    assert str(SearchProgress((3, 60))) == "3 of 60 candidates"
    assert str(SearchProgress((3, 60), (2, 4), 1)) == "tuning 2 of 4, 3 of 60 candidates, 1 given out again"


def driver(path, call):
    """A process that asks the scenario something."""
    script = f"import fspid; scenario = fspid.Scenario.from_file({str(path)!r}); {call}"
    return subprocess.Popen([sys.executable, "-c", script], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)


def interrupted(process):
    """How long it takes to end after Ctrl-C, s."""
    begun = time.monotonic()
    process.send_signal(signal.SIGINT)
    _, told = process.communicate(timeout=60)
    assert "KeyboardInterrupt" in told, told
    return time.monotonic() - begun


@pytest.mark.parametrize("call", ["tune('PID', budget=400, population=200)", "contest('long', budget=400)"])
def test_ctrl_c_does_not_wait_for_a_generation(call, path, tmp_path):
    # One that takes minutes.
    long = path.with_name("long.toml")
    long.write_text(TEXT.replace("runs = 10", "runs = 2000"))
    process = driver(long, f"import os; os.chdir({str(tmp_path)!r}); scenario.{call}")
    time.sleep(2.0)
    assert process.poll() is None
    # 0.2 s on a machine that does nothing else (docs/measurements.md).
    assert interrupted(process) < 5.0


def test_a_tuning_that_ctrl_c_has_stopped_goes_on_to_the_same_design(scenario, path, here, tmp_path):
    state = path.with_name("pitch.toml.PID.state.json")
    process = driver(path, "scenario.tune('PID', threads=1)")
    while not state.exists():
        assert process.poll() is None
        time.sleep(0.01)
    interrupted(process)
    assert state.exists()
    assert tuned(scenario, tmp_path) == here
    assert not state.exists()


def test_a_worker_of_ray_that_is_killed_within_a_generation_does_not_show(cluster, scenario, here, tmp_path):
    second = cluster.add_node(num_cpus=1)
    killing = []

    def watch(progress):
        if progress.candidates[0] >= 6 and not killing:
            killing.append(threading.Timer(0.05, cluster.remove_node, [second, False]))
            killing[0].start()

    found = tuned(scenario, tmp_path, engine="ray", watch=watch)
    killing[0].join()
    assert found == here


def test_a_driver_that_is_killed_goes_on_where_it_was(cluster, scenario, path, here, tmp_path):
    state = path.with_name("pitch.toml.PID.state.json")
    process = driver(path, f"scenario.tune('PID', engine='ray', address={cluster.address!r})")
    while not state.exists():
        assert process.poll() is None
        time.sleep(0.01)
    process.kill()
    process.communicate()
    begun = []
    found = tuned(scenario, tmp_path, engine="ray", watch=lambda it: begun.append(it.candidates[0]))
    assert begun[0] > 0
    assert found == here
    assert not state.exists()


def test_a_contest_on_ray_has_the_same_files(cluster, scenario, contest_here, tmp_path):
    scenario.contest(tmp_path / "c", budget=8, engine="ray")
    assert files(tmp_path / "c") == contest_here


def test_the_program_tunes_on_ray_with_the_same_design(cluster, cli, path, here, tmp_path):
    on_ray = ["--engine", "ray", "--address", cluster.address, "--python", sys.executable]
    told = cli("tune", path, "--controller", "PID", "--history", "h.parquet", *on_ray)
    assert (told, (tmp_path / "h.parquet").read_bytes()) == here[1:]


def test_the_program_says_what_keeps_it_from_an_engine(path):
    found = program()
    if found is None:
        pytest.skip("the program is not built")
    for needed in ("distributed", "ray"):
        pytest.importorskip(needed)

    def told(*arguments):
        return subprocess.run([found, "tune", *arguments], capture_output=True, text=True, input=TEXT, check=False)

    nobody = told(path, "--engine", "dask", "--address", "tcp://127.0.0.1:1", "--python", sys.executable)
    assert nobody.returncode == 2 and "there is no Dask scheduler" in nobody.stderr
    nobody = told(path, "--engine", "ray", "--python", "/nowhere/python")
    assert nobody.returncode == 2 and "--python /nowhere/python" in nobody.stderr
    nobody = told("-", "--engine", "ray")
    assert nobody.returncode == 2 and "give it as a file" in nobody.stderr
    assert "local, ray, dask" in told(path, "--engine", "slurm").stderr


def test_what_workers_of_dask_fly_is_there_again_when_all_who_held_it_were_killed(scenario):
    distributed = pytest.importorskip("distributed")
    from fspid.engines.dask import Dask

    units = [("nonsense", 0, 1)]
    with (
        distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as dask,
        distributed.Client(dask) as client,
        Dask(client=client) as engine,
    ):
        job = engine.share(FlightsJob.of(scenario._core))
        for _ in range(2):
            # Whoever reads the order has the job.
            with pytest.raises(fspid.Error, match="this is no order"):
                list(engine.fly(job, units))
            gone = client.run(os.getpid)
            for pid in gone.values():
                os.kill(pid, signal.SIGKILL)
            waited = time.monotonic()
            while set(gone) & set(client.scheduler_info()["workers"]):
                assert time.monotonic() < waited + 30
                time.sleep(0.05)


def test_a_scheduler_of_dask_that_drops_everything_is_named(scenario):
    distributed = pytest.importorskip("distributed")
    from fspid.engines.dask import Dask

    with (
        distributed.LocalCluster(n_workers=1, threads_per_worker=1, processes=False, dashboard_address=None) as dask,
        distributed.Client(dask) as client,
        Dask(client=client) as engine,
    ):
        job = engine.share(FlightsJob.of(scenario._core))
        client.cancel(job)
        with pytest.raises(fspid.Error, match="begin again: what was flown before is kept"):
            list(engine.fly(job, [("nonsense", 0, 1)]))


def test_a_worker_of_dask_that_is_killed_does_not_show(scenario, here, contest_here, tmp_path):
    distributed = pytest.importorskip("distributed")
    killed = []

    def watch(progress):
        if progress.candidates[0] >= 6 and not killed:
            pid = next(iter(client.run(os.getpid).values()))
            killed.append(threading.Timer(0.05, os.kill, [pid, signal.SIGKILL]))
            killed[0].start()

    with (
        distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as dask,
        distributed.Client(dask) as client,
    ):
        found = tuned(scenario, tmp_path, engine="dask", client=client, watch=watch)
        killed[0].join()
        scenario.contest(tmp_path / "c", budget=8, engine="dask", client=client)
    assert found == here
    assert files(tmp_path / "c") == contest_here
