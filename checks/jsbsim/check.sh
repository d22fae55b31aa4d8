#!/usr/bin/env bash
# JSBSim flies: trims of published models, the same bits twice and on any number of threads, errors by name, and how fast.
# Aircraft of tables that are made of JSBSim's files have its loads, in all that convert.
# check.sh [fspid]; installs jsbsim 1.3.3 from PyPI into a folder of its own.
set -euo pipefail
here="$(cd "$(dirname "$0")" && pwd)"
root="$(cd "$here/../.." && pwd)"
fspid="${1:-$root/target/release/fspid}"
work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT

python3 -m venv "$work/python"
"$work/python/bin/pip" install --quiet --disable-pip-version-check jsbsim==1.3.3
export FSPID_PYTHON="$work/python/bin/python"
"$FSPID_PYTHON" "$here/flights.py" "$fspid" "$work"
# As the tests have built it: of its crate alone the features would be others, and all below it would be built anew.
(cd "$root" && cargo build --locked --workspace --example jsbsim)
"$FSPID_PYTHON" "$here/tables.py" "$root/target/debug/examples/jsbsim"
