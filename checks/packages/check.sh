#!/usr/bin/env bash
# Checks every crate as a registry would have it: packed, unpacked in a folder of its own, and compiled from there.
# What `cargo package --workspace` does as well, but in one build for all.
set -euo pipefail
cd "$(dirname "$0")/../.."
rm -f target/package/fspid*.crate
cargo package --workspace --no-verify --allow-dirty

work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT
for packed in target/package/fspid*.crate; do tar -xzf "$packed" -C "$work"; done
{
    printf '[workspace]\nresolver = "3"\nmembers = ["*"]\nexclude = ["target"]\n[patch.crates-io]\n'
    for folder in "$work"/fspid*/; do
        name="$(basename "$folder")"
        printf '%s = { path = "%s" }\n' "${name%-[0-9]*}" "$name"
    done
} >"$work/Cargo.toml"
cp Cargo.lock "$work/"
CARGO_TARGET_DIR="$PWD/target/packages" cargo check --workspace --manifest-path "$work/Cargo.toml"
