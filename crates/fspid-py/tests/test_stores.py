"""Parts in stores: whole or not there, the same bytes as on one machine, and what a store refuses told by name.

Stores of files need nothing; those of S3 ask a server of moto on this machine (``checks/python/stores.sh`` installs it).
"""

from __future__ import annotations

import errno
import hashlib
import http.client
import http.server
import os
import signal
import subprocess
import sys
import threading

import pytest

import fspid
from fspid.engines.job import ShardJob
from fspid.engines.store import Store, StoreParts

from conftest import ROOT

pytest.importorskip("fsspec")
RUNS, SHARD_RUNS, SHARDS = 48, 8, 6


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


@pytest.fixture(scope="module")
def server():
    """A server that answers as S3 does."""
    moto = pytest.importorskip("moto.server")
    pytest.importorskip("s3fs")
    server = moto.ThreadedMotoServer(ip_address="127.0.0.1", port=0, verbose=False)
    server.start()
    yield "http://{}:{}".format(*server.get_host_and_port())
    server.stop()


def options(endpoint):
    return {"endpoint_url": endpoint, "key": "any", "secret": "any"}


@pytest.fixture(params=["file", "s3"])
def place(request, tmp_path):
    """A store that is empty: its URL and what fsspec takes for it."""
    if request.param == "file":
        return f"file://{tmp_path}/store", {}
    import fsspec

    found = options(request.getfixturevalue("server"))
    bucket = "b" + hashlib.sha256(str(tmp_path).encode()).hexdigest()[:20]
    fsspec.filesystem("s3", **found).mkdir(bucket)
    return f"s3://{bucket}/campaigns", found


def opened(campaign, place):
    return Store.of(place[0], campaign.id, place[1])


def test_a_campaign_whose_workers_put_parts_goes_on_and_has_the_same_bytes(scenario, here, place, tmp_path):
    campaign = planned(scenario, tmp_path)
    store = opened(campaign, place)
    parts = StoreParts(campaign, store)
    assert parts.missing() == list(range(SHARDS))
    job = ShardJob.of(campaign, store)
    for number in (0, 3, 5):
        receipt = job.fly(number)
        assert receipt.sha256 == hashlib.sha256(store.get(receipt.name)).hexdigest()
        parts.take(number, receipt)
    # Another driver, which heard nothing of the first.
    parts = StoreParts(campaign, store)
    assert parts.missing() == [1, 2, 4]
    for number in parts.missing():
        parts.take(number, job.fly(number))
    assert parts.missing() == []
    parts.gather()
    campaign.merge()
    assert campaign.file.read_bytes() == here


def test_a_part_that_is_there_is_compared_and_kept(scenario, place, tmp_path):
    campaign = planned(scenario, tmp_path)
    store = opened(campaign, place)
    assert store.put("part", b"one") == store.put("part", b"one")
    with pytest.raises(fspid.Error, match="part is there with other bytes"):
        store.put("part", b"two")
    assert store.get("part") == b"one"


def test_two_workers_that_put_at_once_agree_or_are_told(scenario, place, tmp_path):
    campaign = planned(scenario, tmp_path)
    store = opened(campaign, place)
    told = []

    def put(data):
        try:
            store.put("part", data)
        except fspid.Error as error:
            told.append(error)

    workers = [threading.Thread(target=put, args=(bytes([n % 2]) * 100_000,)) for n in range(8)]
    for worker in workers:
        worker.start()
    for worker in workers:
        worker.join()
    assert store.get("part") in (b"\0" * 100_000, b"\1" * 100_000)
    assert len(told) == 4


def test_a_damaged_part_is_named_with_what_to_do(scenario, place, tmp_path):
    campaign = planned(scenario, tmp_path)
    store = opened(campaign, place)
    parts = StoreParts(campaign, store)
    job = ShardJob.of(campaign, store)
    name = job.fly(0).name
    for number in range(1, SHARDS - 1):
        parts.take(number, job.fly(number))
    part = bytearray(ShardJob.of(campaign).fly(SHARDS - 1))
    part[len(part) // 2] ^= 1
    last = fspid.engines.store.Path(campaign._core.part(SHARDS - 1)).name
    store.put(last, bytes(part))
    assert parts.missing() == []
    with pytest.raises(fspid.Error, match=f"remove .*{last}, and the same command"):
        parts.gather()
    assert campaign.missing() == [SHARDS - 1]
    assert name in store.names()


def test_a_put_that_dies_in_the_middle_leaves_nothing_in_a_folder(scenario, tmp_path):
    campaign = planned(scenario, tmp_path)
    store = opened(campaign, (f"file://{tmp_path}/store", {}))
    program = (
        "import os, sys\nfrom fspid.engines.store import Store\n"
        "os.fsync = lambda _: os.kill(os.getpid(), 9)\nStore(sys.argv[1], 'c').put('part', b'x' * 1_000_000)\n"
    )
    died = subprocess.run([sys.executable, "-c", program, store.url], check=False)
    assert died.returncode == -signal.SIGKILL
    there = store._replace(campaign="c")
    assert "part" not in there.names()
    assert there.put("part", b"whole").bytes == 5


def test_a_put_that_dies_in_the_middle_leaves_nothing_in_a_bucket(scenario, server, tmp_path):
    import fsspec

    campaign = planned(scenario, tmp_path)
    fsspec.filesystem("s3", **options(server)).mkdir("died")
    store = opened(campaign, ("s3://died", options(server)))
    host = server.removeprefix("http://")
    connection = http.client.HTTPConnection(host)
    connection.putrequest("PUT", f"/died/{campaign.id}/part")
    connection.putheader("Content-Length", "1000000")
    connection.endheaders()
    connection.send(b"x" * 500_000)
    connection.close()
    assert store.names() == set()


def test_a_full_folder_is_told_and_leaves_nothing(scenario, tmp_path, monkeypatch):
    campaign = planned(scenario, tmp_path)
    store = opened(campaign, (f"file://{tmp_path}/store", {}))

    def full(_):
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr("os.fsync", full)
    with pytest.raises(fspid.FileError, match="cannot put .*part: it is full"):
        store.put("part", b"x" * 100)
    assert list((tmp_path / "store" / campaign.id).iterdir()) == []


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="/sys is of Linux")
def test_a_folder_that_may_only_be_read_is_told_before_anything_flies(scenario, tmp_path):
    campaign = planned(scenario, tmp_path)
    with pytest.raises(fspid.FileError, match="it may only be read"):
        StoreParts(campaign, opened(campaign, ("file:///sys/fspid", {}))).missing()


class _Refusing(http.server.BaseHTTPRequestHandler):
    """S3 of which everything may be listed and nothing written."""

    # Clients wait to be asked for the rest of what they put.
    protocol_version = "HTTP/1.1"

    def _answer(self, status, text):
        self.send_response(status)
        self.send_header("Content-Type", "application/xml")
        self.send_header("Content-Length", str(len(text)))
        self.end_headers()
        self.wfile.write(text.encode())

    def do_GET(self):  # noqa: N802
        self._answer(200, '<?xml version="1.0"?><ListBucketResult><Name>b</Name><KeyCount>0</KeyCount></ListBucketResult>')

    def do_PUT(self):  # noqa: N802
        self.rfile.read(int(self.headers["Content-Length"]))
        self._answer(403, '<?xml version="1.0"?><Error><Code>AccessDenied</Code><Message>Access Denied</Message></Error>')

    def log_message(self, *_):
        pass


def test_a_bucket_that_may_only_be_read_is_told_before_anything_flies(scenario, tmp_path):
    pytest.importorskip("s3fs")
    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), _Refusing)
    threading.Thread(target=server.serve_forever, daemon=True).start()
    campaign = planned(scenario, tmp_path)
    store = opened(campaign, ("s3://b", options(f"http://127.0.0.1:{server.server_port}")))
    with pytest.raises(fspid.FileError, match="cannot put s3://b/.*campaign.json: it may only be read"):
        StoreParts(campaign, store).missing()
    server.shutdown()


def test_a_bucket_that_there_is_not_is_told(scenario, server, tmp_path):
    campaign = planned(scenario, tmp_path)
    with pytest.raises(fspid.FileError, match="s3://nothing/.*is not there"):
        StoreParts(campaign, opened(campaign, ("s3://nothing", options(server)))).missing()


def test_a_store_that_may_take_halves_is_refused_with_those_that_are_known(scenario, tmp_path):
    campaign = planned(scenario, tmp_path)
    with pytest.raises(fspid.InputError, match=r"ftp://x.*known are file://, s3://"):
        campaign.run(engine="dask", store="ftp://x")


def test_a_package_that_is_missing_is_named(scenario, tmp_path, monkeypatch):
    import fsspec

    def missing(_, **__):
        raise ImportError("Install s3fs to access S3")

    monkeypatch.setattr(fsspec, "filesystem", missing)
    with pytest.raises(fspid.Error, match=r"pip install 'fspid\[s3\]'"):
        Store.of("s3://b", "c")


def test_workers_of_dask_put_parts_and_the_file_is_the_same(scenario, here, place, tmp_path):
    distributed = pytest.importorskip("distributed")
    url, found = place
    with (
        distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster,
        distributed.Client(cluster) as client,
    ):
        campaign = scenario.campaign(
            tmp_path / "c", runs=RUNS, shard_runs=SHARD_RUNS, engine="dask", client=client, store=url, store_options=found
        )
    assert campaign.file.read_bytes() == here
    assert len(opened(campaign, place).names()) == SHARDS + 1


def test_workers_of_ray_put_parts_and_the_file_is_the_same(cluster, scenario, here, tmp_path):
    place = f"file://{tmp_path}/store", {}
    campaign = scenario.campaign(tmp_path / "c", runs=RUNS, shard_runs=SHARD_RUNS, engine="ray", store=place[0])
    assert campaign.file.read_bytes() == here
    assert len(opened(campaign, place).names()) == SHARDS + 1
