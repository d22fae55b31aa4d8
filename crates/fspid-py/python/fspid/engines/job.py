"""What a worker needs to fly any shard of a campaign: the plan and the files that its scenario names."""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from .. import _core
from ..errors import Error
from .store import Receipt, Store

if TYPE_CHECKING:
    from ..campaign import Campaign


class WrongBuild(Error):
    """A worker has another build of fspid than the driver, whose bits may differ."""


class Job(NamedTuple):
    """A campaign as it travels to workers, which need to see no folder of the driver.

    Attributes
    ----------
    id : str
        What tells the campaign from every other.
    plan : str
        The plan, as ``campaign.json`` has it.
    files : tuple of (str, bytes)
        Files that the scenario names.
    build : str
        SHA-256 of the driver's native module.
    """

    id: str
    plan: str
    files: tuple[tuple[str, bytes], ...]
    build: str

    @classmethod
    def of(cls, campaign: Campaign) -> Job:
        """The job of a campaign."""
        folder = campaign._core.scenario_folder
        files = tuple((name, (Path(folder) / name).read_bytes()) for name in campaign._core.files)
        return cls(campaign.id, campaign._core.plan_text, files, build())

    def fly(self, number: int) -> bytes:
        """Fly a shard here, on one thread, and answer its part: a whole Parquet file."""
        if self.build != build():
            raise WrongBuild(
                f"this worker has fspid {_core.VERSION} of another build than the driver, so that bits may differ;"
                " install the same wheel everywhere"
            )
        core = _unpacked(self)
        core.shard(number, 1)
        path = Path(core.part(number))
        try:
            return path.read_bytes()
        finally:
            path.unlink(missing_ok=True)


    def put(self, number: int, store: Store) -> Receipt:
        """Fly a shard here and put its part into a store."""
        part = self.fly(number)
        return store.put(Path(_unpacked(self).part(number)).name, part)

    def do(self, number: int, store: Store | None) -> bytes | Receipt:
        """Fly a shard; answers its part, or what was put into a store."""
        return self.fly(number) if store is None else self.put(number, store)


def build() -> str:
    """SHA-256 of the native module."""
    import hashlib

    global _build
    if _build is None:
        _build = hashlib.sha256(Path(_core.__file__ or "").read_bytes()).hexdigest()
    return _build


_build: str | None = None

#: The campaign that this process flies, and the folder in which it is unpacked: shards come one after the other.
_here: tuple[str, tempfile.TemporaryDirectory[str], _core.Campaign] | None = None

#: How deep a scenario lies, so that ``../`` in names of files stays within the folder.
_DEPTH = 8


def _unpacked(job: Job) -> _core.Campaign:
    global _here
    if _here is not None and _here[0] == job.id:
        return _here[2]
    root = tempfile.TemporaryDirectory(prefix="fspid-")
    scenario = Path(root.name).joinpath(*["scenario"] * _DEPTH)
    campaign = Path(root.name) / "campaign"
    scenario.mkdir(parents=True)
    (campaign / "shards").mkdir(parents=True)
    for name, data in job.files:
        place = (scenario / name).resolve()
        # What lies elsewhere has to be there already; the campaign's digest tells whether it is the same.
        if place.is_relative_to(Path(root.name).resolve()):
            place.parent.mkdir(parents=True, exist_ok=True)
            place.write_bytes(data)
    (campaign / "campaign.json").write_text(_moved(job.plan), encoding="utf-8")
    core = _core.Campaign.planned(campaign)
    _here = (job.id, root, core)
    return core


def _moved(plan: str) -> str:
    """The plan with the folder of its scenario where it is unpacked."""
    import json

    moved = json.loads(plan)
    moved["scenario"]["folder"] = "/".join(["..", *["scenario"] * _DEPTH])
    return json.dumps(moved)
