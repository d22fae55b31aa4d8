#!/usr/bin/env bash
# Builds the firmware example of fspid-core for a Cortex-M4F, with `core` and nothing else of Rust's library.
# Needs Debian 12 or newer, the Rust toolchain for its cargo, and root or sudo where packages are missing; half a
# minute of CPU time. The toolchain's own target is not asked for: Debian has a compiler with its library's sources.
set -euo pipefail
cd "$(dirname "$0")"
target=thumbv7em-none-eabihf
export CARGO_TARGET_DIR="$PWD/../../target/firmware"

version() { dpkg-query --show --showformat='${db:Status-Status} ${Version}' "$1" 2>/dev/null || true; }
if [[ "$(version rustc-web)" != "installed "* || "$(version rust-web-src)" != "installed "* ]]; then
    root=""
    [[ "$(id -u)" == 0 ]] || root=sudo
    $root apt-get update
    $root apt-get install --yes --no-install-recommends rustc-web rust-web-src
fi
if [[ "$(version rustc-web)" != "$(version rust-web-src)" ]]; then
    echo "compiler $(version rustc-web) and sources $(version rust-web-src) are not of one version" >&2
    exit 1
fi

# RUSTC_BOOTSTRAP lets a stable compiler build `core` from its sources.
RUSTC=/usr/bin/rustc RUSTC_BOOTSTRAP=1 cargo build --release --locked -Zbuild-std=core --target "$target"
library="$CARGO_TARGET_DIR/$target/release/libfspid_firmware.rlib"
if cargo tree --locked --prefix none | grep -vE '^(fspid-(firmware|core|fuzzy|numeric)|libm) '; then
    echo "these crates should not be in a firmware" >&2
    exit 1
fi
echo "built for $target with $(/usr/bin/rustc --version): ${library#"$PWD/../../"}"
