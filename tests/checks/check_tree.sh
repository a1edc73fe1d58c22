#!/usr/bin/env bash
# Looks over the tracked files: no generated code or downloads, no paths of one
# machine, no registry hosts, no marks of unfinished work, no long files; shell
# scripts are sound.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

readonly max_lines=500
failed=0

# report WHAT: fails the check when standard input is not empty.
report() {
  local lines
  lines="$(cat)"
  if [[ -n "${lines}" ]]; then
    printf '%s:\n%s\n\n' "$1" "${lines}"
    failed=1
  fi
}

tracked() { git -c safe.directory='*' ls-files -- "$@"; }
# Lines of tracked text files that match an extended regular expression.
lines_with() { git -c safe.directory='*' grep -nIE "$1" -- . ':!tests/checks/check_tree.sh' || true; }

[[ -n "$(tracked)" ]] || { echo "git lists no files"; exit 1; }

tracked '*.pb.h' '*.pb.cc' '*_pb2.py' 'build/*' 'out/*' '*node_modules/*' '*.aux.xml' \
  | report "Generated files and downloads that git tracks"
lines_with '(^|[^A-Za-z0-9_.}/-])/(work|root|tmp|home)/' | report "Paths of one machine"
lines_with 'npmjs\.(org|com)|deb\.debian\.org|security\.debian\.org' | report "Hosts of registries"
lines_with '\b(TODO|FIXME|XXX)\b' | report "Marks of unfinished work"
tracked '*.h' '*.cc' '*.inc' '*.proto' '*.py' '*.sh' '*.cmake' '*CMakeLists.txt' \
  | xargs wc -l | awk -v max="${max_lines}" '$2 != "total" && $1 > max { print $2 ": " $1 " lines" }' \
  | report "Files of more than ${max_lines} lines"

mapfile -t scripts < <(tracked '*.sh' '.ci/run')
for script in "${scripts[@]}"; do
  bash -n "${script}" || failed=1
  [[ -x "${script}" ]] || { echo "${script} is not executable"; failed=1; }
done
shellcheck "${scripts[@]}" || failed=1

((failed == 0)) && echo "$(tracked | wc -l) tracked files and ${#scripts[@]} scripts are in order."
exit "${failed}"
