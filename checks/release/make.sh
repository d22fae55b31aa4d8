#!/usr/bin/env bash
# Makes a release, by one command:
#   make.sh VERSION [--dry-run] [--out FOLDER]
#
#   1. a clone of the commit that is checked out gets the version (manifests, locks, changelog)
#   2. what must hold does: `.ci/run` (a dry run leaves that out), every crate packed, compiled from what is packed (likewise)
#   3. the program is built as checks/reproducible/build.sh builds it: no path of this machine in it
#   4. its manual, completions, bill of materials; a Debian package, which lintian finds nothing in, and which is unpacked and asked
#   5. the crates, the package, an archive and SHA256SUMS are in the folder (target/VERSION if none is named)
#   6. the commit of the version, with a tag, is fetched into this repository
#
# A dry run does not do the sixth: the tree, the index, the branches and the tags stay as they are, and only what is in `target` is
# written. Nothing is published. FSPID_RELEASE_PROFILE names another profile than `dist`, which takes long. Needs Debian 12 or newer,
# the Rust toolchain, and root or sudo where lintian is missing.
set -euo pipefail
cd "$(dirname "$0")/../.."
root="$PWD"
profile="${FSPID_RELEASE_PROFILE:-dist}"
version="" dry="" out=""
while (($#)); do
    case "$1" in
    --dry-run) dry=yes ;;
    --out) out="$2" && shift ;;
    [0-9]*) version="$1" ;;
    *)
        echo "there is no argument \`$1\`: make.sh VERSION [--dry-run] [--out FOLDER]" >&2
        exit 2
        ;;
    esac
    shift
done
[[ -n "$version" ]] || { echo "make.sh VERSION [--dry-run] [--out FOLDER]" >&2 && exit 2; }
if [[ -n "$(git status --porcelain)" ]]; then
    echo "the tree has changes: a release is made of a commit" >&2
    exit 1
fi
out="${out:-target/$version}"
mkdir -p "$out"
out="$(realpath "$out")"
work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT
step() { printf '\n== %s (after %d min)\n' "$1" "$((SECONDS / 60))"; }

step "the version, in a clone"
# Always the same folder, so that a second try need not build everything again.
clone="$root/target/release-clone"
rm -rf "$clone"
git clone --quiet "$root" "$clone"
cd "$clone"
python3 checks/release/version.py "$version" "$(date --utc +%F)" "$clone"
# Only versions of ours move in the locks.
for lock in $(git ls-files '*Cargo.lock'); do
    cargo update --quiet --workspace --offline --manifest-path "${lock%.lock}.toml"
    others="$(git diff --unified=0 "$lock" | grep '^[-+]version' | grep -vF -e "-version = \"" -e "+version = \"$version\"" || true)"
    if [[ -n "$others" ]]; then
        echo "$lock: more than our versions moved: $others" >&2
        exit 1
    fi
done
git commit --quiet --all --message "Version $version"
git tag "v$version"

if [[ -z "$dry" ]]; then
    step "what must hold"
    .ci/run
    checks/packages/check.sh
fi
step "crates"
CARGO_TARGET_DIR="$root/target/release-crates" cargo package --workspace --no-verify --locked --quiet
cp "$root"/target/release-crates/package/fspid*-"$version".crate "$out/"
printf '%d crates\n' "$(find "$out" -name '*.crate' | wc -l)"

step "the program, profile $profile"
# A dry run takes the page that is there, if one is.
if [[ -z "$dry" ]]; then
    web/build.sh
    export FSPID_WEB_DIST="$clone/web/dist"
else
    export FSPID_WEB_DIST="${FSPID_WEB_DIST:-$root/web/dist}"
fi
export CARGO_TARGET_DIR="$root/target/reproducible"
checks/reproducible/build.sh "$profile"
mkdir -p target/release
cp "$CARGO_TARGET_DIR/$profile/fspid" target/release/fspid
unset CARGO_TARGET_DIR
strip target/release/fspid
target/release/fspid --version | tee "$work/version"
grep -qx "fspid $version" "$work/version"
grep -qE '^commit [0-9a-f]{12}$' "$work/version"
grep -q '^for .* by rustc' "$work/version"
grep -q 'scenarios of schema .* certificates of schema .* answers of schema' "$work/version"

step "manual, completions, Debian package"
checks/release/files.sh target/release/fspid target/around
cargo install cargo-deb --version 3.8.0 --locked --debug --no-default-features --quiet --root "$root/target/tools"
PATH="$root/target/tools/bin:$PATH" cargo deb --no-build --no-strip --package fspid-cli --output "$out/"
. checks/export/tools.sh
needs lintian lintian
package="$(ls "$out"/fspid_"$version"-1_*.deb)"
lintian --fail-on error,warning --allow-root "$package"
checks/release/installed.sh "$package" "$version"

step "archive and digests"
tar --create --file - --sort=name --owner=0 --group=0 --numeric-owner --mtime="@$(git log -1 --format=%ct)" \
    --transform="s|^\./|fspid-$version/|;s|^target/||" README.md CHANGELOG.md LICENSE-MIT LICENSE-APACHE target/around target/release/fspid |
    gzip --best --no-name >"$out/fspid-$version-$(rustc -vV | sed -n 's/^host: //p').tar.gz"
(cd "$out" && sha256sum -- *.crate *.deb *.tar.gz >SHA256SUMS)
cat "$out/SHA256SUMS"

cd "$root"
if [[ -n "$dry" ]]; then
    [[ -z "$(git status --porcelain)" ]]
    echo "a dry run: nothing was committed, tagged or published; what would be handed out is in ${out#"$root/"}"
else
    git fetch --quiet "$clone" "refs/tags/v$version:refs/tags/v$version"
    echo "the tag v$version is here, one commit above this one: git merge --ff-only v$version. What is handed out is in ${out#"$root/"}"
fi
