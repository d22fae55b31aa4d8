#!/usr/bin/env bash
# Prints what one bad sample does to fspid-core and to other PID controllers in Rust, as a table; ends with 1 where fspid-core answers
# with what is no number, forgets, or jumps. Needs the Rust toolchain and the registry; half a minute.
set -euo pipefail
cd "$(dirname "$0")"
CARGO_TARGET_DIR="$PWD/../../target/peers" cargo run --release --locked --quiet -- "$@"
