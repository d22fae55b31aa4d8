"""Stores of parts that workers write by themselves: any path that fsspec opens and that takes a file whole or not at all."""

from __future__ import annotations

import contextlib
import errno
import hashlib
import importlib
import itertools
import os
import tempfile
from collections.abc import Iterator, Mapping
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from ..errors import Error, FileError, InputError

if TYPE_CHECKING:
    from ..campaign import Campaign

#: How a file gets into a store of each protocol: whole, and only where none is.
PUTS = {
    "file": "a file beside it, flushed to the disk, then a hard link, which fails where there is one",
    "s3": "one PUT with If-None-Match: *",
    "gs": "one upload with ifGenerationMatch=0",
    "memory": "one entry of a dictionary, for tests within a process",
}

#: Parts that are brought from a store at a time.
_AT_A_TIME = 8


class Receipt(NamedTuple):
    """What a worker answers of a part that it put into a store."""

    name: str
    bytes: int
    sha256: str


class Store(NamedTuple):
    """A place for the parts of one campaign, as it travels to workers.

    Attributes
    ----------
    url : str
        Such as ``s3://bucket/prefix`` or ``file:///shared/parts``.
    campaign : str
        What tells the campaign from every other; its parts lie in a folder of that name.
    options : tuple of (str, object)
        What fsspec takes beside the path, such as ``endpoint_url``.
    """

    url: str
    campaign: str
    options: tuple[tuple[str, Any], ...] = ()

    @classmethod
    def of(cls, url: str, campaign: str, options: Mapping[str, Any] | None = None) -> Store:
        """The store at a path; refused unless it is known to take files whole or not at all."""
        store = cls(url.rstrip("/"), campaign, tuple(sorted((options or {}).items())))
        if store.protocol not in PUTS:
            known = ", ".join(f"{name}://" for name in PUTS)
            raise InputError(
                f"{url}: it is not known how a store of {store.protocol}:// takes a file whole or not at all;"
                f" known are {known}"
            )
        store._files()
        return store

    @property
    def protocol(self) -> str:
        """The protocol, such as ``s3``."""
        name = self.url.partition("://")[0] if "://" in self.url else "file"
        return {"local": "file", "gcs": "gs", "s3a": "s3"}.get(name, name)

    def where(self, name: str) -> str:
        """The whole path of a part, for people."""
        return f"{self.url}/{self.campaign}/{name}"

    def put(self, name: str, data: bytes) -> Receipt:
        """Put a file: whole, or not at all; one that is there must be the same."""
        digest = hashlib.sha256(data).hexdigest()
        with self._told("cannot put", name):
            try:
                self._create(name, data)
            except FileExistsError:
                found = hashlib.sha256(self._files().cat_file(self._path(name))).hexdigest()
                if found != digest:
                    raise Error(
                        f"{self.where(name)} is there with other bytes than were flown now; remove it if it is damaged,"
                        " or name another store"
                    ) from None
        return Receipt(name, len(data), digest)

    def get(self, name: str) -> bytes:
        """Read a file."""
        with self._told("cannot read", name):
            data: bytes = self._files().cat_file(self._path(name))
        return data

    def names(self) -> set[str]:
        """The files that are there."""
        with self._told("cannot list", ""):
            files = self._files()
            files.invalidate_cache()
            try:
                paths = files.ls(self._path(""), detail=False)
            except FileNotFoundError:
                return set()
        return {str(path).rstrip("/").rpartition("/")[2] for path in paths}

    def _files(self) -> Any:
        try:
            fsspec = importlib.import_module("fsspec")
            return fsspec.filesystem(self.protocol, **dict(self.options))
        except ImportError as missing:
            extra = "s3" if self.protocol == "s3" else "stores"
            raise Error(f"{self.url} needs a package: pip install 'fspid[{extra}]' ({missing})") from missing

    def _path(self, name: str) -> str:
        base = self.url.partition("://")[2] if "://" in self.url else self.url
        return f"{base}/{self.campaign}/{name}".rstrip("/")

    def _create(self, name: str, data: bytes) -> None:
        """Put a file where none is; FileExistsError where one is."""
        path = self._path(name)
        if self.protocol == "file":
            _link(Path(path), data)
        else:
            self._files().pipe_file(path, data, mode="create")

    @contextlib.contextmanager
    def _told(self, what: str, name: str) -> Iterator[None]:
        """What a store refuses, as errors of this package: each of its libraries has its own."""
        try:
            yield
        except (Error, FileExistsError):
            raise
        except FileNotFoundError as reason:
            raise FileError(f"{what} {self.where(name)}: it is not there ({reason})") from reason
        except OSError as reason:
            full = reason.errno in (errno.ENOSPC, errno.EDQUOT)
            refused = isinstance(reason, PermissionError) or reason.errno == errno.EROFS
            why = "it is full" if full else "it may only be read" if refused else "it does not answer as it should"
            raise FileError(f"{what} {self.where(name)}: {why} ({reason})") from reason
        except Exception as reason:
            raise FileError(f"{what} {self.where(name)}: {type(reason).__name__}: {reason}") from reason


def _link(path: Path, data: bytes) -> None:
    """A file that appears whole, and only where none is."""
    path.parent.mkdir(parents=True, exist_ok=True)
    handle, unfinished = tempfile.mkstemp(prefix=".unfinished-", dir=path.parent)
    try:
        with os.fdopen(handle, "wb") as file:
            file.write(data)
            file.flush()
            os.fsync(file.fileno())
        os.link(unfinished, path)
    finally:
        os.unlink(unfinished)


class FolderParts:
    """Parts that workers answer and the driver takes into the campaign's folder."""

    store: Store | None = None

    def __init__(self, campaign: Campaign) -> None:
        self._campaign = campaign

    def missing(self) -> list[int]:
        """Shards whose parts are not there, or not whole."""
        return self._campaign.missing()

    def take(self, number: int, answer: Any) -> None:
        """Take in what a worker answered."""
        self._campaign.put(number, answer)

    def gather(self) -> None:
        """Nothing: all of it lies in the folder."""


class StoreParts:
    """Parts that workers put into a store; the driver hears names and digests."""

    def __init__(self, campaign: Campaign, store: Store) -> None:
        self._campaign = campaign
        self.store: Store | None = store
        self._of = store
        self._digests: dict[str, str] = {}

    def missing(self) -> list[int]:
        """Shards that the store does not have; tried with the plan, so that a store that takes nothing is told now."""
        there = self._of.names()
        if "campaign.json" not in there:
            self._of.put("campaign.json", self._campaign._core.plan_text.encode())
        return [number for number in range(self._campaign.shards) if self._name(number) not in there]

    def take(self, number: int, answer: Any) -> None:
        """Remember what a worker put."""
        if answer.name != self._name(number):
            raise Error(f"a worker answered {answer.name} for shard {number}")
        self._digests[answer.name] = answer.sha256

    def gather(self) -> None:
        """Bring all parts into the campaign's folder, and check every cell."""
        numbers = iter(self._campaign.missing())
        with ThreadPoolExecutor(_AT_A_TIME) as threads:
            # As many as are brought at a time, so that no more are in memory.
            for some in iter(lambda: list(itertools.islice(numbers, _AT_A_TIME)), []):
                list(threads.map(self._bring, some))

    def _bring(self, number: int) -> None:
        name = self._name(number)
        part = self._of.get(name)
        expected = self._digests.get(name)
        again = f"remove {self._of.where(name)}, and the same command flies its runs again"
        if expected is not None and hashlib.sha256(part).hexdigest() != expected:
            raise Error(f"what the store gives is not what the worker put; {again}")
        try:
            self._campaign.put(number, part)
        except FileError:
            raise
        except Error as reason:
            raise Error(f"{reason}; {again}") from reason

    def _name(self, number: int) -> str:
        return Path(self._campaign._core.part(number)).name


def parts(campaign: Campaign, store: str | None, options: Mapping[str, Any] | None) -> FolderParts | StoreParts:
    """Where the parts of a campaign go: into its folder, or into a store."""
    if store is None:
        return FolderParts(campaign)
    return StoreParts(campaign, Store.of(store, campaign.id, options))
