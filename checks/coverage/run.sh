#!/usr/bin/env bash
# Runs a test program for check.sh, so that what it counts is not mixed with what others count: same names, other code.
# What it starts counts beside it, by numbers of its own.
name="$(basename "$1")"
echo $$ >"$FSPID_COVERAGE_RAW/$name.pid"
LLVM_PROFILE_FILE="$FSPID_COVERAGE_RAW/$name/%p-%4m.profraw" exec "$@"
