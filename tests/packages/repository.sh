#!/usr/bin/env bash
# The signed repository, as apt of a bare Debian sees it: installed from, upgraded, gone back, purged, and refused where
# somebody changed it.
#   repository.sh WORK PACKAGES     after make.sh
# Exits 77 with one line "SKIPPED: reason" where this computer lacks what it takes; with VANTAGE_HIL_REQUIRED in the
# environment that is a failure.
set -euo pipefail
tools=$(cd "$(dirname "$0")/../../tools" && pwd)
work=$1 made=$(realpath "$2")
skip() {
  [ -z "${VANTAGE_HIL_REQUIRED:-}" ] || { echo "repository: $1" >&2; exit 1; }
  echo "SKIPPED: $1"
  exit 77
}
for tool in aptly gpg mmdebstrap; do
  command -v $tool >/dev/null || skip "$tool is missing (./test installs it)"
done
codename=$(. /etc/os-release && echo "${VERSION_CODENAME:-unknown}")
case "$codename" in bookworm | trixie) ;; *) skip "this is neither Debian 12 nor 13, whose packages are made here" ;; esac
as_root=()
if [ "$(id -u)" -ne 0 ]; then
  sudo -n true 2>/dev/null || skip "a bare Debian is made by root: be root, or have sudo ask for no password"
  as_root=(sudo)
fi

rm -rf "$work"
mkdir -p "$work"
work=$(realpath "$work")
root=$(mktemp -d "${TMPDIR:-/var/tmp}/vantage-repository.XXXXXX")
export GNUPGHOME=$work/gnupg
finish() {
  gpgconf --kill all
  "${as_root[@]}" umount "$root/repository" "$root/proc" "$root/dev" 2>/dev/null || true
  "${as_root[@]}" rm -rf --one-file-system "$root"
}
trap finish EXIT
trap 'exit 130' INT TERM

checks_log=$work/check.log
. "$tools/../tests/support/checks.sh"
refuses() { # words command...
  local words=$1
  shift
  ! "$@" 2>"$work/refusal" && grep -q "$words" "$work/refusal"
}

first=$(dpkg-deb -f "$made"/first/vantage-rig_*.deb Version)
mkdir -m 700 "$GNUPGHOME"
gpg --batch --quiet --passphrase '' --quick-generate-key 'Vantage <vantage@localhost>' ed25519 sign never

settings=$work/apt.conf
apt-config dump | grep -E '^Acquire::([a-z]+::([^ ]*::)?Proxy|Check-|Retries)' >"$settings" || true
sources=$("$tools/debian_sources.sh" "$codename")
if [ "$codename" = bookworm ]; then
  # As docs/build/deploy.md says: libcamera and libgpiod are too old there.
  sources+=$'\n'$(awk '$3 == "bookworm" {print $1, $2, "bookworm-backports main"; exit}' <<<"$sources")
fi
"${as_root[@]}" mmdebstrap --quiet --mode=root --variant=apt --aptopt="$settings" "$codename" "$root" - <<<"$sources" 2>"$work/root.log" ||
  { tail -5 "$work/root.log" >&2; skip "no bare Debian can be had"; }
"${as_root[@]}" mkdir -p "$root/repository" "$root/etc/apt/keyrings"
inside() { "${as_root[@]}" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin DEBIAN_FRONTEND=noninteractive chroot "$root" "$@"; }
apt_get() { inside apt-get -q -y --no-install-recommends "$@"; }

repository() { "$tools/apt_repository.sh" "$work/repository" --key 'Vantage <vantage@localhost>' "$@"; }
check "the repository is made by one command" repository "$made"/first/*.deb
check "again with the same packages it stays as it is" repository "$made"/first/*.deb
mkdir -p "$work/other/DEBIAN"
printf 'Package: other\nVersion: 1.0\nArchitecture: all\nMaintainer: x <x@localhost>\nDescription: x\n' >"$work/other/DEBIAN/control"
dpkg-deb --build "$work/other" "$work/other.deb" >/dev/null
check "a package of no known release is refused" refuses "names no release of Debian" repository "$work/other.deb"
check "and a key that nobody has" refuses "has no secret key" "$tools/apt_repository.sh" "$work/repository" --key nobody "$made"/first/*.deb
"${as_root[@]}" mount --bind "$work/repository/public" "$root/repository"
"${as_root[@]}" cp "$work/repository/public/vantage.gpg" "$root/etc/apt/keyrings/"
printf 'Types: deb\nURIs: file:///repository\nSuites: %s\nComponents: main\nSigned-By: /etc/apt/keyrings/vantage.gpg\n' "$codename" |
  "${as_root[@]}" tee "$root/etc/apt/sources.list.d/vantage.sources" >/dev/null
check "apt takes it by its key" apt_get update
options=()
[ "$codename" != bookworm ] || options=(-t bookworm-backports)
packages=(vantage-rig vantage vantage-calib)
check "apt installs all three from it" apt_get install "${options[@]}" "${packages[@]}"
all_run() { # Named as their packages are.
  local program
  for program in "${packages[@]}"; do inside $program --version || return 1; done
}
check "their programs run" all_run
# Whoever installs the packages can play the demo.
"${as_root[@]}" mount --bind /proc "$root/proc"
"${as_root[@]}" mount --bind /dev "$root/dev"
check "a user plays the demo" inside su -s /bin/sh -c 'cd /tmp && vantage demo --headless --seconds 3 --folder played' nobody
check "which leaves a film" inside test -s /tmp/played/flight.mkv

inside sh -c 'echo "# the administrator'"'"'s own line" >>/etc/vantage/rig.toml
  echo secret >/etc/vantage/rig.key && chown root:vantage /etc/vantage/rig.key && chmod 640 /etc/vantage/rig.key
  echo numbers >/etc/vantage/calibration.yaml
  install -d -o vantage -g vantage /var/lib/vantage /var/lib/vantage/takes
  echo seen >/var/lib/vantage/takes/take.mkv && chown vantage:vantage /var/lib/vantage/takes/take.mkv'
kept() {
  inside sh -c 'grep -q "own line" /etc/vantage/rig.toml && test -s /etc/vantage/calibration.yaml &&
    test -s /var/lib/vantage/takes/take.mkv && test "$(stat -c "%U %G %a" /etc/vantage/rig.key)" = "root vantage 640"'
}
version_is() { # all three packages'
  local package
  for package in "${packages[@]}"; do
    test "$(inside dpkg-query -W -f '${Version}' $package)" = "$1" || return 1
  done
}
check "newer packages are added" repository "$made"/next/*.deb
check "apt sees them" apt_get update
check "and upgrades to them" apt_get upgrade
check "all in their version" version_is "$first+1"
check "their programs run" all_run
check "configuration, key, calibration and take are kept" kept
check "apt goes back to those before" apt_get install --allow-downgrades "${packages[@]/%/=$first}"
check "all in their version" version_is "$first"
check "their programs run" all_run
check "configuration, key, calibration and take are kept" kept

check "all is purged" apt_get purge "${packages[@]}"
check "with configuration and keys" not inside test -e /etc/vantage
check "but never a take" inside test -s /var/lib/vantage/takes/take.mkv
check "which is still the service's" inside test "$(inside stat -c %U /var/lib/vantage/takes/take.mkv)" = vantage

index=$(find "$work/repository/public/dists/$codename/main/binary-amd64" -name Packages)
echo >>"$index"
rm -f "${index}".gz "${index}".bz2
check "what somebody changed is refused" not inside sh -c 'rm -rf /var/lib/apt/lists/* && apt-get -q update -o APT::Update::Error-Mode=any'
close_checks
