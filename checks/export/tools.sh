# Sourced by the checks beside it: tools that a check needs, from Debian's packages.

# Program and packages: installs them where the program is missing; where that cannot be, says so and answers 1.
needs() {
    local program="$1"
    shift
    command -v "$program" > /dev/null && return
    if ! { apt-get update -qq && apt-get install -y -qq --no-install-recommends "$@"; } > /dev/null 2>&1; then
        echo "NOT CHECKED: $program is missing, and cannot be installed here"
        return 1
    fi
}

# The program that exports: the one that FSPID names, else a release build.
program() {
    [[ -z "${FSPID:-}" ]] || return 0
    cargo build --release --locked --quiet -p fspid-cli
    FSPID="$PWD/target/release/fspid"
}
