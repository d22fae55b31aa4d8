#!/usr/bin/env bash
# The same bits, elsewhere: the answers of digests.sh by the program of this machine, and by the same program on other processors,
# each in an emulator, side by side as digests. Ends with 1 where one differs from this machine's.
#
#   check.sh                 every lane
#   check.sh --lanes         their names
#   check.sh aarch64 sse2    those alone
#
#   one-thread               this machine, one thread
#   avx512                   this machine as it is, where it has AVX-512
#   sse2 sse4.2 avx2         this machine's program on an emulated processor that has no more: lanes choose as they run
#   native                   built for this machine's processor alone (RUSTFLAGS="-C target-cpu=native")
#   aarch64 riscv64 i686 powerpc64    built for 64-bit ARM and RISC-V, 32-bit x86 and 64-bit big-endian PowerPC; 32-bit PowerPC
#                            has no atomic numbers of 64 bits, which fspid-scenario (apart.rs), -campaign and -external count with
#   wasm                     the mathematics of the cockpit's page, in Node: what it has verbs for
#
# Needs Debian 12 or newer and the Rust toolchain for its cargo; installs Debian's compilers, libraries and emulators where they are
# missing (root or sudo). The toolchain's own targets are not asked for: Debian has a compiler with its library's sources. A build for
# another processor takes some eight minutes of CPU time (with CARGO_PROFILE_RELEASE_OPT_LEVEL=1 half of that, and another order of
# what the compiler does), a lane in an emulator two to five.
set -euo pipefail
cd "$(dirname "$0")/../.."
lanes=(one-thread avx512 sse2 sse4.2 avx2 native aarch64 riscv64 i686 powerpc64 wasm)
if [[ "${1:-}" == --lanes ]]; then
    printf '%s\n' "${lanes[@]}"
    exit
fi
here="$PWD/checks/same-bits"
work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT

. checks/export/tools.sh
. checks/same-bits/cross.sh
program
[[ "$FSPID" == /* ]] || FSPID="$PWD/$FSPID"

# Lane, what it is in words, and how the program is called there.
compared() {
    local lane="$1" what="$2" differ
    "$here/digests.sh" "${@:3}" >"$work/$lane"
    differ="$(diff "$work/reference" "$work/$lane" | grep -c '^>' || true)"
    echo "$lane ($what): $(wc -l <"$work/$lane") answers, $differ different"
    ((differ == 0)) || {
        diff "$work/reference" "$work/$lane" | grep '^[<>]' | sed 's/^</    this machine:/; s/^>/    there:       /'
        return 1
    }
}

# Lane, target, what a C compiler of it is called, Debian's packages, and its emulator.
cross() {
    local lane="$1" target="$2" prefix="$3" emulator="$4"
    needs "$prefix-gcc" "gcc-$prefix" "${@:5}"
    needs "$emulator" qemu-user
    built_for "$target" "$prefix-gcc" || return 1
    compared "$lane" "$target, $("$emulator" --version | head -n 1)" "$emulator" -L "/usr/$prefix" "$PWD/target/same-bits/$target/release/fspid"
}

emulated() {
    needs qemu-x86_64 qemu-user
    compared "$1" "qemu-x86_64 -cpu $2" qemu-x86_64 -cpu "$2" "$FSPID"
}

lane() {
    case "$1" in
    one-thread) RAYON_NUM_THREADS=1 compared "$1" "RAYON_NUM_THREADS=1" "$FSPID" ;;
    avx512)
        if ! grep -q avx512f /proc/cpuinfo; then
            echo "avx512: NOT CHECKED: this machine has none"
            return
        fi
        compared "$1" "this machine" "$FSPID"
        ;;
    sse2) emulated "$1" qemu64 ;;
    sse4.2) emulated "$1" Nehalem ;;
    avx2) emulated "$1" Haswell ;;
    native)
        RUSTFLAGS="-C target-cpu=native" CARGO_TARGET_DIR="$PWD/target/same-bits" CARGO_INCREMENTAL=0 \
            cargo build --release --locked --quiet -p fspid-cli --no-default-features
        compared "$1" "target-cpu=native" "$PWD/target/same-bits/release/fspid"
        ;;
    aarch64) cross "$1" aarch64-unknown-linux-gnu aarch64-linux-gnu qemu-aarch64 libc6-dev-arm64-cross ;;
    riscv64) cross "$1" riscv64gc-unknown-linux-gnu riscv64-linux-gnu qemu-riscv64 libc6-dev-riscv64-cross ;;
    i686) cross "$1" i686-unknown-linux-gnu i686-linux-gnu qemu-i386 libc6-dev-i386-cross ;;
    powerpc64) cross "$1" powerpc64-unknown-linux-gnu powerpc64-linux-gnu qemu-ppc64 libc6-dev-ppc64-cross ;;
    wasm)
        web/build.sh --wasm
        node "$here/wasm.mjs" "$FSPID"
        ;;
    *)
        echo "there is no lane \`$1\`; known are ${lanes[*]}" >&2
        return 2
        ;;
    esac
}

echo "reference: $("$FSPID" --version | tr '\n' ' ')"
"$here/digests.sh" "$FSPID" >"$work/reference"
cat "$work/reference"
if grep -q 'NOT ANSWERED' "$work/reference"; then
    echo "the reference itself lacks an answer" >&2
    exit 1
fi
failed=()
for name in "${@:-${lanes[@]}}"; do lane "$name" || failed+=("$name"); done
if ((${#failed[@]})); then
    echo "not the same: ${failed[*]}"
    exit 1
fi
