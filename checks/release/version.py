#!/usr/bin/env python3
"""Writes a version into the manifests, the page's package and the changelog; says what it changed.

    version.py VERSION DATE [FOLDER]

Every place is found or the script ends with 1: none is passed over in silence. What stands below "## [Unreleased]" becomes the
version's, and the heading stays, with nothing below it. Locks are for cargo to write.
"""

import json
import re
import sys
from pathlib import Path

SEMVER = re.compile(r"(\d+)\.(\d+)\.(\d+)")


def refuse(why: str) -> None:
    print(f"version.py: {why}", file=sys.stderr)
    sys.exit(1)


def parts(version: str) -> tuple[int, ...]:
    found = SEMVER.fullmatch(version)
    if not found:
        refuse(f"`{version}` is no version; one is three numbers with dots between them")
    return tuple(int(part) for part in found.groups())


def manifest(text: str, new: str) -> tuple[str, str, int]:
    """The workspace's manifest with the version in it; the version before; how many crates of ours name it."""
    found = re.search(r'^\[workspace\.package\]\nversion = "([^"]+)"$', text, re.MULTILINE)
    if not found:
        refuse("Cargo.toml: no version below [workspace.package]")
    old = found.group(1)
    if parts(new) <= parts(old):
        refuse(f"{new} does not follow {old}, which Cargo.toml has")
    text = text.replace(f'[workspace.package]\nversion = "{old}"', f'[workspace.package]\nversion = "{new}"')
    ours = re.compile(rf'^(fspid[a-z-]* = {{ path = "[^"]+", version = )"{re.escape(old)}"', re.MULTILINE)
    text, count = ours.subn(rf'\g<1>"{new}"', text)
    if count == 0:
        refuse("Cargo.toml: no crate of ours in [workspace.dependencies]")
    if left := re.search(rf'^fspid[a-z-]* = .*version = "(?!{re.escape(new)})', text, re.MULTILINE):
        refuse(f"Cargo.toml: another version in `{left.group(0)}`")
    return text, old, count


def changelog(text: str, new: str, date: str) -> str:
    heading = "## [Unreleased]\n"
    if text.count(heading) != 1:
        refuse(f"CHANGELOG.md: {text.count(heading)} headings `{heading.strip()}`")
    if f"## [{new}]" in text:
        refuse(f"CHANGELOG.md has {new} already")
    below = text.split(heading)[1].split("\n## [")[0]
    if not re.search(r"^- ", below, re.MULTILINE):
        refuse("CHANGELOG.md: nothing is unreleased")
    return text.replace(heading, f"{heading}\n## [{new}] - {date}\n")


def main() -> None:
    if len(sys.argv) not in (3, 4):
        refuse("version.py VERSION DATE [FOLDER]")
    new, date = sys.argv[1:3]
    if not re.fullmatch(r"\d{4}-\d{2}-\d{2}", date):
        refuse(f"`{date}` is no date; one is 2026-11-23")
    root = Path(sys.argv[3]) if len(sys.argv) == 4 else Path(__file__).parents[2]
    files = {name: (root / name).read_text(encoding="utf-8") for name in ("Cargo.toml", "CHANGELOG.md", "web/package.json", "web/package-lock.json")}
    written = {"CHANGELOG.md": changelog(files["CHANGELOG.md"], new, date)}
    written["Cargo.toml"], old, count = manifest(files["Cargo.toml"], new)
    for name, wanted in (("web/package.json", 1), ("web/package-lock.json", 2)):
        # The page's own version stands before those of what it is made of.
        line = f'"version": "{old}"'
        head, tail = files[name][:600], files[name][600:]
        if json.loads(files[name])["version"] != old or head.count(line) != wanted:
            refuse(f"{name}: its version is not {old}, as that of the crates is")
        written[name] = head.replace(line, f'"version": "{new}"') + tail
    for name, text in written.items():
        (root / name).write_text(text, encoding="utf-8")
    print(f"{old} -> {new}, {date}: {', '.join(sorted(written))}; {count} crates")


main()
