#!/usr/bin/env bash
# Puts answers that no test asks for beside those of the tests: `also.sh ANSWERS`, after the program was built for the tests.
set -euo pipefail
cd "$(dirname "$0")/../.."
answers="$1"

# A name, and the words of a command.
also() {
    local name="$1"
    mkdir -p "$answers/$name"
    (cd "$work" && "$program" "${@:2}" --format json) >"$work/answer" 2>/dev/null || true
    if python3 -m json.tool "$work/answer" /dev/null 2>/dev/null; then
        cp "$work/answer" "$answers/$name/also-$((count += 1)).json"
    else
        echo "no answer: fspid ${*:2}"
    fi
}
program="$PWD/target/debug/fspid" work="$(mktemp -d)" count=0 scenarios="$PWD/scenarios"
trap 'rm -rf "$work"' EXIT
for aircraft in $("$program" aircraft list --format json | python3 -c 'import json, sys; print(*(it["name"] for it in json.load(sys.stdin)["aircraft"]))'); do
    for question in show trim linearise modes qualities derive; do also "aircraft-$question" aircraft "$question" "$aircraft"; done
done
for file in "$scenarios"/gallery/*.toml "$scenarios"/*.toml; do
    also simulate simulate "$file"
    also analyse analyse "$file" --map 5
    also verify verify "$file" --set ctms
done
"$program" init --template campaign "$work/campaign.toml" >/dev/null
"$program" init --template tuning "$work/tuning.toml" >/dev/null
"$program" init --template contest "$work/contest.toml" >/dev/null
"$program" init "$work/pitch.toml" >/dev/null
for file in 747-pitch-step campaign limits square-accumulating plant-change; do
    also certify certify "$scenarios/$file.toml" --out "$work/proofs"
done
also certify-cases certify "$PWD/data/designs/learned/light-six.toml" --controller FSPID --cases tuning --set setpoint.amplitude_deg=0
also certify certify "$scenarios/gallery/navion-linear.toml" --disturbances --out "$work/proofs"
also certify certify "$scenarios/gallery/rate-limited-servo.toml" --disturbances --out "$work/proofs"
also certify certify "$scenarios/../data/designs/learned/light-six.toml" --controller FSPID --set setpoint.amplitude_deg=0 --disturbances
for proof in "$work"/proofs/*.json; do also certify-check certify --check "$proof"; done
for changed in "" "--set controller.FSPID.nominal.ki=0.3"; do
    # Without a change the text is the one that was certified.
    also certify-check certify --check "$PWD/data/designs/navion-paper.certificate.json" --against "$PWD/data/designs/navion-paper.toml" $changed
done
also campaign-run campaign run campaign.toml --runs 200 --quiet --out run
also campaign-report campaign report run/campaign.parquet
for template in requirements pitch-hold; do
    # A requirement of one controller alone, and notes of no measure.
    "$program" init --template "$template" "$work/$template.toml" >/dev/null
    printf '\n[[dispersion]]\npath = "loop.duration_s"\ndistribution = "choice"\nvalues = [10.0]\n' >>"$work/$template.toml"
    also campaign-run campaign run "$template.toml" --runs 20 --quiet --out "run-$template"
    also campaign-report campaign report "run-$template/campaign.parquet"
done
also campaign-rare campaign rare campaign.toml --fails overshoot_pct --flights 4000 --set loop.duration_s=2
also campaign-rare campaign rare campaign.toml --fails overshoot_pct --method both --most 1e-6 --flights 4000 --set loop.duration_s=2
for optimiser in nsga-ii bfgs de; do also tune tune tuning.toml --optimiser "$optimiser" --budget 200 --quiet --limit; done
also contest contest contest.toml --budget 30 --seeds 3 --quiet --out three --limit
also adaptation adaptation pitch.toml --seeds 3 --budget 30 --quiet
also limit limit pitch.toml --travel-deg 10,20 --quiet --causal --set loop.duration_s=2
