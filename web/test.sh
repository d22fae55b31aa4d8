#!/usr/bin/env bash
# Tests the cockpit after `web/build.sh`: types, the same bits as the program, and every view in a real browser, by mouse and by
# keys, alone and behind `fspid serve`. Needs what the build needs, Debian's Chromium (installed if missing) and a built program, target/debug/fspid or FSPID.
set -euo pipefail
cd "$(dirname "$0")"
if [[ ! -x "${CHROMIUM:=/usr/bin/chromium}" ]]; then
    root=""
    [[ "$(id -u)" == 0 ]] || root=sudo
    $root apt-get update
    $root apt-get install --yes --no-install-recommends chromium fonts-dejavu-core
fi
export CHROMIUM FSPID="${FSPID:-$PWD/../target/debug/fspid}"
npm run --silent check
# One after the other: each has a browser of its own.
node --test --test-concurrency=1 tests/same-bits.test.mjs tests/views.test.mjs tests/served.test.mjs \
    tests/reports.test.mjs tests/spoken.test.mjs tests/pictures.test.mjs
