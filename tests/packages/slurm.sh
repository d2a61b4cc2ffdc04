#!/usr/bin/env bash
# A long export that Slurm splits. Debian's own slurmctld and slurmd, with one node in a container, run the array of
# docs/operate/exports.md over a take of the demo. Its tasks write byte for byte what one process writes. An array that is
# cancelled half-way and submitted again writes the same too.
#   tests/packages/slurm.sh
# After `tools/build.sh release vantage`. Everything goes to out/slurm/; Slurm's packages are unpacked there and not
# installed. Closes with a line `N passed, N failed`.
set -euo pipefail
cd "$(dirname "$0")/../.."
out=$PWD/out/slurm root=$PWD/out/slurm/root
vantage=$PWD/build/release/bin/vantage

# Namespaces of its own: when this ends so does all that it started, and its ports are nobody else's.
if [ "${1-}" != inside ]; then
  [ "$(id -u)" -eq 0 ] || exec sudo tests/packages/slurm.sh
  rm -rf "$out"
  mkdir -p "$root" "$out/packages"
  chown _apt "$out/packages" 2>/dev/null || true
  (
    cd "$out/packages"
    slurm=(slurmctld slurmd slurm-client slurm-wlm-basic-plugins munge)
    # The libraries that this computer lacks.
    mapfile -t libraries < <(apt-get install --simulate --no-install-recommends "${slurm[@]}" | awk '/^Inst/ {print $2}')
    apt-get download -q "${slurm[@]}" "${libraries[@]}"
    for package in *.deb; do dpkg-deb -x "$package" "$root"; done
  ) >"$out/packages.log" 2>&1 || { tail -n 20 "$out/packages.log" >&2; exit 1; }
  exec unshare --mount --pid --net --fork --mount-proc --kill-child tests/packages/slurm.sh inside
fi

checks_log=$out/check.log
. tests/support/checks.sh
wait_until() { # seconds, command...
  local end=$((SECONDS + $1))
  shift
  until "$@" >/dev/null 2>&1; do
    [ $SECONDS -lt $end ] || return 1
    sleep 0.2
  done
}

# With an address that is no loopback: Slurm looks up no name on a computer without one.
ip link set lo up
ip address add 192.0.2.1/24 dev lo

check "the demo's rigs keep takes" "$vantage" demo --headless --seconds 4 --folder "$out/demo" --keep "$out/rigs"
check "they are joined to one" "$vantage" take join "$out"/rigs/*.mkv -o "$out/take.mkv"
seconds=$("$vantage" take info "$out/take.mkv" --json | jq '.duration_s | ceil')

libraries=$root/usr/lib/$(dpkg-architecture -q DEB_HOST_MULTIARCH)
export SLURM_CONF=$out/slurm.conf PATH=$root/usr/bin:$root/usr/sbin:$PATH
export LD_LIBRARY_PATH=$libraries:$libraries/slurm-wlm
mkdir -p "$out"/{state,spool,munge}
(umask 077 && head -c 128 /dev/urandom >"$out/munge/key")
cat >"$SLURM_CONF" <<END
ClusterName=vantage
SlurmctldHost=$(hostname -s)(192.0.2.1)
SlurmUser=$(id -un)
SlurmdUser=$(id -un)
AuthType=auth/munge
AuthInfo=socket=$out/munge/socket
PluginDir=$libraries/slurm-wlm
StateSaveLocation=$out/state
SlurmdSpoolDir=$out/spool
SlurmctldPidFile=$out/slurmctld.pid
SlurmdPidFile=$out/slurmd.pid
SlurmctldLogFile=$out/slurmctld.log
SlurmdLogFile=$out/slurmd.log
ProctrackType=proctrack/pgid
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
MailProg=/bin/true
NodeName=$(hostname -s) NodeAddr=192.0.2.1 CPUs=$(nproc) State=UNKNOWN
PartitionName=exports Nodes=ALL Default=YES State=UP
END
munged --foreground --force --key-file "$out/munge/key" --socket "$out/munge/socket" --pid-file "$out/munge/pid" \
  --log-file "$out/munge/log" --seed-file "$out/munge/seed" 2>"$out/munged.log" &
check "munged runs" wait_until 60 munge --socket "$out/munge/socket" --no-input
slurmctld-wlm -D 2>"$out/slurmctld.err" &
check "slurmctld runs" wait_until 60 scontrol ping
slurmd-wlm -D -d "$root/usr/sbin/slurmstepd-wlm" 2>"$out/slurmd.err" &
node_is() { sinfo --noheader --format %T | grep -qx "$1"; }
check "its node has no work" wait_until 60 node_is idle

# An array of one task for every two seconds of the take.
last_task=$(((seconds - 1) / 2))
array() { # form, folder, options of sbatch...
  local form=$1 folder=$2
  shift 2
  sbatch --array="0-$last_task" --output="$out/task.%A.%a.log" "$@" --wrap "exec '$vantage' take export '$out/take.mkv' \
    --as $form --from \$((SLURM_ARRAY_TASK_ID * 2)) --to \$((SLURM_ARRAY_TASK_ID * 2 + 2)) -o '$folder'"
}
for form in ply exr training; do
  check "one process exports the whole as $form" "$vantage" take export "$out/take.mkv" --as $form -o "$out/$form.one"
  check "$((last_task + 1)) tasks of Slurm export its parts" array $form "$out/$form.tasks" --wait
  check "they wrote the same, byte for byte" diff -r "$out/$form.one" "$out/$form.tasks"
done

# Cancelled once the first file of the second export stands.
written() { [ -n "$(find "$1" -name '*.ply' -print -quit)" ]; }
check "the array begins again in another folder" array ply "$out/cancelled"
check "files of it appear" wait_until 120 written "$out/cancelled"
check "it is cancelled" scancel --name wrap
check "the node has ended it" wait_until 60 node_is idle
check "so the export is not complete" not diff -rq "$out/ply.one" "$out/cancelled"
check "the same array completes it" array ply "$out/cancelled" --wait
check "to the same, byte for byte" diff -r "$out/ply.one" "$out/cancelled"
close_checks
