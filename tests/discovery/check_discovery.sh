#!/usr/bin/env bash
# A rig announces itself through a real avahi-daemon, and a host finds it and pairs with it: in a network of their own,
# where nobody else hears them. Needs no root, but leave to make user and network namespaces.
#   tests/discovery/check_discovery.sh VANTAGE VANTAGE_RIG
set -euo pipefail
export PATH=$PATH:/usr/sbin:/sbin
vantage=$(realpath "$1") rig=$(realpath "$2")
if [ "${3:-}" != inside ]; then
  for needed in unshare ip dbus-daemon avahi-daemon jq; do
    command -v $needed >/dev/null || { echo "SKIPPED: there is no $needed on this computer"; exit 0; }
  done
  unshare --user --map-root-user --net --mount --pid --fork true 2>/dev/null ||
    { echo "SKIPPED: this user may make no network namespace here"; exit 0; }
  # With the process that begins it all others of the namespace end.
  exec unshare --user --map-root-user --net --mount --pid --fork --mount-proc "$0" "$vantage" "$rig" inside
fi

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mount -t tmpfs none /run
mkdir -p /run/dbus
# The daemons' own users are not known in here: they are this one.
for file in passwd group; do
  sed -E 's,^(avahi|messagebus):x:[0-9]+,\1:x:0,' /etc/$file >"$work/$file"
  mount --bind "$work/$file" /etc/$file
done
ip link set lo up
ip link add stage0 type veth peer name stage1 2>/dev/null || { echo "SKIPPED: this kernel has no veth"; exit 0; }
ip link set stage1 up
ip address add 10.77.0.1/24 dev stage0
ip link set stage0 up multicast on

cat >"$work/bus.conf" <<'END'
<busconfig>
  <type>system</type>
  <listen>unix:path=/run/dbus/system_bus_socket</listen>
  <auth>EXTERNAL</auth>
  <policy context="default"><allow send_destination="*"/><allow receive_sender="*"/><allow own="*"/><allow user="*"/></policy>
</busconfig>
END
printf '[server]\nallow-interfaces=stage0\nuse-ipv6=no\n' >"$work/avahi.conf"
dbus-daemon --config-file="$work/bus.conf" --fork --nopidfile
avahi-daemon --file="$work/avahi.conf" --no-drop-root --no-chroot --no-rlimits >"$work/avahi.log" 2>&1 &
for _ in $(seq 100); do
  grep -q 'Server startup complete' "$work/avahi.log" && break
  sleep 0.05
done
grep -q 'Server startup complete' "$work/avahi.log" ||
  { cat "$work/avahi.log"; echo "SKIPPED: avahi-daemon does not run in a namespace here"; exit 0; }

printf 'version = 1\nname = "north"\n[stream]\nbind = "tcp://*:5600"\nkey_file = "rig.key"\nauthorized_hosts = "h"\n' \
  >"$work/rig.toml"
mkfifo "$work/at_rig" "$work/at_host"
: >"$work/rig.out"
exec 3<>"$work/at_rig" 4<>"$work/at_host"
"$rig" pair --json --config "$work/rig.toml" <"$work/at_rig" >"$work/rig.out" &
until grep -q '"open"' "$work/rig.out"; do sleep 0.05; done
search() {
  "$vantage" setup --json --search 3 --wait 0.2 --stage "$work/stage.toml" <"$work/at_host" >"$work/host.out" 2>"$work/host.err" &
  host=$!
}
search
code() { sed -n 's/.*"event":"code","code":"\([0-9 ]*\)".*/\1/p' "$1"; }
for _ in $(seq 300); do
  [ -z "$(code "$work/rig.out")" ] || [ -z "$(code "$work/host.out")" ] || break
  # Registering takes Avahi a second or so, and longer on a busy computer.
  kill -0 $host 2>/dev/null || search
  sleep 0.1
done
code "$work/rig.out" >&4
code "$work/host.out" >&3
for _ in $(seq 100); do
  grep -q '"checked"' "$work/host.out" && break
  sleep 0.1
done
cat "$work"/{rig.out,host.out,host.err}
jq -es '.[0] | .event == "found" and .rigs == [{"name": "north", "host": "10.77.0.1", "pairing_port": 5590,
  "stream_port": 0}]' "$work/host.out" >/dev/null || { echo "FAILED: the rig was not found as it is"; exit 1; }
grep -q 'tcp://10.77.0.1:5600' "$work/stage.toml" || { echo "FAILED: the rig is not in the stage"; exit 1; }
echo "found and paired"
