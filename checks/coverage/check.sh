#!/usr/bin/env bash
# Which lines and branches of each crate its own tests, and those of the crates named, run:
#   check.sh                    all crates, by all tests of the workspace: most of an hour on two cores
#   check.sh fspid-core …       these crates, by their own tests: minutes
#   check.sh --missed FOLDER    after one of them: lists lines and branches that were not run, of files below a folder
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
programs="$CARGO_TARGET_DIR/programs"

if [[ "${1:-}" == --missed ]]; then
    python3 checks/coverage/table.py --missed "$2" "$CARGO_TARGET_DIR"/*.lcov
    exit
fi

crates=(--workspace)
# Alone a crate has only the features that it is asked with; in the workspace others ask it.
if (($#)); then crates=("${@/#/--package=}" --all-features); fi
rm -rf "$CARGO_TARGET_DIR"/raw "$CARGO_TARGET_DIR"/*.lcov
export FSPID_COVERAGE_RAW="$CARGO_TARGET_DIR/raw"
mkdir -p "$FSPID_COVERAGE_RAW"
export RUSTC_BOOTSTRAP=1 RUSTFLAGS="-Cinstrument-coverage -Zcoverage-options=branch"
# Macros and build scripts are instrumented too, and run while it is built: they write where nobody looks.
export LLVM_PROFILE_FILE="$CARGO_TARGET_DIR/building-%4m.profraw"
cargo test --locked --no-run --tests "${crates[@]}" 2>"$CARGO_TARGET_DIR/built" ||
    { tail -n 20 "$CARGO_TARGET_DIR/built" >&2 && exit 1; }
sed -n 's/.*(\(.*target\/coverage\/.*\))$/\1/p' "$CARGO_TARGET_DIR/built" >"$programs"
runner="CARGO_TARGET_$(rustc -vV | sed -n 's/^host: //p' | tr a-z- A-Z_)_RUNNER"
env "$runner=$PWD/checks/coverage/run.sh" cargo test --locked --no-fail-fast --tests "${crates[@]}" 2>&1 |
    grep -E '^test result|FAILED|panicked' |
    awk '/^test result/ { passed += $4; failed += $6; next } { print } END { print passed " passed, " failed " failed" }'

# A program, and the counts that are its own. Lines and branches are then those that any of them ran.
counted() {
    local name
    name="$(basename "$1")"
    # A program that a test kills while it writes leaves a file that is not whole.
    "llvm-profdata-$llvm" merge --sparse --failure-mode=all --output="$CARGO_TARGET_DIR/$name.profdata" "${@:2}"
    "llvm-cov-$llvm" export --format=lcov --skip-functions --instr-profile="$CARGO_TARGET_DIR/$name.profdata" "$1" \
        >"$CARGO_TARGET_DIR/$name.lcov" 2>"$CARGO_TARGET_DIR/$name.told"
    rm "$CARGO_TARGET_DIR/$name.profdata"
}
started=()
while read -r program; do
    raw="$FSPID_COVERAGE_RAW/$(basename "$program")"
    own=("$raw/$(cat "$raw.pid")"-*.profraw)
    [[ -e "${own[0]}" ]] || continue
    # Behind the number of the process stands that of the program.
    signature="${own[0]##*-}" signature="${signature%_*}"
    counted "$program" "$raw"/*-"$signature"_*.profraw
    for file in "$raw"/*.profraw; do
        [[ "$file" == *-"$signature"_* ]] || started+=("$file")
    done
done <"$programs"
# What tests start is a program too.
if [[ "${crates[*]}" == *workspace* ]]; then counted "$CARGO_TARGET_DIR/debug/fspid" "${started[@]}"; fi
rm -rf "$FSPID_COVERAGE_RAW"
asked=()
for name in "$@"; do asked+=(--crate "$name"); done
python3 checks/coverage/table.py "${asked[@]}" "$CARGO_TARGET_DIR"/*.lcov
