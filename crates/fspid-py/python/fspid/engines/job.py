"""What a worker needs to fly for somebody else: texts, and the files that a scenario names."""

from __future__ import annotations

import tempfile
import threading
from abc import ABC, abstractmethod
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar

from .. import _core
from ..errors import Error

if TYPE_CHECKING:
    from ..campaign import Campaign
    from .store import Receipt, Store


class WrongBuild(Error):
    """A worker has another build of fspid than the driver, whose bits may differ."""


@dataclass(frozen=True)
class Job(ABC):
    """What is flown, as it travels to workers, which need to see no folder of the driver.

    Attributes
    ----------
    id : str
        What tells it from every other.
    text : str
        The plan of a campaign as ``campaign.json`` has it, or a scenario.
    files : tuple of (str, bytes)
        Files that the scenario names.
    build : str
        SHA-256 of the driver's native module.
    """

    id: str
    text: str
    files: tuple[tuple[str, bytes], ...]
    build: str

    def fly(self, unit: Any) -> Any:
        """Fly a part of it here, on one thread."""
        if self.build != build():
            raise WrongBuild(
                f"this worker has fspid {_core.VERSION} of another build than the driver, so that bits may differ;"
                " install the same wheel everywhere"
            )
        # Held until it has flown: another thread may be given another job.
        here = _Here.of(self)
        return self._flown(here.flyer, unit)

    def unpacks_as(self, other: Job) -> bool:
        """Whether what flies the one flies the other: plans of one campaign may cut it into other shards."""
        return type(self) is type(other) and (self.text, self.files) == (other.text, other.files) and self.id == other.id

    @abstractmethod
    def _unpacked(self, root: Path, scenario: Path) -> Any:
        """Who flies, of the texts in a folder, in which the scenario's own lies."""

    @abstractmethod
    def _flown(self, flyer: Any, unit: Any) -> Any: ...


@dataclass(frozen=True)
class ShardJob(Job):
    """A campaign: a unit is the number of a shard, its answer the shard's whole Parquet file.

    Attributes
    ----------
    store : Store, optional
        Where parts are put; what was put there is then the answer.
    """

    store: Store | None = None

    @classmethod
    def of(cls, campaign: Campaign, store: Store | None = None) -> ShardJob:
        """The job of a campaign."""
        core = campaign._core
        return cls(campaign.id, core.plan_text, _files(core.scenario_folder, core.files), build(), store)

    def _unpacked(self, root: Path, scenario: Path) -> _core.Campaign:
        campaign = root / "campaign"
        (campaign / "shards").mkdir(parents=True)
        (campaign / "campaign.json").write_text(_moved(self.text), encoding="utf-8")
        return _core.Campaign.planned(campaign)

    def _flown(self, flyer: _core.Campaign, unit: int) -> bytes | Receipt:
        flyer.shard(unit, 1)
        path = Path(flyer.part(unit))
        try:
            part = path.read_bytes()
            return part if self.store is None else self.store.put(path.name, part)
        finally:
            path.unlink(missing_ok=True)


@dataclass(frozen=True)
class FlightsJob(Job):
    """A tuning or a contest: a unit is an order with the flights of it that are wanted, the first and that behind the last.

    Attributes
    ----------
    changes : tuple of str
        Changes of the scenario, as ``--set`` takes them.
    """

    changes: tuple[str, ...]

    @classmethod
    def of(cls, scenario: _core.Scenario) -> FlightsJob:
        """The job of a scenario."""
        import hashlib

        files, changes = _files(scenario.folder, scenario.files()), tuple(scenario.overrides)
        # Files of cases too, which the digest of the scenario leaves out.
        name = hashlib.sha256(repr((scenario.text, changes, files)).encode()).hexdigest()
        return cls(name, scenario.text, files, build(), changes)

    def _unpacked(self, root: Path, scenario: Path) -> _core.Worker:
        path = scenario / "scenario.toml"
        path.write_text(self.text, encoding="utf-8")
        return _core.Worker(path, list(self.changes))

    def _flown(self, flyer: _core.Worker, unit: tuple[str, int, int]) -> tuple[float, str]:
        import time

        begun = time.perf_counter()
        answer = flyer.fly(*unit)
        return time.perf_counter() - begun, answer


def _files(folder: str | Path | None, names: Iterable[str]) -> tuple[tuple[str, bytes], ...]:
    return tuple((name, (Path(folder or ".") / name).read_bytes()) for name in names)


def build() -> str:
    """SHA-256 of the native module."""
    import hashlib

    global _build
    if _build is None:
        _build = hashlib.sha256(Path(_core.__file__ or "").read_bytes()).hexdigest()
    return _build


_build: str | None = None

#: How deep a scenario lies, so that ``../`` in names of files stays within the folder.
_DEPTH = 8


class _Here:
    """The job that this process flies, unpacked: units come one after the other, and threads share it."""

    _now: ClassVar[_Here | None] = None
    _lock: ClassVar[threading.Lock] = threading.Lock()

    def __init__(self, job: Job) -> None:
        self.job = job
        self._root = tempfile.TemporaryDirectory(prefix="fspid-")
        root = Path(self._root.name)
        scenario = root.joinpath(*["scenario"] * _DEPTH)
        scenario.mkdir(parents=True)
        for name, data in job.files:
            place = (scenario / name).resolve()
            # What lies elsewhere has to be there already; a digest tells whether it is the same.
            if place.is_relative_to(root.resolve()):
                place.parent.mkdir(parents=True, exist_ok=True)
                place.write_bytes(data)
        self.flyer: Any = job._unpacked(root, scenario)

    @classmethod
    def of(cls, job: Job) -> _Here:
        with cls._lock:
            if cls._now is None or not cls._now.job.unpacks_as(job):
                cls._now = cls(job)
            return cls._now


def _moved(plan: str) -> str:
    """The plan with the folder of its scenario where it is unpacked."""
    import json

    moved = json.loads(plan)
    moved["scenario"]["folder"] = "/".join(["..", *["scenario"] * _DEPTH])
    return json.dumps(moved)
