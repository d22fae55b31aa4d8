#!/usr/bin/env bash
# Shipped designs as C: the same bits from two compilers at four levels on this machine, and on a Cortex-M4F and an M3
# (without a floating-point unit) in an emulator; instructions, flash and stack of a step. Takes a minute.
set -euo pipefail
cd "$(dirname "$0")/../.."

for program in arm-none-eabi-gcc qemu-system-arm clang; do
    if ! command -v "$program" > /dev/null; then
        apt-get update -qq
        apt-get install -y -qq --no-install-recommends \
            gcc-arm-none-eabi libnewlib-arm-none-eabi qemu-system-arm clang
    fi
done

cargo build --release --quiet
work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT
here="$PWD/checks/export"
plain=(-std=c99 -Wall -Wextra -Wconversion -Werror -ffp-contract=off)

# Folder, samples, design, and what else is asked for.
written() { target/release/fspid export "$3" --controller FSPID --to c --samples "$2" --out "$work/$1" "${@:4}" > "$work/$1.told" 2>&1; }

on_a_board() {
    local board="$1" level="$2" file="$3" flags
    case "$board" in
        mps2-an386) flags=(-mcpu=cortex-m4 -mfloat-abi=hard -mfpu=fpv4-sp-d16) ;;
        *) flags=(-mcpu=cortex-m3) ;;
    esac
    arm-none-eabi-gcc "$level" "${plain[@]}" -Wno-error "${flags[@]}" -mthumb --specs=rdimon.specs fspid.c fspid_selftest.c "$file" "$here/start.c" \
        -I. -Wl,--section-start=.vectors=0 -Wl,-Tdata=0x20000000 -o board.elf 2> /dev/null
    timeout 120 qemu-system-arm -machine "$board" -nographic -semihosting -icount shift=0 -kernel board.elf 2>&1 | tail -1
}

for design in data/designs/navion-paper.toml data/designs/learned/light.toml data/designs/learned/transport.toml; do
    name="$(basename "$design" .toml)"
    for numbers in single double; do
        written "$name-$numbers" 20000 "$design" --numbers "$numbers" --angles degrees
        for compiler in gcc clang; do
            for level in -O0 -O2 -O3 -Os; do
                (cd "$work/$name-$numbers" && "$compiler" "$level" "${plain[@]}" ./*.c -o check)
                echo "$name, $numbers, $compiler $level: $("$work/$name-$numbers/check" | tail -1)"
            done
        done
    done
    written "$name-board" 2000 "$design"
    (
        cd "$work/$name-board"
        for board in mps2-an386 mps2-an385; do
            for level in -O0 -O2 -Os; do
                echo "$name, $board $level: $(on_a_board "$board" "$level" fspid_check.c)"
            done
            echo "$name, $board -O2: $(on_a_board "$board" -O2 "$here/count.c")"
            echo "$name, $board -O2: $(on_a_board "$board" -O2 "$here/count_selftest.c")"
        done
        arm-none-eabi-gcc -Os "${plain[@]}" -mcpu=cortex-m4 -mfloat-abi=hard -mfpu=fpv4-sp-d16 -mthumb -fstack-usage -c fspid.c
        echo "$name, flash at -Os: $(arm-none-eabi-size fspid.o | awk 'NR == 2 { print $1 }') bytes; deepest frames: $(sort -t "$(printf '\t')" -k2 -n -r fspid.su | head -2 | awk '{ printf "%s ", $2 }')bytes"
    )
done
