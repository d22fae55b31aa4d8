#!/usr/bin/env bash
# Exports for MATLAB and Simulink, in Octave as a stand-in for MATLAB: the function is asked for 2 000 answers; the S-function
# is compiled by Octave's mex against a stub of Simulink's header (stubs/matlab), and runs 20 000 vectors in a C program on
# that stub, two blocks side by side. Nobody here can run MATLAB or Simulink itself. Installs octave by apt.
# `--quick`: one of the designs.
set -euo pipefail
cd "$(dirname "$0")/../.."
. checks/export/tools.sh
needs octave octave octave-dev || exit 0
needs mkoctfile octave-dev || exit 0
program
stubs="$PWD/checks/export/stubs/matlab"
work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT
bad=0
designs=(data/designs/learned/light.toml data/designs/navion-paper.toml)
if [[ "${1:-}" == --quick ]]; then designs=("${designs[0]}"); fi
for design in "${designs[@]}"; do
    name="$(basename "$design" .toml)"
    for numbers in single double; do
        real=$([[ $numbers == single ]] && echo float || echo double)
        asked=(--controller FSPID --numbers "$numbers" --angles degrees)
        "$FSPID" export "$design" "${asked[@]}" --to matlab --samples 2000 --out "$work/$name-$numbers-m" &> "$work/told"
        said="$(cd "$work/$name-$numbers-m" && octave --no-gui --quiet --eval fspid_check 2> /dev/null)"
        echo "$name, $numbers, function: $said"
        [[ $said == *" 0 different"* ]] || bad=1
        "$FSPID" export "$design" "${asked[@]}" --to simulink --out "$work/$name-$numbers-s" &> "$work/told"
        (
            cd "$work/$name-$numbers-s"
            cc -std=c99 -O2 -Wall -Wextra -ffp-contract=off -DNUMBER="$real" -I"$stubs" fspid_sfun.c fspid.c -o sfun
            echo "$name, $numbers, S-function: $(./sfun)"
            mkoctfile --mex -DMATLAB_MEX_FILE -I"$stubs" -o fspid_sfun.mex fspid_sfun.c fspid.c
            echo "$name, $numbers, S-function: compiled by Octave's mex"
        )
    done
done

# Options that the shipped designs have not.
controller=controller.FSPID
sampled=(--set "$controller.supervisor.defuzzifier=endpoints:31" --set "$controller.supervisor.out_of_range=evaluate"
    --set "$controller.anti_windup.kind=conditional" --set "$controller.output_limits_deg=[-10, 10]")
remembered=(--set "$controller.law=accumulating" --set "$controller.leakage_per_s=0.5" --set "$controller.integral=literal"
    --set "$controller.dead_zone.error_deg=1" --set "$controller.dead_zone.change_deg_s=5" --set "$controller.rate_gain=0.1"
    --set "$controller.slew_limit_deg_s=60" --set "$controller.supervisor.out_of_range=error"
    --set "$controller.anti_windup.kind=back-calculation" --set "$controller.anti_windup.tracking_s=0.5"
    --set "$controller.gain_coupling.setpoint_weight_per_kp=0.1")
for options in sampled remembered; do
    declare -n given="$options"
    "$FSPID" export data/designs/navion-paper.toml --controller FSPID --to matlab --samples 1000 --out "$work/$options" "${given[@]}" &> "$work/told" || cat "$work/told"
    said="$(cd "$work/$options" && octave --no-gui --quiet --eval fspid_check 2> /dev/null)"
    echo "$options, function: $said"
    [[ $said == *" 0 different"* ]] || bad=1
done
exit "$bad"
