# Rig computers of tests/deploy/fleet.sh, sourced by it: containers with a systemd of their own, each with a layer of files
# over one bare Debian. Uses $lab, $base, $work and $network.

make_network() {
  ip link set lo up
  ip link add fleet type bridge
  ip address add $network.1/24 dev fleet
  ip link set fleet up
}

# Where systemd does not give a container a control group, this does: two in one would end each other's services.
enter_group() { # name
  local hierarchy
  [ ! -d /run/systemd/system ] || return 0
  for hierarchy in /sys/fs/cgroup /sys/fs/cgroup/*; do
    [ -e "$hierarchy/cgroup.procs" ] || continue
    mkdir -p "$hierarchy/vantage-fleet-$1" 2>/dev/null || continue
    echo $BASHPID >"$hierarchy/vantage-fleet-$1/cgroup.procs" 2>/dev/null || true
  done
}

start_rig() { # name, last byte of its address
  local folder=$lab/$1 group=()
  mkdir -p "$folder"/{upper,work,root}
  mount -t overlay overlay -o "lowerdir=$base,upperdir=$folder/upper,workdir=$folder/work" "$folder/root"
  echo "$1" >"$folder/root/etc/hostname"
  printf '127.0.0.1 localhost %s\n' "$1" >"$folder/root/etc/hosts"
  tr -d - </proc/sys/kernel/random/uuid >"$folder/root/etc/machine-id"
  printf '[Match]\nName=host0\n[Network]\nAddress=%s.%s/24\n' $network "$2" >"$folder/root/etc/systemd/network/10-host0.network"
  chroot "$folder/root" ssh-keygen -A >/dev/null
  install -d -m 700 "$folder/root/home/technician/.ssh"
  cp "$work/technician.pub" "$folder/root/home/technician/.ssh/authorized_keys"
  chroot "$folder/root" chown -R technician: /home/technician
  [ -d /run/systemd/system ] || group=(--keep-unit)
  (
    enter_group "$1"
    exec systemd-nspawn --quiet --boot --register=no "${group[@]}" --directory "$folder/root" --machine "$1" \
      --network-bridge=fleet --resolv-conf=off --console=pipe </dev/null >"$work/$1.console" 2>&1
  ) &
  echo $! >"$folder/pid"
  local end=$((SECONDS + 60))
  until (exec 3<>/dev/tcp/$network."$2"/22) 2>/dev/null; do
    [ $SECONDS -lt $end ] || { echo "fleet: $1 does not come up: $(tail -n 5 "$work/$1.console")" >&2; return 1; }
    sleep 0.5
  done
}

leader_of() { # rig: process 1 of its container, as seen from here
  pgrep --parent "$(cat "$lab/$1/pid")" | head -n 1
}

on() { # rig command...
  local rig=$1
  shift
  nsenter --target "$(leader_of "$rig")" --mount --uts --ipc --net --pid -- env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin "$@"
}

stop_rig() { # name
  local folder=$lab/$1 pid
  pid=$(cat "$folder/pid")
  kill -KILL "$(leader_of "$1")" 2>/dev/null || true # systemd-nspawn ends with it
  wait "$pid" 2>/dev/null || true
  for _ in $(seq 50); do umount "$folder/root" 2>/dev/null && break || sleep 0.2; done
  rm -rf --one-file-system "$folder"
  for hierarchy in /sys/fs/cgroup /sys/fs/cgroup/*; do
    [ ! -d "$hierarchy/vantage-fleet-$1" ] || find "$hierarchy/vantage-fleet-$1" -depth -type d -exec rmdir {} + 2>/dev/null || true
  done
}

stop_rigs() {
  local pid
  for pid in "$lab"/*/pid; do [ ! -e "$pid" ] || stop_rig "$(basename "$(dirname "$pid")")"; done
}

replace_rig() { # name, last byte of its address: another computer in its place
  stop_rig "$1"
  start_rig "$1" "$2"
}
