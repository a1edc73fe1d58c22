#!/usr/bin/env bash
# Fails when a tracked C++ file is not as clang-format-14 writes it.
# To mend: git ls-files '*.h' '*.cc' | xargs clang-format-14 -i
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

mapfile -t files < <(git -c safe.directory='*' ls-files -- '*.h' '*.cc')
((${#files[@]} > 0)) || { echo "git lists no C++ files"; exit 1; }
clang-format-14 --dry-run -Werror "${files[@]}"
echo "${#files[@]} C++ files are well formatted."
