#!/usr/bin/env bash
# Asks a Debian package what a user would: unpacked, its program flies, its pages are found by `man`, shells take its completions.
#   installed.sh PACKAGE VERSION
set -euo pipefail
work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT
dpkg-deb --extract "$1" "$work/root"
fspid="$work/root/usr/bin/fspid"
[[ "$("$fspid" --version | head -n 1)" == "fspid $2" ]]
"$fspid" init "$work/pitch.toml" >/dev/null
"$fspid" simulate "$work/pitch.toml" --format json >"$work/answer.json"
python3 -c 'import json, sys; assert json.load(open(sys.argv[1]))["schema"] == 1' "$work/answer.json"
# Every command that the program has, has a page.
for command in $("$fspid" --help | awk '/^Commands:/ { on = 1; next } on && NF == 0 { exit } on { print $1 }' | grep -vx help); do
    page="$work/root/usr/share/man/man1/fspid-$command.1.gz"
    gzip --test "$page"
    if command -v man >/dev/null; then man --warnings --local-file "$page" >"$work/page" 2>"$work/warnings" && grep -q "fspid" "$work/page"; fi
done
bash -n "$work/root/usr/share/bash-completion/completions/fspid"
bash -c 'source "$1"; complete -p fspid' _ "$work/root/usr/share/bash-completion/completions/fspid" >/dev/null
for shell in zsh fish; do
    command -v "$shell" >/dev/null || { echo "NOT CHECKED: $shell is not here to read its completions" && continue; }
    file="$work/root/usr/share/zsh/vendor-completions/_fspid"
    [[ "$shell" == fish ]] && file="$work/root/usr/share/fish/vendor_completions.d/fspid.fish"
    "$shell" -n "$file"
done
[[ -s "$work/root/usr/share/fspid/fspid.ps1" && -s "$work/root/usr/share/doc/fspid/fspid.cdx.json" ]]
echo "unpacked, it flies; $(find "$work/root/usr/share/man/man1" -name '*.gz' | wc -l) pages, completions of four shells, $(dpkg-deb --field "$1" Installed-Size) kB"
