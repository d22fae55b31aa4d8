#!/usr/bin/env bash
# The long checks, one after the other, and one page about them at the end: target/nightly/summary.md.
#   run.sh                  every lane
#   run.sh --list           their names and commands
#   run.sh fuzz coverage    those alone, beside the answers of the others that are on the page
#   run.sh --rest           those that are not on the page, or failed there: a night in parts; after a commit the program that
#                           the others ask is built anew first
# A lane that fails does not end the others; the script ends with 1 where one on the page has failed. What a lane printed is in
# target/nightly; each line of the page names its commit.
# Takes a night on two cores.
set -uo pipefail
cd "$(dirname "$0")/../.."
export CARGO_INCREMENTAL=0 DEBIAN_FRONTEND=noninteractive

# Name, what it asks, and the command, in the order in which they run: what is quick and what others need first.
lanes() {
    cat <<'LANES'
release-program|the program as it is handed out, to the lanes below; the paper by it|web/build.sh && cargo build --release --locked && target/release/fspid reproduce --check --out target/nightly/paper
instructions|instructions of a step, inference, margins, certificate|checks/instructions/check.py
memory|what commands take in memory, beside what they tell before they fly|checks/memory/check.py
supply|licences, sources, budgets, bill of materials|checks/supply/check.sh
packages|every crate compiles from what is packed|checks/packages/check.sh
reproducible|two builds, one hash|checks/reproducible/check.sh
same-bits|the same answers on other processors|checks/same-bits/check.sh
windows|compiles for Windows, neither linked nor run|checks/windows/check.sh
python|the package for Python, on clusters too, and its notebooks|checks/python/run.sh
firmware|core for a Cortex-M4F|checks/firmware/check.sh
exports|C on six emulated processors and an AVR; every design in Rust and in MATLAB's stand-in|checks/export/check.sh --long && checks/export/rust.sh && checks/export/octave.sh
fmu|FMUs in FMPy, under sanitizers|checks/export/fmu.sh
evidence|evidence of exports, its verdicts held|checks/export/evidence.sh
properties|all tests, those that are cut short by day as long as they are, property tests with numbers of this night|FSPID_LONG_TESTS=1 PROPTEST_RNG_SEED="$(date +%Y%m%d)" PROPTEST_CASES=2000 cargo test --workspace --locked
accepted|1500 drawn scenarios, every command|FSPID_ACCEPTED_DRAWS=1500 cargo test --workspace --locked --test all accepted
whole-program|laws of every command over 1000 scenarios drawn from the schema, their exports flown, their answers held against schemas|FSPID_WHOLE_DRAWS=1000 FSPID_WHOLE_FIRST="$(date +%Y%m%d)000" cargo test -p fspid-cli --locked --test all whole_program
false-safe|100 000 loops that are bad by construction, none called good|cargo run --release --locked -p fspid-cli --example false_safe -- 100000 "$(date +%Y%m%d)"
hostile|a hundred million bad samples through every structure of controller|cargo run --release --locked -p fspid-options --example hostile_samples -- 100000000 "$(date +%Y%m%d)"
peers|one bad sample, shown to other PID controllers too|checks/peers/check.sh
faults|a thousand disturbed writes|python3 checks/faults/matrix.py target/release/fspid --kills 72
rare|intervals of rare failures|checks/rare/intervals.sh
flood|the server, flooded for ten minutes|checks/serve/flood.sh
slow-loops|margins of 10 000 loops with slow modes, refuted from outside|cargo run --release --locked -p fspid-lti --example slow_loops -- 10000 "$(date +%Y%m%d)" >target/nightly/loops.csv && python3 oracles/check_slow_loops.py target/nightly/loops.csv
proofs|flights against proofs|cargo run --release --locked -p fspid-proof --example refute_proofs -- --count 100
book|the guide as a book|cargo install mdbook --version 0.5.4 --locked --no-default-features --debug --quiet --root target/tools && target/tools/bin/mdbook build docs/guide
cockpit|the page as it is handed out, in a browser|FSPID="$PWD/target/release/fspid" web/test.sh
fuzz|every reader for 10 minutes|fuzz/run.sh 600
coverage|lines and branches of every crate|checks/coverage/check.sh
mutation|changes of what flies that no test notices|checks/mutation/check.sh
release|a release, without keeping it|checks/release/make.sh "$(checks/nightly/next.sh)" --dry-run
LANES
}

if [[ "${1:-}" == --list ]]; then
    lanes | awk -F'|' '{ printf "%-16s %s\n%-16s   %s\n", $1, $2, "", $3 }'
    exit
fi
rest=""
if [[ "${1:-}" == --rest ]]; then
    rest=1
    shift
fi
for name in "$@"; do
    if ! lanes | grep -q "^$name|"; then
        echo "there is no lane \`$name\`; known are $(lanes | cut -d'|' -f1 | paste -sd' ')" >&2
        exit 2
    fi
done
out="$PWD/target/nightly"
rows="$out/rows"
summary="$out/summary.md"
[[ "$rest" ]] || (($#)) || rm -rf "$rows"
mkdir -p "$rows"

# The page, of what is answered so far.
write_summary() {
    printf '# A night\n\n%s; %s, %s cores.\n\n' "$(rustc --version)" "$(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -n 1)" "$(nproc)"
    printf '| lane | asks | commit, when | minutes | of processor | answer |\n| --- | --- | --- | --- | --- | --- |\n'
    local name what command answered=0 missing=() failed=0
    while IFS='|' read -r name what command; do
        if [[ ! -e "$rows/$name" ]]; then
            missing+=("$name")
            continue
        fi
        answered=$((answered + 1))
        has_failed "$name" && failed=$((failed + 1))
        printf '| %s | %s | %s\n' "$name" "$what" "$(cat "$rows/$name")"
    done < <(lanes)
    printf '\n%d lanes answered, %d of them failed; not asked: %s.\n' "$answered" "$failed" "$(IFS=' '; echo "${missing[*]:-none}")"
    ((failed == 0))
}
has_failed() { grep -q '\*\*FAILED' "$rows/$1"; }

# What lanes ask is the program of the commit that their lines name.
is_old_program() { [[ "$1" == release-program ]] && ! grep -qF "$commit, " "$rows/$1"; }

commit="$(git rev-parse --short=8 HEAD)$([[ -z "$(git status --porcelain)" ]] || echo ' and changes')"
while IFS='|' read -r name what command; do
    if (($#)) && [[ " $* " != *" $name "* ]]; then continue; fi
    if [[ "$rest" && -e "$rows/$name" ]] && ! has_failed "$name" && ! is_old_program "$name"; then continue; fi
    printf '== %s: %s\n' "$name" "$command"
    began=$SECONDS
    TIMEFORMAT='%U %S'
    { time bash -c "$command" >"$out/$name.log" 2>&1 </dev/null; } 2>"$out/time"
    code=$?
    # `time` answers with its command's own code.
    minutes="$(awk -v s=$((SECONDS - began)) 'BEGIN { printf "%.1f", s / 60 }')"
    processor="$(awk 'END { printf "%.1f", ($1 + $2) / 60 }' "$out/time")"
    last="$(grep -v '^[[:space:]]*$' "$out/$name.log" | tail -n 1 | tr '|' '/' | cut -c1-140)"
    if ((code)); then
        answer="**FAILED ($code)**: $last"
    elif grep -q 'NOT CHECKED\|not judged' "$out/$name.log"; then
        answer="in part: $(grep -m 1 'NOT CHECKED\|not judged' "$out/$name.log" | tr '|' '/' | cut -c1-140)"
    else
        answer="$last"
    fi
    printf '%s, %s | %s | %s | %s |\n' "$commit" "$(date --utc '+%F %H:%M')" "$minutes" "$processor" "$answer" >"$rows/$name"
    write_summary >"$summary"
done < <(lanes)
write_summary | tee "$summary"
((PIPESTATUS[0] == 0))
