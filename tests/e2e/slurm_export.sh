#!/usr/bin/env bash
# An export as a Slurm array on a single node: slurm_export.sh TERRANE.
#
# Configures Slurm and MUNGE in a temporary folder, under ports of their own, and
# ends them again; nothing of the machine's own configuration is read or changed.
# With TERRANE_HEAVY=1 the packages are installed where they are missing. Exit
# code 77 (skipped) where that cannot be done.
set -euo pipefail

terrane="$(realpath "$1")"
here="$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)"
# shellcheck source=tests/e2e/shards.sh
source "${here}/shards.sh"
slurm=(munged slurmctld slurmd sinfo sbatch)

[[ "$(id -u)" == 0 ]] || skip "only root can run slurmd."
if [[ -n "$(missing_commands "${slurm[@]}")" ]]; then
  [[ "${TERRANE_HEAVY:-0}" == 1 ]] || skip "there is no Slurm on this machine, and TERRANE_HEAVY=1 is not set."
  "${here}/../../deploy/install-packages.sh" apt-packages-heavy.txt
fi

folder="$(mktemp -d)"
pids=()
finish() {
  for pid in "${pids[@]}"; do kill "${pid}" 2>/dev/null || true; done
  for pid in "${pids[@]}"; do wait "${pid}" 2>/dev/null || true; done
  rm -rf "${folder}"
}
trap finish EXIT
# What a daemon said, for a failure.
fail() {
  echo "$1" >&2
  tail -n 20 "${folder}"/*.log >&2
  exit 1
}
free_port() {
  /usr/bin/python3 -c 'import socket; s = socket.socket(); s.bind(("127.0.0.1", 0)); print(s.getsockname()[1])'
}
# Waits for up to 30 seconds for a command to succeed.
wait_for() {
  for _ in {1..150}; do
    if "$@" >/dev/null 2>&1; then return 0; fi
    sleep 0.2
  done
  return 1
}

node="$(hostname -s)"
chmod 755 "${folder}"
mkdir "${folder}/state" "${folder}/spool" "${folder}/munge"
dd if=/dev/urandom of="${folder}/munge/key" bs=1024 count=1 status=none
chmod 700 "${folder}/munge"
chmod 400 "${folder}/munge/key"
cat >"${folder}/slurm.conf" <<CONF
ClusterName=terrane
SlurmctldHost=${node}(127.0.0.1)
SlurmctldPort=$(free_port)
SlurmdPort=$(free_port)
AuthType=auth/munge
AuthInfo=socket=${folder}/munge.socket
CredType=cred/munge
SlurmUser=root
SlurmdUser=root
StateSaveLocation=${folder}/state
SlurmdSpoolDir=${folder}/spool
SlurmctldPidFile=${folder}/slurmctld.pid
SlurmdPidFile=${folder}/slurmd.pid
ProctrackType=proctrack/pgid
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
ReturnToService=2
MpiDefault=none
NodeName=${node} NodeAddr=127.0.0.1 CPUs=2 State=UNKNOWN
PartitionName=terrane Nodes=${node} Default=YES MaxTime=10 State=UP OverSubscribe=YES
CONF
export SLURM_CONF="${folder}/slurm.conf"

munged --foreground --force --key-file="${folder}/munge/key" --socket="${folder}/munge.socket" \
  --pid-file="${folder}/munge/pid" --seed-file="${folder}/munge/seed" 2>"${folder}/munged.log" &
pids+=($!)
wait_for test -S "${folder}/munge.socket" || fail "munged does not start"
slurmctld -D -f "${SLURM_CONF}" >"${folder}/slurmctld.log" 2>&1 &
pids+=($!)
slurmd -D -f "${SLURM_CONF}" -N "${node}" >"${folder}/slurmd.log" 2>&1 &
pids+=($!)
node_is_idle() { [[ "$(sinfo --noheader --format=%t)" == idle ]]; }
wait_for node_is_idle || fail "the node does not come up"

sbatch --wait --array=0-3 --output="${folder}/job-%a.log" --wrap \
  "'${terrane}' export ${choice[*]} --out '${folder}/parts/tile.tif' --shards 4 --shard \${SLURM_ARRAY_TASK_ID}" ||
  fail "the array fails"
check_parts "${terrane}" "${folder}"
echo "A Slurm array of 4 shards wrote the 20 tiles that one process writes."
