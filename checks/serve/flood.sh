#!/usr/bin/env bash
# Floods a server of the cockpit for so many seconds (600 if nothing is said), while a client with the token asks every half
# second. Ends with 1 where the server is gone, that client was not answered, memory has grown by more than 64 MiB, or a
# descriptor is left. Needs a release build of fspid, Linux and Python, whose standard library is enough. FSPID names another
# program.
set -euo pipefail
cd "$(dirname "$0")/../.."
exec python3 checks/serve/flood.py "${FSPID:-target/release/fspid}" "${1:-600}"
