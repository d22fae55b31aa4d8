#!/usr/bin/env bash
# Changes the code, one place at a time, and asks whether a test notices (cargo-mutants, from the registry):
#   check.sh                        what flies: the supervisor, PID, guards, limits, the equations of fspid-core
#   check.sh FILE…                  other files of one crate, `crates/fspid-core/src/pid.rs`
#   check.sh --shard 0/8 [FILE…]    a part of them
#
# A change is tested by the tests of its own crate with all its features; those of what flies without `alloc` of fspid-fuzzy, whose tests
# take a minute and ask other things. Ends with 1 where one survives that equivalent.txt does not explain. In a copy of the repository, one
# change at a time; a change of fspid-core takes some ten seconds, the whole of it an hour.
set -euo pipefail
cd "$(dirname "$0")/../.."
cargo install cargo-mutants --version 27.1.0 --locked --debug --quiet --root target/tools
shard=()
if [[ "${1:-}" == --shard ]]; then
    shard=(--shard "$2")
    shift 2
fi
files=("$@")
features=(--all-features)
if ((!${#files[@]})); then
    files=(crates/fspid-core/src/{pid,guard,limits,integral,rounded,tuner,second_input,equations/pid,equations/tuner}.rs crates/fspid-fuzzy/src/supervisor.rs)
    features=(--features fspid-fuzzy/batch)
fi
out="$PWD/target/mutation"
mkdir -p "$out"
PATH="$PWD/target/tools/bin:$PATH" cargo mutants --workspace --jobs 1 --baseline=skip --timeout 120 --no-shuffle --colors=never --output "$out" "${shard[@]}" \
    "${features[@]}" --cargo-arg=--lib --cargo-arg=--tests $(printf -- '--file %s ' "${files[@]}") || true
if [[ ! -s "$out/mutants.out/outcomes.json" ]]; then
    echo "nothing was changed: are these files of the workspace? ${files[*]}" >&2
    exit 1
fi
# A line of equivalent.txt: the change as cargo-mutants names it, without line and column, a tab, and why nothing can notice it.
sed -E 's/^([^:]+):[0-9]+:[0-9]+: /\1: /' "$out/mutants.out/missed.txt" | sort | uniq -c | sed 's/^ *[0-9]* //' >"$out/survived"
sed '/^#/d' checks/mutation/equivalent.txt | cut -f 1 | sort -u >"$out/explained"
printf 'caught %d, survived %d, of which explained %d; do not compile %d, ran too long %d\n' \
    "$(wc -l <"$out/mutants.out/caught.txt")" "$(wc -l <"$out/mutants.out/missed.txt")" \
    "$(comm -12 <(sort -u "$out/survived") "$out/explained" | wc -l)" "$(wc -l <"$out/mutants.out/unviable.txt")" "$(wc -l <"$out/mutants.out/timeout.txt")"
if left="$(comm -23 <(sort -u "$out/survived") "$out/explained" | grep .)"; then
    printf 'nobody noticed, and nobody explains:\n%s\n' "$left"
    exit 1
fi
