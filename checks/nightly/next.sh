#!/usr/bin/env bash
# The version after that of Cargo.toml: its minor number and one.
set -euo pipefail
sed -n '/^\[workspace.package\]/,/^version/s/^version = "\([0-9]*\)\.\([0-9]*\)\..*/\1 \2/p' "$(dirname "$0")/../../Cargo.toml" |
    while read -r major minor; do echo "$major.$((minor + 1)).0"; done
