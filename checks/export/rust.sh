#!/usr/bin/env bash
# Shipped designs as constants in Rust: built as a package of their own with fspid-core, asked for 20 000 answers each, and
# built for a Cortex-M4F with `core` alone. Needs what checks/firmware/check.sh installs, if that compiler is there; without
# it the last part is left out and said so. `--quick`: one of the designs.
set -euo pipefail
cd "$(dirname "$0")/../.."
. checks/export/tools.sh
program
work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT
export CARGO_TARGET_DIR="$PWD/target/export-rust"
here=(--config "patch.crates-io.fspid-core.path='$PWD/crates/fspid-core'")

designs=(data/designs/learned/light.toml data/designs/navion-paper.toml data/designs/learned/transport.toml)
if [[ "${1:-}" == --quick ]]; then designs=("${designs[0]}"); fi
for design in "${designs[@]}"; do
    name="$(basename "$design" .toml)"
    for choice in "single degrees" "double radians"; do
        read -r numbers angles <<< "$choice"
        folder="$work/$name-$numbers"
        "$FSPID" export "$design" --controller FSPID --to rust --numbers "$numbers" --angles "$angles" --out "$folder" &> "$work/told"
        said="$(cd "$folder" && cargo run --quiet --example check "${here[@]}")"
        echo "$name, $numbers, $angles: $said"
        [[ "$said" == *" 0 different"* ]]
    done
    if [[ -x /usr/bin/rustc && -d /usr/lib/rustlib/src ]]; then
        (
            cd "$work/$name-single"
            export RUSTC=/usr/bin/rustc RUSTC_BOOTSTRAP=1
            cargo build --quiet --release --lib -Zbuild-std=core --target thumbv7em-none-eabihf "${here[@]}"
            echo "$name, single: built for thumbv7em-none-eabihf with $(/usr/bin/rustc --version)"
        )
    else
        echo "$name: not built for a Cortex-M4F, for there is no compiler from checks/firmware/check.sh"
    fi
done
