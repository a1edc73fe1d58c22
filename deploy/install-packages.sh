#!/usr/bin/env bash
# Installs the packages of a list beside this script that are missing. Says what it
# is going to install before it does. Works as root or through sudo; quick when
# everything is there; waits while another program holds apt's locks.
#
#   deploy/install-packages.sh                      apt-packages.txt, all of it
#   deploy/install-packages.sh --build              without what only tests take
#   deploy/install-packages.sh apt-packages-run.txt another list
set -euo pipefail

build_only=false
if [[ "${1:-}" == --build ]]; then
  build_only=true
  shift
fi
list="$(dirname "${BASH_SOURCE[0]}")/${1:-apt-packages.txt}"
readonly build_only list
readonly lock_wait_seconds=900

# The packages of the list that this machine wants, one a line.
wanted_packages() {
  local first second wanted=true
  while read -r first second _; do
    case "${first}" in
      "" | "#"*) ;;
      "[tests]") if ${build_only}; then return; fi ;;
      "[unless-command")
        if command -v "${second%]}" >/dev/null; then wanted=false; else wanted=true; fi
        ;;
      *) if ${wanted}; then echo "${first}"; fi ;;
    esac
  done <"${list}"
}

# Those of the packages given that are not installed.
missing_packages() {
  local installed
  # dpkg-query exits 1 when it does not know one of them: that one is missing.
  installed="$(dpkg-query --show --showformat='${Package} ${db:Status-Status}\n' "$@" \
    2>/dev/null | awk '$2 == "installed" { print $1 }' || true)"
  comm -23 <(printf '%s\n' "$@" | sort -u) <(sort -u <<<"${installed}")
}

# apt-get with root's rights, tried again while another program holds a lock
# (DPkg::Lock::Timeout alone does not cover the lock of the package lists).
apt_get() {
  local log code waited=0
  log="$(mktemp)"
  while true; do
    code=0
    "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive LC_ALL=C \
      apt-get -o DPkg::Lock::Timeout="${lock_wait_seconds}" -o Dpkg::Use-Pty=0 "$@" 2>&1 | tee "${log}" || code=$?
    if ((code == 0)) || ! grep -q "Could not get lock" "${log}" || ((waited >= lock_wait_seconds)); then
      rm -f "${log}"
      return "${code}"
    fi
    echo "Another program is installing packages; waiting for it."
    sleep 5
    waited=$((waited + 5))
  done
}

mapfile -t wanted < <(wanted_packages)
mapfile -t missing < <(missing_packages "${wanted[@]}")
if ((${#missing[@]} == 0)); then
  echo "All ${#wanted[@]} packages of deploy/${list##*/} are installed."
  exit 0
fi

echo "Going to install with apt-get, without recommended packages:"
printf '%s\n' "${missing[*]}" | fold --spaces --width=76 | sed 's/^/  /'

as_root=()
if ((EUID != 0)); then
  if ! command -v sudo >/dev/null; then
    echo "Run this as root, or install sudo." >&2
    exit 1
  fi
  as_root=(sudo)
fi

# Package lists are fetched only when they do not know a package, or when what
# they name cannot be fetched any more.
if ! apt-get install --simulate --no-install-recommends "${missing[@]}" >/dev/null 2>&1; then
  apt_get update --quiet
fi
install=(install --yes --quiet --no-install-recommends "${missing[@]}")
apt_get "${install[@]}" || { apt_get update --quiet && apt_get "${install[@]}"; }
