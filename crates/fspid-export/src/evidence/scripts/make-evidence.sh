#!/bin/sh
# Makes results/ and the verdict in the first line of README.md. What a machine does not have is named and left out:
# gcc, clang, gcov, cppcheck, frama-c (Debian: frama-c-base), arm-none-eabi-gcc with qemu-system-arm.
# Ends with 1, and asks nothing else, where the code is not what was exported or answers otherwise.
set -eu
cd "$(dirname "$0")"
rm -rf results
mkdir results
work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT
plain="-std=c99 -ffp-contract=off -Icode"
strict="-Wall -Wextra -Wconversion -Wfloat-equal"
all="@COUNT@ samples, 0 different"
has() { command -v "$1" > /dev/null || { echo "not here: $1" >&2; return 1; }; }
head_of() { "$@" --version 2>&1 | head -1; }
verdict() {
    { printf '%s\n' "$1"; tail -n +2 README.md; } > "$work/README.md"
    cp "$work/README.md" README.md
    printf '%s\n' "$1" > results/verdict.txt
}
# What would be said of it from here on would be said of other code.
wrong() {
    verdict "Wrong: $1."
    cat results/verdict.txt
    exit 1
}
verdict "Not proved: make-evidence.sh did not come to its end."

# The code as exported, and nothing beside it.
has sha256sum || wrong "without sha256sum nobody knows whether code/ is what was exported"
sha256sum -c code.sha256 > results/code.txt 2>&1 \
    || wrong "code/ is not what was exported, $(grep -v ': OK$' results/code.txt | head -1)"
find code ! -type d | LC_ALL=C sort > "$work/there"
sed 's/^[0-9a-f]*  //' code.sha256 | LC_ALL=C sort > "$work/exported"
cmp -s "$work/there" "$work/exported" \
    || wrong "code/ is not what was exported, beside it is $(LC_ALL=C comm -23 "$work/there" "$work/exported" | head -1)"
# And the pack, but for README.md, whose first line is the verdict.
sha256sum -c pack.sha256 > results/pack.txt 2>&1 \
    || wrong "the pack is not what was written, $(grep -v ': OK$' results/pack.txt | head -1)"

: > results/tools.txt
for tool in gcc clang gcov cppcheck arm-none-eabi-gcc qemu-system-arm; do
    if has "$tool"; then head_of "$tool" >> results/tools.txt; fi
done
if has frama-c; then echo "Frama-C $(frama-c -version)" >> results/tools.txt; fi

# Warnings of the two sources, vectors at each level, C++.
: > results/warnings.txt
: > results/vectors.txt
differing=""
for compiler in gcc clang; do
    has "$compiler" || continue
    $compiler $plain $strict -O2 -c code/@PREFIX@.c -o "$work/w.o" 2>> results/warnings.txt
    $compiler $plain $strict -O2 -c code/@PREFIX@_selftest.c -o "$work/w.o" 2>> results/warnings.txt
    for level in -O0 -O2 -O3 -Os; do
        $compiler $plain $level code/@PREFIX@.c code/@PREFIX@_check.c -o "$work/check"
        told="$("$work/check" | tail -1)"
        echo "$compiler $level: ${told:-no answer}" >> results/vectors.txt
        [ "$told" = "$all" ] || differing="${differing:-$compiler $level: ${told:-no answer}}"
    done
done
echo "warnings: $(grep -c warning: results/warnings.txt || true)" | tee -a results/warnings.txt
cat results/vectors.txt
[ -s results/vectors.txt ] || wrong "neither gcc nor clang is here, so that nothing was asked"
[ -z "$differing" ] || wrong "$differing"

# From C++ 11, with the C as it is.
if has g++; then
    printf '#include "@PREFIX@.h"\nint main() { @PREFIX@_state state; @PREFIX@_init(&state); return @PREFIX@_selftest(&@PREFIX@_design); }\n' > "$work/main.cpp"
    gcc $plain -c code/@PREFIX@.c -o "$work/c.o"
    gcc $plain -c code/@PREFIX@_selftest.c -o "$work/s.o"
    g++ -std=c++11 -Wall -Wextra -Werror -Icode "$work/main.cpp" "$work/c.o" "$work/s.o" -o "$work/cpp"
    "$work/cpp" || wrong "from C++11 the self test does not answer 0"
    echo "C++11: links, self test 0" | tee results/cpp.txt
fi

# Branches by gcov.
if has gcov; then
    code="$PWD/code"
    (cd "$work" && gcc -std=c99 -O0 --coverage -ffp-contract=off -I"$code" "$code/@PREFIX@.c" "$code/@PREFIX@_check.c" -o covered)
    told="$("$work/covered" | tail -1)"
    [ "$told" = "$all" ] || wrong "gcc --coverage: ${told:-no answer}"
    if (cd "$work" && gcov -b -c -o . covered-@PREFIX@.gcda > gcov.txt 2>&1); then
        cp "$work/@PREFIX@.c.gcov" results/gcov.txt
        sed -n "/File.*code\/@PREFIX@.c'/,/^\$/p" "$work/gcov.txt" | tee results/branches.txt
    else
        echo "branches are not counted: $(tail -1 "$work/gcov.txt")" | tee results/branches.txt
    fi
fi

# MISRA C 2012 by cppcheck's addon; the texts of the rules are licensed and not here.
if has cppcheck; then
    cppcheck --addon=misra --std=c99 -Icode --quiet code/@PREFIX@.c code/@PREFIX@_selftest.c 2> results/misra.txt || true
    grep -o 'misra-c2012-[0-9.]*' results/misra.txt | sort | uniq -c | tee results/misra-counts.txt
fi

# The proof: 0 alarms and every assertion, and nothing wrong in the sweep that it rests on, or README.md says that there is
# none.
gcc $plain -O2 sweep.c -o "$work/sweep"
"$work/sweep" > results/sweep.txt || wrong "the sweep, on which a proof rests: $(tail -1 results/sweep.txt)"
cat results/sweep.txt
final='@FIRST@'
if has frama-c; then
    # The preprocessor's machine may be an x87, by whose numbers nothing is computed here.
    frama-c -no-autoload-plugins -load-module eva,inout -machdep gcc_x86_32 -eva -eva-precision 3 \
        -warn-special-float non-finite @SPECIFIED@ "-cpp-extra-args=-Icode -DFSPID_OTHER_BITS" eva_main.c > results/eva.txt 2>&1 || true
    alarms="$(sed -n 's/^ *\([0-9]*\) alarms\{0,1\} generated by the analysis.*/\1/p' results/eva.txt)"
    asserted="$(sed -n 's/^ *Assertions *//p' results/eva.txt | tr -s ' ')"
    case "$asserted" in *" 0 unknown 0 invalid "*) all_valid=yes ;; *) all_valid=no ;; esac
    if ! grep -q " 0 wrong" results/sweep.txt; then
        final="Not proved: Frama-C Eva gives ${alarms:-no count of} alarm(s), but it rests on a sweep: $(tail -1 results/sweep.txt)."
    elif [ "$alarms" = 0 ] && [ "$all_valid" = yes ]; then
        final="Proved by Frama-C Eva with the sweep beside it: 0 alarms, assertions $asserted, for every finite sample, for ever."
    else
        final="Not proved: Frama-C Eva gives ${alarms:-no count of} alarm(s), assertions ${asserted:-none}; results/eva.txt."
    fi
    echo "$final"
else
    case "$final" in
        "Not proved yet: "*) final="Not proved: Frama-C was not there when make-evidence.sh made results/." ;;
    esac
fi

# Flash, frames and instructions.
if has arm-none-eabi-gcc && has qemu-system-arm; then
    : > results/boards.txt
    for core in "cortex-m4 mps2-an386 -mfloat-abi=hard -mfpu=fpv4-sp-d16" "cortex-m3 mps2-an385"; do
        set -- $core
        cpu="$1"; machine="$2"; shift 2
        for level in -O2 -Os; do
            arm-none-eabi-gcc $plain $level -mcpu=$cpu -mthumb "$@" -ffunction-sections -fstack-usage -c code/@PREFIX@.c -o "$work/@PREFIX@.o"
            size="$(arm-none-eabi-size -A "$work/@PREFIX@.o" | awk '/^\.text|^\.rodata/ { all += $2 } END { print all }')"
            beside="$(arm-none-eabi-size -A "$work/@PREFIX@.o" | awk '/_track|_saturated|_faults|_init/ { all += $2 } END { print all + 0 }')"
            static="$(arm-none-eabi-size -A "$work/@PREFIX@.o" | awk '/^\.data|^\.bss/ { all += $2 } END { print all + 0 }')"
            stack="$(awk '{ print $(NF - 1), $1 }' "$work/@PREFIX@.su" | sort -n -r | head -2 | awk '{ all += $1 } END { print all }')"
            arm-none-eabi-gcc -std=c99 -w -ffp-contract=off $level -mcpu=$cpu -mthumb "$@" --specs=rdimon.specs -Icode \
                code/@PREFIX@.c code/@PREFIX@_selftest.c boards.c start.c -Wl,--section-start=.vectors=0 \
                -Wl,-Tdata=0x20000000 -o "$work/board.elf"
            told="$(timeout 300 qemu-system-arm -machine $machine -nographic -semihosting -icount shift=0 -kernel "$work/board.elf" 2>&1 | tail -1)"
            case "$told" in *"which answers 0 "*) ;; *) wrong "$cpu gcc $level: ${told:-no answer}" ;; esac
            echo "$cpu gcc $level: flash $size bytes, of which $beside for init, track, saturated and faults; static RAM $static; two deepest frames $stack bytes; instructions: $told" | tee -a results/boards.txt
        done
    done
fi

sh mutate.sh
grep -q "^found though shown to change nothing 0$" results/mutation.txt \
    || wrong "changes are found that were shown to change nothing, results/mutation.txt"
verdict "$final"
find . -type f ! -name files.sha256 | sort | xargs sha256sum > results/files.sha256
