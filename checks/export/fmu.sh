#!/usr/bin/env bash
# Shipped designs as FMUs of both versions, in an importer that others wrote: FMPy validates them, flies all vectors with two
# instances side by side, steps back, sets parameters, and builds them from their sources. Then FMUs of drawn controllers are
# built with sanitizers and called as they must not be. And the other way round: an FMU that PythonFMU made, with names and a
# sign of its own, flies here with the bits of the same law in C. Takes some minutes, most of them for the tests' own build.
set -euo pipefail
cd "$(dirname "$0")/../.."

. checks/export/tools.sh
program
work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/python"
"$work/python/bin/pip" install --quiet --disable-pip-version-check fmpy==0.3.32
# FMPy brings the cmake that it builds with.
export PATH="$work/python/bin:$PATH"
failed=0

for design in data/designs/navion-paper.toml data/designs/learned/light.toml data/designs/learned/transport.toml; do
    name="$(basename "$design" .toml)"
    for version in 2 3; do
        for numbers in double single; do
            out="$work/$name-$version-$numbers"
            "$FSPID" export "$design" --controller FSPID --to "fmu$version" --numbers "$numbers" --out "$out" > "$out.told" 2>&1
            "$FSPID" export "$design" --controller FSPID --to "fmu$version" --numbers "$numbers" --out "$out.again" > "$out.told" 2>&1
            cmp "$out/fspid.fmu" "$out.again/fspid.fmu"
            python checks/export/fmu.py "$out/fspid.fmu" "$out/vectors.csv" "$numbers" > "$out.log" 2>&1 || { failed=1; cat "$out.log"; }
            echo "$name, $numbers: $(grep "^FMI" "$out.log" || echo "no answer")"
        done
    done
done

# Fuzzy systems of their own, with and without memory of the previous answer.
for system in examples/systems/*.toml; do
    name="$(basename "$system" .toml)"
    for version in 2 3; do
        out="$work/$name-$version"
        "$FSPID" export "$system" --to "fmu$version" --out "$out" > "$out.told" 2>&1
        python checks/export/fmu_system.py "$out"/*.fmu "$out/vectors.csv" double > "$out.log" 2>&1 || { failed=1; cat "$out.log"; }
        echo "$name: $(grep "^FMI" "$out.log" || echo "no answer")"
    done
done

# Without a compiler there are sources, and a note.
CC="$work/no-compiler" "$FSPID" export data/designs/learned/light.toml --controller FSPID --to fmu3 --out "$work/sources" > "$work/told" 2>&1
grep "sources only" "$work/told"
echo "sources only: $(stat -c %s "$work/sources/fspid.fmu") bytes"

# An FMU of another tool, whose library looks for Python in the program that loads it.
foreign() {
    "$work/python/bin/pip" install --quiet --disable-pip-version-check pythonfmu==0.7.0
    python -m pythonfmu build -f checks/export/law.py -d "$work" > "$work/told" 2>&1
    "$FSPID" init "$work/pitch.toml" > "$work/told" 2>&1
    "$FSPID" export "$work/pitch.toml" --controller FSPID --to c --samples 9 --out "$work/code" > "$work/told" 2>&1
    cc -shared -fPIC -O2 -ffp-contract=off -I "$work/code/external" checks/export/law.c -o "$work/law.so"
    local names=(--input setpoint_rad=theta_ref --input measurement_rad=theta --input rate_rad_s=q)
    local library
    library="$(python -c 'import sysconfig as s; print(s.get_config_var("LIBDIR") + "/" + s.get_config_var("LDLIBRARY"))')"
    LD_PRELOAD="$library" "$FSPID" simulate "$work/pitch.toml" --library "$work/law.so" --fmu "$work/Law.fmu" \
        "${names[@]}" --output command_rad=-delta_e --trace "$work/law.csv" > "$work/told"
    python - "$work/law.csv" <<'PYTHON'
import csv, sys
rows = list(csv.DictReader(open(sys.argv[1], newline="")))
mine = [name for name in rows[0] if name.startswith("law.so.")]
different = sum(row[name] != row[name.replace("law.so.", "Law.fmu.")] for row in rows for name in mine)
print(f"PythonFMU: {len(rows)} samples, {len(mine)} columns, {different} different")
sys.exit(different != 0 or len(rows) < 1000)
PYTHON
}
foreign || failed=1

# What the tests themselves consist of is built as ever; the FMUs and the importer in C with sanitizers.
printf '#!/bin/sh\nCC="cc -fsanitize=address,undefined -fno-sanitize-recover=undefined" exec "$@"\n' > "$work/sanitizing"
chmod +x "$work/sanitizing"
cargo test --quiet -p fspid-export --test all --config "target.'cfg(unix)'.runner='$work/sanitizing'" the_fmu_of_any || failed=1
exit "$failed"
