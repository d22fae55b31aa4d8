#!/usr/bin/env bash
# Stores of parts against a server of S3 on this machine (moto), which is too heavy for every check: `stores.sh PYTHON` with a
# Python that has the wheel of fspid. Installs some 290 MB into a folder that goes again.
set -euo pipefail
cd "$(dirname "$0")/../../crates/fspid-py"
python="$(command -v "${1:-python3}")"
work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT
"$python" -m pip --disable-pip-version-check --quiet install --target "$work" "moto[server,s3]>=5" "s3fs>=2025.2" "pytest>=8" "distributed>=2025.1"
PYTHONPATH="$work" "$python" -m pytest -q tests/test_stores.py
