#!/usr/bin/env bash
# What the cockpit's page costs after `web/build.sh`: paint, frames, memory over 10 000 redraws (REDRAWS=N for others). A long
# check for a quiet machine; its last result stands in docs/measurements.md.
set -euo pipefail
cd "$(dirname "$0")"
node tests/measure.mjs
