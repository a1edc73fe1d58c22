#!/usr/bin/env bash
# Tests of check_tree.sh: a tree in order passes, each kind of disorder fails.
set -euo pipefail
check="$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)/check_tree.sh"
tree="$(mktemp -d)"
trap 'rm -rf "${tree}"' EXIT
git init --quiet "${tree}"

# tree_of FILE TEXT: the tree holds a good script and this file.
tree_of() {
  git -C "${tree}" rm -r --quiet --cached --force --ignore-unmatch .
  printf '#!/usr/bin/env bash\necho good\n' >"${tree}/good.sh"
  chmod +x "${tree}/good.sh"
  mkdir -p "$(dirname "${tree}/$1")"
  printf '%b' "$2" >"${tree}/$1"
  git -C "${tree}" add --force good.sh "$1"
}

expect_failure() {
  tree_of "$1" "$2"
  if "${check}" "${tree}" >"${tree}/log" 2>&1; then
    echo "check_tree.sh let $1 pass"
    exit 1
  fi
}

tree_of "core/a.h" "// built into build/release, /usr/bin\n"
"${check}" "${tree}"

expect_failure "proto/a.pb.h" "x\n"
expect_failure "build/a.txt" "x\n"
expect_failure "docs/a.md" "see /work/main\n"
expect_failure "a.cc" "open(\"/tmp/x\")\n"
expect_failure "a.json" "https://registry.npmjs.org/x\n"
expect_failure "a.cc" "// TODO: all\n"
expect_failure "long.cc" "$(printf 'x\\n%.0s' {1..501})"
expect_failure "not_executable.sh" "#!/bin/bash\n"
touch "${tree}/unsound.sh"
chmod +x "${tree}/unsound.sh"
expect_failure "unsound.sh" "if\n"
expect_failure "unsound.sh" "#!/bin/bash\nrm \$1\n"
echo "check_tree.sh fails where it must."
