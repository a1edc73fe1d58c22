#!/usr/bin/env bash
# Takes one program out of a Debian package, without installing the package, whose service
# would start and listen: debian_program.sh BUILD_DIR PACKAGE PATH prints where it is.
#
# Kept under BUILD_DIR. Exit code 77 (skipped) when apt-get is not there or cannot fetch.
set -euo pipefail

folder="$1/debian/$2"
mkdir -p "${folder}"
folder="$(cd "${folder}" && pwd)"
program="${folder}/root/$3"

skip() {
  echo "SKIPPED, NOTHING WAS CHECKED: $1" >&2
  exit 77
}

# Two checks may come at the same time.
exec 9>"${folder}/lock"
flock 9
if [[ ! -x "${program}" ]]; then
  command -v apt-get >/dev/null || skip "this machine has no apt-get to fetch the package $2 with."
  (cd "${folder}" && rm -f ./*.deb && apt-get download --quiet "$2") >"${folder}/log" 2>&1 ||
    skip "apt-get cannot fetch the package $2: $(tail -1 "${folder}/log")"
  dpkg-deb --extract "${folder}/$2"_*.deb "${folder}/root"
fi
echo "${program}"
