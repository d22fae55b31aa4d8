#!/usr/bin/env bash
# Runs a test program for check.sh, so that what it counts is not mixed with what others count: same names, other code.
LLVM_PROFILE_FILE="$FSPID_COVERAGE_RAW/$(basename "$1")/%p-%4m.profraw" exec "$@"
