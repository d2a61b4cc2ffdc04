#!/usr/bin/env bash
# A rig's daemon on a network with two PTP grandmasters, each computer in a network namespace of its own.
#   unshare --mount --pid --fork --kill-child ptp_masters.sh FOLDER PROGRAM [ARGUMENTS]
# The second grandmaster, which is the better one, comes when FOLDER/second exists, and goes when FOLDER/second_gone exists.
# All namespaces have one clock, so every ptp4l observes it and sets nothing. The logs are FOLDER/NAME.ptp.
set -euo pipefail
folder=$1
shift
mount --make-rprivate /
mount -t tmpfs tmpfs /run
for computer in switch first second rig; do ip netns add "$computer"; done
ip -n switch link add bridge type bridge
ip -n switch link set bridge up
for computer in first second rig; do
  ip link add eth0 netns "$computer" type veth peer name "$computer" netns switch
  ip -n switch link set dev "$computer" master bridge up
  ip -n "$computer" link set dev lo up
  ip -n "$computer" link set dev eth0 up
done
ptp4l() {
  exec ip netns exec "$1" /usr/sbin/ptp4l -S -2 -m -i eth0 --free_running 1 --logAnnounceInterval -2 "${@:2}" > "$folder/$1.ptp" 2>&1
}
exists() { until [ -e "$folder/$1" ]; do sleep 0.05; done; }
# The socket is where ptp4l's is by default, which the daemon asks.
ptp4l rig --slaveOnly 1 &
ptp4l first --priority1 100 --uds_address /run/ptp4l-first &
{
  exists second
  ptp4l second --priority1 50 --uds_address /run/ptp4l-second &
  exists second_gone
  kill $!
} &
exec "$@"
