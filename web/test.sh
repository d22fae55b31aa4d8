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
# One after the other: each has a browser of its own. On a machine that does much else a browser may answer later than a test waits:
# a file that fails is asked once more, and has to pass as a whole then.
again=()
for name in same-bits views served reports spoken pictures; do
    node --test "tests/$name.test.mjs" || again+=("tests/$name.test.mjs")
done
if [[ ${#again[@]} -gt 0 ]]; then
    echo "asked once more: ${again[*]}"
    node --test --test-concurrency=1 "${again[@]}"
fi
