#!/usr/bin/env bash
# Evidence for shipped designs: what `fspid export --evidence` writes and its script makes. Takes a quarter of an hour.
# Ends with 0 if every pack is proved, the sweep finds nothing, no vector differs, no compiler warns, MISRA has no
# required finding, the self test keeps its budget, and the bytes are the same a second time.
set -euo pipefail
cd "$(dirname "$0")/../.."

. checks/export/tools.sh
needs frama-c frama-c-base
needs cppcheck cppcheck
needs clang clang
needs arm-none-eabi-gcc gcc-arm-none-eabi libnewlib-arm-none-eabi
needs qemu-system-arm qemu-system-arm

program
work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT
failed=0
wrong() { echo "WRONG: $*"; failed=1; }

for design in data/designs/navion-paper.toml data/designs/learned/light.toml data/designs/learned/transport.toml; do
    name="$(basename "$design" .toml)"
    for again in first second; do
        "$FSPID" export "$design" --controller FSPID --to c --out "$work/$name-$again-code" \
            --evidence "$work/$name-$again" > /dev/null 2>&1
    done
    diff -r "$work/$name-first" "$work/$name-second" > /dev/null || wrong "$name: other bytes a second time"
    (cd "$work/$name-first" && sh make-evidence.sh > "$work/$name.log" 2>&1) || wrong "$name: $(tail -1 "$work/$name.log")"
    echo "== $name"
    (
        cd "$work/$name-first"
        sed -n '/^| single change of/,/^$/p' README.md
        cat results/vectors.txt results/cpp.txt results/branches.txt results/verdict.txt results/sweep.txt \
            results/boards.txt results/mutation.txt results/misra-counts.txt
    )
    cd "$work/$name-first/results"
    grep -q "^Proved" verdict.txt || wrong "$name: not proved"
    grep -q " 0 wrong" sweep.txt || wrong "$name: the sweep"
    grep -qv " 0 different" vectors.txt && wrong "$name: vectors"
    grep -q "^warnings: 0" warnings.txt || wrong "$name: warnings"
    # The advisory rules that README.md of a pack gives reasons for.
    grep -v -E 'misra-c2012-(8\.7|8\.9|12\.1|15\.5|19\.2)$' misra-counts.txt && wrong "$name: MISRA"
    # Rules that conclude numbers are asked no exponential.
    most=210000
    [ "$name" = light ] && most=70000
    awk -v most="$most" -F 'self test ' '/cortex-m4 gcc -O2/ { split($2, of, ","); exit of[1] > most }' boards.txt \
        || wrong "$name: self test"
    cd - > /dev/null
done
exit "$failed"
