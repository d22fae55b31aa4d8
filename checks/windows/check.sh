#!/usr/bin/env bash
# Does the program compile for Windows? Every crate of it is checked for x86_64-pc-windows-gnu; nothing is linked and nothing is run,
# so that this claims no more. Needs Debian 12 or newer and the Rust toolchain for its cargo; root or sudo where packages are missing.
set -euo pipefail
cd "$(dirname "$0")/../.."
. checks/export/tools.sh
. checks/same-bits/cross.sh
debian_compiler
RUSTC=/usr/bin/rustc RUSTC_BOOTSTRAP=1 CARGO_INCREMENTAL=0 CARGO_TARGET_DIR="$PWD/target/same-bits" \
    cargo check --locked --quiet -Zbuild-std=std,panic_unwind --target x86_64-pc-windows-gnu -p fspid-cli
echo "compiles for x86_64-pc-windows-gnu, by $(/usr/bin/rustc --version); not linked, not run"
