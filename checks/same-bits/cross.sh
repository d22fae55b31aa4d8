# Sourced by checks that build the program for other processors, from the folder of the repository.

# Debian's compiler with the sources of its library, of one version. `rustc` of the toolchain has neither targets nor sources.
debian_compiler() {
    [[ -x /usr/bin/rustc && -d /usr/lib/rustlib/src/rust/library ]] || needs rustc-web rustc-web rust-web-src || true
    local version='${db:Status-Status} ${Version}'
    local compiler sources
    compiler="$(dpkg-query --show --showformat="$version" rustc-web)"
    sources="$(dpkg-query --show --showformat="$version" rust-web-src)"
    if [[ "$compiler" != "$sources" ]]; then
        echo "compiler $compiler and sources $sources are not of one version" >&2
        return 1
    fi
}

# Target of Rust and the C compiler that links for it: the program, without its server, in target/same-bits/TARGET/release.
built_for() {
    local target="$1" linker="$2" variable
    debian_compiler
    variable="CARGO_TARGET_$(tr a-z- A-Z_ <<<"$target")_LINKER"
    # RUSTC_BOOTSTRAP lets a stable compiler build the library from its sources.
    env RUSTC=/usr/bin/rustc RUSTC_BOOTSTRAP=1 CARGO_INCREMENTAL=0 CARGO_TARGET_DIR="$PWD/target/same-bits" "$variable=$linker" \
        cargo build --release --locked --quiet -Zbuild-std=std,panic_unwind --target "$target" -p fspid-cli --no-default-features
}
