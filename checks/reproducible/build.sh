#!/usr/bin/env bash
# Builds the program so that the same commit, compiler and page give the same bytes, wherever it is built: no path of this machine is
# left in it. The profile is `dist`, what is handed out, unless another is named: build.sh [PROFILE [CARGO'S ARGUMENT…]].
set -euo pipefail
cd "$(dirname "$0")/../.."
profile="${1:-dist}"
cargo_home="${CARGO_HOME:-$HOME/.cargo}"

target="$(realpath -m "${CARGO_TARGET_DIR:-$PWD/target}")"

# What a panic tells of a line of a dependency, of this repository and of the library has its path; here they get names. So have
# messages that are written while it is built (MAVLink's): the last rule that fits holds.
flags=("--remap-path-prefix=$PWD=/fspid" "--remap-path-prefix=$cargo_home=/cargo" "--remap-path-prefix=$(rustc --print sysroot)=/rust"
    "--remap-path-prefix=$target=/target")
# Folders may have blanks in their names: the flags are parted by a sign that has none.
CARGO_ENCODED_RUSTFLAGS="$(printf '%s\x1f' "${flags[@]}")"
CARGO_ENCODED_RUSTFLAGS="${CARGO_ENCODED_RUSTFLAGS%$'\x1f'}"
export CARGO_ENCODED_RUSTFLAGS CARGO_INCREMENTAL=0
cargo build --locked --quiet --profile "$profile" -p fspid-cli "${@:2}"
