#!/usr/bin/env bash
# Holds the systemd unit to systemd-analyze: check_systemd.sh TERRANE_SERVER. It verifies
# without a word on standard error, and what it is exposed to stays below a bound. Nothing
# is started. Exit code 77 (skipped) without systemd-analyze.
set -euo pipefail

here="$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)"
readonly unit="${here}/../../deploy/systemd/terrane-server.service"
readonly most_exposure=15  # tenths, of 100

if ! command -v systemd-analyze >/dev/null; then
  echo "SKIPPED, NOTHING WAS CHECKED: there is no systemd-analyze on this machine." >&2
  exit 77
fi
folder="$(mktemp -d)"
trap 'rm -rf "${folder}"' EXIT

# Verifies the unit of that file; what it says is on standard output.
verify() { { systemd-analyze verify "$1" || true; } 2>&1; }

# The program is where this build has it, not where the unit wants it.
sed "s#/usr/local/bin/terrane-server#$(realpath "$1")#" "${unit}" >"${folder}/terrane-server.service"
said="$(verify "${folder}/terrane-server.service")"
if [[ -n "${said}" ]]; then
  echo "systemd-analyze verify says: ${said}" >&2
  exit 1
fi

# The check itself sees a wrong line.
mkdir "${folder}/wrong"
sed "s/^ProtectHome=yes/ProtectHome=maybe/" "${folder}/terrane-server.service" >"${folder}/wrong/terrane-server.service"
if [[ -z "$(verify "${folder}/wrong/terrane-server.service")" ]]; then
  echo "systemd-analyze verify says nothing about a wrong line." >&2
  exit 1
fi

systemd-analyze security --offline=true --threshold="${most_exposure}" --no-pager "${folder}/terrane-server.service" |
  tail -1

# Every flag that the unit gives exists.
help="$("$1" --help)"
sed -n '/^ExecStart/,/[^\\]$/p' "${unit}" | grep -oE -- '--[a-z-]+' | while read -r flag; do
  grep -q -- "${flag}\b" <<<"${help}" || {
    echo "terrane-server has no ${flag}, which the unit gives." >&2
    exit 1
  }
done
