#!/usr/bin/env bash
# What happens to the fleet; fleet.sh starts it in a network namespace of its own.
#   story.sh WORK BUILD_FOLDER LAB BASE FIRST_VERSION
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
work=$1 build=$2 lab=$3 base=$4 first=$5
next=$first+1 broken=$first+2
network=10.89.0
deploy=$(realpath "$here/../../hw_config/deploy")
export PATH=$build/bin:$PATH
# ssh keeps connections a while; one to a rig that is gone must not be taken for the next.
export ANSIBLE_SSH_CONTROL_PATH_DIR=$lab/ssh
. "$here/containers.sh"
finish() {
  stop_rigs
  [ -z "${server-}" ] || kill "$server" 2>/dev/null || true
}
trap finish EXIT
trap 'exit 130' INT TERM

checks_log=$work/check.log
. "$here/../support/checks.sh"

make_network
(cd "$work/repository/public" && exec python3 -m http.server --bind $network.1 80 >"$work/http.log" 2>&1) &
server=$!

# The host's side: a stage, and what its rigs are to be.
stage=$work/stage/stage.toml
mkdir -p "$work/stage/group_vars" "$work/stage/host_vars"
vantage keys new "$work/stage/host.key" >"$work/host.pub"
{
  printf 'version = 1\nkey_file = "host.key"\nrate_hz = 2.0\n'
  number=1
  for rig in north south west; do
    printf '[[rigs]]\nname = "%s"\nendpoint = "tcp://%s:5600"\npublic_key_file = "%s.pub"\n' $rig $network.1$number $rig
    number=$((number + 1))
  done
} >"$stage"
settings() { # version azimuth sysctl
  cat >"$work/stage/group_vars/rigs.yml" <<END
ansible_user: technician
ansible_ssh_private_key_file: $work/technician
ansible_ssh_common_args: -o UserKnownHostsFile=$work/known_hosts -o StrictHostKeyChecking=accept-new
ansible_python_interpreter: /usr/bin/python3
vantage_version: "$1"
vantage_repository: http://$network.1/
vantage_repository_key: $work/repository/public/vantage.gpg
vantage_default_release: ""
vantage_config:
  source: {width_px: 64, height_px: 48}
  virtual_rig: {elevation_deg: $2, loop_mb: 1.0}
  match: {disparities: 16, preset: fast}
vantage_ptp: software
vantage_ptp_interface: host0
# A container may not set the clock.
vantage_ptp_options: {free_running: 1}
vantage_sysctl: {net.ipv4.tcp_retries2: $3}
vantage_boot: pi5-global-shutter
vantage_health_limit_s: 60
END
}
play() { # option...
  (cd "$deploy" && ANSIBLE_NOCOLOR=1 ansible-playbook -i "$stage" site.yml "$@") 2>&1 | tee "$work/play.log"
}
changed() { # rig, how many tasks changed
  grep -Eq "^$1 +:.* changed=$2 " "$work/play.log"
}
none_changed() { for rig in "$@"; do changed $rig 0 || return 1; done; }
not_reached() { ! grep -Eq "^$1 +:" "$work/play.log"; }
# Ansible breaks the lines of its warnings.
says() { grep -q -e "$1" "$work/play.log" || tr '\n' ' ' <"$work/play.log" | grep -q -e "$1"; }
version_is() { # version rig...
  local version=$1 rig
  shift
  for rig in "$@"; do [ "$(on "$rig" dpkg-query -W -f '${Version}' vantage-rig)" = "$version" ] || return 1; done
}
all_stream() {
  local told
  told=$(vantage rigs status --stage "$stage" --wait 20 --json) || true
  echo "$told"
  [ "$(grep -o '"state":"connected"' <<<"$told" | wc -l)" -eq 3 ] && [ "$(grep -o '"published":[1-9]' <<<"$told" | wc -l)" -ge 3 ]
}

all_have() { # line of rig.toml
  local rig
  for rig in north south west; do on "$rig" grep -qx "$1" /etc/vantage/rig.toml || return 1; done
}
calibration_is_here() { diff <(on north cat /etc/vantage/calibration.yaml) "$work/stage/north.yaml"; }
# No secret key of a rig lies on this side or was told while deploying.
secrets_stayed() {
  local rig secret
  for rig in north south west; do
    secret=$(on "$rig" sed -n 's/^secret = "\(.*\)"$/\1/p' /etc/vantage/rig.key)
    [ ${#secret} -eq 40 ] || return 1
    ! grep -rqF -e "$secret" "$work/stage" "$work/play.log" || return 1
  done
  [ "$(cat "$work"/stage/{north,south,west}.pub | sort -u | wc -l)" -eq 3 ]
}

for rig in north:11 south:12 west:13; do start_rig "${rig%:*}" "${rig#*:}"; done
settings "$first" 10.0 12
check "a PTP role that there is not is refused" not play -e vantage_ptp=hardwear
check "with what there is" says "it must be hardware, software or none"
sed 's/:5600/:x/' "$stage" >"$work/stage/wrong.toml"
check "a stage file with a wrong endpoint is refused" not play -i "$work/stage/wrong.toml"
check "by the rig's name" says "the endpoint of 'north' must be tcp://HOST:PORT"
check "what --check says of bare rigs is no failure" play --check --diff -e vantage_serial=3
check "and changes none of them" not on north test -e /etc/vantage
check "three rigs are installed" play -e vantage_serial=3
check "in the version of the stage" version_is "$first" north south west
check "a host with the right key hears all of them" all_stream
check "their secret keys differ and stayed there" secrets_stayed
check "PTP runs at the interface that was named" on north sh -c "systemctl is-active vantage-ptp-software && grep -q '^\[host0\]' /etc/vantage/ptp/rig-software.conf"
check "the kernel setting is in force" on north sh -c 'test "$(sysctl -n net.ipv4.tcp_retries2)" = 12'
check "boot files are in place" on north sh -c 'grep -q "^# BEGIN Vantage" /boot/firmware/config.txt && test -s /etc/modprobe.d/vantage-imx296.conf'
check "a second time" play -e vantage_serial=3
check "nothing changes" none_changed north south west

settings "$first" 12.0 9
cp "$here/calibration.yaml" "$work/stage/north.yaml"
check "a changed configuration is shown by --check --diff" play --check --diff -e vantage_serial=3
check "line by line" says '^+elevation_deg = 12.0'
check "and not made" on south grep -q 'elevation_deg = 10.0' /etc/vantage/rig.toml
check "it is deployed" play -e vantage_serial=3
check "to all" all_have "elevation_deg = 12.0"
check "a rig's calibration with it" on north grep -q '^calibration = "calibration.yaml"' /etc/vantage/rig.toml
check "as it is here" calibration_is_here
check "the kernel setting with it" on west sh -c 'test "$(sysctl -n net.ipv4.tcp_retries2)" = 9'

key=$(on south sha256sum /etc/vantage/rig.key)
settings "$next" 12.0 9
check "an upgrade" play
check "reaches all" version_is "$next" north south west
check "of which vantage rigs update says the same" vantage rigs update --stage "$stage" --wait 20
check "and keeps their keys" test "$(on south sha256sum /etc/vantage/rig.key)" = "$key"
check "all stream" all_stream

settings "$broken" 14.0 9
check "a broken upgrade fails" not play
check "the first rig says why" says 'this version is broken'
check "the play ends before the second" not_reached south
check "the first has its version back" version_is "$next" north
check "and its configuration" on north grep -q 'elevation_deg = 12.0' /etc/vantage/rig.toml
check "the others were not touched" version_is "$next" south west
check "all stream" all_stream
settings "$next" 12.0 9
check "the settings of before" play -e vantage_serial=3
check "finds nothing to change" none_changed north south west

sed -i 's/baseline_m: 0.12/baseline_m: 0.13/' "$work/stage/north.yaml"
check "a damaged calibration fails" not play
check "the rig says why" says 'the checksum does not fit'
check "and has the one before" on north grep -q 'baseline_m: 0.12' /etc/vantage/calibration.yaml
cp "$here/calibration.yaml" "$work/stage/north.yaml"

before=$(cat "$work/stage/west.pub")
replace_rig west 13
rm -rf "$ANSIBLE_SSH_CONTROL_PATH_DIR"
ssh-keygen -q -f "$work/known_hosts" -R $network.13 >/dev/null 2>&1
check "a rig that was replaced is made like the others" play -e vantage_serial=3
check "which stay as they are" none_changed north south
check "it has a key of its own, which this host knows now" test "$(cat "$work/stage/west.pub")" != "$before"
check "all stream" all_stream

on south sh -c "sed -i 's/elevation_deg = 12.0/elevation_deg = 80.0/' /etc/vantage/rig.toml; echo intruder >>/etc/vantage/hosts.keys
  sysctl -q -w net.ipv4.tcp_retries2=5; systemctl disable --now vantage-ptp-software"
check "drift is looked for" play --check --diff -e vantage_serial=3
check "found at the rig that drifted: configuration, and so a restart, hosts, kernel, PTP" changed south 5
check "and nowhere else" none_changed north west
check "with what differs" says '^-elevation_deg = 80.0'
check "nothing was mended by looking" on south grep -q 'elevation_deg = 80.0' /etc/vantage/rig.toml
check "it is mended" play -e vantage_serial=3
check "and gone" play --check -e vantage_serial=3
check "at all" none_changed north south west
check "all stream" all_stream
close_checks
