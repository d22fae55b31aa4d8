#!/usr/bin/env bash
# Proves by linking that nothing that flies can panic; why that is a proof stands in src/lib.rs.
# Needs Linux, the Rust toolchain and a C compiler as its linker; takes some ten seconds.
set -euo pipefail
cd "$(dirname "$0")"
export CARGO_TARGET_DIR="$PWD/../../target/no-panic"
library="$CARGO_TARGET_DIR/release/libfspid_no_panic.so"
rm -f "$library"

# First the control: with an index that can be out of range the link must fail, and for this reason.
if said="$(cargo build --release --locked --features with-panic 2>&1)"; then
    echo "a panic was linked: this check shows nothing on this machine" >&2
    exit 1
fi
if ! grep -q 'undefined.*a_panic_can_be_reached' <<<"$said"; then
    printf '%s\n' "$said" >&2
    exit 1
fi

cargo build --release --locked
functions="$(nm -D --defined-only "$library" | awk '$2 == "T" { print $3 }')"
if nm "$library" | grep -iE 'panic|unwind|alloc'; then
    echo "these names should not be in it" >&2
    exit 1
fi
echo "no panic can be reached from:" $functions
