#!/usr/bin/env bash
# Which lines and branches of each crate its own tests, and those of the crates named, run:
#   check.sh                    all crates, by all tests of the workspace: most of an hour on two cores
#   check.sh fspid-core …       these crates, by their own tests: minutes
#   check.sh --missed FOLDER    after one of them: lists what was not run of files below a folder
#
# Branches are counted by what rustc calls unstable (`-Zcoverage-options=branch`), which RUSTC_BOOTSTRAP opens in the stable compiler;
# the program that is tested is otherwise the same. Needs Debian's llvm of the compiler's own LLVM version (llvm-22 for Rust 1.95),
# which is installed where it is missing.
set -euo pipefail
cd "$(dirname "$0")/../.."
. checks/export/tools.sh
llvm="$(rustc -vV | sed -n 's/^LLVM version: \([0-9]*\).*/\1/p')"
needs "llvm-cov-$llvm" "llvm-$llvm"
export CARGO_TARGET_DIR="$PWD/target/coverage" CARGO_INCREMENTAL=0
data="$CARGO_TARGET_DIR/whole.profdata" programs="$CARGO_TARGET_DIR/programs"

objects() { sed 's/^/--object=/' "$programs"; }

if [[ "${1:-}" == --missed ]]; then
    # shellcheck disable=SC2046
    "llvm-cov-$llvm" show --instr-profile="$data" $(objects) --show-branches=count "$PWD/$2" |
        awk '/^\/.*:$/ { file = $0 } /^ *[0-9]+\| +0\|/ { print file, $0 }'
    exit
fi

crates=(--workspace)
# Alone a crate has only the features that it is asked with; in the workspace others ask it.
if (($#)); then crates=("${@/#/--package=}" --all-features); fi
rm -rf "$CARGO_TARGET_DIR/raw"
mkdir -p "$CARGO_TARGET_DIR/raw"
export RUSTC_BOOTSTRAP=1 RUSTFLAGS="-Cinstrument-coverage -Zcoverage-options=branch"
export LLVM_PROFILE_FILE="$CARGO_TARGET_DIR/raw/%p-%4m.profraw"
# Macros and build scripts are instrumented too, and run while it is built: they write where nobody looks.
LLVM_PROFILE_FILE="$CARGO_TARGET_DIR/building-%4m.profraw" cargo test --locked --no-run --tests "${crates[@]}" 2>"$CARGO_TARGET_DIR/built" ||
    { tail -n 20 "$CARGO_TARGET_DIR/built" >&2 && exit 1; }
sed -n 's/.*(\(.*target\/coverage\/.*\))$/\1/p' "$CARGO_TARGET_DIR/built" >"$programs"
# What tests start is a program too.
[[ -x "$CARGO_TARGET_DIR/debug/fspid" && "${crates[*]}" == *workspace* ]] && echo "$CARGO_TARGET_DIR/debug/fspid" >>"$programs"
cargo test --locked --no-fail-fast --tests "${crates[@]}" 2>&1 | grep -E '^test result|FAILED|panicked' | awk '/^test result/ { passed += $4; failed += $6; next } { print } END { print passed " passed, " failed " failed" }'
"llvm-profdata-$llvm" merge --sparse --output="$data" "$CARGO_TARGET_DIR"/raw/*.profraw
rm -rf "$CARGO_TARGET_DIR/raw"
# shellcheck disable=SC2046
"llvm-cov-$llvm" export --summary-only --skip-functions --instr-profile="$data" $(objects) >"$CARGO_TARGET_DIR/whole.json"
python3 checks/coverage/table.py "$CARGO_TARGET_DIR/whole.json" "$@"
