"""What tests share: scenarios, and the program beside which answers are compared."""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
from pathlib import Path

import pytest

import fspid

# What a shell starts in the background ignores Ctrl-C, and so would what tests start and interrupt.
if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)

ROOT = Path(__file__).resolve().parents[3]

STEP = {
    "schema": 1,
    "name": "five degrees",
    "plant": {"preset": "b747-paper"},
    "loop": {"sample_period_s": 0.01, "duration_s": 20.0},
    "setpoint": {"kind": "step", "amplitude_deg": 5.0},
    "controller": [{"name": "PID", "kind": "pid", "kp": 2.0, "ki": 0.5, "kd": 1.0}],
}


@pytest.fixture
def step() -> fspid.Scenario:
    """A step of five degrees, flown by a PID."""
    return fspid.Scenario.from_dict(STEP)


def program() -> str | None:
    """The program ``fspid`` of the same sources, if it is built."""
    named = os.environ.get("FSPID_PROGRAM")
    built = [ROOT / "target" / profile / "fspid" for profile in ("release", "debug")]
    found = [named] if named else [str(path) for path in built if path.exists()]
    return found[0] if found else shutil.which("fspid")


@pytest.fixture
def cli(tmp_path: Path):  # type: ignore[no-untyped-def]
    """Runs the program in a folder of its own; its standard output, whatever its exit code."""
    found = program()
    if found is None:
        pytest.skip("the program is not built: cargo build --release, or FSPID_PROGRAM=path")

    def run(*arguments: object) -> str:
        words = [found, *(str(argument) for argument in arguments)]
        return subprocess.run(words, cwd=tmp_path, capture_output=True, text=True, check=False).stdout

    return run


@pytest.fixture(scope="session")
def cluster():  # type: ignore[no-untyped-def]
    """A cluster of Ray on this machine, one processor in its head; tests add nodes and kill them."""
    ray = pytest.importorskip("ray")
    from ray.cluster_utils import Cluster

    cluster = Cluster(initialize_head=True, head_node_args={"num_cpus": 1, "include_dashboard": False})
    ray.init(address=cluster.address, log_to_driver=False, logging_level="error")
    yield cluster
    ray.shutdown()
    cluster.shutdown()
