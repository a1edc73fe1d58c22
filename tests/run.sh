#!/usr/bin/env bash
# Runs every test: installs what is missing, builds the release and the asan
# preset, then runs ctest in both. CI runs this script (.ci/run).
#
#   tests/run.sh           everything
#   tests/run.sh --fast    the release preset only
#
# The asan tree leaves out the checks of the tree (label check), which do not
# depend on a build. Fails when anything does; the last lines are ctest's.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

presets=(asan release)
case "${1:-}" in
  "") ;;
  --fast) presets=(release) ;;
  *)
    sed -n '2,/^set /{/^#/s/^# \{0,1\}//p}' "${BASH_SOURCE[0]}"
    [[ "$1" == --help ]] && exit 0
    exit 2
    ;;
esac

# Says what comes next and how long it has taken so far.
step() { printf '\n==> %s (%d:%02d)\n' "$1" $((SECONDS / 60)) $((SECONDS % 60)); }

step "Packages"
deploy/install-packages.sh

for preset in "${presets[@]}"; do
  step "Building preset ${preset}"
  cmake --preset "${preset}" --log-level=WARNING
  cmake --build --preset "${preset}"
done

failed=()
for preset in "${presets[@]}"; do
  step "Testing preset ${preset}"
  exclude=()
  [[ "${preset}" == release ]] || exclude=(--label-exclude check)
  ctest --preset "${preset}" --no-tests=error --parallel "$(nproc)" "${exclude[@]}" ||
    failed+=("$(sed "s/^/${preset}: /" "build/${preset}/Testing/Temporary/LastTestsFailed.log" || echo "${preset}: ctest")")
done
if ((${#failed[@]})); then
  printf '\nFailed:\n' >&2
  printf '%s\n' "${failed[@]}" >&2
  exit 1
fi
