#!/usr/bin/env bash
# What fspid is built from: licences, sources, bans, what runs while building, how many packages each crate brings; and the bill of
# materials, made twice and read against the standard's own schema. `--quick` leaves out what has to be built or fetched first.
set -euo pipefail
cd "$(dirname "$0")/../.."

work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT

python3 checks/supply/bill.py --policy
python3 checks/supply/bill.py --out "$work/fspid.cdx.json"
python3 checks/supply/bill.py --out "$work/again.cdx.json" >"$work/quiet"
cmp "$work/fspid.cdx.json" "$work/again.cdx.json"
[ "${1:-}" = --quick ] && exit 0

cargo install cargo-deny --version 0.20.2 --locked --debug --quiet --root target/tools
PATH="$PWD/target/tools/bin:$PATH" cargo deny --offline --config checks/supply/deny.toml check --hide-inclusion-graph licenses bans sources

python3 -m venv "$work/python"
"$work/python/bin/pip" install --quiet --disable-pip-version-check 'cyclonedx-python-lib[json-validation]==11.12.0'
"$work/python/bin/python" checks/supply/valid.py "$work/fspid.cdx.json"
echo "advisories: not checked, since their database has to be fetched; with a network: cargo deny check advisories"
