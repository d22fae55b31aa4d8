#!/usr/bin/env bash
# The shipped designs on JSBSim's aircraft, on which nobody was tuned: the table of data/designs/learned/README.md.
# designs.sh [fspid [design …]]; installs jsbsim 1.3.3 from PyPI into a folder of its own.
set -euo pipefail
here="$(cd "$(dirname "$0")" && pwd)"
root="$(cd "$here/../.." && pwd)"
fspid="${1:-$root/target/release/fspid}"
work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT

if [ -z "${FSPID_PYTHON:-}" ]; then
    python3 -m venv "$work/python"
    "$work/python/bin/pip" install --quiet --disable-pip-version-check jsbsim==1.3.3
    export FSPID_PYTHON="$work/python/bin/python"
fi
"$FSPID_PYTHON" "$here/designs.py" "$fspid" "$root" "$work" "${@:2}"
