#!/usr/bin/env bash
# Exports for MATLAB and Simulink, in Octave as a stand-in for MATLAB: the function is asked for 2 000 answers; the S-function
# is compiled by Octave's mex against a stub of Simulink's header (stubs/matlab), and runs 20 000 vectors in a C program on
# that stub, two blocks side by side. Nobody here can run MATLAB or Simulink itself. Installs octave by apt.
set -euo pipefail
cd "$(dirname "$0")/../.."
if ! command -v octave > /dev/null || ! command -v mkoctfile > /dev/null; then
    apt-get update -qq
    apt-get install -y -qq --no-install-recommends octave octave-dev
fi
if [[ -z "${FSPID:-}" ]]; then
    cargo build --release --quiet
    FSPID=target/release/fspid
fi
stubs="$PWD/checks/export/stubs/matlab"
work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT
bad=0
for design in data/designs/navion-paper.toml data/designs/learned/light.toml; do
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
exit "$bad"
