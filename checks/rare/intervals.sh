#!/usr/bin/env bash
# How often the intervals of `fspid campaign rare` hold probabilities that are known: 95 of 100 are promised.
# usage: checks/rare/intervals.sh [SEEDS]      100 seeds take some minutes on one core
set -euo pipefail
cd "$(dirname "$0")/../.."
exec cargo run --quiet --release -p fspid-campaign --example rare_coverage -- "${1:-100}"
