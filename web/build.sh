#!/usr/bin/env bash
# Builds the cockpit: its mathematics for WebAssembly, and its page in two forms,
#   web/dist/site/      index.html, app.js, app.css, worker.js, fspid.wasm: for a server, nothing inline
#   web/dist/page.html  one file that works from disk
# Needs Debian 12 or newer, the Rust toolchain for its cargo and its linker, Node 20 with npm, and root or sudo where
# packages are missing. The toolchain's own target is not asked for: Debian has a compiler with its library's sources.
#   --wasm    the mathematics alone
#   --quick   for tests of the page: the same bits and views, built in two thirds of the time, and four times as large
set -euo pipefail
cd "$(dirname "$0")"
target=wasm32-unknown-unknown
asked=" $* "
is_asked() { [[ "$asked" == *" $1 "* ]]; }
profile=web
if is_asked --quick; then profile=web-quick; fi

packages=(rustc-web rust-web-src binaryen zopfli)
version() { dpkg-query --show --showformat='${db:Status-Status} ${Version}' "$1" 2>/dev/null || true; }
for package in "${packages[@]}"; do
    [[ "$(version "$package")" == "installed "* ]] && continue
    root=""
    [[ "$(id -u)" == 0 ]] || root=sudo
    $root apt-get update
    $root apt-get install --yes --no-install-recommends "${packages[@]}"
    break
done
if [[ "$(version rustc-web)" != "$(version rust-web-src)" ]]; then
    echo "compiler $(version rustc-web) and sources $(version rust-web-src) are not of one version" >&2
    exit 1
fi

# The linker of the toolchain serves that compiler too.
sysroot="$(rustc --print sysroot)"
linker="$(find "$sysroot" -name rust-lld -type f | head -n 1)"
# RUSTC_BOOTSTRAP lets a stable compiler build the library from its sources. A panic ends the mathematics at once and without
# words, which are a third of it otherwise; the page starts it anew.
(
    cd ..
    RUSTFLAGS="-Zunstable-options -Cpanic=immediate-abort -Zlocation-detail=none" \
        RUSTC=/usr/bin/rustc RUSTC_BOOTSTRAP=1 CARGO_TARGET_DIR="$PWD/target/web" CARGO_INCREMENTAL=0 \
        CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_LINKER="$linker" \
        cargo build --locked --profile "$profile" -Zbuild-std=std,panic_abort -Zbuild-std-features=optimize_for_size --target "$target" --package fspid-web
)
mkdir -p dist
built="../target/web/$target/$profile/fspid_web.wasm"
if is_asked --quick; then
    cp "$built" dist/fspid.wasm
else
    wasm-opt -Oz --enable-bulk-memory --enable-nontrapping-float-to-int --enable-sign-ext --enable-mutable-globals \
        "$built" --output dist/fspid.wasm
fi
echo "web/dist/fspid.wasm: $(stat --format=%s dist/fspid.wasm) bytes, $(gzip --best --stdout dist/fspid.wasm | wc --bytes) gzipped"
if is_asked --wasm; then exit 0; fi

[[ -d node_modules && node_modules/.package-lock.json -nt package-lock.json ]] || npm ci --no-audit --no-fund
if is_asked --quick; then export FSPID_PACKS_WITH=gzip; fi
npm run --silent build
gzip --best --keep --force --stdout dist/site/app.js dist/site/app.css dist/site/worker.js dist/site/fspid.wasm | wc --bytes |
    xargs -I{} echo "web/dist/site: {} bytes of script, style and mathematics, gzipped"
echo "web/dist/page.html: $(stat --format=%s dist/page.html) bytes"
# A program that was built while there was no page does not know where to look for one: it is asked to look again.
touch ../crates/fspid-serve/build.rs
