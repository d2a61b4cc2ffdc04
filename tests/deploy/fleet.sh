#!/usr/bin/env bash
# A fleet of three rig computers, deployed by hw_config/deploy: Debian with its own systemd, sshd and network each
# (systemd-nspawn), and the packages of this build in a signed repository. Installed, changed, upgraded, a broken upgrade
# taken back, a rig replaced, drift reported. Run by hand:
#   tests/deploy/fleet.sh WORK BUILD_FOLDER
# VANTAGE_FLEET_ROOT=FOLDER keeps the bare Debian there for the next time. Needs root, ansible-core, systemd-container and
# what ./test installs. Exits 77 with one line "SKIPPED: reason" where this computer lacks that. Nothing listens beyond
# the fleet's own network namespace. Closes with a line `N passed, N failed`.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
work=${1:?fleet.sh WORK BUILD_FOLDER} build=$(realpath "${2:?fleet.sh WORK BUILD_FOLDER}")
skip() { echo "SKIPPED: $1"; exit 77; }
[ "$(id -u)" -eq 0 ] || skip "containers are started by root"
for tool in ansible-playbook:ansible-core systemd-nspawn:systemd-container ssh:openssh-client mmdebstrap:mmdebstrap \
  aptly:aptly gpg:gnupg dpkg-shlibdeps:dpkg-dev ip:iproute2; do
  command -v "${tool%%:*}" >/dev/null || skip "${tool%%:*} is missing (sudo apt install ${tool#*:})"
done
codename=$(. /etc/os-release && echo "${VERSION_CODENAME:-unknown}")
case "$codename" in bookworm | trixie) ;; *) skip "this is neither Debian 12 nor 13, whose packages are made here" ;; esac
for program in vantage vantage-rig; do
  [ -x "$build/bin/$program" ] || skip "$build/bin/$program is missing (./run --build-only makes it)"
done
tools=$here/../../tools

rm -rf "$work"
mkdir -p "$work"
work=$(realpath "$work")
lab=$(mktemp -d "${TMPDIR:-/var/tmp}/vantage-fleet.XXXXXX")
base=${VANTAGE_FLEET_ROOT:-$lab/debian}
export GNUPGHOME=$work/gnupg
. "$here/base.sh"
finish() {
  gpgconf --kill all
  rm -rf --one-file-system "$lab"
}
trap finish EXIT
trap 'exit 130' INT TERM

# Three versions: the one that was built, the next one, and one whose daemon ends at once.
(cd "$build" && cpack -B "$work/first" -D CPACK_COMPONENTS_ALL=rig >"$work/cpack.log" 2>&1) ||
  { tail -20 "$work/cpack.log" >&2; exit 1; }
package=$(echo "$work"/first/vantage-rig_*.deb)
first=$(dpkg-deb -f "$package" Version) next=$first+1 broken=$first+2
repack() { # version
  sed -i "s/^Version:.*/Version: $1/" "$work/tree/DEBIAN/control"
  dpkg-deb -Zgzip -z1 --root-owner-group --build "$work/tree" "$work/vantage-rig_$1.deb" >/dev/null
}
dpkg-deb -R "$package" "$work/tree"
repack "$next"
printf '#!/bin/sh\necho "vantage-rig: this version is broken" >&2\nexit 1\n' >"$work/tree/usr/bin/vantage-rig"
repack "$broken"
mkdir -m 700 "$GNUPGHOME"
gpg --batch --quiet --passphrase '' --quick-generate-key 'Fleet <fleet@localhost>' ed25519 sign never
"$tools/apt_repository.sh" "$work/repository" --key 'Fleet <fleet@localhost>' "$package" "$work"/vantage-rig_*.deb

ssh-keygen -q -t ed25519 -N '' -f "$work/technician"
make_base "$(dpkg-deb -f "$package" Depends), linuxptp" || { tail -5 "$work/root.log" >&2; skip "no bare Debian can be had"; }
# In a network and with mounts that are nobody else's.
status=0
unshare --net --mount "$here/story.sh" "$work" "$build" "$lab" "$base" "$first" || status=$?
exit $status
