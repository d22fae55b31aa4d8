#!/usr/bin/env bash
# Two builds of the commit that is checked out, in two folders, with two folders of cargo's: one hash, or where they part.
#   check.sh [PROFILE]                      `release` if nothing is named; `dist` is what is handed out, and takes twice as long
#   check.sh PROFILE --against PROGRAM      one build, compared with a program that somebody else built of this commit
# With a page in web/dist both carry it. Takes two builds from nothing: some fifteen minutes on two cores.
set -euo pipefail
cd "$(dirname "$0")/../.."
profile="${1:-release}"
against="${3:-}"
[[ "${2:---against}" == --against ]] || { echo "check.sh [PROFILE [--against PROGRAM]]" >&2 && exit 2; }
work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT
cargo_home="${CARGO_HOME:-$HOME/.cargo}"
[[ -d web/dist/site ]] && export FSPID_WEB_DIST="$PWD/web/dist"

# A folder: the commit cloned into it, and what the build of it is called.
built() {
    git clone --quiet . "$1"
    (cd "$1" && CARGO_TARGET_DIR="$1/target" checks/reproducible/build.sh "$profile")
    cp "$1/target/$profile/fspid" "$2"
    rm -rf "$1"
}

if [[ -n "$against" ]]; then cp "$against" "$work/first"; else built "$work/one" "$work/first"; fi
# The same packages by another path, as another person has them.
mkdir -p "$work/cargo of another"
for part in registry git config.toml; do
    if [[ -e "$cargo_home/$part" ]]; then ln -s "$cargo_home/$part" "$work/cargo of another/$part"; fi
done
CARGO_HOME="$work/cargo of another" built "$work/another folder/and a deeper one" "$work/second"

sha256sum "$work/first" "$work/second" | sed "s|$work/||"
"$work/first" --version
if ! cmp "$work/first" "$work/second"; then
    echo "words that only one of them has:"
    diff <(strings -n 8 "$work/first" | sort -u) <(strings -n 8 "$work/second" | sort -u) | head -n 20 || true
    exit 1
fi
# Two folders may hide a third: no path of this machine is in it.
for path in "$PWD" "$work" "$cargo_home" "$HOME/"; do
    if grep -qaF -- "$path" "$work/first"; then
        echo "$path stands in it: $(strings "$work/first" | grep -F -- "$path" | head -n 3)" >&2
        exit 1
    fi
done
echo "the same bytes: $(stat --format=%s "$work/first")"
