#!/usr/bin/env bash
# Makes docs/answers anew: the shapes of what the program answers with `--format json`, learned from every answer that its
# tests ask for and from so many scenarios drawn from the schema (300 if nothing is said). Tests hold every answer against
# what was learned; a change of an answer is seen in these files.
set -euo pipefail
cd "$(dirname "$0")/../.."
answers="$PWD/target/answers"
rm -rf "$answers"
# A test that fails shall not keep what the others have told.
FSPID_ANSWERS="$answers" FSPID_WHOLE_DRAWS="${1:-300}" cargo test -p fspid-cli --test all --no-fail-fast || true
checks/answers/also.sh "$answers"
python3 checks/answers/learn.py "$answers" docs/answers
