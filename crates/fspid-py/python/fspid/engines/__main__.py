"""``python -m fspid.engines ray FOLDER``: the driver that ``fspid campaign run --engine`` starts."""

from __future__ import annotations

import argparse
import sys

from ..campaign import Campaign
from ..errors import Error, FileError
from . import NAMES, Progress, fly


def main() -> int:
    """Fly and merge the campaign in a folder; the exit code is that of the program."""
    parser = argparse.ArgumentParser(prog="python -m fspid.engines", description=__doc__)
    parser.add_argument("engine", choices=NAMES, help="who flies")
    parser.add_argument("folder", help="the campaign's folder, in which it is planned")
    parser.add_argument("--address", help="where the cluster is")
    parser.add_argument("--store", help="where workers put parts: s3://BUCKET/PREFIX, gs://…, file://…")
    parser.add_argument("--quiet", action="store_true", help="say nothing while flying")
    asked = parser.parse_args()

    def watch(progress: Progress) -> None:
        end = "\n" if progress.done else ""
        print(f"\r\x1b[K{progress}{end}", end="", file=sys.stderr, flush=True)

    quiet = asked.quiet or not sys.stderr.isatty()
    try:
        campaign = Campaign.from_folder(asked.folder)
        fly(campaign, asked.engine, store=asked.store, address=asked.address, watch=None if quiet else watch)
        print(campaign.merge())
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


if __name__ == "__main__":
    sys.exit(main())
