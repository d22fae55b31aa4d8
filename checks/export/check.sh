#!/usr/bin/env bash
# Shipped designs as C: the same bits from compilers and processors, and what a step takes. Ends with an error where one bit differs.
#
#   check.sh          two compilers at four levels on this machine, and a Cortex-M4F in an emulator
#   check.sh --long   a Cortex-M3 and M0 without a floating-point unit, 64-bit ARM and RISC-V, and a big-endian PowerPC as well,
#                     instructions, flash and stack of a step, and the time and flash of an 8-bit AVR
set -euo pipefail
cd "$(dirname "$0")/../.."
long="${1:-}"

. checks/export/tools.sh

compilers=(gcc)
needs clang clang && compilers+=(clang)
board=yes
needs qemu-system-arm qemu-system-arm || board=no
needs arm-none-eabi-gcc gcc-arm-none-eabi libnewlib-arm-none-eabi || board=no
if [ "$long" = --long ]; then
    # The long check asks everything or nothing.
    [ "$board" = yes ]
    needs qemu-ppc qemu-user
    needs aarch64-linux-gnu-gcc gcc-aarch64-linux-gnu libc6-dev-arm64-cross
    needs riscv64-linux-gnu-gcc gcc-riscv64-linux-gnu libc6-dev-riscv64-cross
    needs powerpc-linux-gnu-gcc gcc-powerpc-linux-gnu libc6-dev-powerpc-cross
    needs avr-gcc gcc-avr avr-libc
    needs simavr simavr
fi

program
work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT
here="$PWD/checks/export"
scripts="$PWD/crates/fspid-export/src/evidence/scripts"
plain=(-std=c99 -Wall -Wextra -Wconversion -Werror -ffp-contract=off)

# Folder, samples, design, and what else is asked for.
written() { "$FSPID" export "$3" --controller FSPID --to c --samples "$2" --out "$work/$1" "${@:4}" > /dev/null; }

# Lane and what it printed; ends where a bit differs.
same() {
    echo "$1: $2"
    case "$2" in
        *" samples, 0 different") ;;
        *) exit 1 ;;
    esac
}

# Board, level, file with `main`, and the flags of its processor.
on_a_board() {
    local board="$1" level="$2" file="$3" top=0x20400000
    [ "$board" = microbit ] && top=0x20004000
    arm-none-eabi-gcc "$level" "${plain[@]}" -Wno-error "${@:4}" -mthumb --specs=rdimon.specs "-DSTACK_TOP=$top" fspid.c fspid_selftest.c "$file" \
        "$here/start.c" -I. -Wl,--section-start=.vectors=0 -Wl,-Tdata=0x20000000 -o board.elf 2> /dev/null
    timeout 120 qemu-system-arm -machine "$board" -nographic -semihosting -icount shift=0 -kernel board.elf 2>&1 | tail -1
}
m4f=(-mcpu=cortex-m4 -mfloat-abi=hard -mfpu=fpv4-sp-d16)

# A compiler, an emulator, and what they are.
elsewhere() {
    for level in -O0 -O2; do
        "$1" "$level" "${plain[@]}" -static ./*.c -o elsewhere
        same "$name, $numbers, $3 $level" "$("$2" ./elsewhere | tail -1)"
    done
}

on_an_avr() {
    avr-gcc -Os -std=c99 -mmcu=atmega1284p -DF_CPU=16000000UL -I. fspid.c "$here/avr.c" -o avr.elf
    echo "$name, AVR at -Os: $(timeout 120 simavr -m atmega1284p -f 16000000 avr.elf 2>&1 | grep -o 'cycles of a step: [0-9]*' | head -1)"
    avr-gcc -Os -std=c99 -mmcu=atmega1284p -DSTEP_ALONE -I. fspid.c "$here/avr.c" -o alone.elf
    echo "$name, AVR, a program of a step alone at -Os: $(avr-size alone.elf | awk 'NR == 2 { print $1 + $2 }') bytes of flash"
}

designs=(data/designs/navion-paper.toml data/designs/learned/light.toml data/designs/learned/transport.toml)
for design in "${designs[@]}"; do
    name="$(basename "$design" .toml)"
    for numbers in single double; do
        written "$name-$numbers" 20000 "$design" --numbers "$numbers" --angles degrees
        cd "$work/$name-$numbers"
        for compiler in "${compilers[@]}"; do
            for level in -O0 -O2 -O3 -Os; do
                "$compiler" "$level" "${plain[@]}" ./*.c -o check
                same "$name, $numbers, $compiler $level" "$(./check | tail -1)"
            done
        done
        if [ "$long" = --long ]; then
            elsewhere aarch64-linux-gnu-gcc qemu-aarch64 aarch64
            elsewhere riscv64-linux-gnu-gcc qemu-riscv64 riscv64
            elsewhere powerpc-linux-gnu-gcc qemu-ppc "powerpc, big-endian"
        fi
        if [ "$long$numbers" = --longdouble ] && avr-gcc -std=c99 -mmcu=atmega1284p -fsyntax-only fspid.c 2> /dev/null; then
            echo "$name: an AVR, whose double has 32 bits, takes numbers of 64"
            exit 1
        fi
        cd - > /dev/null
    done
    [ "$board" = yes ] || continue
    written "$name-board" 2000 "$design"
    cd "$work/$name-board"
    for level in -O0 -O2 -Os; do
        same "$name, Cortex-M4F $level" "$(on_a_board mps2-an386 "$level" fspid_check.c "${m4f[@]}")"
    done
    if [ "$long" = --long ]; then
        for level in -O0 -O2 -Os; do
            same "$name, Cortex-M3 $level" "$(on_a_board mps2-an385 "$level" fspid_check.c -mcpu=cortex-m3)"
            same "$name, Cortex-M0 $level" "$(on_a_board microbit "$level" fspid_check.c -mcpu=cortex-m0)"
        done
        # What the evidence of an export counts with.
        sed 's/@PREFIX@/fspid/g; s/@SETPOINT@/setpoint_rad/g; s/@MEASUREMENT@/measurement_rad/g' \
            "$scripts/boards.c" > count.c
        echo "$name, Cortex-M4F -O2, instructions: $(on_a_board mps2-an386 -O2 count.c "${m4f[@]}")"
        echo "$name, Cortex-M3 -O2, instructions: $(on_a_board mps2-an385 -O2 count.c -mcpu=cortex-m3)"
        arm-none-eabi-gcc -Os "${plain[@]}" "${m4f[@]}" -mthumb -fstack-usage -c fspid.c
        echo "$name, flash at -Os: $(arm-none-eabi-size fspid.o | awk 'NR == 2 { print $1 }') bytes; deepest frames: $(sort -t "$(printf '\t')" -k2 -n -r fspid.su | head -2 | awk '{ printf "%s ", $2 }')bytes"
        on_an_avr
    fi
    cd - > /dev/null
done
