#!/usr/bin/env bash
# What a program answers, as digests: one line for each answer, its name and the SHA-256 of every byte of it.
#   digests.sh PROGRAM [ARGUMENT…]     where PROGRAM may be an emulator, and fspid its argument, with its whole path
# An answer that a program does not give has the first line of its complaint in place of a digest.
set -euo pipefail
root="$(cd "$(dirname "$0")/../.." && pwd)"
work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT
# Answers name files as they were asked for: they are the same ones everywhere.
cd "$work"
ln -s "$root/scenarios" "$root/data" .

# Name of the answer, and the file or folder that holds it. Files of a folder count with their names.
digest() {
    local name="$1" path="$2" sum
    if [[ -d "$path" ]]; then
        sum="$(cd "$path" && find . -type f | LC_ALL=C sort | xargs -d '\n' sha256sum | sha256sum)"
    else
        sum="$(sha256sum <"$path")"
    fi
    printf '%s %s\n' "$name" "${sum%% *}"
}

# Name, what it is written to, and the command. That a requirement is not met (1) is an answer like another.
answer() {
    local name="$1" path="$2" code=0
    "${@:3}" >said 2>complaint || code=$?
    if ((code > 1)); then
        printf '%s NOT ANSWERED (%d): %s\n' "$name" "$code" "$(grep -v '^ *$' complaint | head -n 1)"
    else
        digest "$name" "$path"
    fi
}

answer reproduce/claims out/claims.json "$@" reproduce --out out
for part in traces figures report.html; do
    [[ -e "out/$part" ]] && digest "reproduce/$part" "out/$part"
done
answer campaign/flights campaign/campaign.parquet \
    "$@" campaign run scenarios/campaign.toml --runs 200 --shard-runs 60 --quiet --out campaign
if [[ -e campaign/campaign.parquet ]]; then
    answer campaign/report campaign.html "$@" campaign report campaign/campaign.parquet --out campaign.html
fi
answer certificate certificates \
    "$@" certify scenarios/747-pitch-step.toml --controller FSPID --out certificates
for language in c rust st lua; do
    answer "export/$language" "$language" \
        "$@" export data/designs/learned/light.toml --controller FSPID --to "$language" --samples 2000 --out "$language"
done
# Flights with lanes that no figure of the paper has: six degrees of freedom, turbulence, sensors, tables.
for scenario in turn b747-turbulence ils-approach sensor-ahrs; do
    answer "flight/$scenario" "$scenario.csv" \
        "$@" simulate "scenarios/gallery/$scenario.toml" --trace "$scenario.csv"
done
answer margins said "$@" analyse scenarios/747-pitch-step.toml --format json
answer limit said "$@" limit scenarios/747-pitch-step.toml --travel-deg 10 --format json
