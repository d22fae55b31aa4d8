#!/usr/bin/env bash
# What stands around an installed program: its manual, completions, and what it is built from.
#   files.sh PROGRAM FOLDER     writes FOLDER/{man1,bash,zsh,fish,powershell,doc}
set -euo pipefail
program="$(realpath "$1")"
rm -rf "$2"
mkdir -p "$2"/{man1,bash,zsh,fish,powershell,doc}
out="$(realpath "$2")"
cd "$(dirname "$0")/../.."

"$program" manual --out "$out/man1" >/dev/null
# No time stands in them, so that the same pages are the same bytes.
gzip --best --no-name "$out"/man1/*.1
"$program" completions bash >"$out/bash/fspid"
"$program" completions zsh >"$out/zsh/_fspid"
"$program" completions fish >"$out/fish/fspid.fish"
"$program" completions powershell >"$out/powershell/fspid.ps1"
python3 checks/supply/bill.py --out "$out/doc/fspid.cdx.json" >/dev/null
# Debian's format, an entry for each version; what changed stands in CHANGELOG.md.
debian_changelog() {
    sed -n 's/^## \[\([0-9.]*\)\] - \(.*\)$/\1 \2/p' CHANGELOG.md | while read -r version date; do
        printf 'fspid (%s-1) unstable; urgency=medium\n\n  * Version %s: every change is told in changelog.gz beside this file.\n\n' "$version" "$version"
        printf ' -- The fspid developers <fspid@localhost>  %s\n\n' "$(LC_ALL=C date --utc --date="$date" '+%a, %d %b %Y 00:00:00 +0000')"
    done
}
debian_changelog >"$out/doc/changelog.Debian"
gzip --best --no-name --stdout CHANGELOG.md >"$out/doc/changelog.gz"
