#!/usr/bin/env bash
# Shipped designs as FMUs of both versions, in an importer that others wrote: FMPy validates them, flies all vectors with two
# instances side by side, steps back, sets parameters, and builds them from their sources. Then FMUs of drawn controllers are
# built with sanitizers and called as they must not be. Takes some minutes, most of them for the tests' own build.
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

# Without a compiler there are sources, and a note.
CC="$work/no-compiler" "$FSPID" export data/designs/learned/light.toml --controller FSPID --to fmu3 --out "$work/sources" > "$work/told" 2>&1
grep "sources only" "$work/told"
echo "sources only: $(stat -c %s "$work/sources/fspid.fmu") bytes"

# What the tests themselves consist of is built as ever; the FMUs and the importer in C with sanitizers.
printf '#!/bin/sh\nCC="cc -fsanitize=address,undefined -fno-sanitize-recover=undefined" exec "$@"\n' > "$work/sanitizing"
chmod +x "$work/sanitizing"
cargo test --quiet -p fspid-export --test all --config "target.'cfg(unix)'.runner='$work/sanitizing'" the_fmu_of_any || failed=1
exit "$failed"
