#!/usr/bin/env bash
# Installs the packages of packages.txt that are missing, and nothing else.
#   tools/install_packages.sh run|test
# Works as root and with sudo. Where everything is there already it asks neither apt nor the network.
# On Debian 12 it adds bookworm-backports from the mirror that this machine already uses.
set -euo pipefail
cd "$(dirname "$0")/.."

purpose=${1:-run}
case "$purpose" in run | test) ;; *)
  echo "install_packages.sh: '$purpose' is neither run nor test" >&2
  exit 2
  ;;
esac

plain=() backports=()
while read -r name flags; do
  case "$name" in '' | '#'*) continue ;; esac
  case " $flags " in *' test '*) [ "$purpose" = test ] || continue ;; esac
  case " $flags " in *' backports '*) backports+=("$name") ;; *) plain+=("$name") ;; esac
done <packages.txt

installed() { # name [minimal upstream version]
  dpkg-query -W -f '${db:Status-Status}\n' "$1" 2>/dev/null | grep -qx installed
}
codename=$(. /etc/os-release && echo "${VERSION_CODENAME:-unknown}")
release_only_needs_backports=false
[ "$codename" = bookworm ] && release_only_needs_backports=true

missing=() missing_backports=()
for p in "${plain[@]}"; do installed "$p" || missing+=("$p"); done
for p in "${backports[@]}"; do
  if ! $release_only_needs_backports; then
    installed "$p" || missing+=("$p")
  elif ! dpkg-query -W -f '${db:Status-Status} ${Version}\n' "$p" 2>/dev/null | grep -q '^installed .*\(~bpo12\|+rpt\)'; then
    missing_backports+=("$p")
  fi
done
[ ${#missing[@]} -eq 0 ] && [ ${#missing_backports[@]} -eq 0 ] && exit 0

as_root() {
  if [ "$(id -u)" -eq 0 ]; then
    "$@"
  elif command -v sudo >/dev/null; then
    sudo "$@"
  else
    echo "Vantage needs these packages: ${missing[*]} ${missing_backports[*]}." >&2
    echo "You are not root and there is no sudo: ask an administrator to install them." >&2
    exit 1
  fi
}
if ! command -v apt-get >/dev/null; then
  echo "Vantage installs its packages with apt-get (Debian 12, 13, Raspberry Pi OS), and this system has none." >&2
  exit 1
fi

export DEBIAN_FRONTEND=noninteractive
echo "Vantage: installing ${#missing[@]} packages, and ${#missing_backports[@]} from backports ..." >&2
if [ ${#missing_backports[@]} -gt 0 ] && ! apt-cache policy | grep -q "${codename}-backports"; then
  mirror=$(apt-get indextargets --format '$(REPO_URI) $(CODENAME)' | awk -v c="$codename" '$2 == c {print $1; exit}')
  keyring=/usr/share/keyrings/debian-archive-keyring.gpg
  if [ -z "$mirror" ]; then
    echo "Vantage: apt knows no mirror of Debian $codename, so its backports cannot be added;" >&2
    echo "add ${codename}-backports to apt's sources and call this again." >&2
    exit 1
  fi
  printf 'Types: deb\nURIs: %s\nSuites: %s-backports\nComponents: main\nSigned-By: %s\n' "$mirror" "$codename" "$keyring" |
    as_root tee /etc/apt/sources.list.d/vantage-backports.sources >/dev/null
fi
apt_get() { as_root env DEBIAN_FRONTEND=noninteractive apt-get -q -o Dpkg::Use-Pty=0 -o DPkg::Lock::Timeout=300 "$@"; }
apt_get update
if [ ${#missing_backports[@]} -gt 0 ]; then
  apt_get install -y --no-install-recommends -t "${codename}-backports" "${missing_backports[@]}"
fi
if [ ${#missing[@]} -gt 0 ]; then
  apt_get install -y --no-install-recommends "${missing[@]}"
fi
