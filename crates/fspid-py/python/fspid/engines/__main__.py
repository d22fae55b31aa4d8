"""``python -m fspid.engines ray FOLDER``: the driver that ``fspid campaign run --engine`` starts.

With ``--flights`` it carries flights of a scenario for ``fspid tune`` and ``fspid contest``: it reads orders from standard
input, one a line, and writes answers.
"""

from __future__ import annotations

import _thread
import argparse
import json
import os
import queue
import sys
import threading
from collections.abc import Iterator
from pathlib import Path
from typing import TextIO

from .. import _core
from ..campaign import Campaign
from ..errors import Error, FileError
from . import NAMES, Progress, fly, reach


def main() -> int:
    """Fly and merge the campaign in a folder, or carry flights; the exit code is that of the program."""
    parser = argparse.ArgumentParser(prog="python -m fspid.engines", description=__doc__)
    parser.add_argument("engine", choices=NAMES, help="who flies")
    parser.add_argument("place", help="the campaign's folder, in which it is planned; with --flights a scenario")
    parser.add_argument("--flights", action="store_true", help="carry flights of tunings and contests")
    parser.add_argument("--set", action="append", default=[], metavar="PATH=VALUE", help="a change of the scenario")
    parser.add_argument("--address", help="where the cluster is")
    parser.add_argument("--store", help="where workers put parts: s3://BUCKET/PREFIX, gs://…, file://…")
    parser.add_argument("--quiet", action="store_true", help="say nothing while flying")
    asked = parser.parse_args()
    return carry(asked) if asked.flights else campaign(asked)


def campaign(asked: argparse.Namespace) -> int:
    """Fly and merge a campaign."""

    def watch(progress: Progress) -> None:
        end = "\n" if progress.done else ""
        print(f"\r\x1b[K{progress}{end}", end="", file=sys.stderr, flush=True)

    quiet = asked.quiet or not sys.stderr.isatty()
    try:
        planned = Campaign.from_folder(asked.place)
        fly(planned, asked.engine, store=asked.store, address=asked.address, watch=None if quiet else watch)
        print(planned.merge())
    except FileError as error:
        print(f"fspid: {error}", file=sys.stderr)
        return 4
    except Error as error:
        print(f"fspid: {error}", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        print("fspid: interrupted; what is flown stays, and the same command goes on from there", file=sys.stderr)
        return 130
    return 0


def carry(asked: argparse.Namespace) -> int:
    """Carry orders to an engine until standard input ends."""
    answers = _own_standard_output()

    def tell(**told: object) -> None:
        print(json.dumps(told), file=answers, flush=True)

    try:
        from .flights import Flights

        scenario = _core.Scenario.read(Path(asked.place), asked.set)
        with reach(asked.engine, address=asked.address) as engine:
            flights = Flights(engine, scenario)
            tell(answers=[])
            for order in _Orders():
                tell(answers=flights(**json.loads(order)))
    except Error as error:
        tell(error=str(error))
        return 2
    except (KeyboardInterrupt, BrokenPipeError):
        # Who asked tells it.
        return 130
    return 0


def _own_standard_output() -> TextIO:
    """Standard output for answers alone: what engines print there goes to standard error."""
    answers = os.fdopen(os.dup(1), "w", encoding="utf-8")
    os.dup2(2, 1)
    return answers


class _Orders:
    """Lines of standard input. Where it ends while something flies, that is interrupted: nobody waits for it."""

    def __init__(self) -> None:
        self._lines: queue.SimpleQueue[str | None] = queue.SimpleQueue()
        self._flying = False
        threading.Thread(target=self._read, daemon=True).start()

    def _read(self) -> None:
        for line in sys.stdin:
            self._lines.put(line)
        self._lines.put(None)
        if self._flying:
            _thread.interrupt_main()

    def __iter__(self) -> Iterator[str]:
        while (line := self._lines.get()) is not None:
            self._flying = True
            yield line
            self._flying = False


if __name__ == "__main__":
    sys.exit(main())
