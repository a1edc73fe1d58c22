#!/usr/bin/env bash
# Looks over the tracked files: check_tree.sh ROOT. No generated code or
# downloads, no paths of one machine, no registry hosts, no marks of unfinished
# work, no long files; shell scripts are sound.
set -euo pipefail
cd "$1"

readonly max_lines=500
failed=0

# Fails the check when there are lines: report WHAT LINES.
report() {
  if [[ -n "$2" ]]; then
    printf '%s:\n%s\n\n' "$1" "$2"
    failed=1
  fi
}

tracked() { git -c safe.directory='*' ls-files -- "$@"; }
# Lines of tracked text files that match an extended regular expression. This
# check and its test hold what they look for.
lines_with() {
  git -c safe.directory='*' grep -nIE "$1" -- . ':!tests/checks/check_tree*' || (($? == 1))
}
long_files() {
  tracked '*.h' '*.cc' '*.inc' '*.proto' '*.py' '*.sh' '*.cmake' '*CMakeLists.txt' \
    | xargs --no-run-if-empty wc -l \
    | awk -v max="${max_lines}" '$2 != "total" && $1 > max { print $2 ": " $1 " lines" }'
}

files="$(tracked | wc -l)"
((files > 0)) || report "Wrong" "git lists no files in $1"
report "Generated files and downloads that git tracks" \
  "$(tracked '*.pb.h' '*.pb.cc' '*_pb2.py' 'build/*' 'out/*' '*node_modules/*' '*.aux.xml')"
report "Paths of one machine" "$(lines_with '(^|[^A-Za-z0-9_.}/-])/(work|root|tmp|home)/')"
report "Hosts of registries" "$(lines_with 'npmjs\.(org|com)|(deb|security)\.debian\.org')"
report "Marks of unfinished work" "$(lines_with '\b(TODO|FIXME|XXX)\b')"
report "Files of more than ${max_lines} lines" "$(long_files)"

mapfile -t scripts < <(tracked '*.sh' '.ci/run')
for script in "${scripts[@]}"; do
  bash -n "${script}" || report "Does not parse" "${script}"
  [[ -x "${script}" ]] || report "Not executable" "${script}"
  shellcheck "${script}" || report "Not sound" "${script}"
done

((failed)) || echo "${files} tracked files and ${#scripts[@]} scripts are in order."
exit "${failed}"
