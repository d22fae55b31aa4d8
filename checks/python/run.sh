#!/usr/bin/env bash
# The package for Python: built as a wheel, installed where nothing else is, typed, tested there; its notebooks run; campaigns on
# Ray, a node of which is killed, and on Dask.
#   --wheel   as it is handed out, small and linked as a whole, which takes ten minutes
#   --quick   without clusters and notebooks
set -euo pipefail
cd "$(dirname "$0")/../.."

work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT
# The module is built from the same crates as the program, where that is built with it, and by its profile.
profile="${FSPID_PROFILE:-release}" features=(--features as-the-program)
if [ "${1:-}" = --wheel ]; then profile=wheel features=(); fi

pip=(python -m pip --disable-pip-version-check --quiet install)
python3 -m venv "$work/build"
PATH="$work/build/bin:$PATH" "${pip[@]}" "maturin>=1.16,<2"
PATH="$work/build/bin:$PATH" maturin build --quiet --profile "$profile" "${features[@]}" --manifest-path crates/fspid-py/Cargo.toml --out "$work/wheels"
wheel=("$work"/wheels/*.whl)
echo "wheel, profile $profile: $(($(stat -c %s "${wheel[0]}") / 1000)) kB"

python3 -m venv "$work/empty"
export PATH="$work/empty/bin:$PATH"
"${pip[@]}" "${wheel[0]}"
cd "$work"
# Without NumPy, in a folder where no source lies.
python - <<'PYTHON'
import subprocess, sys, time
seconds = []
for _ in range(9):
    begun = time.perf_counter()
    subprocess.run([sys.executable, "-c", "import fspid"], check=True)
    whole = time.perf_counter() - begun
    begun = time.perf_counter()
    subprocess.run([sys.executable, "-c", "pass"], check=True)
    seconds.append(whole - (time.perf_counter() - begun))
print(f"import fspid: {1000 * sorted(seconds)[4]:.0f} ms")
import fspid
assert fspid.Scenario.preset("pitch-hold").simulate().good
assert "numpy" not in sys.modules
PYTHON
cd - > /dev/null

left_out=nothing
if [ "${1:-}" = --quick ]; then left_out='ray|distributed|ipykernel|nbclient|nbformat'; fi
grep -vE "^($left_out)[>=]" checks/python/requirements.txt >"$work/requirements.txt"
"${pip[@]}" -r "$work/requirements.txt"
mypy --strict -p fspid
# What is typed of the native module is what it has.
python -m mypy.stubtest fspid._core
cd crates/fspid-py
export FSPID_PROGRAM="${FSPID_PROGRAM:-$PWD/../../target/release/fspid}"
python -m pytest -q
[ "${1:-}" = --quick ] || python ../../checks/python/notebooks.py
python -m pytest -q --doctest-modules --pyargs fspid.scenario fspid.fuzzy fspid.controllers fspid.lti fspid.widget fspid.gym
