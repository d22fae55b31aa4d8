#!/bin/sh
# Changes each line of mutants.csv in the C, compiles it, and asks it for the vectors. Answers how many fail.
set -eu
cd "$(dirname "$0")"
work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT
CC="${CC:-cc}"
flags="-std=c99 -O0 -w -ffp-contract=off -Icode"
$CC $flags -c code/@PREFIX@_check.c -o "$work/check.o"
# Number, line and text of each change; a change has one line.
awk -v out="$work" 'NR > 1 {
    text = $0; n = $0; sub(/,.*/, "", n)
    # The text is the field before the last, quoted where it holds a comma.
    sub(/,[^,]*$/, "", text)
    if (text ~ /"$/) {
        sub(/"$/, "", text); i = 0
        while ((j = index(substr(text, i + 1), ",\"")) > 0) i += j
        line = substr(text, 1, i - 1); text = substr(text, i + 2); gsub(/""/, "\"", text)
    } else {
        line = text; sub(/,[^,]*$/, "", line); sub(/.*,/, "", text)
    }
    sub(/.*,/, "", line)
    print line > (out "/" n ".line"); print text > (out "/" n ".text")
    close(out "/" n ".line"); close(out "/" n ".text")
}' mutants.csv
mkdir -p results
ls "$work" | sed -n 's/\.line$//p' | sort -n | xargs -P "$(nproc)" -n 1 sh -c '
    work="$0"; n="$1"
    awk -v line="$(cat "$work/$n.line")" -v file="$work/$n.text" \
        "NR == line { getline text < file; print text; next } { print }" code/@PREFIX@.c > "$work/$n.c"
    if ! ${CC:-cc} '"$flags"' -c "$work/$n.c" -o "$work/$n.o" 2> /dev/null; then echo "$n not-compiled"
    elif ! ${CC:-cc} "$work/$n.o" "$work/check.o" -o "$work/$n.run" 2> /dev/null; then echo "$n not-linked"
    elif timeout 20 "$work/$n.run" > /dev/null 2>&1; then echo "$n survived"
    else echo "$n found"; fi
    rm -f "$work/$n.c" "$work/$n.o" "$work/$n.run"' "$work" | sort -n > results/mutants.txt
awk '{ count[$2]++ } END { for (word in count) printf "%s %d\n", word, count[word] }' results/mutants.txt | sort \
    > results/mutation.txt
# What was shown to change nothing, against what the compiled C says.
awk 'FNR == NR { n = $0; sub(/,.*/, "", n); if ($0 ~ /,equivalent: [^,]*$/) shown[n] = 1; next }
    $2 == "survived" && !($1 in shown) { left++ } $2 == "found" && ($1 in shown) { wrong++ }
    END { printf "survived and not shown to change nothing %d\nfound though shown to change nothing %d\n", left, wrong }' \
    mutants.csv results/mutants.txt >> results/mutation.txt
cat results/mutation.txt
