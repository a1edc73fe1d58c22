#!/usr/bin/env bash
# Opens an SVG that terrane writes in headless Chromium and looks at the
# screenshot: check_svg_browser.sh TERRANE.
#
# With TERRANE_HEAVY=1 Chromium is installed where it is missing (Debian's
# package, as root). Without it, exit code 77 (skipped).
set -euo pipefail

here="$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)"
skip() {
  echo "SKIPPED, NOTHING WAS CHECKED: $1" >&2
  exit 77
}

if ! command -v chromium >/dev/null; then
  [[ "${TERRANE_HEAVY:-0}" == 1 ]] || skip "there is no Chromium on this machine, and TERRANE_HEAVY=1 is not set."
  [[ "$(id -u)" == 0 ]] || skip "only root can install Chromium."
  apt-get install --yes --no-install-recommends chromium >/dev/null
fi

folder="$(mktemp -d)"
trap 'rm -rf "${folder}"' EXIT
"$1" tree --local --preset tree/genetic --out "${folder}/tree.svg" >/dev/null
"$1" tree --local --preset tree/genetic --size 600 --out "${folder}/drawn.png" >/dev/null
chromium --headless --no-sandbox --disable-gpu --hide-scrollbars --user-data-dir="${folder}/profile" \
  --window-size=600,600 --screenshot="${folder}/shown.png" "file://${folder}/tree.svg" >"${folder}/log" 2>&1 || {
  cat "${folder}/log" >&2
  exit 1
}
/usr/bin/python3 "${here}/same_picture.py" "${folder}/shown.png" "${folder}/drawn.png"
