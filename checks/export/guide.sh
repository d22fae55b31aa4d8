#!/usr/bin/env bash
# Runs the ten commands of docs/guide/export.md as they stand there, in a copy of what they ask for.
set -euo pipefail
cd "$(dirname "$0")/../.."
. checks/export/tools.sh
needs qemu-system-arm qemu-system-arm || exit 0
needs arm-none-eabi-gcc gcc-arm-none-eabi libnewlib-arm-none-eabi || exit 0
work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT
awk '/^## In ten commands/ { here = 1 } here && /^```$/ { exit } block { print } here && /^```sh$/ { block = 1 }' \
    docs/guide/export.md > "$work/commands"
[ "$(wc -l < "$work/commands")" = 10 ]
export CARGO_TARGET_DIR="$PWD/target" DEBIAN_FRONTEND=noninteractive
run="${FSPID:-cargo run --release --manifest-path $PWD/Cargo.toml --}"
sed -i "s|cargo run --release --|$run|; s|^apt-get install|command -v qemu-system-arm > /dev/null \|\| apt-get install|" "$work/commands"
for folder in data checks; do ln -s "$PWD/$folder" "$work/$folder"; done
cd "$work"
bash -euo pipefail commands | tee said
[ "$(grep -c "^2000 samples, 0 different$" said)" = 2 ]
