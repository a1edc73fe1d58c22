# shellcheck shell=bash
# What the container tests share; read by them with `source`. Nothing is kept outside of
# BUILD_DIR/containers: neither images nor settings of podman and buildah.

skip() {
  echo "SKIPPED, NOTHING WAS CHECKED: $1" >&2
  exit 77
}

fail() {
  echo "FAILED: $1" >&2
  exit 1
}

# How images are laid out in that folder: overlaid, or where the kernel cannot do that
# here, such as inside a container, copied layer by layer, which takes ten times the space.
storage_driver() {
  local try="$1/overlay" driver=vfs
  mkdir -p "${try}"/{lower,upper,work,all}
  if mount -t overlay overlay -o "lowerdir=${try}/lower,upperdir=${try}/upper,workdir=${try}/work" "${try}/all" 2>/dev/null; then
    umount "${try}/all"
    driver=overlay
  fi
  rm -rf "${try}"
  echo "${driver}"
}

# Settings for root without a daemon, which raise no limit that a sandbox would not let it
# raise. containers_setup BUILD_DIR.
containers_setup() {
  [[ "${TERRANE_HEAVY:-0}" == 1 ]] || skip "an image takes minutes and gigabytes; TERRANE_HEAVY=1 is not set."
  ((EUID == 0)) || skip "only root can make a base image and run it here."
  "${root}/deploy/install-packages.sh" apt-packages-heavy.txt
  mkdir -p "$1/containers"
  kept="$(cd "$1/containers" && pwd)"
  cat >"${kept}/storage.conf" <<CONF
[storage]
driver = "$(storage_driver "${kept}")"
graphroot = "${kept}/storage"
runroot = "${kept}/run"
CONF
  cat >"${kept}/containers.conf" <<CONF
[containers]
default_ulimits = ["nofile=4096:4096", "nproc=1024:1024"]
[engine]
runtime = "runc"
cgroup_manager = "cgroupfs"
events_logger = "file"
CONF
  export CONTAINERS_STORAGE_CONF="${kept}/storage.conf" CONTAINERS_CONF="${kept}/containers.conf"
}

# Debian 12 as debootstrap makes it, with this machine's sources of packages, as the image
# localhost/terrane-base. Made once.
base_image() {
  podman image exists localhost/terrane-base && return
  local mirror folder="${kept}/base"
  # shellcheck disable=SC2016 # apt's own word
  mirror="$(apt-get indextargets --format '$(REPO_URI)' 'Created-By: Packages' 'Codename: bookworm' | head -1)"
  [[ -n "${mirror}" ]] || skip "apt-get knows no source of Debian 12."
  rm -rf "${folder}"
  debootstrap --variant=minbase bookworm "${folder}" "${mirror}" >"${kept}/debootstrap.log" 2>&1 ||
    skip "debootstrap cannot make a base: $(tail -1 "${kept}/debootstrap.log")"
  if [[ -e /etc/apt/sources.list.d/debian.sources ]]; then
    rm -f "${folder}/etc/apt/sources.list"
    cp /etc/apt/sources.list.d/debian.sources "${folder}/etc/apt/sources.list.d/"
  else
    cp /etc/apt/sources.list "${folder}/etc/apt/"
  fi
  rm -rf "${folder}"/var/cache/apt/archives/*.deb "${folder}"/var/lib/apt/lists/*
  tar --directory "${folder}" --create . | podman import - localhost/terrane-base >/dev/null
  rm -rf "${folder}"
}

# Builds a target of deploy/container/Dockerfile, with this machine's ccache. Layers are
# kept: without a change it takes seconds. build_image TARGET IMAGE.
build_image() {
  local volume=()
  if command -v ccache >/dev/null; then volume=(--volume "$(ccache --get-config cache_dir):/ccache"); fi
  base_image
  buildah bud --isolation chroot --layers --build-arg BASE=localhost/terrane-base "${volume[@]}" \
    --file "${root}/deploy/container/Dockerfile" --target "$1" --tag "$2" "${root}" >"${kept}/build-$1.log" 2>&1 || {
    tail -40 "${kept}/build-$1.log" >&2
    fail "the image was not built."
  }
  podman image inspect "$2" --format "$2 has {{.Size}} bytes, user {{.User}}"
}

# What runs a command in the network of a container; nothing for this machine's.
within=()

# Waits for a 200 from an address of the server's HTTP port.
wait_ready() {
  local waited
  for ((waited = 0; waited < 300; ++waited)); do
    if "${within[@]}" curl --silent --fail --max-time 2 --output /dev/null "$1"; then return; fi
    sleep 0.1
  done
  fail "$1 does not answer."
}

# What the process $1 may do that a replica must not, a line each; nothing for a confined one.
liberties() {
  local status="/proc/$1/status"
  grep -q '^Uid:\s*65532\s' "${status}" || echo "it is somebody"
  grep -q '^CapEff:\s*0*$' "${status}" || echo "it has capabilities"
  grep -q '^CapBnd:\s*0*$' "${status}" || echo "it may get capabilities"
  grep -q '^NoNewPrivs:\s*1$' "${status}" || echo "it may get privileges"
  # Of a line: which directory is mounted where, how.
  awk '$5 == "/" { how = $6 } END { exit how !~ /^ro(,|$)/ }' "/proc/$1/mountinfo" || echo "its root can be written"
}

# The process of a container.
process_of() { podman inspect "$1" --format '{{.State.Pid}}'; }

# A container is confined, as the process inside sees it; one that nothing was said of is not.
confined() {
  local found free
  found="$(liberties "$(process_of "$1")")"
  [[ -z "${found}" ]] || fail "the server is not confined: ${found}."
  free="$(podman run --detach --user 0:0 --network none "${server_image}")"
  found="$(liberties "$(process_of "${free}")")"
  podman rm --force --time 0 "${free}" >/dev/null
  (($(wc -l <<<"${found}") == 5)) || fail "of a container that is not confined only this is seen: ${found}."
}

# The server whose HTTP port is at $1 has taken the control group's limit, $2 MiB, for its own.
memory_limited() {
  local limit
  limit="$("${within[@]}" curl --silent "$1/metrics" | awk '$1 == "terrane_memory_limit_bytes" { printf "%.0f", $2 }')"
  ((${limit:-0} == $2 << 20)) || fail "the server takes its memory limit for ${limit:-no} bytes."
}

# Heights from the server at $1 are those that the terrane $2 makes here, byte for byte.
same_heights() {
  local folder world=(terrain --seed 7 --level 6 --window "0,0,700,500")
  folder="$(mktemp -d)"
  "${within[@]}" "$2" "${world[@]}" --server "$1" --out "${folder}/served.f32" >/dev/null
  "$2" "${world[@]}" --local --out "${folder}/local.f32" >/dev/null
  cmp "${folder}/served.f32" "${folder}/local.f32"
  rm -r "${folder}"
}

here="$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)"
root="$(cd "${here}/../.." && pwd)"
export server_image="localhost/terrane:0.1.0"
export tools_image="localhost/terrane-tools:0.1.0"
kept=
