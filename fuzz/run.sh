#!/usr/bin/env bash
# Fuzzes every reader for so many seconds (20 if nothing is said), as many at once as there are cores. Ends with 1 where
# one was brought down, whose input is then in target/fuzz/found, or where one reads none of its seeds. FSPID names the
# program that makes seeds.
#   --quick   before it: only readers of files that people hand on, behind which fewer crates are built
#   --build   builds the readers and runs none
#
# cargo-fuzz is not needed: these are the flags that it gives the stable compiler when it leaves the sanitizer out.
set -euo pipefail
cd "$(dirname "$0")"
features=()
if [[ "${1:-}" == --quick ]]; then
    features=(--no-default-features)
    shift
fi
seconds="${1:-20}"
[[ "$seconds" == --build ]] && only_builds=1
fspid="${FSPID:-$PWD/../target/release/fspid}"
host="$(rustc -vV | sed -n 's/^host: //p')"
export CARGO_TARGET_DIR="$PWD/../target/fuzz"
# With a target, build scripts and macros are left as they are.
RUSTFLAGS="--cfg fuzzing -Cdebug-assertions -Cpasses=sancov-module -Cllvm-args=-sanitizer-coverage-level=4 \
-Cllvm-args=-sanitizer-coverage-inline-8bit-counters -Cllvm-args=-sanitizer-coverage-pc-table \
-Cllvm-args=-sanitizer-coverage-trace-compares" cargo build --locked --profile quick "${features[@]}" --target "$host"
[[ "${only_builds:-}" ]] && exit 0

# Seeds: the fixtures of the tests, and what only the program writes.
tests="$PWD/../crates"
made="$CARGO_TARGET_DIR/seeds" found="$CARGO_TARGET_DIR/found"
rm -rf "$made" "$found"
mkdir -p "$made"/{formula,toml,certificate,part,plan,state,csv,set,fly,mavlink,server} "$found"
echo 'max(0.5*x, error^2) - exp(-change)' >"$made/formula/one"
cp "$tests"/fspid-scenario/src/file/templates/fuzzy-system.toml "$made/toml"
printf 'a,b\n1,2\n-0.5,1e-3\n' >"$made/csv/one"
printf 'a,b,"c,d"\n1,2,3\n-0.5,1e-3,"x"\n' >"$made/csv/two"
printf 'controller.CPID.kp=1.5\nactuator={time_constant_s=0.2,delay_samples=3}\n' >"$made/set/one"
printf 'plant.preset.numerator[0]=-1.7\nloop.duration_s=4.0\n' >"$made/set/two"
printf '# r, y, dt\n1,0,0.01\n1,0.5,0.01\nreset\n0,nan,0.01\n1,1e300,0.01\n' >"$made/fly/one"
packets="$tests/fspid-mavlink/tests/data/packets.jsonl" at=0
for digits in $(grep -o '"packets": \[[^]]*' "$packets" | grep -o '[0-9a-f]\{16,\}' | sort -u); do
    printf "$(sed 's/../\\x&/g' <<<"$digits")" >"$made/mavlink/$((at += 1))"
done
scenarios="$PWD/../scenarios"
# For readers that are built with the whole program.
of_the_whole_program() {
    # What the page asks, of the one scenario that the target's server has; its id is that of its name.
    token=0123456789abcdef0123456789abcdef
    id="$(printf mine.toml | sha256sum | cut -c1-32)"
    digest="$(printf 'schema = 1\nname = "KEPT-TO-ITSELF"\n[[controller]]\nname = "PID"\n' | sha256sum | cut -c1-64)"
    asks() {
        printf '%s HTTP/1.1\r\nHost: 127.0.0.1:8000\r\nX-Fspid-Token: %s\r\nContent-Type: application/json\r\nContent-Length: %d\r\n\r\n%s' \
            "$1" "$token" "${#2}" "$2"
    }
    printf 'GET / HTTP/1.1\r\nHost: localhost:8000\r\n\r\n' >"$made/server/page"
    for path in health scenarios "scenarios/$id" jobs jobs/1/events jobs/1/runs/0 jobs/1/report telemetry/events; do
        asks "GET /api/$path" "" >"$made/server/${path//\//-}"
    done
    job="{\"kind\":\"tune\",\"id\":\"$id\",\"options\":{\"budget\":8,\"seed\":3,\"set\":[\"loop.duration_s=4.0\"]}}"
    campaign="{\"kind\":\"campaign\",\"id\":\"$id\",\"options\":{\"runs\":8,\"measures\":[\"iae_deg_s\"],\"sampling\":\"random\"}}"
    asks "PUT /api/scenarios/$id" "{\"text\":\"schema = 1\",\"digest\":\"$digest\"}" >"$made/server/save"
    {
        asks "POST /api/jobs" "$job"
        asks "POST /api/jobs" "$campaign"
        asks "GET /api/jobs" ""
        asks "DELETE /api/jobs/1" ""
        asks "GET /api/jobs/1/events" ""
    } >"$made/server/jobs-of-a-person"
    "$fspid" certify "$scenarios/747-pitch-step.toml" --out "$made/certificate" >/dev/null || true
    "$fspid" campaign plan "$scenarios/campaign.toml" --runs 50 --out "$made/plan" >/dev/null
    # A merged file and a part, small enough for an input.
    "$fspid" campaign run "$scenarios/campaign.toml" --runs 3 --shard-runs 3 --threads 1 --quiet --out "$made/whole" >/dev/null
    cp "$made/whole/campaign.parquet" "$made/part/whole"
    cp "$made"/whole/shards/*.parquet "$made/part/part"
    for optimiser in cma-es de l-shade pso ga nelder-mead bfgs nsga-ii; do
        # A search that is killed leaves its first state, which is small. Without blanks more of it fits into an input.
        state="$made/$optimiser.toml.state.json"
        "$fspid" tune "$scenarios/gallery/tune-navion.toml" --optimiser "$optimiser" --budget 1000000 --quiet \
            --out "$made/$optimiser.toml" >/dev/null 2>&1 &
        while kill -0 $! 2>/dev/null && [[ ! -e "$state" ]]; do sleep 0.05; done
        kill -KILL $! 2>/dev/null || true
        wait $! 2>/dev/null || true
        if [[ -e "$state" ]]; then tr -d ' \n' <"$state" >"$made/state/${state##*/}"; fi
    done
}
[[ "${features[*]}" ]] || of_the_whole_program

seeds_of() {
    case "$1" in
    fis | fcl | fll | fml) echo "$tests/fspid-formats/tests/data/$1" ;;
    daveml) echo "$tests/fspid-daveml/tests/data" ;;
    scenario) echo "$scenarios $scenarios/gallery $tests/fspid-scenario/tests/scenarios" ;;
    *) echo "$made/$1" ;;
    esac
}

fuzz() {
    local words=() readers="$CARGO_TARGET_DIR/$host/quick/readers" read inputs
    # What a reader of files is given is gone with the seeds of the next run.
    export FSPID_FUZZ_TARGET="$1" TMPDIR="$made"
    [[ -f "$1.dict" ]] && words=("-dict=$1.dict")
    # An input that takes longer than 20 s or more than 2 GiB is a finding too.
    words+=(-seed=22 -max_len=32768 -timeout=20 -rss_limit_mb=2048 "-artifact_prefix=$found/$1-")
    mkdir -p "$made/corpus/$1"
    # A seed that is refused, for it is cut off, say, shows nothing of what stands behind the reader.
    read="$(FSPID_FUZZ_TELL=1 "$readers" $(seeds_of "$1") "${words[@]}" -runs=0 2>&1 | grep -c '^read$' || true)"
    if ((read == 0)); then
        echo "$1: reads none of its seeds"
        return 1
    fi
    if "$readers" "$made/corpus/$1" $(seeds_of "$1") "${words[@]}" -max_total_time="$seconds" \
        -print_final_stats=1 >"$found/$1.log" 2>&1; then
        inputs="$(sed -n 's/^stat::number_of_executed_units: *//p' "$found/$1.log")"
        echo "$1: $inputs inputs, nothing found; $read seeds are read"
    else
        tail -n 30 "$found/$1.log"
        echo "$1: FOUND SOMETHING; its input is in $found"
        return 1
    fi
}

targets=(fuzz_targets/*.rs)
targets=("${targets[@]##*/}")
if [[ "${features[*]}" ]]; then
    # Files of readers that are built only with the whole program.
    whole="$(grep -A 1 'feature = "whole-program"' fuzz_targets/readers.rs | sed -n 's/^mod \(.*\);/\1.rs/p')"
    mapfile -t targets < <(printf '%s\n' "${targets[@]}" | grep -vxF "$whole")
fi
export -f fuzz seeds_of
export seconds host made found tests scenarios
printf '%s\n' "${targets[@]%.rs}" | grep -vx readers |
    xargs -P "$(nproc)" -I {} bash -c 'set -euo pipefail; fuzz {}'
