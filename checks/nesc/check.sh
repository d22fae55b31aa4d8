#!/usr/bin/env bash
# NASA's F-16 with its own control law against the flights of three simulators of the NESC check cases 11, 13.1 and 13.2;
# 13.3 and 13.4 are flown, and have to come to where they are sent.
# check.sh F16_FOLDER NESC_FOLDER [fspid]
#   F16_FOLDER   F16_aero.dml, F16_control.dml, F16_inertia.dml, F16_prop.dml of NASA's repository nasa/simupy-flight
#   NESC_FOLDER  caseNN_simMM.csv of the same, rows at whole seconds or tenths
set -euo pipefail
here="$(cd "$(dirname "$0")" && pwd)"
fspid="${3:-$here/../../target/release/fspid}"
work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT
cp "$here"/*.toml "$1"/F16_*.dml "$work"
for case in case11 case13p1 case13p2 case13p3 case13p4; do
    "$fspid" simulate "$work/$case.toml" --trace "$work/$case.csv" > /dev/null
done
python3 "$here/compare.py" "$work" "$2"
