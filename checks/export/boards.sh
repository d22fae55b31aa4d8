#!/usr/bin/env bash
# What the guide says of flight controllers and build systems: the code in the pages of PX4 and ArduPilot, taken out of the
# pages, and the sketch for Arduino, compiled against stubs of the projects' headers (stubs/); the CMake project built and its
# test run. Needs cc and c++; CMake is installed by apt where it is missing.
set -euo pipefail
cd "$(dirname "$0")/../.."
. checks/export/tools.sh
needs cmake cmake || exit 0
program
stubs="$PWD/checks/export/stubs"
work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT
strict=(-std=c++14 -Wall -Wextra -Werror -fno-exceptions -fno-rtti)

# The block of a page that begins with a comment of a file's name.
block() { awk -v name="// $2" '/^```/ { inside = 0 } inside { print } $0 == name { inside = 1 }' "$1"; }

for design in data/designs/navion-paper.toml data/designs/learned/light.toml; do
    name="$(basename "$design" .toml)"
    for angles in degrees radians; do
        folder="$work/$name-$angles"
        "$FSPID" export "$design" --controller FSPID --to c --angles "$angles" --samples 2000 --out "$folder" &> "$work/told"
        c++ "${strict[@]}" -I"$folder" -I"$stubs/arduino" -include Arduino.h -x c++ -c "$folder/arduino/fspid_sketch/fspid_sketch.ino" -o "$work/sketch.o"
        echo "$name, $angles: the sketch compiles"
    done
    cmake -S "$work/$name-degrees" -B "$work/$name-build" > "$work/told"
    cmake --build "$work/$name-build" > "$work/told"
    (cd "$work/$name-build" && ctest 2>&1 | grep "tests passed" | sed "s/^/$name, CMake: /")
done

folder="$work/pages"
"$FSPID" export data/designs/learned/light.toml --controller FSPID --to c --samples 100 --out "$folder" &> "$work/told"
for page in px4 ardupilot; do
    for file in $(sed -n 's|^// \([a-zA-Z0-9_]*\.[a-z]*\)$|\1|p' "docs/guide/export-$page.md"); do
        block "docs/guide/export-$page.md" "$file" > "$folder/$file"
    done
done
for page in px4 ardupilot; do
    for file in $(sed -n 's|^// \([a-zA-Z0-9_]*\.cpp\)$|\1|p' "docs/guide/export-$page.md"); do
        c++ "${strict[@]}" -I"$folder" -I"$stubs/$page" -c "$folder/$file" -o "$work/$file.o"
        echo "export-$page.md: $file compiles against stubs"
    done
done
